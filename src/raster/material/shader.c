#include <stdio.h>
#include <stdlib.h>

#include "raster/material/shader.h"

#include "base/equal.h"
#include "raster/light/gl_environment.h"
#include "raster/material/cloth_sky.h"
#include "raster/material/cloths.h"
#include "raster/material/part.h"

#include "scene/record/material_at.h"
#include "shading/material/material_stack.h"
#include "text/assemble/composition.h"
#include "text/assemble/tables.h"
#include "text/source/number_text.h"
#include "weft/lobe.h"

static void find_zeros(const ShaderKey *key, bool zero[INPUT_COUNT]) {
    for (int k = 0; k < INPUT_COUNT; k++) zero[k] = key->inputs[k].state == INPUT_ZERO;
}

static CompositionSlots find_slots(const ShaderKey *key) {
    bool zero[INPUT_COUNT];
    find_zeros(key, zero);
    const bool whole = key->inputs[INPUT_sheen].state == INPUT_ONE && zero[INPUT_sheen_upward];
    CompositionSlots found = composition_slots(&key->choices, zero, whole);
    found.sampled = key->reference != 0;
    if (!key->woven) return found;
    found.slots[PLACE_DIFFUSE] = (TextSlot){.lobes = {LOBE_WOVEN, LOBE_YARN}, .count = 2};
    found.slots[PLACE_SPECULAR].count = 0;
    found.lobes[PLACE_DIFFUSE] = lobe_default(found.slots[PLACE_DIFFUSE].lobes[0]);
    return found;
}

static bool is_mapped(const ShaderInput *input) { return input->state == INPUT_MAP || input->state == INPUT_MAYBE; }

/* Sets all textured numbers of a surface to x, and the roughness over a normal map, whose slopes widen the highlight
 * from afar. */
