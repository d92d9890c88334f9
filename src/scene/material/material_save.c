/* material_save.c - writing a material file (docs/materials.md), which material_file.c reads */
#define _XOPEN_SOURCE 700 /* realpath */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/equal.h"
#include "base/fail.h"
#include "base/file.h"
#include "base/json.h"
#include "base/pi.h"
#include "brdf/measured.h"
#include "scene/material/cloth_file.h"
#include "scene/material/relief.h"
#include "scene/mtlx/mtlx_write.h"
#include "scene/record/scene.h"
#include "shading/material/choice.h"
#include "weave/weft_cloth.h"
#include "weft/save.h"

/* A file being written. The first failure stays. */
typedef struct Writer {
    const WeftScene *scene;
    const char *path;
    WeftError *error;
    WeftResult result;
    Arena arena;
    json_t *root;                   /* the material, or its back */
    const char *part;               /* between the names of the file and of an input: "-", of a back "-back-" */
    const char *floats;             /* the suffix of a picture of floats */
    const char *files[INPUT_COUNT]; /* files with an input's texture, as the material file names them */
} Writer;

static void no_memory(Writer *w) {
    if (w->result == WEFT_OK) w->result = fail(w->error, WEFT_MESSAGE_MEMORY, w->path, NULL);
}

static void put(Writer *w, json_t *object, const char *key, json_t *value) {
    if (json_object_set_new(object, key, value) != 0) no_memory(w);
}

/* Returns the degrees that are read as these radians, or come nearest. */
static float degrees(float radians) {
    const float unit = PI_FLOAT / 180.0f;
    float best = radians / unit, near = best;
    for (int k = 0; k < 4; k++) near = nextafterf(near, -INFINITY);
    for (int k = 0; k < 9; k++, near = nextafterf(near, INFINITY))
        if (fabsf(near * unit - radians) < fabsf(best * unit - radians)) best = near;
    return best;
}

static json_t *numbers(Writer *w, const float *values, int count) {
    json_t *array = json_array();
    for (int k = 0; k < count; k++)
        if (json_array_append_new(array, json_of_float(values[k])) != 0) no_memory(w);
    return array;
}

static json_t *value_json(Writer *w, const Input *input, WeftInputKind kind) {
    const float *v = input->value;
    bool grey = !(v[0] < v[1] || v[0] > v[1] || v[0] < v[2] || v[0] > v[2]);
    if (kind == WEFT_INPUT_COLOR && !grey) return numbers(w, v, 3);
    bool angle = kind == WEFT_INPUT_ANGLE || kind == WEFT_INPUT_DIRECTION;
    return json_of_float(angle ? degrees(v[0]) : v[0]);
}

/* Returns the absolute folder of a path, with a slash at its end, or NULL. The caller frees it. */
static char *folder_of(const char *path) {
    const char *slash = strrchr(path, '/');
    char *name = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup("."),
         *full = name ? realpath(name, NULL) : NULL;
    free(name);
    char *folder = full ? malloc(strlen(full) + 2) : NULL;
    if (folder) sprintf(folder, "%s%s", full, strcmp(full, "/") == 0 ? "" : "/");
    free(full);
    return folder;
}

/* Returns the relative path of a file from a folder, both absolute. */
static char *relative(Writer *w, const char *folder, const char *file) {
    size_t common = 0, up = 0;
    for (size_t k = 0; folder[k] && folder[k] == file[k]; k++)
        if (folder[k] == '/') common = k + 1;
    for (const char *rest = folder + common; *rest; rest++) up += *rest == '/';
    char *path = arena_array(&w->arena, 3 * up + strlen(file) + 1, 1), *to = path;
    if (!path) no_memory(w);
    for (size_t k = 0; path && k < up; k++) to += sprintf(to, "../");
    if (path) memcpy(to, file + common, strlen(file + common) + 1);
    return path;
}

/* Writes an image beside the material file: integers as .png, floats as w->floats says. Returns its name. */
static const char *write_picture(Writer *w, const WeftImage *image, InputId id) {
    const char *dot = strrchr(w->path, '.'), *slash = strrchr(w->path, '/');
    int stem = dot && (!slash || dot > slash) ? (int)(dot - w->path) : (int)strlen(w->path);
    const char *name = input_infos[id].name, *suffix = image->type == WEFT_PIXEL_F32 ? w->floats : "png";
    size_t size = (size_t)stem + strlen(w->part) + strlen(name) + 8;
    char *path = arena_array(&w->arena, size, 1);
    if (!path) {
        no_memory(w);
        return NULL;
    }
    snprintf(path, size, "%.*s%s%s.%s", stem, w->path, w->part, name, suffix);
    WeftResult result = weft_image_write_as(path, image, &(WeftImageWriting){.data = 1}, w->error);
    if (w->result == WEFT_OK) w->result = result;
    return slash ? path + (slash + 1 - w->path) : path;
}

