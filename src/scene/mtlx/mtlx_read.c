#include "scene/mtlx/mtlx_read.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/equal.h"
#include "base/fail.h"
#include "base/path.h"
#include "base/pi.h"
#include "scene/mtlx/mtlx_graph.h"
#include "scene/mtlx/mtlx_nodes.h"

/* A document being read. The first failure stays. */
typedef struct MtlxReader {
    const char *name;
    const WeftLog *log;
    WeftError *error;
    WeftResult result;
    const XmlElement *shader;
    const MtlxNodeInfo *node;
    Material material;             /* numbers of the rows */
    json_t *textures[INPUT_COUNT]; /* owned; NULL: none */
    float weights[INPUT_COUNT];    /* numbers that colours are multiplied by, where a row has one */
    bool has[INPUT_COUNT];         /* a row has the input */
} MtlxReader;

__attribute__((format(printf, 3, 4))) static void refuse(MtlxReader *r, const XmlElement *at, const char *format, ...) {
    char text[256];
    if (r->result != WEFT_OK) return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    r->result = fail(r->error, WEFT_MESSAGE_MATERIAL_FILE, r->name, "line %d: %s", at->line, text);
}

__attribute__((format(printf, 3, 4))) static void ignore(MtlxReader *r, const XmlElement *at, const char *format, ...) {
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    warn(r->log, WEFT_MESSAGE_GLTF_WARN_IGNORED, r->name, "line %d: %s", at->line, text);
}

static void put(MtlxReader *r, json_t *object, const char *key, json_t *value) {
    if (json_object_set_new(object, key, value) != 0 && r->result == WEFT_OK)
        r->result = fail(r->error, WEFT_MESSAGE_MEMORY, r->name, NULL);
}

static json_t *numbers(MtlxReader *r, const float *values, int count) {
    json_t *array = json_array();
    for (int k = 0; k < count; k++)
        if (json_array_append_new(array, json_real((double)values[k])) != 0 && r->result == WEFT_OK)
            r->result = fail(r->error, WEFT_MESSAGE_MEMORY, r->name, NULL);
    return array;
}

static const char *word(const char *text) { return text ? text : ""; }

/* Writes how a picture repeats. The colour around a picture (constant) is not one of weft's. */
static void put_wrap(MtlxReader *r, json_t *object, const MtlxSource *source, const XmlElement *at) {
    static const char *const from[] = {"periodic", "mirror", "clamp", "constant"}, *const to[] = {"repeat", "mirror",
                                                                                                  "clamp", "clamp"};
    const char *words[2] = {to[0], to[0]};
    for (int k = 0; k < 2; k++) {
        int n = 0;
        if (!source->wrap[k]) continue;
        while (n < 4 && strcmp(from[n], source->wrap[k]) != 0) n++;
        if (n == 4)
            refuse(r, at, "\"%.40s\" is not an address mode: periodic, mirror, clamp or constant", source->wrap[k]);
        else
            words[k] = to[n];
        if (n == 3) ignore(r, at, "address mode constant: the edge is repeated in its place");
    }
    put(r, object, "wrap", json_pack("[ss]", words[0], words[1]));
}

/* Writes the name of a picture's file, with the prefixes of the elements around it. */
static void put_file(MtlxReader *r, json_t *object, const XmlElement *input) {
    char path[2048];
    const char *prefix = xml_inherited(input, "fileprefix"), *file = xml_attribute(input, "value");
    const int size = snprintf(path, sizeof path, "%s%s", word(prefix), file);
    if (size < 0 || (size_t)size >= sizeof path || !path[0])
        refuse(r, input, "the name of a picture is empty or too long");
    else if (strchr(path, '<'))
        refuse(r, input, "\"%.80s\": tiles such as <UDIM> are not read: join them into one picture", path);
    put(r, object, "texture", json_string(path));
}

