/* unity.c - the functions of a text that a Custom Function node of Unity's Shader Graph calls: one for each precision
 *
 *   void NAME_float(float3 Color, float Roughness, float3 Wo, float3 Wi, out float3 Out)
 *
 *   Unity Technologies, "Shader Graph", version 17, Custom Function Node: a file's function has the name of the node and
 * the suffix _float or _half. */
#include <stdio.h>

#include "export/draft.h"

#include "scene/record/material.h"

static char *function(const Draft *draft, const char *end, char name[SPELL_NAME]) {
    char bare[DRAFT_ID + 16];
    snprintf(bare, sizeof bare, "%s_%s", draft->id[0], end);
    return spell_item(&draft->speller, &draft->items, ITEM_FUNCTION, bare, name);
}

/* Returns true if the text's surface has an input that a number or a colour sets. */
static bool takes(const Draft *draft, int input) {
    char bare[DRAFT_ID + 16], wanted[64];
    const WeftInputKind kind = input_infos[input].kind;
    snprintf(bare, sizeof bare, "%s_surface", draft->id[0]);
    snprintf(wanted, sizeof wanted, "s.%.40s = ", input_infos[input].name);
    const Item *surface = items_find(&draft->items, (Token){TOKEN_NAME, bare, strlen(bare)});
    const char *at = surface ? strstr(surface->code, wanted) : NULL;
    return at && at < surface->end && kind != WEFT_INPUT_NORMAL && kind != WEFT_INPUT_DIRECTION;
}

/* Writes "BaseColor" for base_color. */
static const char *parameter(int input, char name[64]) {
    int size = 0;
    bool first = true;
    for (const char *c = input_infos[input].name; *c && size < 63; c++) {
        if (*c != '_') name[size++] = (char)(first && *c >= 'a' && *c <= 'z' ? *c - 'a' + 'A' : *c);
        first = *c == '_';
    }
    name[size] = '\0';
    return name;
}

static bool has_two_colors(const Draft *draft) {
    return weft_lobe_info(draft->desc->lobe->lobe)->traits & WEFT_LOBE_TWO_COLORS;
}

static void put_lobe(const Draft *draft, const char *precision, Buffer *out) {
    char make[SPELL_NAME], call[SPELL_NAME];
    const bool rough = draft_lobe_rough(draft->desc->lobe), two = has_two_colors(draft);
    function(draft, rough ? "rough" : "default", make);
    function(draft, "eval", call);
    put_line(out, "    %s3 Color,", precision);
    if (two) put_line(out, "    %s3 Second,", precision);
    if (rough) put_line(out, "    %s Roughness,", precision);
    put_line(out, "    %s3 Wo, %s3 Wi, out %s3 Out) {", precision, precision, precision);
    put_line(out, "    Out = %s(%s(%s), Color, %sWo, Wi) * max(Wi.z, 0.0);\n}", call, make, rough ? "Roughness" : "",
             two ? "Second, " : "");
}

static void put_material(const Draft *draft, const char *precision, Buffer *out) {
    char name[SPELL_NAME], bare[64], record[SPELL_NAME];
    for (int k = 0; k < INPUT_COUNT; k++)
        if (takes(draft, k))
            put_line(out, "    %s%s %s,", precision, input_infos[k].kind == WEFT_INPUT_COLOR ? "3" : "",
                     parameter(k, bare));
    if (draft->desc->cloth) put_line(out, "    float2 Uv, float2 UvDdx, float2 UvDdy,");
    put_line(out, "    %s3 Wo, %s3 Wi, out %s3 Out) {", precision, precision, precision);
    spell_item(&draft->speller, &draft->items, ITEM_RECORD, "Surface", record);
    put_line(out, "    %s s = %s();", record, function(draft, "surface", name));
    for (int k = 0; k < INPUT_COUNT; k++)
        if (takes(draft, k)) put_line(out, "    s.%s = %s;", input_infos[k].name, parameter(k, bare));
    if (draft->desc->cloth) {
        spell_item(&draft->speller, &draft->items, ITEM_RECORD, "WeaveSeen", record);
        put_line(out, "    %s seen = %s(s, Uv.x, -Uv.y, UvDdx.x, -UvDdx.y, UvDdy.x, -UvDdy.y, 1); // v runs up", record,
                 function(draft, "see", name));
    }
    put_line(out, "    Out = %s(s, %sWo, Wi);\n}", function(draft, "shade", name), draft->desc->cloth ? "seen, " : "");
}

void draft_unity(const Draft *draft, Buffer *out) {
    static const char *const precisions[] = {"float", "half"};
    char name[SPELL_NAME];
    spell_name(&draft->speller, ITEM_FUNCTION, draft->id[0], name);
    put_line(
        out,
        "\n/* %s times the cosine of Wi, for a Custom Function node of name %s: times the light it is radiance. */",
        draft->desc->lobe ? "Color times f" : "f", name);
    for (int k = 0; k < 2; k++) {
        put_line(out, "%svoid %s_%s(", k ? "\n" : "", name, precisions[k]);
        if (draft->desc->lobe)
            put_lobe(draft, precisions[k], out);
        else
            put_material(draft, precisions[k], out);
    }
}
