/* ambient.c - the functions by which an engine lights a lobe by an environment map: where to look the map up, how wide,
 * and what the lobe makes of it (shading/ambient/ambient_lobe.h, strategy `fitted`) */
#include <stdio.h>
#include <string.h>

#include "base/fail.h"
#include "export/draft.h"
#include "shading/ambient/ambient_fit.h"
#include "text/assemble/dispatch.h"
#include "text/source/number_text.h"

/* The look-ups: those of the four weights, of which two have two axes, and that along the lobe's mean direction. */
enum { LOOKS = 7, FOCUS = 6 };
static const struct {
    Dir axis; /* x towards wo; of FOCUS it is read from the table */
    float kappa;
} looks[LOOKS] = {
    {{AMBIENT_AXIS_0}, 0.0f},
    {{AMBIENT_AXIS_1_LEFT}, AMBIENT_KAPPA_1},
    {{AMBIENT_AXIS_1_RIGHT}, AMBIENT_KAPPA_1},
    {{AMBIENT_AXIS_2}, AMBIENT_KAPPA_2},
    {{AMBIENT_AXIS_3_LEFT}, AMBIENT_KAPPA_3},
    {{AMBIENT_AXIS_3_RIGHT}, AMBIENT_KAPPA_3},
    {{0.0f, 0.0f, 1.0f}, 0.0f},
};

/* The planes of the table in the text, and those of a fit that they are: three shares, and where the lobe has a FOCUS its
 * direction and width. E has a table of its own, which interpolates it better. */
enum { PLANE_AXIS = 3, PLANE_KAPPA, PLANES };
static const int planes_of_fit[PLANES] = {0, 1, 2, 4 * AMBIENT_GROUP_SHAPE, 4 * AMBIENT_GROUP_SHAPE + 1};

/* A lobe narrower than this log2 kappa shows that a light of the map has an extent. */
static const float NARROW = 7.0f;

/* Returns why the light of a map on a lobe is more than weights of look-ups; NULL if it is not. */
static const char *refusal(const WeftLobe *lobe, const AmbientFit *fit) {
    const unsigned traits = weft_lobe_info(lobe->lobe)->traits;
    const bool dense = fit->denser > AMBIENT_DENSER;
    if (traits & TRAIT_TWO_COLORS) return "the lobe has two colours";
    if (traits & TRAIT_TINTED) return "the lobe changes its colour with the direction";
    if (fit->by_azimuth) return "the lobe depends on the azimuth of the viewer";
    if (fit->finest > NARROW) return "the lobe is narrow: filter the map by it, as a split sum does";
    return ambient_strategy(lobe->lobe, false, dense) == AMBIENT_SAMPLED ? "weft samples the lobe" : NULL;
}

/* Writes the function that interpolates a plane of the table over cos_o and the lobe's first parameter. */
static void put_entry(Text *text, const char *prefix, const AmbientFit *fit, int layer) {
    const float per_root = (float)(fit->rows - 1) / fmaxf(fit->root_high - fit->root_low, 1e-6f);
    text_line(text,
              "\n/* A plane of the table: 0, 1, 2 are shares of look-ups 1 and 2, of 3, of 4 and 5; 3 and 4 are\n"
              " * the sine of the lobe's mean direction, towards wo, and log2 of its kappa. */\n"
              "float %s_ambient_entry(float p, float cos_o, int plane) {\n    TableRef t;\n    t.texels = %d;\n"
              "    float y = 1.0 - sqrt(max(1.0 - sqrt(clamp(cos_o, 0.0, 1.0)), 0.0)), x = y * %s;\n"
              "    float left = clamp(floor(x), 0.0, %s), across = clamp(x - left, 0.0, 1.0);\n    int column = "
              "int(left);",
              prefix, layer, number((float)(AMBIENT_COLUMNS - 1)).text, number((float)(AMBIENT_COLUMNS - 2)).text);
    if (fit->rows < 2) {
        text_line(
            text,
            "    return mix(table_fetch(t.texels, %d, plane, column), table_fetch(t.texels, %d, plane, column + 1), "
            "across);\n}",
            AMBIENT_COLUMNS, AMBIENT_COLUMNS);
        return;
    }
    text_line(text,
              "    float height = (sqrt(max(p, 0.0)) - %s) * %s, above = clamp(floor(height), 0.0, %s);\n"
              "    int row = plane * %d + int(above);",
              number(fit->root_low).text, number(per_root).text, number((float)(fit->rows - 2)).text, fit->rows);
    for (int k = 0; k < 2; k++)
        text_line(text,
                  "    float %s = mix(table_fetch(t.texels, %d, row%s, column), table_fetch(t.texels, %d, row%s, "
                  "column + 1), "
                  "across);",
                  k ? "second" : "first", AMBIENT_COLUMNS, k ? " + 1" : "", AMBIENT_COLUMNS, k ? " + 1" : "");
    text_line(text, "    return mix(first, second, clamp(height - above, 0.0, 1.0));\n}");
}

static void put_axis(Text *text, const LobeNames *own, const char *p, bool focus) {
    text_line(
        text,
        "\n/* The axis of look-up k, 0 to %d, of the map. */\nDir %s_ambient_axis(%s m, Dir wo, int k) {\n"
        "    float s = sqrt(wo.x * wo.x + wo.y * wo.y), tx = 1.0, ty = 0.0;\n"
        "    if (s > 1e-6) {\n        tx = wo.x / s;\n        ty = wo.y / s;\n    }\n    Dir a = dir(0.0, 0.0, 1.0);",
        LOOKS - 1, own->prefix, own->record);
    for (int k = 1; k < FOCUS; k++) {
        const Dir a = looks[k].axis;
        text_line(text, "    if (k == %d) a = dir(%s, %s, %s);", k, number(a.x).text, number(a.y).text,
                  number(a.z).text);
    }
    if (focus)
        text_line(text,
                  "    if (k == %d) {\n        float sine = clamp(%s_ambient_entry(%s, wo.z, %d), -1.0, 1.0);\n"
                  "        a = dir(sine, 0.0, sqrt(max(1.0 - sine * sine, 0.0)));\n    }",
                  FOCUS, own->prefix, p, PLANE_AXIS);
    text_line(text, "    return dir(a.x * tx - a.y * ty, a.x * ty + a.y * tx, a.z);\n}");
}

