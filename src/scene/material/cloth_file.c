#define _XOPEN_SOURCE 700 /* realpath */
#include "scene/material/cloth_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "base/fail.h"
#include "base/pi.h"
#include "scene/material/cloth_fit.h"
#include "scene/record/scene.h"
#include "shading/dialect/tone.h"
#include "weave/weave_draft.h"
#include "weave/weft_cloth.h"

enum { CELLS_MAX = 1 << 20 }; /* of a draft: a cloth takes 16 bytes a crossing */

/* The length that the relief of an asset is smoothed over unless the file says another, metres: waves of 10 cm keep half
 * of their height, threads and piles nothing. */
#define RELIEF_FOLDS 0.02f

/* A weave being read. The first failure stays. */
typedef struct ClothReader {
    const ClothSource *source;
    WeftResult result;
    WeftDraft *draft;
    char path[4096 + 512]; /* of the draft's file; "": none */
    WeftYarn yarns[2];
} ClothReader;

static void refuse(ClothReader *r, const char *key, const char *what) {
    if (r->result == WEFT_OK)
        r->result = fail(r->source->error, r->source->refusal, r->source->name, "weave: %.40s: %s", key, what);
}

static void keep_first(ClothReader *r, WeftResult result) {
    if (r->result == WEFT_OK) r->result = result;
}

/* Fails with the error of a draft, and the name of the material file that asks for it. */
static void keep_cause(ClothReader *r, const WeftError *why) {
    if (r->result != WEFT_OK) return;
    r->result = why->result;
    WeftError *error = r->source->error;
    if (!error) return;
    *error = *why;
    const size_t used = strlen(why->text);
    struct stat file;
    const char *hint = stat(r->path, &file) == 0 ? "" : "; words such as twill 2/2 need no file";
    if (r->source->refusal == WEFT_MESSAGE_MATERIAL_FILE)
        snprintf(error->text + used, sizeof why->text - used, " (the draft of %s)%s", r->source->name, hint);
    else
        snprintf(error->text + used, sizeof why->text - used, "%s", hint);
}

static bool is_setting(const ClothReader *r) { return r->source->refusal == WEFT_MESSAGE_PARAM_VALUE; }

/* Reads a draft: the text of a WIF, which has several lines, or words, or a file beside the material's. */
static void read_draft(ClothReader *r, const json_t *json) {
    const char *text = json_string_value(json);
    const char *folder = r->source->folder;
    struct stat file;
    if (text && strchr(text, '\n')) {
        keep_first(r, weft_draft_read_memory(text, strlen(text), r->source->name, &r->draft, r->source->log,
                                             r->source->error));
        return;
    }
    if (!text || strlen(text) > 4096) {
        refuse(r, "draft", "expected words such as \"twill 2/2\", or a file");
        return;
    }
    if (folder && strlen(folder) > 511) {
        refuse(r, "draft", "lies in a folder whose name is too long");
        return;
    }
    snprintf(r->path, sizeof r->path, "%.511s%s", text[0] == '/' || !folder ? "" : folder, text);
    WeftError why;
    const bool there = folder && stat(r->path, &file) == 0 && !S_ISDIR(file.st_mode);
    if (there || (folder && draft_names_file(text))) {
        const WeftResult result = weft_draft_read(r->path, &r->draft, r->source->log, &why);
        if (result != WEFT_OK) keep_cause(r, &why);
    } else {
        const WeftResult result = weft_draft_parse(text, &r->draft, &why);
        if (result != WEFT_OK && is_setting(r)) keep_cause(r, &why);
        if (result != WEFT_OK) refuse(r, "draft", why.text);
        r->path[0] = '\0';
    }
}

