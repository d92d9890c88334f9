/* u3m_save.c - writing a material as .u3m or .u3ma, which scene/material/u3m_read.c reads
 *
 * Vizoo and Browzwear, "Unified 3D Material", schema 1.1, 2020, and its "Additional specification": members, ranges, what
 * has to be kept. A document is what was read, or an empty one; members that the material has otherwise are replaced. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/cache.h"
#include "base/equal.h"
#include "base/fail.h"
#include "base/file.h"
#include "base/json.h"
#include "base/patch.h"
#include "base/path.h"
#include "base/pi.h"
#include "image/srgb.h"
#include "scene/material/relief.h"
#include "scene/record/material.h"
#include "scene/save/u3m_look.h"
#include "scene/save/u3m_physics.h"
#include "scene/save/u3m_picture.h"
#include "scene/u3m/u3m_archive.h"
#include "scene/u3m/u3m_fields.h"
#include "scene/u3m/u3m_source.h"
#include "shading/dialect/tone.h"
#include "weave/weft_cloth.h"
#include "weft/save.h"

/* A file being written. The first failure stays. */
typedef struct U3mWriter {
    const WeftScene *scene;
    int index;
    const char *path;
    const WeftLog *log;
    WeftError *error;
    WeftResult result;
    const U3mSource *source; /* NULL: the material is of no U3M */
    json_t *was, *root;      /* the document as it was read, NULL without; as it is written */
    U3mPictures pictures;
    bool changed;
} U3mWriter;

static void no_memory(U3mWriter *w) {
    if (w->result == WEFT_OK) w->result = fail(w->error, WEFT_MESSAGE_MEMORY, w->path, NULL);
}

static void put(U3mWriter *w, json_t *object, const char *key, json_t *value) {
    if (json_object_set_new(object, key, value) != 0) no_memory(w);
}

/* Returns the value in sRGB that is read as this linear one, or comes nearest. */
static float encoded(float linear) {
    if (linear >= 1.0f) return 1.0f; /* of which several values are rounded to 1 */
    float best = tone_encode(fmaxf(linear, 0.0f)), near = best;
    for (int k = 0; k < 4; k++) near = nextafterf(near, 0.0f);
    for (int k = 0; k < 9; k++, near = nextafterf(near, 1.0f))
        if (fabsf(srgb_decode(near) - linear) < fabsf(srgb_decode(best) - linear)) best = near;
    return best;
}

static json_t *color_json(const float linear[3]) {
    return json_pack("{s:o, s:o, s:o}", "r", json_of_float(encoded(linear[0])), "g", json_of_float(encoded(linear[1])),
                     "b", json_of_float(encoded(linear[2])));
}

/* A member of a visual part that is written: the field, the part it is of, and its input. */
typedef struct U3mMember {
    const U3mField *field;
    const char *part;
    const U3mLook *look;
    const Input *input;
} U3mMember;

static U3mPixels pixels_of(const U3mMember *member) {
    if (member->field->kind != U3M_NUMBER) return U3M_AS_IS;
    if (input_infos[member->field->input].kind == WEFT_INPUT_DIRECTION) return U3M_ANGLE;
    return member->look->luminance[member->field->input] ? U3M_LUMINANCE : U3M_CHANNEL;
}

static bool is_angle(const U3mMember *member) {
    const WeftInputKind kind = input_infos[member->field->input].kind;
    return kind == WEFT_INPUT_DIRECTION || kind == WEFT_INPUT_ANGLE;
}

/* Returns a number of a member from that of its input. A whole turn is none. */
static float number_of(const U3mMember *member, float x) {
    const U3mField *field = member->field;
    const float number = ((is_angle(member) ? x * (180.0f / PI_FLOAT) : x) - field->offset) / field->scale;
    return is_angle(member) ? number - floorf(number) : number;
}

static float within(U3mWriter *w, const U3mMember *member, float x) {
    const U3mField *field = member->field;
    const float low = fmaxf(field->low, -1e30f), high = fminf(field->high, 1e30f);
    if (x < low || x > high)
        warn(w->log, WEFT_MESSAGE_PARAM_RANGE, w->path, "%s.%s: %g becomes %g, the most that U3M has", member->part,
             field->name, (double)x, (double)fminf(fmaxf(x, low), high));
    return fminf(fmaxf(x, low), high);
}