static void put_kappa(Text *text, const LobeNames *own, const char *p, bool focus) {
    text_line(
        text,
        "\n/* The filter of look-up k: the map is weighted by exp(kappa (mu - 1)), mu the cosine to the axis; where\n"
        " * kappa is 0 by max(mu, 0). */\nfloat %s_ambient_kappa(%s m, Dir wo, int k) {",
        own->prefix, own->record);
    if (focus)
        text_line(text, "    if (k == %d) return exp2(%s_ambient_entry(%s, wo.z, %d));", FOCUS, own->prefix, p,
                  PLANE_KAPPA);
    for (int k = 1; k < FOCUS; k++) text_line(text, "    if (k == %d) return %s;", k, number(looks[k].kappa).text);
    text_line(text, "    return 0.0;\n}");
}

static void put_light(Text *text, const LobeNames *own, const char *p, bool focus) {
    const char *entry = own->prefix;
    text_line(
        text,
        "\n/* The light of the map that the lobe sends towards wo; look0 to look%d: the means of the map under the "
        "filters. */\n"
        "Rgb %s_ambient(%s m, Rgb color, Dir wo, Rgb look0, Rgb look1, Rgb look2, Rgb look3, Rgb look4, Rgb look5,\n"
        "    Rgb look6) {\n    if (wo.z <= 0.0) return rgb_grey(0.0);",
        LOOKS - 1, own->prefix, own->record);
    text_line(text,
              "    float b = %s_ambient_entry(%s, wo.z, 0), c = %s_ambient_entry(%s, wo.z, 1);\n"
              "    float d = %s_ambient_entry(%s, wo.z, 2), a = max(1.0 - b - c - d, 0.0);",
              entry, p, entry, p, entry, p);
    text_line(text, "    Rgb front = rgb_add(rgb_scale(look0, a), rgb_scale(rgb_add(look1, look2), 0.5 * b));\n"
                    "    Rgb back = rgb_add(rgb_scale(look3, c), rgb_scale(rgb_add(look4, look5), 0.5 * d));\n"
                    "    Rgb mean = rgb_scale(rgb_add(front, back), 1.0 / max(a + b + c + d, 1e-20));");
    if (focus)
        text_line(text,
                  "    float x = clamp(0.5 + %s * (%s_ambient_entry(%s, wo.z, %d) - %s), 0.0, 1.0);\n"
                  "    mean = rgb_mix(mean, look6, x * x * (3.0 - 2.0 * x));",
                  number(0.5f / AMBIENT_BLEND).text, entry, p, PLANE_KAPPA, number(AMBIENT_CLOSE).text);
    text_line(text, "    return rgb_mul(color, rgb_scale(mean, %s_albedo(m, wo.z)));\n}", own->prefix);
}

void draft_ambient(Draft *draft, const WeftLobe *lobe) {
    const LobeNames *own = lobe_names(lobe->lobe);
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    const bool rows = draft_lobe_rough(lobe);
    Text *text = &draft->text;
    AmbientFit *fit = arena_array(&text->macros.arena, 1, sizeof *fit);
    Lobe of;
    float *texels = arena_array(&text->macros.arena, PLANES * AMBIENT_ROWS * AMBIENT_COLUMNS, sizeof *texels);
    char *name = arena_array(&text->macros.arena, SPELL_NAME, 1), p[64];
    if (!fit || !texels || !name) {
        fail(&text->error, WEFT_MESSAGE_MEMORY, "table", NULL);
        return;
    }
    lobe_of(lobe, &of);
    ambient_fit(fit, &of, rows ? info->params[0].low : of.params[0], rows ? info->params[0].high : of.params[0], 0);
    const char *why = refusal(lobe, fit);
    if (why) {
        fail(&text->error, WEFT_MESSAGE_DESC, info->id, "its light of a map is more than weights of look-ups: %s", why);
        return;
    }
    const bool focus = fit->finest > AMBIENT_CLOSE - AMBIENT_BLEND;
    snprintf(p, sizeof p, "%s%s", rows ? "m." : "0.0", rows ? info->params[0].name : "");
    text_include(text, "shading/lobe/table.h");
    text_include(text, "shading/dialect/rgb.h");
    const int planes = focus ? PLANES : PLANE_AXIS, size = fit->rows * AMBIENT_COLUMNS;
    for (int k = 0; k < planes; k++)
        memcpy(texels + k * size, fit->texels[planes_of_fit[k] * fit->rows], (size_t)size * sizeof(float));
    snprintf(name, SPELL_NAME, "%s_ambient", own->prefix);
    const TextTable table = {texels, planes * fit->rows, AMBIENT_COLUMNS, name};
    put_entry(text, own->prefix, fit, text_table(text, table));
    put_axis(text, own, p, focus);
    put_kappa(text, own, p, focus);
    put_light(text, own, p, focus);
    draft_root(draft, "%s_ambient", own->prefix);
    draft_root(draft, "%s_ambient_axis", own->prefix);
    draft_root(draft, "%s_ambient_kappa", own->prefix);
}
