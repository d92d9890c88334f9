#include "scene/material/material_file.h"

#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/json.h"
#include "base/mark.h"
#include "base/pi.h"
#include "scene/material/cloth_file.h"
#include "scene/material/set.h"

/* A file being read. The first failure stays. */
typedef struct Reader {
    const char *name, *folder, *key; /* key: being read, for messages */
    MaterialFile *out;
    const WeftLog *log;
    WeftError *error;
    WeftResult result;
} Reader;

__attribute__((format(printf, 2, 3))) static void refuse(Reader *r, const char *format, ...) {
    char text[256];
    if (r->result != WEFT_OK) return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    r->result = fail(r->error, WEFT_MESSAGE_MATERIAL_FILE, r->name, "%.60s%s%s", r->key, r->key[0] ? ": " : "", text);
}

/* Refuses a value, which the message ends with. */
__attribute__((format(printf, 3, 4))) static void refuse_value(Reader *r, const json_t *value, const char *format,
                                                               ...) {
    char text[200], shown[JSON_SHOWN];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    refuse(r, "%s%s", text, json_but(value, shown));
}

enum { SUBJECT = 160 };

/* Writes "FILE: KEY", the subject of a warning. */
static const char *subject(const Reader *r, const char *key, char text[SUBJECT]) {
    snprintf(text, SUBJECT, "%.120s: %.36s", r->name, key);
    return text;
}

/* Returns a number as a float; one that is too large becomes the largest. */
static float number(Reader *r, const json_t *json, const char *what) {
    if (!json_is_number(json)) {
        refuse_value(r, json, "%s must be a number", what);
        return 0.0f;
    }
    double value = json_number_value(json);
    if (!isfinite(value)) refuse(r, "%s is not finite", what);
    return (float)fmin(fmax(value, -1e30), 1e30);
}

/* Reads a value without a texture: a number or, for a colour, [r, g, b] or "#rrggbb". */
static void read_value(Reader *r, const json_t *json, InputId id, float v[3]) {
    const WeftInputInfo *info = &input_infos[id];
    bool color = info->kind == WEFT_INPUT_COLOR;
    if (color && json_is_string(json)) {
        if (!hex_color(json_string_value(json), v))
            refuse(r, "\"%.40s\" is not a color such as \"#c02030\"", json_string_value(json));
    } else if (color && json_is_array(json) && json_array_size(json) == 3) {
        for (size_t c = 0; c < 3; c++) v[c] = number(r, json_array_get(json, c), "an element");
    } else if (json_is_number(json)) {
        v[0] = number(r, json, "it");
        if (color) v[1] = v[2] = v[0];
    } else {
        refuse_value(r, json,
                     color ? "expected a number, [r, g, b], \"#rrggbb\" or an object with a texture"
                           : "expected a number or an object with a texture");
    }
    char about[SUBJECT];
    subject(r, r->key, about);
    for (int c = 0; c < (color ? 3 : 1) && r->result == WEFT_OK; c++) v[c] = number_ranged(info, v[c], about, r->log);
}

/* Returns the index of a text among names, which end with NULL. Fails if it is none of them. */
static int one_of(Reader *r, const json_t *json, const char *what, const char *const *names) {
    const char *text = json_string_value(json);
    char list[128] = "";
    for (int k = 0; names[k]; k++) {
        if (text && strcmp(names[k], text) == 0) return k;
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", k ? ", " : "", names[k]);
    }
    refuse_value(r, json, "%s must be one of %s", what, list);
    return 0;
}

/* Returns the index of a file's image, which is read once for all inputs. */
static int image_index(Reader *r, const char *file) {
    MaterialFile *out = r->out;
    if (!r->folder) {
        refuse(r, "a texture needs a file to lie beside");
        return 0;
    }
    size_t size = strlen(r->folder) + strlen(file) + 1;
    char *path = malloc(size);
    if (!path) {
        r->result = fail(r->error, WEFT_MESSAGE_MEMORY, r->name, NULL);
        return 0;
    }
    snprintf(path, size, "%s%s", file[0] == '/' ? "" : r->folder, file);
    for (int k = 0; k < out->image_count; k++)
        if (strcmp(out->paths[k], path) == 0) {
            free(path);
            return k;
        }
    out->paths[out->image_count] = path; /* never full: at most one image an input */
    WeftResult result =
        levels_read(path, &out->images[out->image_count], &out->levels[out->image_count], r->log, r->error);
    if (r->result == WEFT_OK) r->result = result;
    return out->image_count++;
}

