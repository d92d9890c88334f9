/* fitted.c - a fitted lobe over its base: notes on its plausibility, and the material that has it */
#include "measure/fit/fitted.h"

#include <math.h>
#include <string.h>

#include "shading/catalogue/registry.h"
#include "shading/material/choice.h"

/* Parameters that have an input of their own. */
static const struct {
    const char *param;
    InputId input;
} named[] = {{"density", INPUT_sheen_density}, {"tilt", INPUT_nap},        {"azimuth", INPUT_nap_direction},
             {"tail", INPUT_sheen_tail},       {"rise", INPUT_sheen_rise}, {"retro", INPUT_diffuse_retro},
             {"lift", INPUT_diffuse_lift}};
enum { NAMED = sizeof named / sizeof *named };

unsigned params_without_input(const WeftLobe *lobe) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    unsigned bits = 0;
    for (int k = 1; k < info->param_count; k++) {
        bool has_input = info->params[k].choices != NULL;
        for (size_t n = 0; n < NAMED; n++) has_input |= strcmp(info->params[k].name, named[n].param) == 0;
        if (!has_input) bits |= 1u << k;
    }
    return bits;
}

/* Returns true if a parameter is not its default and lies at an end of its plausible range or, with `hard`,
 * of its hard range. */
static bool at_edge(const WeftLobe *lobe, bool hard) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    for (int k = 0; k < info->param_count; k++) {
        const WeftParamInfo *p = &info->params[k];
        const float low = hard ? p->hard_low : p->low, high = hard ? p->hard_high : p->high;
        float value = lobe->params[k], near = 1e-3f * (high - low);
        bool moved = value < p->def || value > p->def;
        if (!p->choices && moved && (value <= low + near || value >= high - near)) return true;
    }
    return false;
}

int weft_fitted_is_weave(const WeftFitted *fitted) {
    return !(weft_lobe_info(fitted->base.lobe)->traits & WEFT_LOBE_DIFFUSE);
}

unsigned weft_fitted_notes(const WeftFitted *fitted) {
    const WeftLobe *lobe = &fitted->lobe;
    float most = 0.0f, base = 0.0f;
    unsigned notes = 0;
    for (int c = 0; c < 3; c++) {
        most = fmaxf(most, lobe->f0[c]);
        base = fmaxf(base, fitted->base.f0[c]);
        if (weft_lobe_info(lobe->lobe)->traits & TRAIT_TWO_COLORS) most = fmaxf(most, lobe->f90[c]);
    }
    if (!(most > 1e-6f)) notes |= WEFT_FITTED_NOTHING;
    if (fmaxf(most, base) > 1.0f) notes |= WEFT_FITTED_BRIGHT;
    if (fitted->albedo > 1.002f) notes |= WEFT_FITTED_GAINS;
    const bool weave = weft_fitted_is_weave(fitted) != 0;
    if (at_edge(lobe, weave) || at_edge(&fitted->base, weave)) notes |= WEFT_FITTED_EDGE;
    return notes;
}

/* Returns the roughness at which lobe_rough gives the lobe its first parameter, which grows or falls with roughness. */
static float roughness_of(const WeftLobe *lobe) {
    double low = 0.0, high = 2.0;
    float first = lobe_rough(lobe->lobe, 0.0f).params[0], last = lobe_rough(lobe->lobe, 2.0f).params[0];
    for (int halving = 0; halving < 50; halving++) {
        double middle_of = 0.5 * (low + high);
        float now = lobe_rough(lobe->lobe, (float)middle_of).params[0];
        bool before = first < last ? now < lobe->params[0] : now > lobe->params[0];
        *(before ? &low : &high) = middle_of;
    }
    return (float)(0.5 * (low + high));
}

static void input_set(WeftMaterial *material, InputId input, const float *values, int count) {
    memcpy(material->inputs[input].value, values, (size_t)count * sizeof *values);
    material->inputs[input].given = 1;
}

