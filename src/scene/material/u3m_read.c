#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/json.h"
#include "base/mark.h"
#include "base/memory.h"
#include "base/path.h"
#include "base/pi.h"
#include "image/srgb.h"
#include "scene/material/set.h"
#include "scene/material/u3m.h"
#include "scene/material/u3m_texture.h"
#include "scene/material/u3m_weave.h"
#include "scene/u3m/u3m_fields.h"
#include "shading/material/choice.h"

enum { U3M_BYTES_MOST = 64 << 20, U3MA_BYTES_MOST = 1 << 30, TEXTS = 256 };

/* A file being read. The first failure stays. */
typedef struct U3mReader {
    const char *name, *side, *key; /* side, key: where it reads, for messages; "" at the top */
    const U3mFiles *files;
    MaterialFile *out;
    const WeftLog *log;
    WeftError *error;
    WeftResult result;
    const char *part;    /* the member that is the front, once it is read */
    bool textured;       /* the part that is read names a picture, whether or not there is one */
    char unshown[TEXTS]; /* members that no input shows, and that say something */
    char lacking[TEXTS]; /* members that the schema demands */
} U3mReader;

/* Writes "front.roughness", the place that is read. */
static const char *place_text(const U3mReader *r, char text[96]) {
    snprintf(text, 96, "%.20s%s%.60s", r->side, r->side[0] && r->key[0] ? "." : "", r->key);
    return text;
}

__attribute__((format(printf, 3, 4))) static void refuse(U3mReader *r, const json_t *value, const char *format, ...) {
    char text[200], shown[JSON_SHOWN], place[96];
    if (r->result != WEFT_OK) return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    place_text(r, place);
    r->result = fail(r->error, WEFT_MESSAGE_MATERIAL_FILE, r->name, "%s%s%s%s", place, place[0] ? ": " : "", text,
                     value ? json_but(value, shown) : "");
}

/* Adds a name to a list with commas; what has no room is left out. */
static void list(char text[TEXTS], const char *name) {
    const size_t used = strlen(text);
    snprintf(text + used, TEXTS - used, "%s%s", used ? ", " : "", name);
}

/* Returns a number, which must be in low .. high. */
static float number(U3mReader *r, const json_t *json, const char *what, double low, double high) {
    if (!json_is_number(json)) {
        refuse(r, json, "%s must be a number", what);
        return 0.0f;
    }
    const double value = json_number_value(json);
    if (!isfinite(value) || value < low || value > high) refuse(r, json, "%s must be from %g to %g", what, low, high);
    return (float)fmin(fmax(value, -1e30), 1e30);
}

/* Reads {"r", "g", "b"}, encoded in sRGB, as a linear colour. */
static void color(U3mReader *r, const json_t *json, const char *what, float linear[3]) {
    static const char *const names[] = {"r", "g", "b"};
    if (!json_is_object(json)) refuse(r, json, "%s must be an object with r, g and b", what);
    for (int c = 0; c < 3 && r->result == WEFT_OK; c++)
        linear[c] = srgb_decode(number(r, json_object_get(json, names[c]), names[c], 0.0, 1.0));
}

/* Reads the pixels of a file at that path, in the archive if there is one. */
static WeftResult read_pixels(const U3mReader *r, const char *path, WeftImage *image, TextureLevels **levels,
                              WeftError *error) {
    FileBytes bytes;
    U3mArchive *archive = r->files->archive;
    if (!archive) return levels_read(path, image, levels, r->log, error);
    WeftResult result = u3m_archive_read(archive, path, &bytes, error);
    if (result == WEFT_OK) result = levels_decode(bytes.data, bytes.size, path, image, levels, r->log, error);
    free(bytes.data);
    return result;
}

/* Returns the index of an image that is read from its file, or -1 with a warning where it cannot be read. */
static int read_image(U3mReader *r, const char *file) {
    MaterialFile *out = r->out;
    const size_t size = strlen(r->files->folder) + strlen(file) + 1;
    char *path = malloc(size);
    if (!path) {
        r->result = fail(r->error, WEFT_MESSAGE_MEMORY, r->name, NULL);
        return -1;
    }
    snprintf(path, size, "%s%s", r->files->folder, file);
    WeftError why;
    WeftImage image = {0};
    TextureLevels *levels = NULL;
    const WeftResult result = read_pixels(r, path, &image, &levels, &why);
    if (result != WEFT_OK) {
        char place[96];
        free(path);
        if (result == WEFT_RESOURCES)
            r->result = fail(r->error, WEFT_MESSAGE_MEMORY, r->name, NULL);
        else
            warn(r->log, WEFT_MESSAGE_GLTF_WARN_IGNORED, r->name, "%s: its constant stands for the texture: %s",
                 place_text(r, place), why.text);
        return -1;
    }
    out->images[out->image_count] = image; /* never full: at most one image an input */
    out->levels[out->image_count] = levels;
    out->paths[out->image_count] = r->files->archive ? NULL : path;
    if (r->files->archive) free(path);
    return out->image_count++;
}