static void pair(Reader *r, const json_t *json, const char *what, float v[2]) {
    if (json_is_array(json) && json_array_size(json) == 2) {
        for (size_t k = 0; k < 2; k++) v[k] = number(r, json_array_get(json, k), what);
    } else if (json_is_number(json)) {
        v[0] = v[1] = number(r, json, what);
    } else {
        refuse_value(r, json, "%s is one number or two", what);
    }
}

/* Sets the placement of a texture as in KHR_texture_transform: scale, then rotate, then offset. */
static void place(Input *input, const float scale[2], float degrees, const float offset[2]) {
    float angle = degrees * (PI_FLOAT / 180.0f), c = cosf(angle), s = sinf(angle);
    const float m[6] = {c * scale[0], s * scale[1], offset[0], 0.0f - s * scale[0], c * scale[1], offset[1]};
    memcpy(input->transform, m, sizeof m);
}

static void six(Reader *r, const json_t *json, const char *what, float m[6]) {
    if (!json_is_array(json) || json_array_size(json) != 6) refuse_value(r, json, "%s must be six numbers", what);
    for (size_t k = 0; k < json_array_size(json) && k < 6; k++) m[k] = number(r, json_array_get(json, k), what);
}

/* Reads one word, or one for u and one for v. */
static void read_wrap(Reader *r, const json_t *json, Texture *texture) {
    static const char *const wraps[] = {"repeat", "mirror", "clamp", NULL}; /* as TextureWrap */
    bool two = json_is_array(json) && json_array_size(json) == 2;
    texture->wrap_u = (TextureWrap)one_of(r, two ? json_array_get(json, 0) : json, "wrap", wraps);
    texture->wrap_v = two ? (TextureWrap)one_of(r, json_array_get(json, 1), "wrap", wraps) : texture->wrap_u;
}

/* The placing of a texture. */
typedef struct Placing {
    float scale[2], offset[2], degrees;
    float matrix[6];
    bool whole; /* by the matrix */
} Placing;

/* Returns true if the key describes the placing, and reads it. */
static bool read_placing(Reader *r, const char *key, const json_t *value, Placing *placing) {
    if (strcmp(key, "scale") == 0) {
        pair(r, value, key, placing->scale);
    } else if (strcmp(key, "offset") == 0) {
        pair(r, value, key, placing->offset);
    } else if (strcmp(key, "rotation") == 0) {
        placing->degrees = number(r, value, key);
    } else if (strcmp(key, "transform") == 0) {
        six(r, value, key, placing->matrix);
        placing->whole = true;
    } else {
        return false;
    }
    return true;
}

static void check_placing(Reader *r, const Placing *placing) {
    for (int k = 0; k < 2; k++)
        if (fabsf(placing->scale[k]) > 1e6f || fabsf(placing->offset[k]) > 1e6f || fabsf(placing->degrees) > 1e6f)
            refuse(r, "it is placed beyond 1e6");
}

/* Reads {"texture": FILE, ...}. */
static void read_texture(Reader *r, json_t *object, InputId id, Input *input) {
    static const char *const channels[] = {"r", "g", "b", "a", NULL};
    MaterialFile *out = r->out;
    Placing placing = {.scale = {1.0f, 1.0f}};
    Texture texture = {0};
    const char *key, *file = NULL;
    json_t *value;
    json_object_foreach(object, key, value) {
        if (strcmp(key, "texture") == 0) {
            file = json_string_value(value);
            if (!file || !file[0] || strlen(file) > 4096) refuse_value(r, value, "texture must be the name of a file");
        } else if (strcmp(key, "factor") == 0) {
            read_value(r, value, id, input->value);
        } else if (strcmp(key, "channel") == 0) {
            if (input_infos[id].kind != WEFT_INPUT_SCALAR && input_infos[id].kind != WEFT_INPUT_ANGLE)
                refuse(r, "channel: its texture is read whole, not by a channel");
            input->channel = (uint8_t)one_of(r, value, key, channels);
        } else if (strcmp(key, "texcoord") == 0) {
            float set = number(r, value, key);
            if (set < 0.0f || set > 1.0f || set > floorf(set)) refuse_value(r, value, "texcoord must be 0 or 1");
            input->texcoord = set > 0.5f;
        } else if (strcmp(key, "wrap") == 0) {
            read_wrap(r, value, &texture);
        } else if (strcmp(key, "nearest") == 0) {
            if (!json_is_boolean(value)) refuse_value(r, value, "nearest must be true or false");
            texture.nearest = json_is_true(value);
        } else if (strcmp(key, "levels") == 0) {
            if (!json_is_boolean(value)) refuse_value(r, value, "levels must be true or false");
            texture.single = json_is_false(value);
        } else if (!read_placing(r, key, value, &placing)) {
            refuse(r, "\"%.40s\" is not a key of a texture", key);
        }
    }
    check_placing(r, &placing);
    if (!file) refuse(r, "the object lacks \"texture\"");
    if (!file || r->result != WEFT_OK) return;
    if (placing.whole)
        memcpy(input->transform, placing.matrix, sizeof placing.matrix);
    else
        place(input, placing.scale, placing.degrees, placing.offset);
    texture.image = image_index(r, file);
    out->textures[out->texture_count++] = texture;
    input->texture = out->texture_count;
}