/* Returns the member "texture" of a number, and the mean of its values. */
static json_t *number_texture(const U3mMember *member, const U3mPicture *picture, json_t *image, float *mean) {
    const float x = member->input->value[0];
    const bool angle = picture->pixels == U3M_ANGLE;
    const float factor = angle ? 1.0f : x * picture->scale / member->field->scale,
                offset = angle ? number_of(member, x) : (0.0f - member->field->offset) / member->field->scale;
    *mean = angle ? picture->mean[0] + offset : x * picture->mean[0] / member->field->scale + offset;
    *mean = angle ? *mean - floorf(*mean) : fminf(fmaxf(*mean, member->field->low), member->field->high);
    return json_pack("{s:o, s:o, s:o}", "factor", json_of_float(factor), "offset", json_of_float(offset), "image",
                     image);
}

static json_t *texture_json(U3mWriter *w, const U3mMember *member, float mean[3]) {
    const U3mField *field = member->field;
    const Input *input = member->input;
    const U3mPicture *picture;
    char name[64];
    snprintf(name, sizeof name, "%.20s-%.40s", member->part, field->name);
    w->result = u3m_picture_add(&w->pictures, input, pixels_of(member), field->kind == U3M_COLOR, name, &picture);
    if (w->result != WEFT_OK) return NULL;
    json_t *image = u3m_picture_image(&w->pictures, input, picture, name);
    if (field->kind == U3M_NUMBER) return number_texture(member, picture, image, mean);
    if (field->kind == U3M_NORMAL)
        return json_pack("{s:o, s:o}", "scale", json_of_float(input->value[0]), "image", image);
    for (int c = 0; c < 3; c++) mean[c] = input->value[c] * picture->mean[c];
    return json_pack("{s:s, s:o, s:o}", "mode", "multiply", "factor", color_json(input->value), "image", image);
}

/* Returns a member of a visual part: its constant, the mean of its texture where it has one, and that. */
static json_t *member_json(U3mWriter *w, const U3mMember *member) {
    const U3mField *field = member->field;
    const bool textured = member->input->texture != 0;
    float constant[3];
    memcpy(constant, member->input->value, sizeof constant);
    if (field->kind == U3M_NUMBER) constant[0] = number_of(member, constant[0]);
    json_t *texture = textured ? texture_json(w, member, constant) : json_null();
    if (!texture) {
        no_memory(w);
        return NULL;
    }
    if (field->kind == U3M_NORMAL)
        return json_pack("{s:{s:i, s:i, s:i}, s:o}", "constant", "x", 0, "y", 0, "z", 1, "texture", texture);
    json_t *value = field->kind == U3M_COLOR ? color_json(constant) : json_of_float(within(w, member, constant[0]));
    return json_pack("{s:o, s:o}", "constant", value, "texture", texture);
}

/* Returns a member that no input shows, at its default. */
static json_t *initial_json(const U3mField *field) {
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    return json_pack("{s:o, s:n}", "constant",
                     field->kind == U3M_COLOR ? color_json(white) : json_of_float(field->initial), "texture");
}

/* Returns true if an input is as it was read. */
static bool is_same(const Input *a, const Input *b) {
    bool same = a->texture == b->texture && a->texcoord == b->texcoord && a->channel == b->channel;
    for (int c = 0; c < 3; c++) same &= is_equal(a->value[c], b->value[c]);
    for (int c = 0; c < 6 && a->texture; c++) same &= is_equal(a->transform[c], b->transform[c]);
    return same;
}

static bool texture_is_file(const WeftScene *scene, const Input *input) {
    return !input->texture || scene->textures[input->texture - 1].version == 0;
}

/* Returns the row of a field that says it: where two do, the one of the look's coat, or the one that has changed. */
static const U3mField *row_of(const U3mField *field, const U3mLook *look, const Material *was) {
    const U3mField *next = field + 1;
    if (field->input != INPUT_clearcoat_gloss) return field;
    if (!was) return look->gloss ? field : next;
    return is_same(&look->material.inputs[field->input], &was->inputs[field->input]) ? next : field;
}

