#include "scene/mtlx/mtlx_write.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "base/equal.h"
#include "base/fail.h"
#include "base/number.h"
#include "scene/record/material_at.h"
#include "shading/material/choice.h"
#include "weft/version.h"

/* A document being written: the row whose nodes are written, and the name of the last of them. */
typedef struct Document {
    const MtlxWriting *writing;
    const MtlxNodeInfo *node;
    const MtlxRow *row;
    const char *last; /* behind the row's name */
    FILE *out;
} Document;

static void put_numbers(FILE *out, const float *values, int count) {
    char text[NUMBER_TEXT];
    for (int k = 0; k < count; k++) fprintf(out, "%s%s", k ? ", " : "", number_shortest(values[k], text));
}

/* Writes a text as an attribute's value; characters that XML has not are left out. */
static void put_text(FILE *out, const char *text) {
    static const char *const entities[] = {"&amp;", "&lt;", "&gt;", "&quot;"};
    for (const char *c = text; *c; c++) {
        const char *special = strchr("&<>\"", *c);
        if (special)
            fputs(entities[special - "&<>\""], out);
        else if ((unsigned char)*c >= ' ')
            fputc(*c, out);
    }
}

static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

static void put_name(FILE *out, const char *name) {
    if (!name || !name[0]) name = "material";
    if (isdigit((unsigned char)name[0])) fputc('_', out);
    for (const char *c = name; *c; c++) fputc(is_letter(*c) ? *c : '_', out);
}

static void begin(const Document *d, const char *kind, const char *suffix, const char *type) {
    fprintf(d->out, "    <%s name=\"%s_%s\" type=\"%s\">\n", kind, d->row->name, suffix, type);
}

static void end(const Document *d, const char *kind) { fprintf(d->out, "    </%s>\n", kind); }

static void input_node(const Document *d, const char *name, const char *type, const char *suffix) {
    fprintf(d->out, "      <input name=\"%s\" type=\"%s\" nodename=\"%s_%s\" />\n", name, type, d->row->name, suffix);
}

static void input_numbers(const Document *d, const char *name, const char *type, const float *values, int count) {
    fprintf(d->out, "      <input name=\"%s\" type=\"%s\" value=\"", name, type);
    put_numbers(d->out, values, count);
    fprintf(d->out, "\" />\n");
}

static void input_word(const Document *d, const char *name, const char *type, const char *word) {
    fprintf(d->out, "      <input name=\"%s\" type=\"%s\" value=\"%s\" />\n", name, type, word);
}

/* Writes a node of the last one and of numbers, which is then the last. */
static void put_with(Document *d, const char *kind, const char *suffix, const char *type, const float *values,
                     int count) {
    begin(d, kind, suffix, type);
    input_node(d, "in1", type, d->last);
    input_numbers(d, "in2", count == 1 ? "float" : type, values, count);
    end(d, kind);
    d->last = suffix;
}

/* Writes one coordinate as a dot product. */
static void put_row(const Document *d, const char *suffix, const float *row) {
    begin(d, "dotproduct", suffix, "float");
    input_node(d, "in1", "vector2", "st");
    input_numbers(d, "in2", "vector2", row, 2);
    end(d, "dotproduct");
}

/* Writes the nodes of texture coordinates that are not the first set as it is. Returns false where there are none. */
static bool put_coordinates(Document *d, const Input *input) {
    static const float identity[6] = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f};
    float m[6];
    bool same = true;
    for (int k = 0; k < 6; k++) same &= is_equal(input->transform[k], identity[k]);
    if (same && !input->texcoord) return false;
    begin(d, "texcoord", "st", "vector2");
    input_word(d, "index", "integer", input->texcoord ? "1" : "0");
    end(d, "texcoord");
    d->last = "st";
    if (same) return true;
    mtlx_flip(input->transform, m);
    put_row(d, "u", m);
    put_row(d, "v", m + 3);
    begin(d, "combine2", "rotated", "vector2");
    input_node(d, "in1", "float", "u");
    input_node(d, "in2", "float", "v");
    end(d, "combine2");
    d->last = "rotated";
    put_with(d, "add", "placed", "vector2", (const float[]){m[2], m[5]}, 2);
    return true;
}