static void read_input(Reader *r, json_t *json, InputId id) {
    Input *input = &r->out->material.inputs[id];
    r->out->named[id] = true;
    input->given = true;
    if (!json_is_object(json)) {
        read_value(r, json, id, input->value);
        return;
    }
    input_set_map_factor(input, id); /* unless there is a factor */
    read_texture(r, json, id, input);
}

static void read_choice(Reader *r, const json_t *json, ChoiceId id) {
    int value;
    WeftError error;
    const char *text = json_string_value(json);
    if (!text)
        refuse_value(r, json, "expected the id of a choice");
    else if (choice_value(id, text, &value, &error) == WEFT_OK)
        material_choose(&r->out->material, id, value);
    else
        refuse(r, "%s", error.text);
}

static void read_keep(Reader *r, const json_t *json) {
    if (!json_is_array(json)) refuse_value(r, json, "expected an array of inputs");
    for (size_t k = 0; k < json_array_size(json); k++) {
        const char *name = json_string_value(json_array_get(json, k));
        int id = name ? weft_material_input_find(name) : -1;
        if (id < 0)
            refuse(r, "\"%.40s\" is not an input", name ? name : "");
        else
            r->out->keep[id] = true;
    }
}

/* Reads a measurement from a file beside the material's. */
static void read_measured(Reader *r, const json_t *json) {
    const char *text = json_string_value(json);
    char path[4096 + 512];
    if (!text || !text[0] || strlen(text) > 4096) {
        refuse_value(r, json, "expected the name of a file");
    } else if (!r->folder || strlen(r->folder) > 511) {
        refuse(r, "a file can be named only by a material in a file");
    } else if (!r->out->measured) {
        snprintf(path, sizeof path, "%s%s", text[0] == '/' ? "" : r->folder, text);
        r->result = scene_measured_read(path, &r->out->measured, r->error);
    }
}

/* Returns an alpha cutoff, which is no less than 0. */
static float cutoff(const Reader *r, float value) {
    char about[SUBJECT];
    if (value >= 0.0f) return value;
    warn(r->log, WEFT_MESSAGE_PARAM_RANGE, subject(r, r->key, about), "%g is beyond the limit, 0, which is used",
         (double)value);
    return 0.0f;
}

static void read_object(Reader *r, json_t *root);

/* Reads the back of a material, a material too. */
static void read_back(Reader *r, json_t *json) {
    Reader back = *r;
    if (!json_is_object(json)) refuse_value(r, json, "expected a material");
    if (json_object_get(json, "back")) refuse(r, "a back has none of its own");
    if (json_object_get(json, "weave")) refuse(r, "weave: the back of a weave is its other face");
    if (r->result != WEFT_OK || r->out->back) return;
    back.out = r->out->back = malloc(sizeof *back.out);
    if (!back.out) {
        r->result = fail(r->error, WEFT_MESSAGE_MEMORY, r->name, NULL);
        return;
    }
    *back.out = (MaterialFile){.material = material_default()};
    read_object(&back, json);
    r->result = back.result;
}