/* Returns the index of the image of a file as it is, -1: none. */
static int known_image(const MaterialFile *out, const char *folder, const char *file) {
    const size_t length = strlen(folder);
    for (int k = 0; k < out->image_count; k++) {
        const char *path = out->paths[k];
        if (path && strncmp(path, folder, length) == 0 && strcmp(path + length, file) == 0) return k;
    }
    return -1;
}

/* Reads the millimetres that an image spans as metres; where they are 0, from its pixels and the dots per inch. */
static void read_span(U3mReader *r, const json_t *json, const WeftImage *image, float span[2]) {
    static const char *const sides[] = {"width", "height"}, *const axes[] = {"x", "y"};
    const json_t *dpi = json_object_get(json, "dpi");
    const int pixels[2] = {image->width, image->height};
    for (int k = 0; k < 2 && r->result == WEFT_OK; k++) {
        const float mm = number(r, json_object_get(json, sides[k]), sides[k], 0.0, 1e6);
        const json_t *dots = json_is_object(dpi) ? json_object_get(dpi, axes[k]) : dpi;
        const float per_inch = dots ? number(r, dots, "dpi", 0.0, 1e6) : 0.0f;
        span[k] = mm > 0.0f ? mm * 1e-3f : per_inch > 0.0f ? (float)pixels[k] / per_inch * 25.4e-3f : 0.0f;
        if (!(span[k] > 0.0f)) refuse(r, NULL, "the image has neither a %s in millimetres nor dpi", sides[k]);
    }
}

/* Reads how an image repeats: mirrored or not, and turned. A turn is one of the millimetres, so it comes before they
 * are divided by the sides. */
static void read_repeat(U3mReader *r, const json_t *json, Texture *texture, float transform[6]) {
    static const char *const modes[] = {"normal", "mirror_x", "mirror_y", "mirror_xy"};
    int mode = 0;
    const json_t *name = json_object_get(json, "mode"), *rotation = json_object_get(json, "rotation");
    const char *text = json_string_value(name);
    while (mode < 4 && !(text && strcmp(modes[mode], text) == 0)) mode++;
    if (mode == 4) refuse(r, name, "the mode of repeat must be normal, mirror_x, mirror_y or mirror_xy");
    texture->wrap_u = mode & 1 ? WRAP_MIRROR : WRAP_REPEAT;
    texture->wrap_v = mode & 2 ? WRAP_MIRROR : WRAP_REPEAT;
    const float angle = (rotation ? number(r, rotation, "rotation", -1e6, 1e6) : 0.0f) * (PI_FLOAT / 180.0f);
    const float m[6] = {cosf(angle), sinf(angle), 0.0f, 0.0f - sinf(angle), cosf(angle), 0.0f};
    memcpy(transform, m, sizeof m);
}

static U3mFormula read_formula(U3mReader *r, const U3mField *field, const json_t *texture) {
    U3mFormula formula = {.mode = U3M_MULTIPLY, .factor = {1.0f, 1.0f, 1.0f}};
    const char *mode = json_string_value(json_object_get(texture, "mode"));
    const json_t *factor = json_object_get(texture, "factor"), *scale = json_object_get(texture, "scale");
    if (field->kind == U3M_COLOR) {
        int k = 0;
        while (u3m_modes[k] && !(mode && strcmp(u3m_modes[k], mode) == 0)) k++;
        if (!u3m_modes[k])
            refuse(r, json_object_get(texture, "mode"),
                   "mode must be add, subtract, multiply, divide, max, min or overlay");
        formula.mode = u3m_modes[k] ? (U3mMode)k : U3M_MULTIPLY;
        color(r, factor, "factor", formula.factor);
    } else if (field->kind == U3M_NORMAL) { /* schema 1.0 called it factor */
        formula.factor[0] = number(r, scale ? scale : factor, "scale", -1e6, 1e6);
    } else {
        formula.factor[0] = number(r, factor, "factor", -1e6, 1e6);
        formula.offset = number(r, json_object_get(texture, "offset"), "offset", -1e6, 1e6);
    }
    return formula;
}