/* Returns the file of a texture relative to the material file. An image without a file, or that differs from its
 * file, is written once. */
static const char *file_of(Writer *w, const Material *material, InputId id) {
    const Texture *texture = &w->scene->textures[material->inputs[id].texture - 1];
    for (int k = 0; k < (int)id; k++) {
        int other = material->inputs[k].texture;
        if (other && w->files[k] && w->scene->textures[other - 1].image == texture->image) return w->files[k];
    }
    const bool own = texture->path && !texture->inverted;
    char *folder = folder_of(w->path), *full = own ? realpath(texture->path, NULL) : NULL;
    const char *file =
        folder && full ? relative(w, folder, full) : write_picture(w, &w->scene->images[texture->image], id);
    free(folder);
    free(full);
    return file;
}

static void place_put(Writer *w, json_t *object, const float m[6]) {
    static const float identity[6] = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f};
    const float scale[2] = {m[0], m[4]}, offset[2] = {m[2], m[5]};
    bool same = true, rotated = m[1] < 0.0f || m[1] > 0.0f || m[3] < 0.0f || m[3] > 0.0f;
    for (int k = 0; k < 6; k++) same &= is_equal(m[k], identity[k]);
    if (same) return;
    if (rotated) {
        put(w, object, "transform", numbers(w, m, 6));
    } else {
        put(w, object, "scale", numbers(w, scale, 2));
        put(w, object, "offset", numbers(w, offset, 2));
    }
}

static json_t *texture_json(Writer *w, const Material *material, InputId id) {
    static const char *const channels[] = {"r", "g", "b", "a"}, *const wraps[] = {"repeat", "mirror",
                                                                                  "clamp"}; /* as TextureWrap */
    const Input *input = &material->inputs[id];
    const Texture *texture = &w->scene->textures[input->texture - 1];
    WeftInputKind kind = input_infos[id].kind;
    json_t *object = json_object();
    const char *file = w->files[id] = file_of(w, material, id);
    put(w, object, "texture", json_string(file ? file : ""));
    put(w, object, "factor", value_json(w, input, kind));
    if (input->channel && (kind == WEFT_INPUT_SCALAR || kind == WEFT_INPUT_ANGLE))
        put(w, object, "channel", json_string(channels[input->channel]));
    if (input->texcoord) put(w, object, "texcoord", json_integer(input->texcoord));
    place_put(w, object, input->transform);
    if (texture->wrap_u != WRAP_REPEAT || texture->wrap_v != WRAP_REPEAT)
        put(w, object, "wrap", json_pack("[ss]", wraps[texture->wrap_u], wraps[texture->wrap_v]));
    if (texture->nearest) put(w, object, "nearest", json_true());
    if (texture->single) put(w, object, "levels", json_false());
    return object;
}

/* Returns true if assigning a material leaves the input as the asset has it, unless the file names it. */
static bool is_of_shape(int id) { return id == INPUT_normal || id == INPUT_occlusion || id == INPUT_opacity; }

static void write_inputs(Writer *w, const Material *material) {
    Material fresh = material_default();
    for (int k = 0; k < CHOICE_COUNT; k++) {
        const char *id = choice_id((ChoiceId)k, material->choices[k]);
        if (!id) continue;
        put(w, w->root, weft_material_choice_name(k), json_string(id));
        material_choose(&fresh, (ChoiceId)k, material->choices[k]);
    }
    for (int k = 0; k < INPUT_COUNT; k++) {
        const Input *input = &material->inputs[k];
        WeftInputKind kind = input_infos[k].kind;
        size_t size = (size_t)input_value_count((InputId)k) * sizeof *input->value;
        bool same = memcmp(input->value, fresh.inputs[k].value, size) == 0 && !input->given;
        if (input->texture)
            put(w, w->root, input_infos[k].name, texture_json(w, material, (InputId)k));
        else if (!same || is_of_shape(k))
            put(w, w->root, input_infos[k].name, value_json(w, input, kind));
    }
}

/* Returns the JSON of a weave, with the file of its draft relative to the material file. */
static json_t *weave_json(Writer *w, const WeftCloth *cloth) {
    char *folder = cloth->path ? folder_of(w->path) : NULL;
    const char *draft = folder ? relative(w, folder, cloth->path) : NULL;
    free(folder);
    return cloth_to_json(cloth, draft);
}