/* Reads "#rrggbb", or [r, g, b] in linear reflectance, into sRGB. Returns false for another value. */
static bool read_rgb(const json_t *json, float color[3]) {
    const char *text = json_string_value(json);
    if (text && text[0] == '#' && strlen(text) == 7 && strspn(text + 1, "0123456789abcdefABCDEF") == 6) {
        const unsigned long rgb = strtoul(text + 1, NULL, 16);
        for (int c = 0; c < 3; c++) color[c] = (float)(rgb >> (16 - 8 * c) & 255u) / 255.0f;
        return true;
    }
    if (json_array_size(json) != 3) return false;
    for (int c = 0; c < 3; c++) {
        const json_t *number = json_array_get(json, (size_t)c);
        const double linear = json_number_value(number);
        if (!json_is_number(number) || !(linear >= 0.0 && linear <= 1.0)) return false;
        color[c] = tone_encode((float)linear);
    }
    return true;
}

/* Reads the colour of all threads of a system. */
static void read_color(ClothReader *r, const json_t *json, WeftThreads threads) {
    float color[3];
    if (!read_rgb(json, color)) {
        refuse(r, "color", "expected a colour such as \"#c02030\", or [r, g, b] in linear reflectance, 0 to 1");
        return;
    }
    for (int k = 0; r->draft && k < r->draft->count[threads]; k++)
        memcpy(r->draft->threads[threads][k].color, color, sizeof color);
}

static float *number_in(WeftYarn *yarn, const WeftYarnNumber *number) {
    return (float *)((char *)yarn + number->offset);
}

static float scale_of(const WeftYarnNumber *number) { return number->angle ? (float)RADIANS : 1.0f; }

static void read_number(ClothReader *r, const char *key, const json_t *json, WeftYarn *yarn) {
    for (int k = 0; weft_yarn_number(k); k++) {
        const WeftYarnNumber *number = weft_yarn_number(k);
        if (strcmp(key, number->name) != 0) continue;
        if (!json_is_number(json)) refuse(r, key, "expected a number");
        *number_in(yarn, number) = scale_of(number) * (float)fmin(fmax(json_number_value(json), -1e6), 1e6);
        return;
    }
    refuse(r, key, "is not a key of a yarn");
}

/* Reads the name of a yarn, or {"yarn": NAME, "color": "#rrggbb", "alpha": 0.3, ...}. */
static void read_yarn(ClothReader *r, const json_t *json, WeftThreads threads) {
    WeftYarn *yarn = &r->yarns[threads];
    const json_t *base = json_is_object(json) ? json_object_get(json, "yarn") : json;
    const char *name = base ? json_string_value(base) : "cotton", *key;
    json_t *value;
    if (!name) {
        refuse(r, "yarn", "expected the name of a yarn");
        return;
    }
    WeftError why;
    if (weft_yarn_find(name, yarn, &why) != WEFT_OK) refuse(r, "yarn", why.text);
    if (!json_is_object(json)) return;
    json_object_foreach((json_t *)(uintptr_t)json, key, value) {
        if (strcmp(key, "yarn") == 0) continue;
        if (strcmp(key, "color") == 0)
            read_color(r, value, threads);
        else
            read_number(r, key, value, yarn);
    }
}

/* Sets the threads per centimetre: a number for both systems, or [WARP, WEFT]. */
static void read_sett(ClothReader *r, const json_t *json) {
    if (!json || !r->draft) return;
    for (int t = 0; t < 2; t++) {
        const json_t *number = json_is_array(json) ? json_array_get(json, (size_t)t) : json;
        const double sett = json_number_value(number);
        if (!json_is_number(number) || !(sett >= 1.0 && sett <= 1000.0) ||
            (json_is_array(json) && json_array_size(json) != 2))
            refuse(r, "sett", "expected threads per centimetre, 1 to 1000, or two of them for warp and weft");
        else
            keep_first(r, weft_draft_set_sett(r->draft, (WeftThreads)t, 100.0f * (float)sett, r->source->error));
    }
}

static double positive(ClothReader *r, const json_t *root, const char *key, double otherwise, double high) {
    const json_t *json = json_object_get(root, key);
    if (!json) return otherwise;
    const double value = json_number_value(json);
    if (!json_is_number(json) || !(value >= 0.0 && value <= high)) refuse(r, key, "is not a number that it can be");
    return value;
}