/* Gives an input an image: one that is there already, or one that is read. Returns its index, or -1. */
static int take_image(U3mReader *r, const U3mField *field, const json_t *texture, const char *file, float value[3]) {
    MaterialFile *out = r->out;
    const U3mFormula formula = read_formula(r, field, texture);
    if (r->result != WEFT_OK) return -1;
    const int known = known_image(out, r->files->folder, file);
    if (known >= 0 && u3m_texture_plain(field, &formula, &out->images[known], value)) return known;
    const int index = read_image(r, file);
    if (index < 0 || u3m_texture_plain(field, &formula, &out->images[index], value)) return index;
    const WeftResult result = u3m_texture_make(field, &formula, &out->images[index], value, r->error);
    if (result != WEFT_OK) r->result = result;
    levels_free(out->levels[index]); /* the file has another picture */
    out->levels[index] = NULL;
    free(out->paths[index]);
    out->paths[index] = NULL;
    return index;
}

/* Reads the texture of a field onto its input. */
static void read_texture(U3mReader *r, const U3mField *field, const json_t *texture) {
    const json_t *image = json_object_get(texture, "image");
    const char *file = json_string_value(json_object_get(image, "path"));
    MaterialFile *out = r->out;
    Input *input = &out->material.inputs[field->input];
    Texture made = {0};
    float value[3] = {1.0f, 1.0f, 1.0f};
    if (!json_is_object(image)) refuse(r, image, "a texture must have an image");
    if (r->result == WEFT_OK && !file) refuse(r, json_object_get(image, "path"), "an image must have a path");
    if (r->result == WEFT_OK && !u3m_path_inside(file))
        refuse(r, json_object_get(image, "path"), "the path must be relative and stay in the folder of the file");
    if (r->result == WEFT_OK && !r->files->folder) refuse(r, NULL, "a texture needs a file to lie beside");
    if (r->result != WEFT_OK) return;
    made.image = take_image(r, field, texture, file, value);
    if (made.image < 0 || r->result != WEFT_OK) return;
    read_span(r, image, &out->images[made.image], out->span[field->input]);
    read_repeat(r, json_object_get(image, "repeat"), &made, input->transform);
    out->textures[out->texture_count++] = made;
    memcpy(out->constant[field->input], input->value, sizeof input->value);
    memcpy(input->value, value, sizeof value);
    input->texture = out->texture_count;
}

/* Reads the constant of a field into v, as the member has it. */
static void read_constant(U3mReader *r, const U3mField *field, const json_t *json, float v[3]) {
    v[0] = v[1] = v[2] = field->initial;
    if (field->kind == U3M_COLOR)
        color(r, json, "constant", v);
    else if (field->kind == U3M_NUMBER)
        v[0] = number(r, json, "constant", (double)field->low, (double)field->high);
}

/* Sets an input from the constant, clamped to what it takes, with a warning where it is beyond. */
static void set_input(U3mReader *r, const U3mField *field, const float v[3]) {
    Input *input = &r->out->material.inputs[field->input];
    char subject[160], place[96];
    snprintf(subject, sizeof subject, "%.60s: %.80s", r->name, place_text(r, place));
    input->given = true;
    r->out->named[field->input] = true;
    if (field->kind == U3M_NORMAL) return; /* a flat normal needs no map */
    for (int c = 0; c < (field->kind == U3M_COLOR ? 3 : 1); c++)
        input->value[c] =
            number_ranged(&input_infos[field->input], field->offset + field->scale * v[c], subject, r->log);
}

/* Returns true if a member that no input shows would be seen elsewhere. */
static bool would_show(const U3mField *field, const json_t *visual, const float v[3], bool textured) {
    static const struct {
        const char *member, *needs;
    } parts[] = {
        {"subsurface_color", "subsurface_value"}, {"subsurface_radius", "subsurface_value"}, {"ior", "transmission"}};
    bool differs = textured;
    for (int c = 0; c < 3; c++) differs |= v[c] < field->initial || v[c] > field->initial;
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        if (strcmp(parts[k].member, field->name) != 0) continue;
        const json_t *other = json_object_get(visual, parts[k].needs);
        differs &= json_number_value(json_object_get(other, "constant")) > 0.0 ||
                   json_is_object(json_object_get(other, "texture"));
    }
    return differs;
}

