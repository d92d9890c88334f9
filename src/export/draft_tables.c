/* draft_tables.c - the tables that a text reads, as samplers of one channel each or as arrays in the text */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "export/draft.h"

#include "base/fail.h"
#include "text/source/number_text.h"
#include "weave/weft_cloth.h"

/* The most elements of a WGSL array expression: "WebGPU Shading Language", section 2.3. */
enum { WGSL_ARRAY = 2047 };

/* The most elements of all indexed arrays of constants in Direct3D 11: the size of a shader's immediate constant buffer. */
enum { HLSL_ARRAYS = 4096 };

/* The most numbers of a cloth's tables in a Shadertoy, and of all tables in C, which are ten megabytes of text. */
enum { TOY_TEXELS = 8192, C_TEXELS = 1 << 20 };

/* The longest side of a texture: "WebGPU", section 3.6.2; Direct3D 11, "Resource Limits". Drivers of OpenGL have the
 * second. */
enum { WGSL_SIDE = 8192, TEXTURE_SIDE = 16384 };

static int size_of(const TextTable *t) { return t->rows * t->columns; }

/* Returns true if table k of the used ones fits into the text for an engine, beside those before it that do. */
static bool fits_engine(const Draft *draft, int k) {
    int sum = 0;
    for (int j = 0; j <= k; j++) {
        const int size = draft->tables->used[j] || j == k ? size_of(&draft->tables->all[j]) : 0;
        if (sum + size > HLSL_ARRAYS && j == k) return false;
        if (sum + size <= HLSL_ARRAYS) sum += size;
    }
    return true;
}

static bool in_text(const Draft *draft, int k) {
    const TextTable *t = &draft->tables->all[k];
    const WeftExportTarget target = draft->desc->target;
    if (target == WEFT_EXPORT_SHADERTOY) return true;
    if (draft->desc->lut != WEFT_EXPORT_LUT_C) return false;
    const bool engine = target == WEFT_EXPORT_UNITY || target == WEFT_EXPORT_UNREAL;
    return target == WEFT_EXPORT_C || (target == WEFT_EXPORT_WGSL && size_of(t) <= WGSL_ARRAY) ||
           (engine && fits_engine(draft, k));
}

static char *table_name(const Draft *draft, int k, char name[SPELL_NAME]) {
    char bare[WEFT_EXPORT_NAME];
    snprintf(bare, sizeof bare, "texels_%s", draft->tables->all[k].name);
    return spell_name(&draft->speller, ITEM_FUNCTION, bare, name);
}

/* The factor and offset of a texel of 16 bits, 0 to 1: powers of two, or 1 and 0. */
typedef struct TableRange {
    float scale, offset;
} TableRange;

static float power_above(float x) {
    float power = 1.0f;
    while (power < x) power *= 2.0f;
    return power;
}

static TableRange table_range(const Draft *draft, int k) {
    const TextTable *t = &draft->tables->all[k];
    float low = 0.0f, high = 0.0f;
    if (draft->desc->lut != WEFT_EXPORT_LUT_PNG16 || in_text(draft, k)) return (TableRange){1.0f, 0.0f};
    for (int n = 0; n < t->rows * t->columns; n++) {
        low = fminf(low, t->texels[n]);
        high = fmaxf(high, t->texels[n]);
    }
    float offset = low < 0.0f ? -power_above(-low) : 0.0f;
    return (TableRange){power_above(high - offset), offset};
}

static void put_numbers(const TextTable *t, const char *suffix, Buffer *out) {
    enum { A_LINE = 8 };
    int count = t->rows * t->columns;
    for (int n = 0; n < count; n++) {
        buffer_put_text(out, n % A_LINE ? " " : "\n    ");
        buffer_put_text(out, number(t->texels[n]).text);
        buffer_put_text(out, suffix);
        if (n + 1 < count) buffer_put(out, ",", 1);
    }
    buffer_put_text(out, "\n");
}

