/* tables.c - the tables that a text reads: as samplers of one channel each, or as arrays in the text */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "export/draft.h"
#include "text/number.h"

static bool in_text(const Draft *draft) {
    return draft->desc->target == WEFT_EXPORT_SHADERTOY ||
           (draft->desc->target == WEFT_EXPORT_C && draft->desc->lut == WEFT_EXPORT_LUT_C);
}

static char *table_name(const Draft *draft, int k, char name[SPELL_NAME]) {
    char plain[WEFT_EXPORT_NAME];
    snprintf(plain, sizeof plain, "texels_%s", draft->tables->all[k].name);
    return spell_name(&draft->speller, ITEM_FUNCTION, plain, name);
}

/* What a texel of 16 bits, 0 to 1, is multiplied by, and what is added: powers of two, or 1 and 0. */
typedef struct Range {
    float scale, offset;
} Range;

static float power_above(float x) {
    float power = 1.0f;
    while (power < x) power *= 2.0f;
    return power;
}

static Range table_range(const Draft *draft, int k) {
    const TextTable *t = &draft->tables->all[k];
    float low = 0.0f, high = 0.0f;
    if (draft->desc->lut != WEFT_EXPORT_LUT_PNG16 || in_text(draft)) return (Range){1.0f, 0.0f};
    for (int n = 0; n < t->rows * t->columns; n++) {
        low = fminf(low, t->texels[n]);
        high = fmaxf(high, t->texels[n]);
    }
    float offset = low < 0.0f ? -power_above(-low) : 0.0f;
    return (Range){power_above(high - offset), offset};
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

static void put_declaration(const Draft *draft, int k, Buffer *out) {
    const TextTable *t = &draft->tables->all[k];
    char name[SPELL_NAME];
    int size = t->rows * t->columns;
    table_name(draft, k, name);
    put_line(out, "/* %d columns, %d rows */", t->columns, t->rows);
    if (draft->desc->target == WEFT_EXPORT_SHADERTOY) {
        put_line(out, "const float %s[%d] = float[%d](", name, size, size);
        put_numbers(t, "", out);
        put_line(out, ");");
    } else if (in_text(draft)) {
        put_line(out, "static const float %s[%d] = {", name, size);
        put_numbers(t, "f", out);
        put_line(out, "};");
    } else if (draft->desc->target == WEFT_EXPORT_C) {
        put_line(out, "static const float *%s = 0; /* set it before the first call */", name);
    } else if (draft->desc->target == WEFT_EXPORT_HLSL) {
        put_line(out, "Texture2D<float> %s;", name);
    } else {
        put_line(out, "uniform highp sampler2D %s;", name);
    }
}

static void put_fetch(const Draft *draft, int k, bool last, Buffer *out) {
    char name[SPELL_NAME], test[32] = "", factor[112] = "", added[40] = "";
    Range range = table_range(draft, k);
    const char *f = draft->desc->target == WEFT_EXPORT_C ? "f" : "";
    if (!last) snprintf(test, sizeof test, "if (t == %d) ", k);
    if (range.offset < 0.0f) snprintf(added, sizeof added, " - %s%s", number(-range.offset).text, f);
    if (range.scale > 1.0f || *added)
        snprintf(factor, sizeof factor, " * %s%s%s", number(range.scale).text, f, added);
    table_name(draft, k, name);
    if (in_text(draft) || draft->desc->target == WEFT_EXPORT_C)
        put_line(out, "    %sreturn %s[row * stride + column]%s;", test, name, factor);
    else if (draft->desc->target == WEFT_EXPORT_HLSL)
        put_line(out, "    %sreturn %s.Load(int3(column, row, 0))%s;", test, name, factor);
    else
        put_line(out, "    %sreturn texelFetch(%s, ivec2(column, row), 0).r%s;", test, name, factor);
}

void draft_tables(const Draft *draft, Buffer *out) {
    int last = -1, count = 0;
    char name[SPELL_NAME];
    for (int k = 0; k < draft->tables->count; k++)
        if (draft->tables->used[k]) {
            last = k;
            count++;
            put_declaration(draft, k, out);
        }
    if (last < 0) return;
    put_line(
        out,
        "\n/* A texel of table t, as it is: interpolation is the caller's, whatever the sampler does. */");
    put_line(out, "%sfloat %s(int t, int stride, int row, int column) {",
             draft->desc->target == WEFT_EXPORT_C ? "static inline " : "",
             spell_name(&draft->speller, ITEM_FUNCTION, "table_fetch", name));
    if (draft->desc->target == WEFT_EXPORT_C && count == 1) put_line(out, "    (void)t;");
    for (int k = 0; k < draft->tables->count; k++)
        if (draft->tables->used[k]) put_fetch(draft, k, k == last, out);
    put_line(out, "}\n");
}

WeftResult draft_uploads(const Draft *draft, WeftExport *out, WeftError *error) {
    for (int k = 0; k < draft->tables->count && !in_text(draft); k++) {
        const TextTable *from = &draft->tables->all[k];
        if (!draft->tables->used[k] || out->table_count == WEFT_EXPORT_TABLES_MAX) continue;
        WeftExportTable *table = &out->tables[out->table_count];
        char name[SPELL_NAME];
        snprintf(table->name, sizeof table->name, "%.95s", table_name(draft, k, name));
        const Range range = table_range(draft, k);
        table->scale = range.scale;
        table->offset = range.offset;
        WeftResult result =
            weft_image_create(from->columns, from->rows, 1, WEFT_PIXEL_F32, &table->texels, error);
        if (result != WEFT_OK) return result;
        out->table_count++;
        float *texels = table->texels.pixels;
        for (int n = 0; n < from->rows * from->columns; n++)
            texels[n] = (from->texels[n] - range.offset) / range.scale;
    }
    return WEFT_OK;
}