static void vary(const ShaderKey *key, Surface *s, float x) {
#define VARY_SCALAR(name)    s->name = x
#define VARY_ANGLE(name)     (void)0
#define VARY_COLOR(name)     (void)0
#define VARY_NORMAL(name)    (void)0
#define VARY_DIRECTION(name) (void)0
#define VARY(kind, name, label, initial, low, high, hard_low, hard_high, role, help)                                   \
    if (is_mapped(&key->inputs[INPUT_##name])) VARY_##kind(name);
    SURFACE_INPUTS(VARY)
    if (is_mapped(&key->inputs[INPUT_normal])) s->roughness = x;
    if (is_mapped(&key->inputs[INPUT_clearcoat_normal])) s->clearcoat_roughness = x;
}

bool shader_bakes(const ShaderKey *key, int slot) {
    Lobe lobes[2];
    bool zero[INPUT_COUNT];
    if (key->woven && slot == PLACE_DIFFUSE) return true;
    if (key->ranged || (key->woven && slot == PLACE_SPECULAR)) return false;
    find_zeros(key, zero);
    for (int k = 0; k < 2; k++) {
        Stack m;
        Surface s = composition_surface(0.5f, zero);
        vary(key, &s, k ? 0.75f : 0.25f);
        stack_make(&m, &s, &key->choices, (TableRef){.kind = TABLE_NONE});
        lobes[k] = stack_slot(&m, slot)->lobe;
        if (!(stack_slot(&m, slot)->normal > 0.0f)) return false;
    }
    return lobes[0].id == lobes[1].id && is_equal(lobes[0].params[0], lobes[1].params[0]);
}

/* Writes the block Material and its samplers: a vec4 an input, two for the place of its texture, the sheen's table, a
 * cloth, fits. The record Uniforms of materials.c has the same members. */
static void put_uniforms(Text *text, const ShaderKey *key) {
    text_line(text, "\nlayout(std140) uniform Material {");
    for (int k = 0; k < INPUT_COUNT; k++) text_line(text, "    highp vec4 material_%s;", input_infos[k].name);
#define MEMBER(type, name, count) text_line(text, "    highp vec4 material_" #name "[%d];", (int)(count));
    MATERIAL_BLOCK(MEMBER)
#undef MEMBER
    text_line(text, "};");
    int slots = 0;
    for (int k = 0; k < INPUT_COUNT; k++)
        if (is_mapped(&key->inputs[k])) {
            if (key->inputs[k].slot >= slots) slots = key->inputs[k].slot + 1;
            if (key->inputs[k].slopes > slots) slots = key->inputs[k].slopes;
        }
    if (slots) text_line(text, "uniform highp sampler2DArray material_maps[%d];", slots);
    if (slots || key->woven || key->part == WEFT_PART_TEXCOORD)
        text_line(text, "in highp vec2 texcoord_0;\nin highp vec2 texcoord_1;");
}

static void put_table(Text *text, const ShaderKey *key) {
    text_line(text, "\nconst int SHEEN_TABLES = %d;", text->table_count);
    text_line(text,
              "\nTableRef material_table() {\n    TableRef t;\n    t.texels = SHEEN_TABLES + int(material_e[0].x);");
    text_line(text, "    t.kind = %d;\n    t.rows = %d;\n    t.columns = %d;\n    t.tilts = %d;", key->table_kind,
              key->table_rows, key->table_columns, key->table_tilts);
    text_line(text, "    t.low = material_e[0].y;\n    t.high = material_e[0].z;\n    t.tilt = material_e[0].w;\n"
                    "    return t;\n}");
}

/* Returns the texel that leaves an input's number as it is. */
static const char *neutral_texel(int input) {
    WeftInputKind kind = input_infos[input].kind;
    return kind == WEFT_INPUT_NORMAL || kind == WEFT_INPUT_DIRECTION ? "vec4(0.5, 0.5, 1.0, 1.0)" : "vec4(1.0)";
}

bool shader_same_neutral(int input, int other) { return strcmp(neutral_texel(input), neutral_texel(other)) == 0; }

/* Writes the look-up of a map, unless an earlier input reads the same texel. */
static void put_texel(Text *text, const ShaderKey *key, int k) {
    const ShaderInput *input = &key->inputs[k];
    const char *name = input_infos[k].name;
    if (!is_mapped(input) || input->like >= 0) return;
    text_line(text, "    vec3 at_%s = vec3(texcoord_%d, 1.0);\n    vec4 map_%s = %s;", name, input->texcoord, name,
              neutral_texel(k));
    if (input->state == INPUT_MAYBE) text_line(text, "    if (material_%s.w > 0.5)", name);
    text_line(text,
              "    map_%s = texture(material_maps[%d], vec3(dot(material_places[%d].xyz, at_%s), "
              "dot(material_places[%d].xyz, at_%s), material_places[%d].w));",
              name, input->slot, 2 * k, name, 2 * k + 1, name, 2 * k);
}

static void put_input(Text *text, const ShaderKey *key, int k) {
    const ShaderInput *input = &key->inputs[k];
    const char *name = input_infos[k].name;
    char value[96], map[96];
    snprintf(value, sizeof value, "material_%s", name);
    snprintf(map, sizeof map, "map_%s", input_infos[input->like >= 0 ? input->like : k].name);
    bool mapped = is_mapped(input);
    if (k == INPUT_occlusion) { /* its number is the strength of the map */
        if (mapped)
            text_line(text, "    s.occlusion = mix(1.0, %s.%c, %s.x);", map, "rgba"[input->channel], value);
        else
            text_line(text, "    s.occlusion = 1.0;");
        return;
    }
    switch (input_infos[k].kind) {
    case WEFT_INPUT_SCALAR:
    case WEFT_INPUT_ANGLE:
        if (mapped)
            text_line(text, "    s.%s = %s.x * %s.%c;", name, value, map, "rgba"[input->channel]);
        else if (input->state == INPUT_VALUE)
            text_line(text, "    s.%s = %s.x;", name, value);
        else
            text_line(text, "    s.%s = %s;", name, input->state == INPUT_ONE ? "1.0" : "0.0");
        break;
    case WEFT_INPUT_COLOR:
        if (mapped)
            text_line(text, "    s.%s = rgb(%s.x * %s.r, %s.y * %s.g, %s.z * %s.b);", name, value, map, value, map,
                      value, map);
        else if (input->state == INPUT_VALUE)
            text_line(text, "    s.%s = rgb(%s.x, %s.y, %s.z);", name, value, value, value);
        else
            text_line(text, "    s.%s = rgb_grey(%s);", name, input->state == INPUT_ONE ? "1.0" : "0.0");
        break;
    case WEFT_INPUT_NORMAL:
        if (mapped)
            text_line(text, "    s.%s = texel_normal(%s.r, %s.g, %s.b, %s.x);", name, map, map, map, value);
        else
            text_line(text, "    s.%s = dir(0.0, 0.0, 1.0);", name);
        break;
    case WEFT_INPUT_DIRECTION:
        if (mapped)
            text_line(text, "    s.%s = texel_direction(%s.r, %s.g, %s.x, %s.y);", name, map, map, value, value);
        else if (input->state == INPUT_ZERO)
            text_line(text, "    s.%s = dir(1.0, 0.0, 0.0);", name);
        else
            text_line(text, "    s.%s = dir(%s.x, %s.y, 0.0);", name, value, value);
        break;
    }
}

/* Returns true if fibres are widened; in a sum of frames they are as they are. */
static bool blends_hair(const ShaderKey *key) { return key->hairy && !key->reference; }

static void put_surface(Text *text, const ShaderKey *key) {
    text_include(text, "shading/dialect/texel.h");
    if (key->colored) text_line(text, "\nin highp vec4 vertex_color;");
    text_line(text, "\nSurface material_surface() {\n    Surface s;");
    for (int k = 0; k < INPUT_COUNT; k++) put_texel(text, key, k);
    for (int k = 0; k < INPUT_COUNT; k++) put_input(text, key, k);
    if (key->colored)
        text_line(text, "    s.base_color = rgb_mul(s.base_color, rgb(vertex_color.r, vertex_color.g, "
                        "vertex_color.b));\n    s.opacity = s.opacity * vertex_color.a;");
    text_line(text, "    return s;\n}");
    text_line(text, "\nconst bool MATERIAL_UNLIT = %s;\nconst bool MATERIAL_DOUBLE_SIDED = %s;",
              key->unlit ? "true" : "false", key->double_sided ? "true" : "false");
    text_line(text, "const bool MATERIAL_HOLED = %s;", key->alpha_mode != WEFT_ALPHA_OPAQUE ? "true" : "false");
    static const char *const coverage[] = {[WEFT_ALPHA_OPAQUE] = "1.0",
                                           [WEFT_ALPHA_MASK] = "opacity < material_more[0].x ? 0.0 : 1.0",
                                           [WEFT_ALPHA_BLEND] = "clamp(opacity, 0.0, 1.0)"};
    if (blends_hair(key)) text_line(text, "\nin highp float hair_covers;");
    text_line(text, "\nfloat coverage_of(float opacity) { return %s; }",
              blends_hair(key) ? "clamp(hair_covers, 0.0, 1.0)" : coverage[key->alpha_mode]);
    if (key->alpha_mode == WEFT_ALPHA_MASK) text_define(text, "MASKED", "1");
    if (key->alpha_mode == WEFT_ALPHA_BLEND || blends_hair(key)) text_define(text, "BLENDED", "1");
}

/* Writes the look-up of the slopes of a normal map about their mean. Their first level is material.y levels coarser than
 * the map. */
static void put_slopes_of(Text *text, const ShaderKey *key, int k) {
    const ShaderInput *input = &key->inputs[k];
    const char *name = input_infos[k].name;
    const int slot = input->slopes - 1;
    text_line(text, "\nvec4 slopes_of_%s(Dir mean) {", name);
    if (is_mapped(input) && slot >= 0) {
        text_line(text, "    vec3 from = vec3(texcoord_%d, 1.0);", input->texcoord);
        text_line(text, "    vec2 at = vec2(dot(material_places[%d].xyz, from), dot(material_places[%d].xyz, from));",
                  2 * k, 2 * k + 1);
        text_line(text, "    float layer = material_places[%d].w;", 2 * k + 1);
        text_line(text, "    float level = slopes_level(at * vec2(textureSize(material_maps[%d], 0).xy));", slot);
        text_line(text, "    vec4 raw = textureLod(material_maps[%d], vec3(at, max(layer, 0.0)), max(level, 0.0));",
                  slot);
        text_line(text, "    float part = clamp(1.0 + level / max(material_%s.y, 1.0), 0.0, 1.0);", name);
        text_line(text, "    if (layer < 0.0 || material_%s.w < 0.5) part = 0.0;", name);
        text_line(text, "    return slopes_about(raw, material_%s.x, part, mean);", name);
    } else {
        text_line(text, "    return vec4(0.0);");
    }
    text_line(text, "}");
}

/* Returns true if the lobe of a slot depends on the azimuth of its frame. */
static bool has_axis(const CompositionSlots *found, int slot) {
    return found->slots[slot].count && weft_lobe_info(found->lobes[slot].id)->traits & TRAIT_ANISOTROPIC;
}

/* Writes the look-ups of slopes. SLOPES_TURN: the frame may be turned towards them, since no lobe but the highlight has
 * an axis. */
static void put_slopes(Text *text, const ShaderKey *key, const CompositionSlots *found) {
    text_include(text, "raster/glsl/slopes.glsl");
    put_slopes_of(text, key, INPUT_normal);
    put_slopes_of(text, key, INPUT_clearcoat_normal);
    if (key->inputs[INPUT_normal].slopes || key->inputs[INPUT_clearcoat_normal].slopes)
        text_define(text, "WIDENED", "1");
    if (!key->inputs[INPUT_normal].slopes) return;
    text_define(text, "SLOPES", "1");
    bool brushed = key->inputs[INPUT_anisotropy].state != INPUT_ZERO;
    if (!brushed && !has_axis(found, PLACE_SHEEN) && !has_axis(found, PLACE_DIFFUSE))
        text_define(text, "SLOPES_TURN", "1");
}

static void put_lights(Text *text, const ShaderKey *key) {
    char each[SHADER_LIGHTS * 16 + 128] = "";
    for (int k = 0; k < key->lights && key->lights <= SHADER_LIGHTS; k++) {
        size_t used = strlen(each);
        snprintf(each + used, sizeof each - used, "L(%d, %d, %d) ", k, key->light_kind[k], key->light_map[k]);
    }
    if (key->lights > SHADER_LIGHTS)
        snprintf(each, sizeof each,
                 "for (int k = 0; k < int(forward.w); k++) { "
                 "L(k, int(lights[4 * k].w), int(lights[4 * k + 2].w)) }");
    text_define(text, "EACH_LIGHT(L)", each);
    if (!key->polygons) return;
    char polygons[SHADER_LIGHTS * 24] = "", corners[SHADER_LIGHTS * 16] = "";
    for (int k = 0; k < key->polygons; k++) {
        size_t used = strlen(polygons), length = strlen(corners);
        if (k && key->polygon_corners[k] != key->polygon_corners[k - 1])
            snprintf(corners + length, sizeof corners - length, "(k) < %d ? %d : ", k, key->polygon_corners[k - 1]);
        snprintf(polygons + used, sizeof polygons - used, "L(%d, %d, %s, %d) ", k, key->polygon_corners[k],
                 key->polygon_two_sided[k] ? "true" : "false", key->polygon_map[k]);
    }
    char count[16];
    size_t length = strlen(corners);
    snprintf(corners + length, sizeof corners - length, "%d", key->polygon_corners[key->polygons - 1]);
    text_define(text, "CORNERS_OF(k)", corners);
    snprintf(count, sizeof count, "%d", key->polygons);
    text_define(text, "POLYGONS", count);
    text_define(text, "EACH_POLYGON(L)", polygons);
}

/* Returns true if a pixel depends on the tangent. */
static bool needs_tangent(const ShaderKey *key, const CompositionSlots *found) {
    static const InputId inputs[] = {INPUT_normal, INPUT_clearcoat_normal, INPUT_anisotropy, INPUT_nap,
                                     INPUT_coat_anisotropy};
    if (key->woven) return true;
    for (size_t k = 0; k < sizeof inputs / sizeof inputs[0]; k++) {
        const ShaderInput *input = &key->inputs[inputs[k]];
        bool number = input_infos[inputs[k]].kind != WEFT_INPUT_NORMAL;
        if (is_mapped(input) || (number && input->state != INPUT_ZERO)) return true;
    }
    return found->slots[PLACE_SHEEN].count && weft_lobe_info(found->lobes[PLACE_SHEEN].id)->traits & TRAIT_ANISOTROPIC;
}

static bool same_slots(const CompositionSlots *a, const CompositionSlots *b) {
    bool same = a->used == b->used && a->transmits == b->transmits && a->glass == b->glass && a->retro == b->retro;
    for (int k = 0; k < SLOT_COUNT; k++) {
        const TextSlot *s = &a->slots[k], *t = &b->slots[k];
        same = same && s->count == t->count;
        for (int j = 0; same && j < s->count; j++) same = s->lobes[j] == t->lobes[j];
        const float *p = a->lobes[k].params, *q = b->lobes[k].params;
        for (int j = 0; same && s->count && j < LOBE_PARAMS_MAX; j++) same = is_equal(p[j], q[j]);
    }
    return same;
}

/* Returns true if both keys bake the same tables, or have neither nap nor anisotropy, which tables that are not baked
 * lack. */
static bool same_tables(const ShaderKey *a, const ShaderKey *b) {
    bool same = true, anisotropic = false;
    for (int k = 0; k < SLOT_COUNT; k++) same &= shader_bakes(a, k) == shader_bakes(b, k);
    for (int x = 0; x < 2; x++) {
        const ShaderInput *inputs = x ? a->inputs : b->inputs;
        anisotropic |= inputs[INPUT_nap].state != INPUT_ZERO || inputs[INPUT_anisotropy].state != INPUT_ZERO;
    }
    return same || !anisotropic;
}

/* Returns true if two keys omit and bake the same things. */
static bool same_extent(const ShaderKey *a, const ShaderKey *b) {
    const CompositionSlots x = find_slots(a), y = find_slots(b);
    return same_slots(&x, &y) && needs_tangent(a, &x) == needs_tangent(b, &y) && same_tables(a, b);
}

static bool join_input(ShaderInput *a, const ShaderInput *b) {
    if (is_mapped(a) && is_mapped(b)) {
        if (b->state == INPUT_MAYBE) a->state = INPUT_MAYBE;
        return a->channel == b->channel && a->texcoord == b->texcoord;
    }
    bool maybe = is_mapped(a) || is_mapped(b);
    int16_t number = a->state == b->state ? a->state : (int16_t)INPUT_VALUE;
    if (is_mapped(b)) *a = *b;
    a->state = maybe ? (int16_t)INPUT_MAYBE : number;
    return true;
}

bool shader_join(ShaderKey *key, const ShaderKey *other) {
    ShaderKey joined = *key, rest = *other;
    memcpy(rest.inputs, key->inputs, sizeof rest.inputs);
    rest.by_azimuth = key->by_azimuth; /* a table with azimuth dependence serves a lobe without */
    joined.by_azimuth |= other->by_azimuth;
    bool same = memcmp((const char *)&rest, (const char *)key, sizeof rest) == 0;
    for (int k = 0; same && k < INPUT_COUNT; k++) same = join_input(&joined.inputs[k], &other->inputs[k]);
    if (!same || !same_extent(&joined, key) || !same_extent(&joined, other)) return false;
    *key = joined;
    return true;
}

/* Defines the look-ups of shading/weave/ as those of the cloth's texture in weave_cloth.glsl. */
static void define_weave(Text *text) {
    text_define(text, "weave_texel(t, stride, row, column)", "weave_fetch(row, column)");
    text_define(text, "weave_cell_texel(t, stride, row, at)", "weave_fetch_cell(row, at)");
}

/* Writes covered(): gaps between threads and coverage below a half let light through. Writes the shader of a shadow map,
 * or of the pixels of a moving picture. */
static void coverage_text(const ShaderKey *key, Text *text) {
    text_include(text, "shading/stack/surface.h");
    text_include(text, "shading/dialect/rgb.h");
    put_uniforms(text, key);
    put_surface(text, key);
    if (key->woven) {
        define_weave(text);
        text_include(text, "raster/glsl/weave_cloth.glsl");
    }
    bool blended = key->resolve && (key->alpha_mode == WEFT_ALPHA_BLEND || blends_hair(key));
    if (blended) text_line(text, "uniform highp float least_opacity;");
    text_line(text, "\nbool covered() { return coverage_of(material_surface().opacity) >= %s%s; }",
              blended ? "least_opacity" : "0.5", key->woven ? " && !weave_is_gap()" : "");
    if (key->resolve)
        text_include(text, "raster/glsl/resolve.glsl");
    else
        text_line(text, "\nvoid main() {\n    if (!covered()) discard;\n}");
}

static void floor_text(const ShaderKey *key, Text *text) {
    if (key->shadowed) text_define(text, "SHADOWED", "1");
    put_lights(text, key);
    text_include(text, "raster/glsl/floor.glsl");
}

static const char *boolean(bool x) { return x ? "true" : "false"; }

/* The table of one slot: baked into uniforms if table.baked is not below 0, else a layer of the program's tables. */
typedef struct AmbientEntry {
    AmbientTable table;
    int layer;
} AmbientEntry;

static void put_ambient_table(Text *text, const char *slot, const AmbientEntry *entry) {
    const AmbientTable t = entry->table;
    text_line(text, "    t.%s.texels = %d;\n    t.%s.rows = %d;\n    t.%s.columns = %d;", slot, entry->layer, slot,
              t.rows, slot, t.columns);
    text_line(text, "    t.%s.low = %s;\n    t.%s.high = %s;\n    t.%s.strategy = %d;", slot, number(t.low).text, slot,
              number(t.high).text, slot, t.strategy);
    text_line(text, "    t.%s.focus = %s;\n    t.%s.narrow = %s;\n    t.%s.second = %s;", slot, boolean(t.focus), slot,
              boolean(t.narrow), slot, boolean(t.second));
    text_line(text, "    t.%s.strips = %s;", slot, boolean(t.strips));
    text_line(text, "    t.%s.by_azimuth = %s;\n    t.%s.lossless = %s;\n    t.%s.baked = %d;", slot,
              boolean(t.by_azimuth), slot, boolean(t.lossless), slot, t.baked);
}

/* Returns the table of a slot; that of an empty slot is never read. Marks the text as failed if memory is short. */
static AmbientEntry find_ambient_table(Text *text, const ShaderKey *key, int slot, const Lobe *lobe, Fits *fits) {
    AmbientTable t = {.rows = 1, .columns = AMBIENT_COLUMNS};
    int layer = 0;
    bool dense = key->dense >> slot & 1;
    if (lobe && !shader_bakes(key, slot)) {
        const AmbientFit *fit = fits_get(fits, lobe);
        if (!fit) {
            text->macros.short_of_memory = true;
            return (AmbientEntry){.table = t};
        }
        t = ambient_table(fit, AMBIENT_FITTED);
        dense = fit->denser > AMBIENT_DENSER;
        int headings = t.by_azimuth ? AMBIENT_HEADINGS : 1;
        layer = text_table(text, (TextTable){t.texels, headings * AMBIENT_PLANES * t.rows, t.columns, NULL});
    } else if (lobe) {
        t.baked = slot * AMBIENT_BAKED;
        t.focus = key->focus >> slot & 1;
        t.narrow = key->narrow >> slot & 1;
        t.by_azimuth = key->by_azimuth >> slot & 1;
        t.second = (weft_lobe_info(lobe->id)->traits & TRAIT_TWO_COLORS) != 0;
    }
    if (lobe) t.strips = lobe_names(lobe->id)->strips;
    t.strategy = AMBIENT_FITTED;
    if (key->ambient > 1)
        t.strategy = key->ambient - 2;
    else if (lobe)
        t.strategy = ambient_strategy(lobe->id, t.by_azimuth, dense);
    return (AmbientEntry){.table = t, .layer = layer};
}

/* Defines for shading/ambient/ambient_lobe.h the function that lights each slot, and the strategies that no slot
 * has. */
static void define_strategies(Text *text, const AmbientEntry entries[SLOT_COUNT]) {
    bool there[AMBIENT_STRATEGIES] = {false};
    for (int k = 0; k < SLOT_COUNT; k++) {
        char name[64];
        there[entries[k].table.strategy] = true;
        snprintf(name, sizeof name, "LIGHT_OF_%s", slot_name(k));
        text_define(text, name,
                    entries[k].table.strategy == AMBIENT_SAMPLED ? "ambient_sampled_light" : "ambient_lookup_light");
    }
    text_define(text, "LIGHT_OF_SLOT(slot)", "LIGHT_OF_##slot");
    if (!there[AMBIENT_IRRADIANCE]) text_define(text, "IS_IRRADIANCE(t)", "false");
    if (!there[AMBIENT_MIRROR]) text_define(text, "IS_MIRROR(t)", "false");
}

static void put_ambient(Text *text, const ShaderKey *key, const CompositionSlots *found, Fits *fits) {
    AmbientEntry entries[SLOT_COUNT];
    for (int k = 0; k < SLOT_COUNT; k++) {
        const Lobe *lobe = found->slots[k].count ? &found->lobes[k] : NULL;
        entries[k] = find_ambient_table(text, key, k, lobe, fits);
    }
    environment_text(text);
    text_line(text, "\nAmbientWeights ambient_baked(Frame f, int k) {\n    vec4 c = material_fits[k];\n"
                    "    AmbientWeights w;\n    w.a = c.x;\n    w.b = c.y;\n    w.c = c.z;\n    w.d = c.w;\n"
                    "    return w;\n}");
    text_include(text, "raster/glsl/light_visibility.glsl");
    define_strategies(text, entries);
    text_include(text, "shading/ambient/ambient.h");
    text_line(text, "\nAmbientTables material_ambient() {\n    AmbientTables t;");
    for (int k = 0; k < SLOT_COUNT; k++) put_ambient_table(text, slot_name(k), &entries[k]);
    text_line(text, "    return t;\n}");
    if (key->woven)
        text_line(text, "\nconst int CLOTH_SKY_FIRST = %d, CLOTH_SKY_TERMS = %d;", SHADER_CLOTH_SKY, CLOTH_SKY_TERMS);
    text_define(text, "AMBIENT", "1");
}

void shader_text(const ShaderKey *key, const TextDesc *desc, Fits *fits, Text *text) {
    text_begin(text, desc);
    if (key->depth || key->resolve) coverage_text(key, text);
    if (key->floor) floor_text(key, text);
    if (key->depth || key->resolve || key->floor) return;
    const CompositionSlots found = find_slots(key);
    if (key->shadowed) text_define(text, "SHADOWED", "1");
    if (needs_tangent(key, &found)) text_define(text, "NEEDS_TANGENT", "1");
    if (key->woven) {
        text_define(text, "WOVEN", "1");
        define_weave(text);
    }
    if (key->hairy) text_define(text, "HAIRY", "1");
    text_define(text, "HAIR_OPEN", key->haired ? "(gl_FrontFacing ? material_more[0].y : 1.0)" : "1.0");
    if (key->coarse) text_define(text, "COARSE", "1");
    part_text(key->part, text);
    put_lights(text, key);
    text_composition_lobes(text, &found, key->table_kind, key->table_tilts);
    if (key->polygons) text_lobe_tables(text);
    text_composition(text, &key->choices);
    text_composition_choices(text, &key->choices);
    put_uniforms(text, key);
    if (key->ambient) put_ambient(text, key, &found, fits);
    put_table(text, key);
    put_surface(text, key);
    if (!key->reference) put_slopes(text, key, &found);
    if (key->reference && key->part != WEFT_PART_ALL) text_define(text, "SHOWS_PART", "1");
    if (key->reference > 1) text_define(text, "SKY_IN_PARTS", "1");
    if (key->bounces) text_define(text, "BOUNCES", "1");
    if (key->panes) text_define(text, "PANES", "1");
    text_include(text, key->reference ? "raster/glsl/reference.glsl" : "raster/glsl/forward.glsl");
}

void shader_vertex_text(const ShaderKey *key, const TextDesc *desc, Text *text) {
    text_begin(text, &(TextDesc){.language = desc->language, .folder = desc->folder});
    if (key->shadowed && !key->floor) text_define(text, "SHADOWED", "1");
    if (blends_hair(key)) text_define(text, "HAIRY", "1");
    text_include(text, key->floor ? "raster/glsl/floor_vertex.glsl" : "raster/glsl/vertex.glsl");
}

void shader_background_text(const TextDesc *desc, Text *vertex, Text *fragment) {
    const TextDesc no_tables = {.language = desc->language, .folder = desc->folder};
    text_begin(vertex, &no_tables);
    text_include(vertex, "raster/glsl/screen.glsl");
    text_begin(fragment, &no_tables);
    text_include(fragment, "raster/glsl/behind.glsl");
}