/* Writes a table inside the text. */
static void put_array(const Draft *draft, const TextTable *t, const char *name, Buffer *out) {
    int size = t->rows * t->columns;
    bool c = draft->desc->target == WEFT_EXPORT_C, braces = c || draft_is_hlsl(draft);
    if (braces)
        put_line(out, "static const float %s[%d] = {", name, size);
    else if (draft->desc->target == WEFT_EXPORT_WGSL)
        put_line(out, "const %s = array<f32, %d>(", name, size);
    else
        put_line(out, "const float %s[%d] = float[%d](", name, size, size);
    put_numbers(t, c ? "f" : "", out);
    put_line(out, braces ? "};" : ");");
}

/* Returns the index of a table among those outside the text. */
static int binding_of(const Draft *draft, int k) {
    int place = 0;
    for (int j = 0; j < k; j++) place += draft->tables->used[j] && !in_text(draft, j);
    return place;
}

static void put_declaration(const Draft *draft, int k, Buffer *out) {
    const TextTable *t = &draft->tables->all[k];
    char name[SPELL_NAME];
    table_name(draft, k, name);
    put_line(out, "/* %d columns, %d rows */", t->columns, t->rows);
    if (in_text(draft, k))
        put_array(draft, t, name, out);
    else if (draft->desc->target == WEFT_EXPORT_C)
        put_line(out, "static const float *%s = 0; /* set it before the first call */", name);
    else if (draft_is_hlsl(draft))
        put_line(out, "Texture2D<float> %s;", name);
    else if (draft->desc->target == WEFT_EXPORT_GODOT)
        put_line(out, "uniform sampler2D %s : filter_nearest, repeat_disable;", name);
    else if (draft->desc->target == WEFT_EXPORT_WGSL)
        put_line(out, "@group(0) @binding(%d) var %s: texture_2d<f32>;", binding_of(draft, k), name);
    else
        put_line(out, "uniform highp sampler2D %s;", name);
}

/* Writes the expression that reads a texel from variables row, column and stride. */
static void put_texel(const Draft *draft, int k, Buffer *out) {
    char name[SPELL_NAME];
    buffer_put_text(out, table_name(draft, k, name));
    if (in_text(draft, k) || draft->desc->target == WEFT_EXPORT_C)
        buffer_put_text(out, "[row * stride + column]");
    else if (draft_is_hlsl(draft))
        buffer_put_text(out, ".Load(int3(column, row, 0))");
    else if (draft->desc->target == WEFT_EXPORT_WGSL)
        buffer_put_text(out, ", vec2i(column, row), 0).r");
    else
        buffer_put_text(out, ", ivec2(column, row), 0).r");
}

static void put_fetch(const Draft *draft, int k, bool last, Buffer *out) {
    const WeftExportTarget target = draft->desc->target;
    const char *f = target == WEFT_EXPORT_C ? "f" : "";
    bool wgsl = target == WEFT_EXPORT_WGSL, beside = !in_text(draft, k);
    char line[32];
    TableRange range = table_range(draft, k);
    snprintf(line, sizeof line, "    if (t == %d) %s", k, wgsl ? "{ " : "");
    buffer_put_text(out, last ? "    " : line);
    buffer_put_text(out, "return ");
    if (beside && target != WEFT_EXPORT_C && !draft_is_hlsl(draft))
        buffer_put_text(out, wgsl ? "textureLoad(" : "texelFetch(");
    put_texel(draft, k, out);
    if (range.scale > 1.0f || range.offset < 0.0f) {
        buffer_put_text(out, " * ");
        buffer_put_text(out, number(range.scale).text);
        buffer_put_text(out, f);
    }
    if (range.offset < 0.0f) {
        buffer_put_text(out, " - ");
        buffer_put_text(out, number(-range.offset).text);
        buffer_put_text(out, f);
    }
    put_line(out, last || !wgsl ? ";" : "; }");
}