/* Returns the length that the relief of the asset is smoothed over, metres: 0 for all of it, infinite for none. */
static float read_relief(ClothReader *r, const json_t *json) {
    static const struct {
        const char *name;
        float metres;
    } choices[] = {{"folds", RELIEF_FOLDS}, {"all", 0.0f}, {"none", INFINITY}};
    if (!json) return RELIEF_FOLDS;
    const char *name = json_string_value(json);
    for (size_t k = 0; name && k < sizeof choices / sizeof *choices; k++)
        if (strcmp(name, choices[k].name) == 0) return choices[k].metres;
    const double metres = json_number_value(json);
    if (!json_is_number(json) || !(metres >= 0.0 && metres <= 10.0))
        refuse(r, "relief", "expected folds, all, none, or the metres that it is smoothed over, 0 to 10");
    return (float)metres;
}

const char *cloth_key_meant(const char *word) {
    static const char *const meanings[][2] = {
        {"scale", "metres"},     {"size", "metres"},           {"meters", "metres"},  {"metre", "metres"},
        {"repeat", "metres"},    {"density", "sett"},          {"epi", "sett"},       {"threads", "sett"},
        {"pattern", "draft"},    {"weave", "draft"},           {"wif", "draft"},      {"file", "draft"},
        {"turn", "rotation"},    {"rotate", "rotation"},       {"angle", "rotation"}, {"random", "seed"},
        {"bumps", "relief"},     {"normal", "relief"},         {"ends", "warp"},      {"picks", "weft"},
        {"color", "warp.color"}, {"colour", "warp.color"},     {"yarn", "warp"},      {"weft.colour", "weft.color"},
        {"woof", "weft"},        {"warp.colour", "warp.color"}};
    for (size_t k = 0; k < sizeof meanings / sizeof *meanings; k++)
        if (strcasecmp(word, meanings[k][0]) == 0) return meanings[k][1];
    return NULL;
}

static void read_keys(ClothReader *r, const json_t *json) {
    static const char *const keys[] = {"draft", "warp", "weft", "sett", "metres", "seed", "rotation", "relief"};
    const char *key;
    json_t *value;
    if (!json_is_object(json)) refuse(r, "it", "expected an object with a \"draft\"");
    json_object_foreach((json_t *)(uintptr_t)json, key, value) {
        bool exists = false;
        for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) exists |= strcmp(key, keys[k]) == 0;
        char what[96];
        const char *meant = cloth_key_meant(key);
        snprintf(what, sizeof what, "is not a key of a weave%s%s%s", meant ? "; did you mean " : "", meant ? meant : "",
                 meant ? "?" : "");
        if (!exists) refuse(r, key, what);
    }
}

/* Stores the source of a cloth in it. Returns false if memory is short. */
static bool keep_source(ClothReader *r, const json_t *json, WeftCloth *cloth) {
    cloth->text = json_dumps(json, JSON_COMPACT);
    cloth->draft = r->draft;
    r->draft = NULL;
    if (!r->path[0]) return cloth->text != NULL;
    cloth->path = realpath(r->path, NULL);
    return cloth->text && cloth->path;
}

WeftResult cloth_from_json(const json_t *json, const ClothSource *source, WeftCloth **out) {
    static const char *const systems[] = {"warp", "weft"};
    ClothReader reader = {.source = source};
    WeftError *error = source->error;
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
    read_sett(&reader, json_object_get(json, "sett"));
    const json_t *given = json_object_get(json, "metres");
    const bool automatic = !given || (json_is_string(given) && strcmp(json_string_value(given), "auto") == 0);
    const double metres = automatic ? 1.0 : positive(&reader, json, "metres", 1.0, 1e4),
                 seed = positive(&reader, json, "seed", 0.0, 288.0);
    if (seed > (floor)(seed)) refuse(&reader, "seed", "expected a whole number, 0 to 288");
    const json_t *angle = json_object_get(json, "rotation");
    const double rotation = angle ? json_number_value(angle) : 0.0;
    if (angle && !(json_is_number(angle) && fabs(rotation) <= 360.0))
        refuse(&reader, "rotation", "expected degrees, -360 to 360");
    const float relief = read_relief(&reader, json_object_get(json, "relief"));
    if (!(metres > 0.0)) refuse(&reader, "metres", "is 0");
    if (reader.result == WEFT_OK)
        reader.result = weft_cloth_create(reader.draft, reader.yarns, (unsigned)seed, out, error);
    if (*out) cloth_spread(*out, metres);
    if (*out) (*out)->automatic = automatic;
    if (*out) (*out)->relief = relief;
    if (*out) cloth_rotate(*out, rotation);
    if (*out && !keep_source(&reader, json, *out)) {
        weft_cloth_free(*out);
        *out = NULL;
        reader.result = fail(error, WEFT_MESSAGE_MEMORY, source->name, NULL);
    }
    weft_draft_free(reader.draft);
    return reader.result;
}