/* Writes the node that reads the picture. */
static void put_image(Document *d, const Input *input, const char *type) {
    static const char *const wraps[] = {"periodic", "mirror", "clamp"}; /* as TextureWrap */
    const Texture *texture = &d->writing->textures[input->texture - 1];
    const bool encoded = d->row->type == MTLX_COLOR && d->writing->images[texture->image].type != WEFT_PIXEL_F32;
    const bool placed = put_coordinates(d, input);
    const char *file = d->writing->files[d->row->input];
    begin(d, "image", "image", type);
    fprintf(d->out, "      <input name=\"file\" type=\"filename\"%s value=\"",
            encoded ? " colorspace=\"srgb_texture\"" : "");
    put_text(d->out, file ? file : "");
    fprintf(d->out, "\" />\n");
    if (placed) input_node(d, "texcoord", "vector2", d->last);
    input_word(d, "uaddressmode", "string", wraps[texture->wrap_u]);
    input_word(d, "vaddressmode", "string", wraps[texture->wrap_v]);
    if (texture->nearest) input_word(d, "filtertype", "string", "closest");
    end(d, "image");
    d->last = "image";
}

static void put_channel(Document *d, const Input *input, const char *type) {
    begin(d, "extract", "channel", "float");
    input_node(d, "in", type, "image");
    fprintf(d->out, "      <input name=\"index\" type=\"integer\" value=\"%d\" />\n", input->channel);
    end(d, "extract");
    d->last = "channel";
}

/* Writes the texture of an input times its number. */
static void put_texture(Document *d, const Input *input) {
    const MtlxRow *row = d->row;
    const bool color = row->type == MTLX_COLOR, normal = row->type == MTLX_NORMAL;
    const char *type = normal ? "vector3" : !color && input->channel == 3 ? "color4" : "color3";
    const float *v = input->value;
    put_image(d, input, type);
    if (normal) {
        begin(d, "normalmap", "map", "vector3");
        input_node(d, "in", "vector3", "image");
        input_numbers(d, "scale", "float", v, 1);
        end(d, "normalmap");
        d->last = "map";
        return;
    }
    if (!color) put_channel(d, input, type);
    const bool one = is_equal(v[0], 1.0f) && (!color || (is_equal(v[1], 1.0f) && is_equal(v[2], 1.0f)));
    if (!one && row->rule != MTLX_MAP) put_with(d, "multiply", "scaled", color ? "color3" : "float", v, color ? 3 : 1);
    if (row->rule == MTLX_SQUARE) {
        begin(d, "multiply", "square", "float");
        input_node(d, "in1", "float", d->last);
        input_node(d, "in2", "float", d->last);
        end(d, "multiply");
        d->last = "square";
    }
    if (row->type == MTLX_GREY) {
        begin(d, "convert", "grey", "color3");
        input_node(d, "in", "float", d->last);
        end(d, "convert");
        d->last = "grey";
    }
}

/* Writes a tangent that is turned towards the bitangent. */
static void put_tangent(Document *d, const Input *input) {
    static const char *const axes[] = {"tangent", "bitangent"}, *const parts[] = {"along", "across"};
    const float v[2] = {cosf(input->value[0]), sinf(input->value[0])};
    for (int k = 0; k < 2; k++) {
        begin(d, axes[k], axes[k], "vector3");
        input_word(d, "space", "string", "world");
        end(d, axes[k]);
        d->last = axes[k];
        put_with(d, "multiply", parts[k], "vector3", &v[k], 1);
    }
    begin(d, "add", "rotated", "vector3");
    input_node(d, "in1", "vector3", "along");
    input_node(d, "in2", "vector3", "across");
    end(d, "add");
    d->last = "rotated";
}

static const Input *input_of(const Document *d, const MtlxRow *row) {
    return row->input < 0 ? NULL : &d->writing->material->inputs[row->input];
}

/* Returns true if the row's input is made by the graph. */
static bool is_made(const Document *d, const MtlxRow *row) {
    const Input *input = input_of(d, row), *inputs = d->writing->material->inputs;
    if (!input || row->rule == MTLX_WEIGHT) return false;
    if (row->type != MTLX_TANGENT) return input->texture != 0;
    const InputId stretch = row->input == INPUT_anisotropy_direction ? INPUT_anisotropy : INPUT_coat_anisotropy;
    return inputs[stretch].value[0] > 0.0f && !is_equal(input->value[0], 0.0f);
}