/* Warns where the file says another encoding of a picture than weft reads. */
static void check_encoding(MtlxReader *r, const MtlxRow *row, const XmlElement *input) {
    const char *space = xml_inherited(input, "colorspace"), *file = xml_attribute(input, "value");
    const bool floats = path_ends(file, ".exr") || path_ends(file, ".hdr") || path_ends(file, ".npy");
    const bool encoded = space && strcmp(space, "srgb_texture") == 0;
    if (row->type == MTLX_COLOR && !floats && !encoded)
        ignore(r, input, "%s: colour space %.40s: integers of a colour are read as sRGB", row->name,
               space ? space : "none");
    if (row->type != MTLX_COLOR && encoded && xml_attribute(input, "colorspace"))
        ignore(r, input, "%s: colour space srgb_texture: numbers are read as they are", row->name);
}

/* Keeps the texture that a graph makes of a row. */
static void take_texture(MtlxReader *r, const MtlxRow *row, const MtlxSource *source) {
    json_t *object = json_object();
    const bool color = row->type == MTLX_COLOR, normal = row->type == MTLX_NORMAL;
    static const char *const channels[] = {"r", "g", "b", "a"};
    float place[6];
    put_file(r, object, source->file);
    check_encoding(r, row, source->file);
    mtlx_flip(source->place, place);
    put(r, object, "transform", numbers(r, place, 6));
    put_wrap(r, object, source, source->file);
    if (source->texcoord) put(r, object, "texcoord", json_integer(1));
    if (source->filter && strcmp(source->filter, "closest") == 0) put(r, object, "nearest", json_true());
    if (color)
        put(r, object, "factor", numbers(r, source->factor, 3));
    else
        put(r, object, "factor", json_real(normal ? (double)source->scale : (double)source->factor[0]));
    if (!color && !normal) put(r, object, "channel", json_string(channels[source->channel < 0 ? 0 : source->channel]));
    json_decref(r->textures[row->input]);
    r->textures[row->input] = object;
}

static void set_value(MtlxReader *r, const MtlxRow *row, const float v[3]) {
    Material *m = &r->material;
    float none[3] = {0.0f, 0.0f, 0.0f}; /* of a row without an input, whose rule is another */
    float *to = row->input < 0 ? none : m->inputs[row->input].value;
    switch (row->rule) {
    case MTLX_ALPHA_CUTOFF: m->alpha_cutoff = v[0]; break;
    case MTLX_ALPHA_MODE: m->alpha_mode = (WeftAlphaMode)v[0]; break;
    case MTLX_TWO_SIDED: m->double_sided = v[0] > 0.0f; break;
    case MTLX_WEIGHT:
        if (row->input >= 0) r->weights[row->input] = v[0];
        for (int c = 0; c < 3; c++) to[c] *= v[0];
        break;
    case MTLX_SQUARE: to[0] = sqrtf(fmaxf(v[0], 0.0f)); break;
    case MTLX_MAP: break; /* without a texture nothing is darker */
    case MTLX_FINITE:
    case MTLX_SAME: memcpy(to, v, 3 * sizeof *to); break;
    }
}

/* Returns true if a number is one that an input of type integer can have: a WeftAlphaMode. */
static bool is_mode(float x) { return is_equal(x, 0.0f) || is_equal(x, 1.0f) || is_equal(x, 2.0f); }

/* Takes what a graph makes of a row's input. */
static void read_graph(MtlxReader *r, const MtlxRow *row, const XmlElement *input) {
    MtlxSource source;
    const XmlElement *strange;
    const bool known = mtlx_follow(input, &source, &strange), tangent = row->type == MTLX_TANGENT;
    if (!known || source.tangent != tangent || (source.square && row->rule != MTLX_SQUARE) ||
        (source.file && source.channel >= 0 && (row->type == MTLX_COLOR || row->type == MTLX_NORMAL)) ||
        (source.file && row->input < 0)) {
        ignore(r, input, "%s: its graph is not understood%s%.40s%s: its default counts", row->name,
               strange ? " (node " : "", strange ? strange->name : "", strange ? ")" : "");
    } else if (tangent) {
        r->material.inputs[row->input].value[0] = atan2f(source.across, source.along);
    } else if (!source.file && row->type == MTLX_INTEGER && !is_mode(source.factor[0])) {
        refuse(r, input, "%s: not 0, 1 or 2", row->name);
    } else if (!source.file) {
        set_value(r, row, source.factor);
    } else if (row->rule == MTLX_WEIGHT) {
        ignore(r, input, "%s: a texture of it is not read: its default counts", row->name);
    } else {
        if (source.square) source.factor[0] = fabsf(source.factor[0]);
        if (row->rule == MTLX_SQUARE && !source.square) {
            ignore(r, input, "%s: its texture is an alpha, and is read as a roughness", row->name);
            source.factor[0] = sqrtf(fmaxf(source.factor[0], 0.0f));
        }
        take_texture(r, row, &source);
    }
}