static void read_field(U3mReader *r, const U3mField *field, const json_t *visual) {
    const json_t *json = json_object_get(visual, field->name), *texture = json_object_get(json, "texture");
    float v[3] = {field->initial, field->initial, field->initial};
    r->key = field->name;
    if (!json) {
        list(r->lacking, field->name);
    } else if (!json_is_object(json)) {
        refuse(r, json, "expected an object with a constant and a texture");
    } else {
        read_constant(r, field, json_object_get(json, "constant"), v);
        if (texture && !json_is_object(texture) && !json_is_null(texture))
            refuse(r, texture, "texture must be an object or null");
    }
    if (r->result != WEFT_OK) return;
    if (field->input >= 0) {
        set_input(r, field, v);
        r->textured |= json_is_object(texture);
        if (json_is_object(texture)) read_texture(r, field, texture);
    } else if (would_show(field, visual, v, json_is_object(texture))) {
        list(r->unshown, field->name);
    }
}

/* Returns true for a member of a visual part that the schema has. */
static bool is_member(const char *key) {
    if (strcmp(key, "shader") == 0 || strcmp(key, "preview") == 0) return true;
    for (int k = 0; u3m_field(k); k++)
        if (strcmp(u3m_field(k)->name, key) == 0) return true;
    return false;
}

/* Reads a front, a back or a side. */
static void read_visual(U3mReader *r, const char *side, json_t *visual) {
    const char *key;
    json_t *value;
    char strange[TEXTS] = "";
    const json_t *shader = json_object_get(visual, "shader");
    r->side = side;
    r->key = "shader";
    if (!json_is_string(shader) || strcmp(json_string_value(shader), "principled") != 0)
        refuse(r, shader, "the shader must be \"principled\"");
    for (int k = 0; u3m_field(k) && r->result == WEFT_OK; k++) read_field(r, u3m_field(k), visual);
    json_object_foreach(visual, key, value) {
        if (!is_member(key)) list(strange, key);
    }
    Material *material = &r->out->material;
    const Input *opacity = &material->inputs[INPUT_opacity];
    material->alpha_mode = opacity->texture || opacity->value[0] < 1.0f ? WEFT_ALPHA_BLEND : WEFT_ALPHA_OPAQUE;
    if (r->result != WEFT_OK) return;
    if (r->lacking[0])
        warn(r->log, WEFT_MESSAGE_GLTF_WARN_REPAIRED, r->name, "%s lacks %s, which have the defaults of the schema",
             side, r->lacking);
    if (r->unshown[0])
        warn(r->log, WEFT_MESSAGE_GLTF_WARN_IGNORED, r->name, "%s: kept and not shown: %s", side, r->unshown);
    if (strange[0]) warn(r->log, WEFT_MESSAGE_GLTF_WARN_IGNORED, r->name, "%s: not in the schema: %s", side, strange);
}

static Material principled(void) {
    Material material = material_default();
    material_choose(&material, CHOICE_workflow, choice_find(CHOICE_workflow, "disney"));
    material.double_sided = true;
    return material;
}

static MaterialFile empty(void) {
    return (MaterialFile){.material = principled(), .alpha_named = true, .sided_named = true, .has_constants = true};
}

/* Reads the back of a material that has a front. */
static void read_back(U3mReader *r, json_t *visual) {
    U3mReader back = *r;
    back.unshown[0] = back.lacking[0] = '\0';
    back.out = r->out->back = malloc(sizeof *back.out);
    if (!back.out) {
        r->result = fail(r->error, WEFT_MESSAGE_MEMORY, r->name, NULL);
        return;
    }
    *back.out = empty();
    read_visual(&back, "back", visual);
    r->result = back.result;
}

/* Reads the visual part that is the front: where there is none the back, else the side. */
static void read_material(U3mReader *r, const json_t *material) {
    static const char *const sides[] = {"front", "back", "side"};
    json_t *behind = json_object_get(material, "back");
    for (int k = 0; k < 3; k++) {
        json_t *visual = json_object_get(material, sides[k]);
        r->key = sides[k];
        if (!visual || json_is_null(visual)) continue;
        r->part = sides[k];
        if (json_is_object(visual))
            read_visual(r, sides[k], visual);
        else
            refuse(r, visual, "expected an object or null");
        if (r->result == WEFT_OK && visual != behind && json_is_object(behind)) read_back(r, behind);
        if (r->result == WEFT_OK && !r->textured)
            r->result = u3m_weave(json_object_get(material, "physics"), r->name, r->out, r->log, r->error);
        return;
    }
    r->key = "";
    refuse(r, NULL, "it has no front, back or side to be seen");
}

