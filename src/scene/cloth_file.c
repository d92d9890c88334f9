#define _XOPEN_SOURCE 700 /* realpath */
#include "scene/cloth_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/fail.h"
#include "base/pi.h"
#include "weave/weave_draft.h"
#include "weave/weft_cloth.h"

enum { CELLS_MAX = 1 << 20 }; /* of a draft: a cloth takes 16 bytes a crossing */

/* A weave being read. The first failure stays. */
typedef struct ClothReader {
    const char *name, *folder;
    const WeftLog *log;
    WeftError *error;
    WeftResult result;
    WeftDraft *draft;
    char path[4096 + 512]; /* of the draft's file; "": it is in none */
    WeftYarn yarns[2];
} ClothReader;

static void refuse(ClothReader *r, const char *key, const char *what) {
    if (r->result == WEFT_OK)
        r->result = fail(r->error, WEFT_MESSAGE_MATERIAL_FILE, r->name, "weave: %.40s: %s", key, what);
}

static void keep_first(ClothReader *r, WeftResult result) {
    if (r->result == WEFT_OK) r->result = result;
}

/* A draft as the text of a WIF, which has lines, in words, or in a file beside the material's. */
static void read_draft(ClothReader *r, const json_t *json) {
    const char *text = json_string_value(json);
    struct stat file;
    if (text && strchr(text, '\n')) {
        keep_first(r, weft_draft_read_memory(text, strlen(text), r->name, &r->draft, r->log, r->error));
        return;
    }
    if (!text || strlen(text) > 4096) {
        refuse(r, "draft", "expected words such as \"twill 2/2\", or a file");
        return;
    }
    if (r->folder && strlen(r->folder) > 511) {
        refuse(r, "draft", "lies in a folder whose name is too long");
        return;
    }
    snprintf(r->path, sizeof r->path, "%.511s%s", text[0] == '/' || !r->folder ? "" : r->folder, text);
    if (r->folder && stat(r->path, &file) == 0) {
        keep_first(r, weft_draft_read(r->path, &r->draft, r->log, r->error));
    } else {
        keep_first(r, weft_draft_parse(text, &r->draft, r->error));
        r->path[0] = '\0';
    }
}

/* "#rrggbb", on all threads of a system. */
static void read_color(ClothReader *r, const json_t *json, WeftThreads threads) {
    const char *text = json_string_value(json);
    char *end = NULL;
    const bool hex =
        text && text[0] == '#' && strlen(text) == 7 && strspn(text + 1, "0123456789abcdefABCDEF") == 6;
    const unsigned long rgb = hex ? strtoul(text + 1, &end, 16) : 0;
    if (!end || *end) {
        refuse(r, "color", "expected a colour such as \"#c02030\"");
        return;
    }
    for (int k = 0; r->draft && k < r->draft->count[threads]; k++)
        for (int c = 0; c < 3; c++)
            r->draft->threads[threads][k].color[c] = (float)(rgb >> (16 - 8 * c) & 255u) / 255.0f;
}

static void read_number(ClothReader *r, const char *key, const json_t *json, WeftYarn *yarn) {
    const struct {
        const char *key;
        float *to;
        float scale;
    } numbers[] = {{"alpha", &yarn->alpha, 1.0f},         {"crimp", &yarn->crimp, (float)RADIANS},
                   {"roundness", &yarn->roundness, 1.0f}, {"twist", &yarn->twist, (float)RADIANS},
                   {"white", &yarn->white, 1.0f},         {"width", &yarn->width, 1.0f},
                   {"bulge", &yarn->bulge, 1.0f},         {"floats", &yarn->floats, 1.0f},
                   {"streaks", &yarn->streaks, 1.0f},     {"dye", &yarn->dye, 1.0f},
                   {"slub", &yarn->slub, 1.0f},           {"wander", &yarn->wander, 1.0f}};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        if (strcmp(key, numbers[k].key) == 0) {
            if (!json_is_number(json)) refuse(r, key, "expected a number");
            *numbers[k].to = numbers[k].scale * (float)fmin(fmax(json_number_value(json), -1e6), 1e6);
            return;
        }
    refuse(r, key, "is not a key of a yarn");
}