/* Reads the members of a material that are neither inputs nor choices. */
static void read_rest(Reader *r, json_t *json) {
    static const char *const modes[] = {"opaque", "mask", "blend", NULL}; /* as WeftAlphaMode */
    MaterialFile *out = r->out;
    const char *key = r->key;
    const int hair = hair_find(key);
    if (hair >= 0) {
        char about[SUBJECT];
        out->material.hair[hair] =
            number_ranged(&hair_infos[hair], number(r, json, "it"), subject(r, key, about), r->log);
    } else if (strcmp(key, "name") == 0 || strcmp(key, "group") == 0 || strcmp(key, "help") == 0) {
        if (!json_is_string(json)) refuse_value(r, json, "expected a text");
    } else if (strcmp(key, "keep") == 0) {
        read_keep(r, json);
    } else if (strcmp(key, "alpha_mode") == 0) {
        out->material.alpha_mode = (WeftAlphaMode)one_of(r, json, "it", modes);
        out->alpha_named = true;
    } else if (strcmp(key, "alpha_cutoff") == 0) {
        out->material.alpha_cutoff = cutoff(r, number(r, json, "it"));
        out->alpha_named = true;
    } else if (strcmp(key, "double_sided") == 0) {
        if (!json_is_boolean(json)) refuse_value(r, json, "expected true or false");
        out->material.double_sided = json_is_true(json);
        out->sided_named = true;
    } else if (strcmp(key, "weave") == 0) {
        const ClothSource source = {r->name, WEFT_MESSAGE_MATERIAL_FILE, r->folder, r->log, r->error};
        if (!out->cloth) r->result = cloth_from_json(json, &source, &out->cloth);
    } else if (strcmp(key, "measured") == 0) {
        read_measured(r, json);
    } else if (strcmp(key, "back") == 0) {
        read_back(r, json);
    } else if (strcmp(key, "unlit") == 0) {
        if (!json_is_boolean(json)) refuse_value(r, json, "expected true or false");
        out->material.unlit = json_is_true(json);
    } else {
        r->key = "";
        refuse(r, "\"%.40s\" is not a key: `weft models` lists inputs and choices", key);
    }
}

/* Reads a material. Choices come first, since a workflow has defaults of its own, which inputs then replace. */
static void read_object(Reader *r, json_t *root) {
    const char *key;
    json_t *value;
    json_object_foreach(root, key, value) {
        r->key = key;
        if (r->result == WEFT_OK && weft_material_choice_find(key) >= 0)
            read_choice(r, value, (ChoiceId)weft_material_choice_find(key));
    }
    json_object_foreach(root, key, value) {
        r->key = key;
        if (r->result != WEFT_OK || weft_material_choice_find(key) >= 0) continue;
        if (weft_material_input_find(key) >= 0)
            read_input(r, value, (InputId)weft_material_input_find(key));
        else
            read_rest(r, value);
    }
    r->key = "keep";
    for (int k = 0; k < INPUT_COUNT && r->result == WEFT_OK; k++)
        if (r->out->named[k] && r->out->keep[k]) refuse(r, "%s is both kept and given", input_infos[k].name);
    if (r->result != WEFT_OK) return;
    plausible_check_named(&r->out->material, r->out->named, r->name, r->log);
    char about[SUBJECT];
    for (int k = 0; k < CHOICE_COUNT; k++)
        plausible_check(&r->out->material, -1, k, subject(r, weft_material_choice_name(k), about), r->log);
}

WeftResult material_file_read(const void *data, size_t size, const char *name, const char *folder, MaterialFile *out,
                              const WeftLog *log, WeftError *error) {
    *out = (MaterialFile){.material = material_default()};
    Reader reader = {.name = name, .folder = folder, .key = "", .out = out, .log = log, .error = error};
    const char *text = data;
    size_t mark = mark_size(text, size), blank = mark;
    while (blank < size && text[blank] && strchr(" \t\r\n", text[blank])) blank++;
    json_error_t where;
    bool starved;
    json_t *root = json_parse(text + mark, size - mark, JSON_REJECT_DUPLICATES, &where, &starved);
    if (blank == size)
        refuse(&reader, "it is empty");
    else if (starved)
        reader.result = fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    else if (!root)
        refuse(&reader, "line %d: %s", where.line, where.text);
    else if (!json_is_object(root))
        refuse(&reader, "it is not an object");
    else
        read_object(&reader, root);
    json_decref(root);
    return reader.result;
}

void material_file_free(MaterialFile *file) {
    for (int k = 0; k < INPUT_COUNT; k++) {
        weft_image_free(&file->images[k]);
        levels_free(file->levels[k]);
        free(file->paths[k]);
    }
    weft_cloth_free(file->cloth);
    scene_measured_free(file->measured);
    free(file->u3m);
    if (file->back) material_file_free(file->back);
    free(file->back);
    *file = (MaterialFile){0};
}
