/* match_pair.c - one model matched to another: inputs copied, kept and searched */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/console/report.h"
#include "cli/match/match_verb.h"

bool match_has_parts(const Match *match) { return model_is_material(&match->from) && model_is_material(&match->to); }

/* Returns the parameter of `from` with the name of parameter `param` of `to`, or -1. The first parameters, which are
 * widths, match even if their names differ. */
static int param_like(const WeftLobeInfo *from, const WeftLobeInfo *to, int param) {
    for (int k = 0; k < from->param_count; k++)
        if (!from->params[k].choices && strcmp(from->params[k].name, to->params[param].name) == 0) return k;
    return param == 0 && from->param_count > 0 && !from->params[0].choices ? 0 : -1;
}

static void copy_lobe(const WeftLobe *from, WeftLobe *to) {
    const WeftLobeInfo *of = weft_lobe_info(from->lobe), *info = weft_lobe_info(to->lobe);
    for (int k = 0; k < info->param_count; k++) {
        const WeftParamInfo *p = &info->params[k];
        int like = p->choices && from->lobe != to->lobe ? -1 : from->lobe == to->lobe ? k : param_like(of, info, k);
        if (like >= 0) to->params[k] = fminf(fmaxf(from->params[like], p->hard_low), p->hard_high);
    }
    memcpy(to->f0, from->f0, sizeof to->f0);
    if (of->traits & info->traits & WEFT_LOBE_TWO_COLORS) memcpy(to->f90, from->f90, sizeof to->f90);
}

/* Copies the inputs of `from`, under the choices of `to`. */
static void copy_material(const WeftMaterial *from, WeftMaterial *to) {
    WeftMaterial copy = *from;
    for (int k = 0; weft_material_choice_name(k); k++)
        if (copy.choices[k] != to->choices[k]) weft_material_choose(&copy, k, to->choices[k]);
    *to = copy;
}

/* Sets a bit of *hold for each parameter of --hold; the copy gets the number that was typed for it. */
static int hold_params(const Match *match, const WeftLobe *typed, WeftLobe *copy, unsigned *hold) {
    const WeftLobeInfo *info = weft_lobe_info(typed->lobe);
    const char *name;
    for (int cursor = 0; (name = option_next(match->options, "--hold", &cursor));) {
        if (strcmp(name, "color") == 0 || strcmp(name, "f0") == 0) {
            *hold |= WEFT_HOLD_COLOR;
            memcpy(copy->f0, typed->f0, sizeof copy->f0);
            continue;
        }
        if (strcmp(name, "f90") == 0) {
            *hold |= WEFT_HOLD_COLOR_2;
            memcpy(copy->f90, typed->f90, sizeof copy->f90);
            continue;
        }
        int k = weft_lobe_param_find(typed->lobe, name);
        if (k < 0) return report(WEFT_USAGE, "%.80s: is not a parameter of %s", name, info->id);
        *hold |= 1u << k;
        copy->params[k] = typed->params[k];
    }
    return 0;
}

static int hold_inputs(const Match *match, const WeftMaterial *typed, WeftMaterial *copy, int *fixed) {
    const char *name;
    for (int cursor = 0; (name = option_next(match->options, "--hold", &cursor));) {
        int k = weft_material_input_find(name);
        if (k < 0) return report(WEFT_USAGE, "%.80s: is not an input; `weft models inputs` lists them", name);
        fixed[k] = 1;
        copy->inputs[k] = typed->inputs[k];
    }
    return 0;
}

/* Refuses a lobe that is only estimated by random walks, since the match would fit its noise. */
static int refuse_estimate(const Model *model) {
    const WeftLobeInfo *info = model->kind == MODEL_LOBE ? weft_lobe_info(model->lobe.lobe) : NULL;
    if (!info || !(info->traits & WEFT_LOBE_REFERENCE)) return 0;
    return report(WEFT_USAGE, "%.200s: is an estimate by random walks: match fibre, which is its mean", model->words);
}

int match_begin(Match *match, const char *from, const char *to) {
    int result = model_parse(from, &match->from); /* the numbers that are matched, without a weave */
    if (result == 0) result = model_prepare(&match->from);
    if (result == 0) result = model_parse(to, &match->to);
    if (result == 0) result = refuse_estimate(&match->from);
    if (result == 0) result = refuse_estimate(&match->to);
    if (result != 0) return result;
    if (match->to.kind == MODEL_MEASURED)
        return report(WEFT_USAGE, "%.200s: has no parameters that could be matched", to);
    match->copy = match->to;
    if (match->to.kind == MODEL_LOBE && match->from.kind == MODEL_LOBE) copy_lobe(&match->from.lobe, &match->copy.lobe);
    if (match_has_parts(match)) copy_material(&match->from.material, &match->copy.material);
    return 0;
}

int match_search(Match *match) {
    WeftError error;
    WeftResult found;
    unsigned hold = 0;
    int fixed[WEFT_INPUTS_MAX] = {0};
    bool lobe = match->to.kind == MODEL_LOBE;
    int result = lobe ? hold_params(match, &match->to.lobe, &match->copy.lobe, &hold)
                      : hold_inputs(match, &match->to.material, &match->copy.material, fixed);
    if (result == 0) result = model_prepare(&match->copy);
    if (result != 0) return result;
    match->to.lobe = match->copy.lobe;
    match->to.material = match->copy.material;
    if (lobe)
        found = weft_match_lobe(match->from.reflection, match->metric, hold, &match->to.lobe, &match->found, &error);
    else
        found = weft_match_material(match->from.reflection, match->metric, fixed, &match->to.material, &match->found,
                                    &error);
    if (found != WEFT_OK) return report_error(&error);
    model_warn(&match->to);
    return model_prepare(&match->to);
}

void match_free(Match *match) {
    model_free(&match->from);
    model_free(&match->to);
    model_free(&match->copy);
}