/* Reads the text of a value. Returns false if it is none of the row's type. */
static bool read_text(const MtlxRow *row, const char *text, float v[3]) {
    const bool color = row->type == MTLX_COLOR || row->type == MTLX_GREY;
    if (row->type == MTLX_BOOLEAN) {
        v[0] = text && strcmp(text, "true") == 0 ? 1.0f : 0.0f;
        return text && (strcmp(text, "true") == 0 || strcmp(text, "false") == 0);
    }
    if (!mtlx_numbers(text, v, color ? 3 : 1)) return false;
    if (row->type == MTLX_GREY) v[0] = (v[0] + v[1] + v[2]) / 3.0f;
    return row->type != MTLX_INTEGER || is_mode(v[0]);
}

static void read_row(MtlxReader *r, const MtlxRow *row) {
    const XmlElement *input = xml_child(r->shader, row->name);
    const char *type = mtlx_type_name(row->type), *is = input ? xml_attribute(input, "type") : NULL;
    float v[3] = {row->initial, row->initial, row->initial};
    const bool vector = row->type == MTLX_NORMAL || row->type == MTLX_TANGENT;
    if (row->input >= 0) r->has[row->input] = true;
    set_value(r, row, v);
    if (!input || r->result != WEFT_OK) return;
    if (!is || strcmp(is, type) != 0)
        refuse(r, input, "%s: its type must be %s, not \"%.40s\"", row->name, type, word(is));
    else if (mtlx_is_connected(input))
        read_graph(r, row, input);
    else if (vector && xml_attribute(input, "value"))
        ignore(r, input, "%s: a constant vector is not read", row->name);
    else if (!vector && !read_text(row, xml_attribute(input, "value"), v))
        refuse(r, input, "%s: \"%.60s\" is not a value of type %s", row->name, word(xml_attribute(input, "value")),
               type);
    else if (!vector)
        set_value(r, row, v);
}

/* Returns true if a text is a number or a colour, of zeros. */
static bool is_zero(const char *text) {
    float v[3] = {0.0f, 0.0f, 0.0f};
    if (!mtlx_numbers(text, v, 1) && !mtlx_numbers(text, v, 3)) return false;
    return is_equal(v[0], 0.0f) && is_equal(v[1], 0.0f) && is_equal(v[2], 0.0f);
}

/* Warns of inputs that switch on what is not shown, and of those that the node does not have. */
static void read_others(MtlxReader *r) {
    static const char *const parts[] = {"transmission_", "subsurface_", "thin_film_", "iridescence_", "attenuation_"};
    for (const XmlElement *input = r->shader->first; input; input = input->next) {
        const char *name = xml_attribute(input, "name");
        bool known = !name || strcmp(input->name, "input") != 0 || mtlx_row(r->node, name) != NULL;
        for (int k = 0; !known && r->node->unshown[k]; k++) {
            if (strcmp(name, r->node->unshown[k]) != 0) continue;
            known = true;
            if (mtlx_is_connected(input) || !is_zero(xml_attribute(input, "value")))
                ignore(r, input, "%.60s: is not shown", name);
        }
        for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
            known = known || strncmp(name, parts[k], strlen(parts[k])) == 0;
        if (!known) ignore(r, input, "%.60s: %s has no such input that weft knows", name, r->node->id);
    }
}

static bool is_black(const Input *input) {
    return !(input->value[0] > 0.0f || input->value[1] > 0.0f || input->value[2] > 0.0f);
}

/* Turns what is off by its weight into what is off by its colour, as a material of weft is without it. */
static void settle_off(MtlxReader *r, InputId weight, InputId color) {
    Input *inputs = r->material.inputs;
    if (!r->has[weight] || r->textures[weight] || r->textures[color]) return;
    if (!is_black(&inputs[weight]) && !is_black(&inputs[color])) return;
    memset(inputs[color].value, 0, sizeof inputs[color].value);
    inputs[weight].value[0] = 1.0f;
}

