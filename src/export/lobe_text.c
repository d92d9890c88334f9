/* lobe_text.c - the functions of a lobe that an engine calls, with a colour and two directions as arguments */
#include <stdio.h>
#include <stdlib.h>

#include "export/draft.h"

#include "base/fail.h"
#include "text/assemble/dispatch.h"
#include "text/assemble/tables.h"
#include "text/source/number_text.h"

const char *draft_lobe_record(int lobe) { return lobe_names(lobe)->record; }

bool draft_lobe_rough(const WeftLobe *lobe) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    return info->param_count > 0 && !info->params[0].choices;
}

/* Renames the lobe's own sampler, since an engine calls another function by that name. */
static void rename_own(Text *text, const char *name) {
    char from[96], to[96];
    snprintf(from, sizeof from, "%s_sample", name);
    snprintf(to, sizeof to, "%s_sample_seen", name);
    text_define(text, from, to);
}

static void put_default(Text *text, const WeftLobe *lobe, const LobeNames *own) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    text_line(text, "\n%s %s_default() {\n    %s m;", own->record, own->prefix, own->record);
    for (int k = 0; k < info->param_count; k++) {
        const WeftParamInfo *p = &info->params[k];
        char value[32];
        if (p->choices)
            snprintf(value, sizeof value, "%d", (int)lobe->params[k]);
        else
            snprintf(value, sizeof value, "%s", number(lobe->params[k]).text);
        text_line(text, "    m.%s = %s; /* %s%s%s */", p->name, value, p->help, p->choices ? ": " : "",
                  p->choices ? p->choices[(int)lobe->params[k]] : "");
    }
    if (!info->param_count) text_line(text, "    m.none = 0.0;");
    text_line(text, "    return m;\n}");
}

static void put_rough(Text *text, const WeftLobe *lobe, const LobeNames *own) {
    const WeftParamInfo *p = &weft_lobe_info(lobe->lobe)->params[0];
    char value[96] = "roughness";
    if (strcmp(p->name, "alpha") == 0)
        snprintf(value, sizeof value, "roughness * roughness");
    else if (strcmp(p->name, "roughness") != 0)
        snprintf(value, sizeof value, "mix(%s, %s, roughness)", number(p->low).text, number(p->high).text);
    text_line(text,
              "\n/* Makes one with %s from an artist's roughness, 0 to 1. */\n"
              "%s %s_rough(float roughness) {\n    %s m = %s_default();\n    m.%s = clamp(%s, %s, %s);\n"
              "    return m;\n}",
              p->name, own->record, own->prefix, own->record, own->prefix, p->name, value, number(p->hard_low).text,
              number(p->hard_high).text);
}

/* Writes the statements that prepare the lobe for wo, with which every function below begins. */
static void put_seen(Text *text, const LobeNames *own) {
    const char *p = own->prefix, *r = own->record;
    text_line(text, "    %sPrepared p;\n    %sView w;\n    %s_prepare(m, p);\n    %s_view(p, wo, w);", r, r, p, p);
}

/* Returns true if the lobe derives its second colour from the user's. */
static bool has_second(const LobeNames *own) {
    char file[96], function[96];
    snprintf(file, sizeof file, "lobes/%s.h", own->prefix);
    snprintf(function, sizeof function, "float %s_second(", own->prefix);
    return strstr(weft_catalogue_text(file), function) != NULL;
}

/* Writes the function of f in a colour: a factor, a mixture of two, or the albedo of fibres. */
static void put_eval(Text *text, const WeftLobe *lobe, const LobeNames *own, bool folded) {
    unsigned traits = weft_lobe_info(lobe->lobe)->traits;
    const char *p = own->prefix, *pi = folded ? "PI * " : "";
    bool two = traits & TRAIT_TWO_COLORS, tinted = traits & TRAIT_TINTED;
    text_include(text, "shading/dialect/rgb.h");
    if (two && has_second(own)) text_include(text, "shading/lobe/fresnel_weight.h");
    text_line(text,
              "\n/* f%s of wo and wi; black below the horizon.%s */\nRgb %s_eval(%s m, Rgb color, %sDir wo, "
              "Dir wi) {\n    if (wo.z <= 0.0 || wi.z <= 0.0) return rgb_grey(0.0);",
              folded ? " times pi, without the cosine," : ", 1/sr, without the cosine,",
              two      ? " color is f0, second f90 or the colour of the weft."
              : tinted ? " color is the albedo of a fibre, in [0, 1]."
                       : "",
              p, own->record, two ? "Rgb second, " : "");
    put_seen(text, own);
    text_line(text, "    LobeValue v = %s_value(p, w, angles_between(wo, wi));", p);
    if (tinted)
        text_line(text,
                  "    Rgb c = rgb(tint_color(v.tint, color.r), tint_color(v.tint, color.g), tint_color(v.tint, "
                  "color.b));\n    return rgb_scale(c, %sv.f);\n}",
                  pi);
    else if (two && has_second(own))
        text_line(text,
                  "    Rgb other = rgb(%s_second(m, color.r, second.r), %s_second(m, color.g, second.g),\n"
                  "                    %s_second(m, color.b, second.b));\n"
                  "    Rgb c = rgb(fresnel_weight_mix(v.s, color.r, other.r), fresnel_weight_mix(v.s, color.g, "
                  "other.g),\n"
                  "                fresnel_weight_mix(v.s, color.b, other.b));\n    return rgb_scale(c, %sv.f);\n}",
                  p, p, p, pi);
    else if (two)
        text_line(text, "    return rgb_scale(rgb_mix(color, second, v.s), %sv.f);\n}", pi);
    else
        text_line(text, "    return rgb_scale(color, %sv.f);\n}", pi);
}