/* Writes the graph of all textures, if there are any. */
static void put_graph(Document *d) {
    const MtlxRow *rows = d->node->rows;
    const char *lasts[WEFT_INPUTS_MAX] = {NULL};
    bool any = false;
    for (const MtlxRow *row = rows; row->name; row++) any |= is_made(d, row);
    if (!any) return;
    fprintf(d->out, "  <nodegraph name=\"");
    put_name(d->out, d->writing->name);
    fprintf(d->out, "_maps\">\n");
    for (d->row = rows; d->row->name; d->row++) {
        if (!is_made(d, d->row)) continue;
        if (d->row->type == MTLX_TANGENT)
            put_tangent(d, input_of(d, d->row));
        else
            put_texture(d, input_of(d, d->row));
        lasts[d->row - rows] = d->last;
    }
    for (const MtlxRow *row = rows; row->name; row++)
        if (lasts[row - rows])
            fprintf(d->out, "    <output name=\"%s_out\" type=\"%s\" nodename=\"%s_%s\" />\n", row->name,
                    mtlx_type_name(row->type), row->name, lasts[row - rows]);
    fprintf(d->out, "  </nodegraph>\n");
}

/* Writes the value of a row without a texture. */
static void put_value(const Document *d, const MtlxRow *row) {
    const Material *material = d->writing->material;
    const bool own = row->input >= 0 && row->rule != MTLX_WEIGHT && row->rule != MTLX_MAP;
    float v[3] = {1.0f, 1.0f, 1.0f};
    if (own) memcpy(v, material->inputs[row->input].value, sizeof v);
    if (row->rule == MTLX_SQUARE) v[0] *= v[0];
    if (row->type == MTLX_GREY) v[1] = v[2] = v[0];
    if (row->rule == MTLX_ALPHA_CUTOFF) v[0] = material->alpha_cutoff;
    if (row->rule == MTLX_ALPHA_MODE)
        fprintf(d->out, "%d", (int)material->alpha_mode);
    else if (row->rule == MTLX_TWO_SIDED)
        fprintf(d->out, material->double_sided ? "true" : "false");
    else
        put_numbers(d->out, v, row->type == MTLX_COLOR || row->type == MTLX_GREY ? 3 : 1);
}

static void put_surface(const Document *d) {
    fprintf(d->out, "  <%s name=\"", d->node->id);
    put_name(d->out, d->writing->name);
    fprintf(d->out, "_shader\" type=\"surfaceshader\">\n");
    for (const MtlxRow *row = d->node->rows; row->name; row++) {
        const bool vector = row->type == MTLX_NORMAL || row->type == MTLX_TANGENT, made = is_made(d, row);
        if (vector && !made) continue;
        if (row->rule == MTLX_FINITE && !(input_of(d, row)->value[0] > 0.0f)) continue;
        fprintf(d->out, "    <input name=\"%s\" type=\"%s\" ", row->name, mtlx_type_name(row->type));
        if (made) {
            fprintf(d->out, "nodegraph=\"");
            put_name(d->out, d->writing->name);
            fprintf(d->out, "_maps\" output=\"%s_out", row->name);
        } else {
            fprintf(d->out, "value=\"");
            put_value(d, row);
        }
        fprintf(d->out, "\" />\n");
    }
    fprintf(d->out, "  </%s>\n", d->node->id);
}

void mtlx_write(const MtlxWriting *writing, FILE *out) {
    Document d = {.writing = writing, .node = &mtlx_nodes[writing->node], .out = out};
    fprintf(out,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<materialx version=\"1.39\" colorspace=\"lin_rec709\">\n");
    fprintf(out, "  <!-- weft %s, docs/materials.md -->\n", WEFT_VERSION);
    put_graph(&d);
    put_surface(&d);
    fprintf(out, "  <surfacematerial name=\"");
    put_name(out, writing->name);
    fprintf(out, "\" type=\"material\">\n    <input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"");
    put_name(out, writing->name);
    fprintf(out, "_shader\" />\n  </surfacematerial>\n</materialx>\n");
}

static bool differs(const Input *a, const Input *b, int id) {
    bool any = a->texture != 0;
    for (int c = 0; c < input_value_count((InputId)id); c++) any |= !is_equal(a->value[c], b->value[c]);
    return any;
}

/* Returns true if an input is seen: the part that it belongs to is there. */
static bool is_seen(const Material *material, InputId gate) {
    const Input *input = &material->inputs[gate];
    return input->texture || input->value[0] > 0.0f || input->value[1] > 0.0f || input->value[2] > 0.0f;
}

static void inputs_lost(const MtlxNodeInfo *node, const Material *given, const char *subject, const WeftLog *log) {
    static const struct {
        InputId input, gate; /* lost where the node lacks the input, and the gate is not black */
    } parts[] = {{INPUT_nap, INPUT_nap},
                 {INPUT_dust, INPUT_dust},
                 {INPUT_retroreflection, INPUT_retroreflection},
                 {INPUT_diffuse_transmission, INPUT_diffuse_transmission},
                 {INPUT_thickness, INPUT_transmission},
                 {INPUT_subsurface, INPUT_subsurface},
                 {INPUT_diffuse_roughness, INPUT_diffuse_roughness},
                 {INPUT_anisotropy, INPUT_anisotropy},
                 {INPUT_coat_ior, INPUT_clearcoat},
                 {INPUT_coat_color, INPUT_clearcoat},
                 {INPUT_coat_darkening, INPUT_clearcoat},
                 {INPUT_coat_anisotropy, INPUT_clearcoat},
                 {INPUT_sheen_upward, INPUT_sheen_upward}};
    const Material plain = material_default();
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        const int id = (int)parts[k].input;
        if (mtlx_row_of(node, id) || !is_seen(given, parts[k].gate)) continue;
        if (differs(&given->inputs[id], &plain.inputs[id], id))
            warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, subject, "%s: %s has no input for it", input_infos[id].name,
                 node->id);
    }
}