static void put_fetch_head(const Draft *draft, Buffer *out) {
    char name[SPELL_NAME];
    spell_name(&draft->speller, ITEM_FUNCTION, "table_fetch", name);
    put_line(out, "\n/* A texel of table t, as it is: interpolation is the caller's, whatever the sampler does. */");
    if (draft->desc->target == WEFT_EXPORT_WGSL)
        put_line(out, "fn %s(t: i32, stride: i32, row: i32, column: i32) -> f32 {", name);
    else
        put_line(out, "%sfloat %s(int t, int stride, int row, int column) {",
                 draft->desc->target == WEFT_EXPORT_C ? "static inline " : "", name);
}

void draft_tables(const Draft *draft, Buffer *out) {
    int last = -1, count = 0;
    for (int k = 0; k < draft->tables->count; k++)
        if (draft->tables->used[k]) {
            last = k;
            count++;
            put_declaration(draft, k, out);
        }
    if (last < 0) return;
    put_fetch_head(draft, out);
    if (draft->desc->target == WEFT_EXPORT_C && count == 1) put_line(out, "    (void)t;");
    for (int k = 0; k < draft->tables->count; k++)
        if (draft->tables->used[k]) put_fetch(draft, k, k == last, out);
    put_line(out, "}\n");
}

static const char *title(const Draft *draft) {
    const WeftExportDesc *desc = draft->desc;
    return desc->name ? desc->name : desc->profile ? desc->profile : weft_export_target_name((int)desc->target);
}

/* Returns true for a table of the draft's cloth. */
static bool is_cloth(const Draft *draft, const TextTable *t) {
    const WeftCloth *cloth = draft->desc->cloth;
    return cloth && (t->texels == cloth->runs || t->texels == cloth->albedos || t->texels == draft->colors);
}

WeftResult draft_tables_fit(const Draft *draft, WeftError *error) {
    const WeftExportTarget target = draft->desc->target;
    const int most = target == WEFT_EXPORT_SHADERTOY ? TOY_TEXELS : C_TEXELS;
    const int side = target == WEFT_EXPORT_WGSL ? WGSL_SIDE : TEXTURE_SIDE;
    long long inside = 0;
    for (int k = 0; k < draft->tables->count; k++) {
        const TextTable *t = &draft->tables->all[k];
        if (!draft->tables->used[k]) continue;
        if (in_text(draft, k))
            inside += target == WEFT_EXPORT_SHADERTOY && !is_cloth(draft, t) ? 0 : (long long)t->rows * t->columns;
        else if (target != WEFT_EXPORT_C && (t->columns > side || t->rows > side))
            return fail(error, WEFT_MESSAGE_DESC, title(draft),
                        "a texture of %d x %d texels (%s), where %s has at most %d a side: take a smaller draft",
                        t->columns, t->rows, t->name, weft_export_target_name((int)target), side);
    }
    if (inside <= most) return WEFT_OK;
    return fail(error, WEFT_MESSAGE_DESC, title(draft), "tables of %lld numbers, where a text for %s holds %d: %s",
                inside, weft_export_target_name((int)target), most,
                target == WEFT_EXPORT_C ? "put them beside it with --lut exr"
                                        : "take another target, or a smaller draft");
}

WeftResult draft_uploads(const Draft *draft, WeftExport *out, WeftError *error) {
    for (int k = 0; k < draft->tables->count; k++) {
        const TextTable *from = &draft->tables->all[k];
        if (!draft->tables->used[k] || in_text(draft, k) || out->table_count == WEFT_EXPORT_TABLES_MAX) continue;
        WeftExportTable *table = &out->tables[out->table_count];
        char name[SPELL_NAME];
        snprintf(table->name, sizeof table->name, "%.95s", table_name(draft, k, name));
        const TableRange range = table_range(draft, k);
        table->scale = range.scale;
        table->offset = range.offset;
        WeftResult result = weft_image_create(from->columns, from->rows, 1, WEFT_PIXEL_F32, &table->texels, error);
        if (result != WEFT_OK) return result;
        out->table_count++;
        float *texels = table->texels.pixels;
        for (int n = 0; n < from->rows * from->columns; n++) texels[n] = (from->texels[n] - range.offset) / range.scale;
    }
    return WEFT_OK;
}