static bool has_glass(const MtlxReader *r) {
    return r->textures[INPUT_transmission] || r->material.inputs[INPUT_transmission].value[0] > 0.0f;
}

/* Returns true if all light that is not reflected goes through. */
static bool is_all_glass(const MtlxReader *r) {
    return !r->textures[INPUT_transmission] && r->material.inputs[INPUT_transmission].value[0] >= 1.0f;
}

static void drop(MtlxReader *r, InputId id) {
    json_decref(r->textures[id]);
    r->textures[id] = NULL;
    r->has[id] = false;
}

/* Gives what tints light on its way through glass to base_color. Where not all light goes that way, base_color is that
 * of the rest, and stays. */
static void tint_base(MtlxReader *r) {
    Input *base = &r->material.inputs[INPUT_base_color], *color = &r->material.inputs[INPUT_attenuation_color];
    json_t **mine = &r->textures[INPUT_base_color], *its = r->textures[INPUT_attenuation_color];
    bool same = json_equal(*mine, its) != 0;
    if (!*mine && !its) {
        same = true;
        for (int c = 0; c < 3; c++) same = same && is_equal(base->value[c], color->value[c]);
    }
    if (same) return;
    if (!is_all_glass(r)) {
        ignore(r, r->shader, "transmission_color: light goes through in base_color, as glTF has it");
        return;
    }
    memcpy(base->value, color->value, sizeof base->value);
    json_decref(*mine);
    *mine = json_incref(its);
    r->weights[INPUT_base_color] = 1.0f;
}

/* Turns the one colour of glass that a node without a thickness has into base_color of what is thin or absorbs
 * nothing, else into that of what is inside. */
static void settle_glass(MtlxReader *r) {
    static const float solid_metres = 0.01f; /* the node has no thickness; tracers take that of the mesh */
    Input *inputs = r->material.inputs;
    if (r->has[INPUT_thickness]) return;
    const bool glass = has_glass(r), solid = glass && !r->material.double_sided,
               absorbs = solid && inputs[INPUT_attenuation_distance].value[0] > 0.0f;
    r->has[INPUT_thickness] = solid;
    inputs[INPUT_thickness].value[0] = solid_metres;
    if (glass && !absorbs) tint_base(r);
    if (absorbs && r->textures[INPUT_attenuation_color])
        ignore(r, r->shader, "transmission_color: a texture of what is inside glass is not read: its number counts");
    drop(r, INPUT_attenuation_color);
    if (!absorbs) drop(r, INPUT_attenuation_distance);
    r->has[INPUT_attenuation_color] = absorbs;
    if (!absorbs || !is_all_glass(r)) return;
    for (int c = 0; c < 3; c++) inputs[INPUT_base_color].value[c] = 1.0f;
    drop(r, INPUT_base_color);
    r->has[INPUT_base_color] = true;
}

static json_t *value_json(MtlxReader *r, InputId id) {
    const float *v = r->material.inputs[id].value;
    const WeftInputKind kind = input_infos[id].kind;
    if (kind == WEFT_INPUT_COLOR) return numbers(r, v, 3);
    const bool angle = kind == WEFT_INPUT_DIRECTION || kind == WEFT_INPUT_ANGLE;
    return json_real(angle ? (double)v[0] * 180.0 / PI_DOUBLE : (double)v[0]);
}

/* Gives a texture of a colour the factor that a weight beside it has, which is in the number. */
static void weigh_textures(MtlxReader *r) {
    for (const MtlxRow *row = r->node->rows; row->name; row++) {
        json_t *object = row->rule == MTLX_WEIGHT ? r->textures[row->input] : NULL;
        float v[3];
        if (!object) continue;
        for (size_t c = 0; c < 3; c++)
            v[c] =
                r->weights[row->input] * (float)json_number_value(json_array_get(json_object_get(object, "factor"), c));
        put(r, object, "factor", numbers(r, v, 3));
    }
}