/* Returns the path of a measurement relative to the material file. */
static json_t *measured_json(Writer *w, const Measured *measured) {
    char *folder = measured->path ? folder_of(w->path) : NULL;
    const char *path = folder ? relative(w, folder, measured->path) : measured->path;
    free(folder);
    return json_string(path ? path : "");
}

static void write_rest(Writer *w, const Material *material) {
    static const char *const modes[] = {"opaque", "mask", "blend"}; /* as WeftAlphaMode */
    put(w, w->root, "alpha_mode", json_string(modes[material->alpha_mode]));
    put(w, w->root, "alpha_cutoff", json_of_float(material->alpha_cutoff));
    if (material->unlit) put(w, w->root, "unlit", json_true());
    if (material->cloth) put(w, w->root, "weave", weave_json(w, w->scene->cloths[material->cloth - 1]));
    if (material->measured) put(w, w->root, "measured", measured_json(w, w->scene->measured[material->measured - 1]));
    for (int k = 0; k < WEFT_HAIR_NUMBERS; k++)
        if (!is_equal(material->hair[k], hair_infos[k].initial))
            put(w, w->root, hair_infos[k].name, json_of_float(material->hair[k]));
    put(w, w->root, "double_sided", json_boolean(material->double_sided));
}

/* Writes a back that was given; that of a weave follows from it. */
static void write_back(Writer *w, int material) {
    const WeftScene *scene = w->scene;
    json_t *front = w->root, *back;
    if (material >= scene->back_count || scene->backs[material] != BACK_GIVEN) return;
    back = json_object();
    w->root = back;
    w->part = "-back-";
    memset(w->files, 0, sizeof w->files);
    write_inputs(w, &scene->materials[scene->material_count + material]);
    w->root = front;
    put(w, front, "back", back);
}

static void write_file(Writer *w) {
    char *text = json_dumps(w->root, JSON_INDENT(4) | JSON_REAL_PRECISION(9));
    OutputFile file;
    if (!text) no_memory(w);
    if (w->result == WEFT_OK) w->result = output_open(&file, w->path, w->error);
    if (w->result == WEFT_OK) {
        fprintf(file.stream, "%s\n", text);
        w->result = output_commit(&file, w->error);
    }
    free(text);
}

static WeftResult check_index(const WeftScene *scene, int index, WeftError *error) {
    char names[NAMES_SIZE], text[16];
    if (index >= 0 && index < scene->material_count) return WEFT_OK;
    snprintf(text, sizeof text, "%d", index);
    return fail(error, WEFT_MESSAGE_MATERIAL_NAME, text, "%s", scene_names(scene, weft_scene_material_name, names));
}

WeftResult weft_scene_save_material(const WeftScene *scene, int index, const char *path, WeftError *error) {
    const WeftResult checked = check_index(scene, index, error);
    if (checked != WEFT_OK) return checked;
    Writer writer = {.scene = scene, .path = path, .error = error, .root = json_object(), .part = "-", .floats = "npy"};
    const Material given = relief_given(scene, index);
    write_inputs(&writer, &given);
    write_rest(&writer, &given);
    write_back(&writer, index);
    if (writer.result == WEFT_OK) write_file(&writer);
    json_decref(writer.root);
    arena_free(&writer.arena);
    return writer.result;
}

WeftResult weft_scene_save_mtlx(const WeftScene *scene, int index, const char *path, WeftMtlxNode node,
                                const WeftLog *log, WeftError *error) {
    const WeftResult checked = check_index(scene, index, error);
    if (checked != WEFT_OK) return checked;
    if ((unsigned)node >= WEFT_MTLX_NODES) return fail(error, WEFT_MESSAGE_DESC, path, "no such node of MaterialX");
    Writer w = {.scene = scene, .path = path, .error = error, .part = "-", .floats = "exr"};
    const Material given = relief_given(scene, index);
    Material written = given;
    mtlx_to_node(node, &written);
    for (int k = 0; k < INPUT_COUNT && w.result == WEFT_OK; k++)
        if (written.inputs[k].texture && mtlx_row_of(&mtlx_nodes[node], k))
            w.files[k] = file_of(&w, &written, (InputId)k);
    const MtlxWriting writing = {.node = node,
                                 .name = scene->material_names[index],
                                 .material = &written,
                                 .textures = scene->textures,
                                 .images = scene->images,
                                 .files = w.files};
    OutputFile file;
    if (w.result == WEFT_OK) w.result = output_open(&file, path, error);
    if (w.result == WEFT_OK) {
        mtlx_write(&writing, file.stream);
        w.result = output_commit(&file, error);
    }
    const bool back = index < scene->back_count && scene->backs[index] == BACK_GIVEN;
    if (w.result == WEFT_OK) mtlx_losses(&writing, &given, back, path, log);
    arena_free(&w.arena);
    return w.result;
}