/* Writes the members of a visual part that it lacks, or that are not as they were read. was: NULL: it was not read. */
static void write_visual(U3mWriter *w, json_t *visual, const char *part, const Material *material,
                         const Material *was) {
    static const ChoiceId meanings[] = {CHOICE_workflow, CHOICE_profile}; /* of inputs */
    const U3mLook look = u3m_look(material);
    bool as_was = was != NULL;
    for (size_t k = 0; k < sizeof meanings / sizeof *meanings && was; k++)
        as_was &= material->choices[meanings[k]] == was->choices[meanings[k]];
    for (int k = 0; u3m_field(k) && w->result == WEFT_OK; k++) {
        const U3mField *field = u3m_field(k);
        if (k && strcmp(field->name, u3m_field(k - 1)->name) == 0) continue;
        field = row_of(field, &look, as_was ? was : NULL);
        const bool there = json_object_get(visual, field->name) != NULL;
        if (field->input < 0) {
            if (!there) put(w, visual, field->name, initial_json(field));
            continue;
        }
        Input input = look.material.inputs[field->input];
        if (there && as_was && is_same(&input, &was->inputs[field->input]) && texture_is_file(w->scene, &input))
            continue;
        if (field->input == INPUT_opacity && material->alpha_mode == WEFT_ALPHA_OPAQUE)
            input = (Input){.value = {1.0f, 0.0f, 0.0f}};
        const U3mMember member = {field, part, &look, &input};
        json_t *json = member_json(w, &member);
        if (w->result == WEFT_OK) put(w, visual, field->name, json);
        w->changed = true;
    }
}

/* Returns a visual part, which is made where there is none. */
static json_t *visual_of(U3mWriter *w, json_t *material, const char *part) {
    json_t *visual = json_object_get(material, part);
    if (json_is_object(visual)) return visual;
    visual = json_pack("{s:s, s:n}", "shader", "principled", "preview");
    put(w, material, part, visual);
    w->changed = true;
    return visual;
}

static void write_back(U3mWriter *w, json_t *material) {
    const WeftScene *scene = w->scene;
    const bool given = scene_has_back(scene, w->index);
    const bool had = w->source && w->source->has_back;
    if (!given) {
        if (had) put(w, material, "back", json_null());
        w->changed |= had;
        return;
    }
    Material back = scene->materials[scene->material_count + w->index];
    if (had) { /* it shares these with the front once it is in a scene */
        back.inputs[INPUT_opacity] = w->source->back.inputs[INPUT_opacity];
        back.alpha_mode = w->source->back.alpha_mode;
    }
    write_visual(w, visual_of(w, material, "back"), "back", &back, had ? &w->source->back : NULL);
}

/* Returns the name of the yarn of a system in the weave of a material, which is cotton where it says nothing. The weave
 * has to outlive it. */
static const char *yarn_name(const json_t *weave, const char *system) {
    const json_t *yarn = json_object_get(weave, system);
    const char *name = json_string_value(json_is_string(yarn) ? yarn : json_object_get(yarn, "yarn"));
    return name ? name : "cotton";
}

static const WeftCloth *cloth_of(const U3mWriter *w) {
    const int number = w->scene->materials[w->index].cloth;
    const WeftCloth *cloth = number > 0 ? w->scene->cloths[number - 1] : NULL;
    return cloth && cloth->draft ? cloth : NULL;
}

static void write_physics(U3mWriter *w, json_t *material, const WeftTextile *textile) {
    const WeftCloth *cloth = cloth_of(w);
    const json_t *physics = json_object_get(material, "physics");
    if (physics && !json_is_null(physics)) return;
    if (textile) {
        put(w, material, "physics", u3m_physics(textile->draft, textile->yarns));
    } else if (cloth) {
        json_error_t where;
        bool starved;
        json_t *weave = cloth->text ? json_parse(cloth->text, strlen(cloth->text), 0, &where, &starved) : NULL;
        const char *const yarns[2] = {yarn_name(weave, "warp"), yarn_name(weave, "weft")};
        put(w, material, "physics", u3m_physics(cloth->draft, yarns));
        json_decref(weave);
    } else if (!physics) {
        put(w, material, "physics", json_null());
    } else {
        return;
    }
    w->changed = true;
}

/* Writes an id of version 4 (IETF, RFC 4122) that follows from what it names, so that files are made again alike. */
static void id_write(const char *name, const char *path, char id[40]) {
    const uint64_t a = cache_hash(cache_hash(CACHE_HASH, name, strlen(name)), path, strlen(path)),
                   b = cache_hash(a, &a, sizeof a);
    snprintf(id, 40, "{%08x-%04x-4%03x-%04x-%012llx}", (unsigned)(a >> 32), (unsigned)(a >> 16 & 0xffff),
             (unsigned)(a & 0xfff), (unsigned)(b >> 48 & 0x3fff) | 0x8000u, (unsigned long long)(b & 0xffffffffffffu));
}

static void now_write(char text[32]) {
    const time_t now = time(NULL);
    struct tm utc;
    if (!gmtime_r(&now, &utc) || !strftime(text, 32, "%Y-%m-%dT%H:%M:%SZ", &utc))
        snprintf(text, 32, "1970-01-01T00:00:00Z");
}