static void put_pdf(Text *text, const LobeNames *own) {
    text_line(text,
              "\n/* Density of %s_sample at wi, 1/sr; 0 below the horizon. */\n"
              "float %s_pdf(%s m, Dir wo, Dir wi) {\n    if (wo.z <= 0.0 || wi.z <= 0.0) return 0.0;",
              own->prefix, own->prefix, own->record);
    put_seen(text, own);
    text_line(text, "    return %s_value(p, w, angles_between(wo, wi)).pdf;\n}", own->prefix);
}

static void put_sample(Text *text, const LobeNames *own) {
    text_line(text,
              "\n/* A wi for u and v in [0, 1), which may lie below the horizon: that is no sample. */\n"
              "Dir %s_sample(%s m, Dir wo, float u, float v) {",
              own->prefix, own->record);
    put_seen(text, own);
    text_line(text, "    return %s_sample_seen(p, w, wo, u, v);\n}", own->prefix);
}

/* Writes the function of E of the white lobe, over its first parameter. */
static void put_albedo(Draft *draft, const WeftLobe *lobe, const LobeNames *own) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    AlbedoTable *table = draft_albedo(draft);
    Lobe of;
    lobe_of(lobe, &of);
    if (!table) {
        fail(&draft->text.error, WEFT_MESSAGE_MEMORY, "table", NULL);
        return;
    }
    bool rows = draft_lobe_rough(lobe);
    albedo_table_fill(table, &of, rows ? info->params[0].low : 0.0f, rows ? info->params[0].high : 0.0f, 0);
    char function[96], *name = draft->albedo_names[draft->albedo_count - 1];
    snprintf(function, sizeof function, "%s_albedo_table", own->prefix);
    snprintf(name, SPELL_NAME, "%s_albedo", own->prefix);
    text_include(&draft->text, "shading/lobe/table.h");
    text_albedo_table(&draft->text, function, name, table);
    text_line(&draft->text,
              "\n/* E of the white lobe towards wo, cos_o = wo.z%s; from a table; of a brushed lobe where it "
              "is greatest. */\n"
              "float %s(%s m, float cos_o) {\n    return table_roots(%s(), cos_o, %s%s);\n}",
              info->param_count > 1 ? ", other parameters as in the default" : "", name, own->record, function,
              rows ? "m." : "0.0", rows ? info->params[0].name : "");
    draft_root(draft, "%s", name);
}

void draft_lobe(Draft *draft, const WeftLobe *lobe, int which) {
    const LobeNames *own = lobe_names(lobe->lobe);
    Text *text = &draft->text;
    rename_own(text, own->prefix);
    text_include(text, "shading/dialect/angles.h");
    if (!text_weight_is_cosine(lobe->lobe)) text_define(text, "FRESNEL_WEIGHT_IS_COSINE(s)", "false");
    text_lobe(text, lobe->lobe);
    put_default(text, lobe, own);
    if (draft_lobe_rough(lobe)) put_rough(text, lobe, own);
    put_eval(text, lobe, own, draft->desc->fold_pi != 0);
    snprintf(draft->id[which], DRAFT_ID, "%s", own->prefix);
    draft->whole[2 + which] = own->record;
    draft_root(draft, "%s_default", own->prefix);
    draft_root(draft, "%s_eval", own->prefix);
    if (draft_lobe_rough(lobe)) draft_root(draft, "%s_rough", own->prefix);
    if (draft->desc->target == WEFT_EXPORT_SHADERTOY) return;
    put_pdf(text, own);
    put_sample(text, own);
    draft_root(draft, "%s_pdf", own->prefix);
    draft_root(draft, "%s_sample", own->prefix);
    if (draft->desc->albedo || draft->desc->ambient) put_albedo(draft, lobe, own);
    if (draft->desc->ambient) draft_ambient(draft, lobe);
}