/* Names textures that have no place; those of sheen and fuzz stand for each other. */
static void textures_lost(const MtlxWriting *writing, const Material *given, const char *subject, const WeftLog *log) {
    const MtlxNodeInfo *node = &mtlx_nodes[writing->node];
    for (int k = 0; k < INPUT_COUNT; k++) {
        const bool rim =
            k == INPUT_sheen_color || k == INPUT_sheen_roughness || k == INPUT_fuzz_color || k == INPUT_fuzz_roughness;
        const MtlxRow *row = mtlx_row_of(node, k);
        const bool kept = row && row->type != MTLX_TANGENT && writing->material->inputs[k].texture;
        if (given->inputs[k].texture && !rim && !kept)
            warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, subject, "%s: its texture has no place in %s",
                 input_infos[k].name, node->id);
    }
}

/* Returns true if what goes through glass is tinted where it enters. */
static bool tints(const Material *material) {
    const Input *base = &material->inputs[INPUT_base_color];
    bool any = base->texture != 0;
    for (int c = 0; c < 3; c++) any = any || !is_equal(base->value[c], 1.0f);
    return any;
}

static void choices_lost(const MtlxNodeInfo *node, const Material *given, const char *subject, const WeftLog *log) {
    const bool rim = is_seen(given, INPUT_fuzz) || (is_seen(given, INPUT_sheen) && is_seen(given, INPUT_sheen_color));
    for (int k = 0; k < CHOICE_COUNT; k++) {
        static const ChoiceId of_rim[] = {CHOICE_sheen_lobe, CHOICE_sheen_d, CHOICE_sheen_v,
                                          CHOICE_sheen_f,    CHOICE_layer,   CHOICE_layer_by};
        const char *id = choice_id((ChoiceId)k, given->choices[k]), *name = weft_material_choice_name(k);
        char text[96];
        bool hidden = k == CHOICE_convert || !id;
        for (size_t j = 0; j < sizeof of_rim / sizeof *of_rim; j++) hidden |= !rim && k == (int)of_rim[j];
        snprintf(text, sizeof text, "%.30s=%.60s ", name, id ? id : "");
        if (!hidden && !strstr(node->choices, text))
            warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, subject, "%s=%s: %s has formulas of its own", name, id, node->id);
    }
}

void mtlx_losses(const MtlxWriting *writing, const Material *given, bool back, const char *subject,
                 const WeftLog *log) {
    const MtlxNodeInfo *node = &mtlx_nodes[writing->node];
    const bool has_one_color = !mtlx_row_of(node, INPUT_thickness);
    const struct {
        bool lost;
        const char *text;
    } parts[] = {
        {given->cloth != 0,
         "its weave, whose threads MaterialX cannot describe; `weft weave --bake` writes its textures"},
        {given->measured != 0, "its measurement: the numbers fitted to it are written"},
        {given->hair[WEFT_HAIR_LENGTH] > 0.0f, "its hair, which is geometry"},
        {back, "its back: MaterialX gives a material one"},
        {has_one_color && mtlx_absorbs(given) && tints(given),
         "base_color: the node has one colour for glass, which is attenuation_color"},
        {has_one_color && mtlx_is_glass(given) && !material_is_solid(given) && !given->double_sided,
         "its one side: thin glass of the node has two"},
        {given->unlit != 0, "unlit: the node reflects light"},
        {given->alpha_mode == WEFT_ALPHA_MASK && writing->node != WEFT_MTLX_GLTF, "alpha_cutoff: the opacity blends"},
    };
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
        if (parts[k].lost) warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, subject, "%s", parts[k].text);
    inputs_lost(node, given, subject, log);
    textures_lost(writing, given, subject, log);
    choices_lost(node, given, subject, log);
}
