/* cloth.c - the cloth of a woven material as text: its numbers, its tables, and what a point of a pixel sees of it */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "export/draft.h"

#include "base/memory.h"
#include "shading/weave/weave_point.h"
#include "text/source/number_text.h"
#include "weave/cloth_base.h"

/* Returns the rows of all levels of the colours, one below the other. */
static int rows_of(const ClothFar *far) {
    int rows = 0;
    for (int level = 0; level < far->levels; level++) rows += FAR_LAYERS * cloth_far_side(far->height, level);
    return rows;
}

/* Returns the colours as one table, as shading/weave/weave_seen.h reads it; NULL if memory is short. */
static float *colors_make(const ClothFar *far) {
    const size_t stride = 4 * (size_t)far->width, rows = (size_t)rows_of(far);
    float *table = alloc_array(rows * stride, sizeof *table), *to = table;
    if (!table) return NULL;
    for (int level = 0; level < far->levels; level++) {
        int width, height;
        const float *from = cloth_far_level(far, level, &width, &height);
        for (int row = 0; row < FAR_LAYERS * height; row++, to += stride, from += 4 * width)
            memcpy(to, from, 4 * (size_t)width * sizeof *to);
    }
    return table;
}

/* Writes a statement that sets a member of m, or of its part `of`. */
static void put_member(Text *text, const char *of, const char *name, float value) {
    text_line(text, "    m.%s%s%s = %s;", of, *of ? "." : "", name, number(value).text);
}
#define PUT_MEMBER(name) put_member(text, of, #name, from->name);
static void put_yarn(Text *text, const char *of, const WeaveYarn *from) { WEAVE_YARN_NUMBERS(PUT_MEMBER) }
static void put_far(Text *text, const char *of, const WeaveFar *from) { WEAVE_FAR_NUMBERS(PUT_MEMBER) }

/* Writes the function of lobe woven of a system. */
#define PUT_BIN(name)                                                                                                  \
    put_member(text, "bins." #name, "slope", from->bins.name.slope);                                                   \
    put_member(text, "bins." #name, "weight", from->bins.name.weight);
static void put_system(Draft *draft, const char *name, const WovenPrepared *fitted) {
    Text *text = &draft->text;
    const char *of = "";
    WovenPrepared whole = *fitted, *from = &whole;
    whole.scale = 1.0f; /* colours from afar contain the share */
    text_line(text, "\n/* The %s from afar: a lobe that is fitted to its points. */\nWovenPrepared %s_%s() {", name,
              draft->id[0], name);
    text_line(text, "    WovenPrepared m;");
    WOVEN_NUMBERS(PUT_MEMBER)
    WOVEN_EACH_BIN(PUT_BIN)
    text_line(text, "    return m;\n}");
}

/* Writes the function of the cloth's numbers and of its tables for points. */
static void put_cloth(Draft *draft, const WeftCloth *cloth) {
    Text *text = &draft->text;
    const Weave *m = &cloth->weave;
    const int runs = text_table(text, (TextTable){cloth->runs, m->picks, 4 * m->warps, "runs"});
    const int albedos = text_table(text, (TextTable){cloth->albedos, m->warps + m->picks, 3, "albedos"});
    text_line(
        text,
        "\n/* The cloth: both yarns, both systems from afar, and the tables of one repeat. */\nWeave %s_cloth() {\n"
        "    Weave m;\n    m.warps = %d;\n    m.picks = %d;\n    m.runs = %d;\n    m.albedos = %d;",
        draft->id[0], m->warps, m->picks, runs, albedos);
    put_yarn(text, "warp", &m->warp);
    put_yarn(text, "weft", &m->weft);
    put_far(text, "warp_far", &m->warp_far);
    put_far(text, "weft_far", &m->weft_far);
    put_member(text, "", "seed", m->seed);
    put_member(text, "", "low", m->low);
    put_member(text, "", "high", m->high);
    put_member(text, "", "openness", m->openness);
    text_line(text, "    m.cycle_x = 0.0;\n    m.cycle_y = 0.0;\n    return m;\n}");
}

/* Writes the functions of the colours from afar, and of where the weave lies. */
static void put_place(Draft *draft, const WeftCloth *cloth) {
    Text *text = &draft->text;
    const ClothFar *far = &cloth->far;
    const WeavePlacing p = cloth_placing(cloth);
    const int colors = text_table(text, (TextTable){draft->colors, rows_of(far), 4 * far->width, "colors"});
    text_line(text,
              "\n/* Its colours from afar. */\nWeaveColors %s_colors() {\n    WeaveColors m;\n    m.texels = %d;\n"
              "    m.stride = %d;\n    m.width = %d;\n    m.height = %d;\n    m.last = %d;\n    return m;\n}",
              draft->id[0], colors, 4 * far->width, far->width, far->height, far->levels - 1);
    text_line(text, "\n/* Where it lies on texture coordinates. */\nWeavePlacing %s_placing() {\n    WeavePlacing m;",
              draft->id[0]);
    put_member(text, "", "warps", p.warps);
    put_member(text, "", "picks", p.picks);
    put_member(text, "", "rotation_cos", p.rotation_cos);
    put_member(text, "", "rotation_sin", p.rotation_sin);
    text_line(text, "    return m;\n}");
}

void draft_cloth(Draft *draft) {
    Text *text = &draft->text;
    const WeftCloth *cloth = draft->desc->cloth;
    const char *id = draft->id[0];
    draft->colors = colors_make(&cloth->far);
    if (!draft->colors) text->macros.short_of_memory = true;
    text_include(text, "shading/weave/weave_seen.h");
    put_cloth(draft, cloth);
    put_place(draft, cloth);
    put_system(draft, "warp", &cloth->far.woven[WEFT_WARP]);
    put_system(draft, "weft", &cloth->far.woven[WEFT_WEFT]);
    text_line(text,
              "\n/* What a point sees at texture coordinates u, v, which change by du_dx, dv_dx to the next pixel "
              "across and\n"
              " * by du_dy, dv_dy to the next one down. points: how many points of the pixel are averaged. */\n"
              "WeaveSeen %s_see(Surface s, float u, float v, float du_dx, float dv_dx, float du_dy, float dv_dy,\n"
              "                  int points) {\n"
              "    return weave_see(%s_cloth(),\n"
              "                      %s_colors(),\n"
              "                      %s_placing(),\n"
              "                      u, v, du_dx, dv_dx, du_dy, dv_dy, points, s.wear);\n}",
              id, id, id, id);
    draft_root(draft, "%s_see", id);
}