/* The name of a yarn, or {"yarn": NAME, "color": "#rrggbb", "alpha": 0.3, ...}. */
static void read_yarn(ClothReader *r, const json_t *json, WeftThreads threads) {
    WeftYarn *yarn = &r->yarns[threads];
    const json_t *base = json_is_object(json) ? json_object_get(json, "yarn") : json;
    const char *name = base ? json_string_value(base) : "cotton", *key;
    json_t *value;
    if (!name) {
        refuse(r, "yarn", "expected the name of a yarn");
        return;
    }
    keep_first(r, weft_yarn_find(name, yarn, r->error));
    if (!json_is_object(json)) return;
    json_object_foreach((json_t *)(uintptr_t)json, key, value) {
        if (strcmp(key, "yarn") == 0) continue;
        if (strcmp(key, "color") == 0)
            read_color(r, value, threads);
        else
            read_number(r, key, value, yarn);
    }
}

static double positive(ClothReader *r, const json_t *root, const char *key, double otherwise, double high) {
    const json_t *json = json_object_get(root, key);
    if (!json) return otherwise;
    const double value = json_number_value(json);
    if (!json_is_number(json) || !(value >= 0.0 && value <= high))
        refuse(r, key, "is not a number that it can be");
    return value;
}

static void read_keys(ClothReader *r, const json_t *json) {
    static const char *const keys[] = {"draft", "warp", "weft", "metres", "seed"};
    const char *key;
    json_t *value;
    if (!json_is_object(json)) refuse(r, "it", "expected an object with a \"draft\"");
    json_object_foreach((json_t *)(uintptr_t)json, key, value) {
        bool known = false;
        for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) known |= strcmp(key, keys[k]) == 0;
        if (!known) refuse(r, key, "is not a key of a weave");
    }
}

/* Notes what the cloth came from. Returns false if memory is short. */
static bool keep_source(ClothReader *r, const json_t *json, WeftCloth *cloth) {
    cloth->text = json_dumps(json, JSON_COMPACT);
    if (!r->path[0]) return cloth->text != NULL;
    cloth->path = realpath(r->path, NULL);
    cloth->draft = r->draft;
    r->draft = NULL;
    return cloth->text && cloth->path;
}

WeftResult cloth_from_json(const json_t *json, const char *name, const char *folder, WeftCloth **out,
                           const WeftLog *log, WeftError *error) {
    static const char *const systems[] = {"warp", "weft"};
    ClothReader reader = {.name = name, .folder = folder, .log = log, .error = error};
    *out = NULL;
    read_keys(&reader, json);
    if (reader.result == WEFT_OK) read_draft(&reader, json_object_get(json, "draft"));
    for (int t = 0; t < 2 && reader.result == WEFT_OK; t++) {
        const json_t *yarn = json_object_get(json, systems[t]);
        if (yarn)
            read_yarn(&reader, yarn, (WeftThreads)t);
        else
            keep_first(&reader, weft_yarn_find("cotton", &reader.yarns[t], error));
    }
    if (reader.draft && (long)reader.draft->count[0] * reader.draft->count[1] > CELLS_MAX)
        refuse(&reader, "draft", "it has more than a million crossings");
    const double metres = positive(&reader, json, "metres", 1.0, 1e4),
                 seed = positive(&reader, json, "seed", 0.0, 288.0);
    if (!(metres > 0.0)) refuse(&reader, "metres", "is 0");
    if (reader.result == WEFT_OK)
        reader.result = weft_cloth_create(reader.draft, reader.yarns, (unsigned)seed, out, error);
    if (*out) cloth_spread(*out, metres);
    if (*out && !keep_source(&reader, json, *out)) {
        weft_cloth_free(*out);
        *out = NULL;
        reader.result = fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    }
    weft_draft_free(reader.draft);
    return reader.result;
}

json_t *cloth_to_json(const WeftCloth *cloth, const char *draft) {
    json_t *json = json_loads(cloth->text, 0, NULL);
    char *text = cloth->draft && !draft ? wif_text(cloth->draft) : NULL;
    if (!cloth->draft) return json;
    if (json_object_set_new(json, "draft", json_string(draft ? draft : text)) != 0) {
        json_decref(json);
        json = NULL;
    }
    free(text);
    return json;
}