static void read_root(U3mReader *r, const json_t *root) {
    static const char *const versions[] = {"1.0", "1.1", NULL};
    const json_t *schema = json_object_get(root, "schema"), *material = json_object_get(root, "material");
    const char *text = json_string_value(schema);
    int known = 0;
    while (versions[known] && !(text && strcmp(versions[known], text) == 0)) known++;
    r->key = "schema";
    if (!versions[known]) refuse(r, schema, "expected \"1.0\" or \"1.1\"");
    r->key = "material";
    if (r->result == WEFT_OK && !json_is_object(material)) refuse(r, material, "expected an object");
    if (r->result == WEFT_OK) read_material(r, material);
}

/* Gives the material file the text that it is of. */
static void keep_text(U3mReader *r, const char *text, size_t size) {
    const size_t path = strlen(r->name) + 1;
    U3mText *kept = alloc_array(sizeof *kept + size + 1 + path, 1);
    r->out->u3m = kept;
    if (!kept) {
        r->result = fail(r->error, WEFT_MESSAGE_MEMORY, r->name, NULL);
        return;
    }
    char *bytes = (char *)(kept + 1);
    memcpy(bytes, text, size);
    memcpy(bytes + size + 1, r->name, path);
    *kept = (U3mText){.size = size, .path = bytes + size + 1, .part = r->part, .text = bytes};
}

WeftResult u3m_read(const void *data, size_t size, const char *name, const U3mFiles *files, MaterialFile *out,
                    const WeftLog *log, WeftError *error) {
    *out = empty();
    U3mReader reader = {.name = name, .side = "", .key = "", .files = files, .out = out, .log = log, .error = error};
    const char *text = data;
    const size_t mark = mark_size(text, size);
    json_error_t where;
    bool starved;
    json_t *root = json_parse(text + mark, size - mark, JSON_REJECT_DUPLICATES, &where, &starved);
    if (starved)
        reader.result = fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    else if (!root)
        refuse(&reader, NULL, "line %d: %s", where.line, where.text);
    else if (!json_is_object(root))
        refuse(&reader, NULL, "it is not an object");
    else
        read_root(&reader, root);
    json_decref(root);
    if (reader.result == WEFT_OK) keep_text(&reader, text + mark, size - mark);
    return reader.result;
}

/* Returns the folder of a path with its slash, or "". The caller frees it; NULL if memory is short. */
static char *folder_of(const char *path) {
    const char *slash = strrchr(path, '/');
    return strndup(path, slash ? (size_t)(slash + 1 - path) : 0);
}

/* Reads the JSON of a file that lies at `at`, on the disk or in the archive. */
static WeftResult read_at(const FileBytes *bytes, const char *path, const char *at, U3mArchive *archive,
                          MaterialFile *out, const WeftLog *log, WeftError *error) {
    char *folder = folder_of(at);
    if (!folder) return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    const WeftResult result = u3m_read(bytes->data, bytes->size, path, &(U3mFiles){folder, archive}, out, log, error);
    free(folder);
    return result;
}

static WeftResult load_archive(const FileBytes *zip, const char *path, MaterialFile *out, const WeftLog *log,
                               WeftError *error) {
    U3mArchive *archive;
    FileBytes bytes = {0};
    WeftResult result = u3m_archive_open(zip->data, zip->size, path, &archive, error);
    if (result != WEFT_OK) return result;
    const char *material = u3m_archive_material(archive);
    result = u3m_archive_read(archive, material, &bytes, error);
    if (result == WEFT_OK && bytes.size > U3M_BYTES_MOST)
        result = fail(error, WEFT_MESSAGE_FILE_LARGE, path, "%s", material);
    if (result == WEFT_OK) result = read_at(&bytes, path, material, archive, out, log, error);
    free(bytes.data);
    u3m_archive_close(archive);
    return result;
}

WeftResult u3m_load(const char *path, MaterialFile *out, const WeftLog *log, WeftError *error) {
    const bool packed = path_ends(path, ".u3ma");
    FileBytes bytes;
    *out = (MaterialFile){0};
    WeftResult result = file_read(path, packed ? U3MA_BYTES_MOST : U3M_BYTES_MOST, &bytes, error);
    if (result != WEFT_OK) return result;
    result = packed ? load_archive(&bytes, path, out, log, error) : read_at(&bytes, path, path, NULL, out, log, error);
    free(bytes.data);
    return result;
}