json_t *cloth_to_json(const WeftCloth *cloth, const char *draft) {
    json_t *json = json_loads(cloth->text, 0, NULL);
    char *text = cloth->path && !draft ? wif_text(cloth->draft) : NULL;
    if (!cloth->path) return json;
    if (json_object_set_new(json, "draft", json_string(draft ? draft : text)) != 0) {
        json_decref(json);
        json = NULL;
    }
    free(text);
    return json;
}

/* Writes the present numbers of a system's yarn into its JSON. Returns false if memory is short. */
static bool put_yarn(json_t *weave, const char *system, WeftYarn *yarn) {
    json_t *json = json_object_get(weave, system);
    if (!json_is_object(json)) {
        json = json_pack("{s:s}", "yarn", json ? json_string_value(json) : "cotton");
        if (json_object_set_new(weave, system, json) != 0) return false;
    }
    for (int k = 0; weft_yarn_number(k); k++) {
        const WeftYarnNumber *number = weft_yarn_number(k);
        const float is = *number_in(yarn, number);
        const double value = isfinite(is) ? (double)is / (double)scale_of(number) : 1e6; /* refused */
        if (json_object_set_new(json, number->name, json_real(value)) != 0) return false;
    }
    return true;
}

static bool put_draft(json_t *weave, const WeftDraft *draft) {
    char *text = wif_text(draft);
    json_object_del(weave, "sett"); /* the draft has its own */
    const bool put = text && json_object_set_new(weave, "draft", json_string(text)) == 0;
    free(text);
    return put;
}

const WeftDraft *weft_scene_cloth(const WeftScene *scene, int cloth, WeftYarn yarns[2]) {
    if (cloth < 1 || cloth > scene->cloth_count) return NULL;
    const WeftCloth *of = scene->cloths[cloth - 1];
    for (int t = 0; yarns && t < 2; t++) yarns[t] = of->yarns[t];
    return of->draft;
}

WeftResult weft_scene_cloth_copy(const WeftScene *scene, int cloth, WeftCloth **out, WeftError *error) {
    *out = NULL;
    if (cloth < 1 || cloth > scene->cloth_count)
        return fail(error, WEFT_MESSAGE_DESC, "cloth", "the scene has none of number %d", cloth);
    *out = cloth_copy(scene->cloths[cloth - 1]);
    return *out ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
}

WeftResult weft_scene_set_weave(WeftScene *scene, int material, const WeftDraft *draft, const WeftYarn yarns[2],
                                WeftError *error) {
    const bool there = material >= 0 && material < scene_own_materials(scene);
    const int number = there ? scene->materials[material].cloth : 0;
    if (!number) return fail(error, WEFT_MESSAGE_DESC, "weave", "material %d is not woven", material);
    const WeftCloth *was = scene->cloths[number - 1];
    WeftYarn both[2] = {yarns[0], yarns[1]};
    WeftCloth *cloth = NULL;
    const ClothSource source = {
        .name = scene->material_names[material], .refusal = WEFT_MESSAGE_MATERIAL_FILE, .error = error};
    json_t *json = cloth_to_json(was, NULL);
    bool put = json && put_yarn(json, "warp", &both[0]) && put_yarn(json, "weft", &both[1]);
    if (put && !draft_same(draft, was->draft)) put = put_draft(json, draft);
    WeftResult result =
        put ? cloth_from_json(json, &source, &cloth) : fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    json_decref(json);
    if (result != WEFT_OK) return result;
    return cloth_put(scene, material, cloth, error);
}