/* Makes a document of a material without any visual part. */
static json_t *document_make(const U3mWriter *w, const char *now) {
    const char *slash = strrchr(w->path, '/'), *base = slash ? slash + 1 : w->path, *dot = strrchr(base, '.');
    char id[40], name[128];
    snprintf(name, sizeof name, "%.*s", dot ? (int)(dot - base) : (int)strlen(base), base);
    id_write(w->scene->material_names[w->index], base, id);
    json_t *utf8 = json_string(name); /* NULL: the name of the file is none */
    if (!utf8 || !name[0]) snprintf(name, sizeof name, "cloth");
    json_decref(utf8);
    return json_pack("{s:s, s:n, s:{s:s, s:s, s:s, s:s, s:s, s:n, s:n, s:n, s:n}}", "schema", "1.1", "custom",
                     "material", "id", id, "name", name, "description", "", "created", now, "modified", now, "front",
                     "back", "side", "metadata");
}

static void document_begin(U3mWriter *w, const char *now) {
    json_error_t where;
    bool starved;
    if (w->source) {
        const U3mText *text = &w->source->text;
        w->was = json_parse(text->text, text->size, 0, &where, &starved);
        w->root = json_deep_copy(w->was);
    } else {
        w->root = document_make(w, now);
    }
    if (!w->root || (w->source && !w->was)) no_memory(w);
}

/* Adds the bytes of one file of the U3M that was read, under the path that it has from there. */
static void file_keep(U3mWriter *w, U3mArchive *archive, const char *folder, const char *file) {
    FileBytes bytes = {0};
    WeftResult result;
    if (!u3m_path_inside(file) || u3m_package_has(w->pictures.package, file)) return;
    const size_t size = strlen(folder) + strlen(file) + 1;
    char *path = malloc(size);
    if (!path) {
        no_memory(w);
        return;
    }
    snprintf(path, size, "%s%s", folder, file);
    if (archive)
        result = u3m_archive_read(archive, path, &bytes, w->error);
    else
        result = file_read(path, (size_t)1 << 30, &bytes, w->error);
    free(path);
    if (result == WEFT_RESOURCES)
        w->result = result;
    else if (result != WEFT_OK) /* it was missing before */
        warn(w->log, WEFT_MESSAGE_GLTF_WARN_IGNORED, w->path, "%s: it cannot be read, as when it was loaded", file);
    else
        w->result = u3m_package_add(w->pictures.package, file, bytes.data, bytes.size, false, w->error);
    free(bytes.data);
}

/* Adds the files that a value names, at any depth: of images, and of devices. */
static void files_keep(U3mWriter *w, const char *folder, json_t *value) {
    const char *key;
    json_t *part;
    size_t k;
    json_array_foreach(value, k, part) {
        if (w->result == WEFT_OK) files_keep(w, folder, part);
    }
    json_object_foreach(value, key, part) {
        const bool names = strcmp(key, "path") == 0 || strcmp(key, "fab") == 0;
        const char *text = json_string_value(part);
        if (w->result == WEFT_OK && names && text && strcmp(text, "null") != 0) file_keep(w, NULL, folder, text);
        if (w->result == WEFT_OK) files_keep(w, folder, part);
    }
}

/* Adds every file of an archive but the .u3m. */
static void archive_keep(U3mWriter *w, U3mArchive *archive, const char *material, size_t folder) {
    const char *file;
    for (int k = 0; w->result == WEFT_OK && (file = u3m_archive_file(archive, k)); k++) {
        char top[4096];
        const size_t length = strlen(file);
        if (strcmp(file, material) == 0 || (length && file[length - 1] == '/')) continue;
        snprintf(top, sizeof top, "%.*s", (int)folder, material);
        if (strncmp(file, top, folder) == 0)
            file_keep(w, archive, top, file + folder);
        else
            warn(w->log, WEFT_MESSAGE_GLTF_WARN_IGNORED, w->path, "%.200s: it is outside the folder of the .u3m", file);
    }
}