/* Returns the material file of what was read. */
static json_t *material_json(MtlxReader *r) {
    static const char *const modes[] = {"opaque", "mask", "blend"}; /* as WeftAlphaMode */
    const Material *m = &r->material;
    json_t *root = json_object();
    put(r, root, r->node->shader, json_string(r->node->shader_id));
    for (int k = 0; k < INPUT_COUNT; k++) {
        if (!r->has[k]) continue;
        if (r->textures[k])
            put(r, root, input_infos[k].name, json_incref(r->textures[k]));
        else if (input_infos[k].kind != WEFT_INPUT_NORMAL)
            put(r, root, input_infos[k].name, value_json(r, (InputId)k));
    }
    const bool clear = r->textures[INPUT_opacity] || m->inputs[INPUT_opacity].value[0] < 1.0f;
    const bool has_mode = mtlx_row(r->node, "alpha_mode") != NULL;
    put(r, root, "alpha_mode",
        json_string(modes[has_mode ? m->alpha_mode
                          : clear  ? WEFT_ALPHA_BLEND
                                   : WEFT_ALPHA_OPAQUE]));
    put(r, root, "alpha_cutoff", json_real((double)m->alpha_cutoff));
    put(r, root, "double_sided", json_boolean(m->double_sided));
    return root;
}

static int node_of(const XmlElement *element) {
    int k = 0;
    while (k < WEFT_MTLX_NODES && strcmp(mtlx_nodes[k].id, element->name) != 0) k++;
    return k < WEFT_MTLX_NODES ? k : -1;
}

/* Finds the surface: that of the first material, or else the first that is known. */
static int find_shader(MtlxReader *r, const XmlElement *root) {
    const XmlElement *material = NULL;
    int materials = 0;
    for (const XmlElement *element = root->first; element; element = element->next) {
        if (strcmp(element->name, "surfacematerial") == 0 && ++materials == 1) material = element;
        if (strcmp(element->name, "xi:include") == 0) ignore(r, element, "an included document is not read");
        if (!r->shader && node_of(element) >= 0) r->shader = element;
    }
    const XmlElement *input = material ? xml_child(material, "surfaceshader") : NULL;
    const char *named = input ? xml_attribute(input, "nodename") : NULL;
    if (named) r->shader = xml_child(root, named);
    if (materials > 1) ignore(r, material, "it has %d materials, of which the first is read", materials);
    if (!r->shader || node_of(r->shader) < 0) {
        refuse(r, r->shader ? r->shader : root, "%s%.40s%s: expected open_pbr_surface, gltf_pbr or standard_surface",
               r->shader ? "its surface is <" : "it has no surface", r->shader ? r->shader->name : "",
               r->shader ? ">" : "");
        return -1;
    }
    return node_of(r->shader);
}

static json_t *read_root(MtlxReader *r, const XmlElement *root) {
    const char *version = xml_attribute(root, "version");
    if (strcmp(root->name, "materialx") != 0)
        refuse(r, root, "it is <%.40s> and no <materialx>", root->name);
    else if (!version || strncmp(version, "1.", 2) != 0)
        refuse(r, root, "version: expected 1.38 or 1.39, not \"%.20s\"", word(version));
    const int node = r->result == WEFT_OK ? find_shader(r, root) : -1;
    if (node < 0) return NULL;
    r->node = &mtlx_nodes[node];
    for (const MtlxRow *row = r->node->rows; row->name && r->result == WEFT_OK; row++) read_row(r, row);
    if (r->result != WEFT_OK) return NULL;
    read_others(r);
    mtlx_from_node((WeftMtlxNode)node, &r->material);
    settle_off(r, INPUT_emission_strength, INPUT_emission);
    settle_off(r, INPUT_sheen, INPUT_sheen_color);
    settle_glass(r);
    weigh_textures(r);
    return material_json(r);
}

WeftResult mtlx_read(const void *data, size_t size, const char *name, json_t **out, const WeftLog *log,
                     WeftError *error) {
    Arena arena = {0};
    const XmlElement *root;
    MtlxReader reader = {.name = name, .log = log, .error = error, .material = material_default()};
    json_t *json = NULL;
    reader.result = xml_read(data, size, name, &arena, &root, error);
    if (reader.result == WEFT_OK) json = read_root(&reader, root);
    for (int k = 0; k < INPUT_COUNT; k++) json_decref(reader.textures[k]);
    arena_free(&arena);
    if (reader.result != WEFT_OK) {
        json_decref(json);
        json = NULL;
    }
    *out = json;
    return reader.result;
}