/* Chooses the terms of a composed lobe: D, V and F. */
static void choose_terms(const WeftLobe *lobe, WeftMaterial *out) {
    static const struct {
        const char *param;
        ChoiceId choice;
    } terms[] = {{"d", CHOICE_sheen_d}, {"v", CHOICE_sheen_v}, {"f", CHOICE_sheen_f}};
    for (size_t t = 0; t < sizeof terms / sizeof *terms; t++) {
        int k = weft_lobe_param_find(lobe->lobe, terms[t].param);
        if (k >= 0) weft_material_choose(out, (int)terms[t].choice, (int)lobe->params[k]);
    }
}

/* Returns true if both have the same parameters, within 1e-4. */
static bool is_same(const Lobe *expressed, const WeftLobe *lobe) {
    bool same = true;
    for (int k = 0; k < weft_lobe_info(lobe->lobe)->param_count; k++)
        same &= fabsf(expressed->params[k] - lobe->params[k]) <= 1e-4f * (fabsf(lobe->params[k]) + 1e-3f);
    return same;
}

/* Sets the inputs of parameters that have their own, and these parameters of `expressed`, the lobe that the
 * material has. */
static void set_named_inputs(const WeftLobe *lobe, Lobe *expressed, WeftMaterial *out) {
    for (size_t n = 0; n < NAMED; n++) {
        int k = weft_lobe_param_find(lobe->lobe, named[n].param);
        if (k < 1) continue;
        expressed->params[k] = lobe->params[k];
        input_set(out, named[n].input, &lobe->params[k], 1);
    }
}

/* Sets the inputs of the base. Returns false if they do not express all of its parameters. */
static bool set_base_inputs(const WeftLobe *base, WeftMaterial *out) {
    const WeftLobeInfo *info = weft_lobe_info(base->lobe);
    float roughness = info->param_count > 0 ? roughness_of(base) : 0.0f;
    Lobe expressed = lobe_rough(base->lobe, roughness);
    set_named_inputs(base, &expressed, out);
    bool same = is_same(&expressed, base);
    for (int c = 0; c < 3; c++) same &= base->f0[c] <= 1.0f;
    weft_material_choose(out, CHOICE_diffuse, base->lobe);
    input_set(out, INPUT_base_color, base->f0, 3);
    input_set(out, weft_lobe_param_find(base->lobe, "wrap") == 0 ? INPUT_subsurface : INPUT_roughness, &roughness, 1);
    return same;
}

/* Sets the inputs of the sheen. Returns false if they do not express all of its parameters. */
static bool set_sheen_inputs(const WeftLobe *lobe, WeftMaterial *out) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    float roughness = info->param_count > 0 ? roughness_of(lobe) : 0.0f;
    Lobe expressed = lobe_rough(lobe->lobe, roughness);
    set_named_inputs(lobe, &expressed, out);
    for (int k = 0; k < info->param_count; k++)
        if (info->params[k].choices) expressed.params[k] = lobe->params[k]; /* as choices of the material */
    bool same = is_same(&expressed, lobe);
    for (int c = 0; c < 3; c++) same &= lobe->f0[c] <= 1000.0f;
    weft_material_choose(out, CHOICE_sheen_lobe, lobe->lobe);
    choose_terms(lobe, out);
    input_set(out, INPUT_sheen_color, lobe->f0, 3);
    input_set(out, INPUT_sheen_second, lobe->f90, 3);
    input_set(out, INPUT_sheen_roughness, &roughness, 1);
    return same;
}

int weft_fitted_material(const WeftFitted *fitted, WeftMaterial *out) {
    weft_material_default(out);
    if (weft_fitted_is_weave(fitted)) return 0;
    weft_material_choose(out, CHOICE_workflow, choice_find(CHOICE_workflow, "cloth"));
    weft_material_choose(out, CHOICE_layer, choice_find(CHOICE_layer, "additive"));
    bool base = set_base_inputs(&fitted->base, out), sheen = set_sheen_inputs(&fitted->lobe, out);
    return base && sheen;
}