/* Keeps the files beside the .u3m that was read, or all of its archive. */
static void sources_keep(U3mWriter *w) {
    const char *path = w->source->text.path;
    FileBytes bytes = {0};
    U3mArchive *archive = NULL;
    if (path_ends(path, ".u3ma")) {
        w->result = file_read(path, (size_t)1 << 30, &bytes, w->error);
        if (w->result == WEFT_OK) w->result = u3m_archive_open(bytes.data, bytes.size, path, &archive, w->error);
        if (w->result == WEFT_OK) {
            const char *material = u3m_archive_material(archive), *slash = strrchr(material, '/');
            archive_keep(w, archive, material, slash ? (size_t)(slash + 1 - material) : 0);
        }
    } else {
        const char *slash = strrchr(path, '/');
        char *folder = strndup(path, slash ? (size_t)(slash + 1 - path) : 0);
        if (!folder)
            no_memory(w);
        else
            files_keep(w, folder, json_object_get(w->root, "material"));
        free(folder);
    }
    u3m_archive_close(archive);
    free(bytes.data);
}

/* Writes the package: of a document that was read what did not change byte for byte. */
static void write_package(U3mWriter *w) {
    size_t size = 0;
    char *text = NULL;
    if (w->source)
        text = patch_text(w->source->text.text, w->source->text.size, w->was, w->root, &size);
    else if ((text = json_dumps(w->root, JSON_INDENT(4) | JSON_REAL_PRECISION(9))))
        size = strlen(text);
    if (!text) no_memory(w);
    if (w->result == WEFT_OK) w->result = u3m_package_write(w->pictures.package, text, size, w->error);
    free(text);
}

/* Gives a woven material the mean colour of its threads, by what is seen of each system. */
static void threads_take(const WeftCloth *cloth, Input *color) {
    const WeftDraftInfo info = weft_draft_info(cloth->draft);
    const WeftClothInfo seen = weft_cloth_info(cloth);
    double sums[3] = {0.0, 0.0, 0.0};
    for (int t = 0; t < 2; t++)
        for (int k = 0; k < info.count[t]; k++)
            for (int c = 0; c < 3; c++)
                sums[c] +=
                    (double)(seen.share[t] * srgb_decode(weft_draft_thread(cloth->draft, (WeftThreads)t, k).color[c])) /
                    info.count[t];
    *color = (Input){.given = 1};
    for (int c = 0; c < 3; c++) color->value[c] = (float)(sums[c] / (double)(seen.share[0] + seen.share[1]));
}

static void write_all(U3mWriter *w, const WeftTextile *textile) {
    char now[32];
    Material given = relief_given(w->scene, w->index), told = given;
    if (!w->source && cloth_of(w)) threads_take(cloth_of(w), &given.inputs[INPUT_base_color]);
    if (w->source && w->source->material.cloth) told.cloth = 0; /* the file has its construction */
    now_write(now);
    document_begin(w, now);
    json_t *material = json_object_get(w->root, "material");
    const char *part = w->source ? w->source->text.part : "front";
    if (w->result == WEFT_OK) u3m_look_lost(&told, w->path, w->log);
    if (w->result == WEFT_OK)
        write_visual(w, visual_of(w, material, part), part, &given, w->source ? &w->source->material : NULL);
    if (w->result == WEFT_OK) write_back(w, material);
    if (w->result == WEFT_OK) write_physics(w, material, textile);
    if (w->result == WEFT_OK && w->changed) put(w, material, "modified", json_string(now));
    if (w->result == WEFT_OK && w->source) sources_keep(w);
    if (w->result == WEFT_OK) write_package(w);
}

WeftResult weft_scene_save_u3m(const WeftScene *scene, int index, const char *path, const WeftTextile *textile,
                               const WeftLog *log, WeftError *error) {
    if (index < 0 || index >= scene_own_materials(scene)) {
        char names[NAMES_SIZE], text[16];
        snprintf(text, sizeof text, "%d", index);
        return fail(error, WEFT_MESSAGE_MATERIAL_NAME, text, "%s", scene_names(scene, weft_scene_material_name, names));
    }
    if (!path_is_u3m(path)) return fail(error, WEFT_MESSAGE_OUTPUT_SUFFIX, path, "a U3M is a .u3m or a .u3ma");
    U3mWriter w = {
        .scene = scene, .index = index, .path = path, .log = log, .error = error, .source = u3m_source(scene, index)};
    w.pictures = (U3mPictures){.scene = scene,
                               .material = index,
                               .path = path,
                               .taken = w.source ? w.source->text.text : NULL,
                               .metres = textile ? textile->metres : 0.0,
                               .log = log,
                               .error = error};
    w.result = u3m_package_begin(path, &w.pictures.package, error);
    if (w.result == WEFT_OK) write_all(&w, textile);
    u3m_package_free(w.pictures.package);
    json_decref(w.was);
    json_decref(w.root);
    return w.result;
}
