/* fit.c - fits of all lobes over all bases, or of a weave, to measured data; the distance of any model from data */
#include "weft/fit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "measure/fit/data.h"
#include "measure/fit/fitted.h"
#include "measure/fit/lobe_search.h"
#include "measure/fit/material_search.h"
#include "measure/fit/weave_search.h"
#include "shading/catalogue/registry.h"

/* A lobe over a base, before it is fitted. */
typedef struct Candidate {
    WeftLobe lobe, base;
} Candidate;

/* The work of weft_fit. Items 0 to count - 1 are the candidates, and item `count` is the baseline, ggx over lambert. */
typedef struct FitWork {
    const WeftFitDesc *desc;
    Samples samples;
    WeftLobe lambert, ggx;
    WeftLobe bases[WEFT_FITTED_BASES];
    int base_count;
    Candidate candidates[WEFT_FITTED_MOST];
    int count;
    WeftFitted fitted[WEFT_FITTED_MOST + 1];
    WeftResult results[WEFT_FITTED_MOST + 1];
    bool isotropic;  /* the data are isotropic */
    bool weave;      /* there is one candidate: lobe woven as the warp, and the same lobe as its base, the weft */
    LoopWatch watch; /* progress of the loop over all items, and if it was interrupted */
} FitWork;

/* The combinations of choices with the least estimated errors, the best first. All of these are searched. */
enum { FINALISTS = 4 };
typedef struct Finalists {
    int count;
    LobeFound found[FINALISTS];
} Finalists;

static void finalists_add(Finalists *self, const LobeFound *found) {
    int at = self->count;
    while (at > 0 && found->error < self->found[at - 1].error) at--;
    if (at == FINALISTS) return;
    if (self->count < FINALISTS) self->count++;
    memmove(&self->found[at + 1], &self->found[at], (size_t)(self->count - 1 - at) * sizeof *found);
    self->found[at] = *found;
}

/* Steps the lobe to the next combination of its choices, such as of terms D, V and F. Returns false after the last. */
static bool next_choices(WeftLobe *lobe) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    for (int k = 0; k < info->param_count; k++) {
        const char *const *choices = info->params[k].choices;
        if (!choices) continue;
        int next = (int)lobe->params[k] + 1;
        lobe->params[k] = choices[next] ? (float)next : 0.0f;
        if (choices[next]) return true;
    }
    return false;
}

/* Picks the best combinations of choices by quick estimates of their errors. A lobe without choices has none. */
static WeftResult pick_choices(const LobeSearch *search, const WeftLobe *lobe, Finalists *best) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    LobeFound found = {.lobe = *lobe};
    WeftResult result = WEFT_OK;
    *best = (Finalists){.count = 0};
    bool more = false;
    for (int k = 0; k < info->param_count; k++) {
        if (!info->params[k].choices) continue;
        found.lobe.params[k] = 0.0f;
        more = true;
    }
    while (more && result == WEFT_OK) {
        result = lobe_search_glance(search, &found);
        finalists_add(best, &found);
        more = next_choices(&found.lobe);
    }
    return result;
}

/* Fits a lobe with the choices that it has, then with each of the best combinations, and keeps the best fit. */
static WeftResult fit_lobe(const LobeSearch *search, LobeFound *out) {
    Finalists best;
    WeftResult result = pick_choices(search, &out->lobe, &best);
    if (result == WEFT_OK) result = lobe_search_run(search, out);
    for (int k = 0; k < best.count && result == WEFT_OK; k++) {
        LobeFound found = {.lobe = best.found[k].lobe, .evaluations = out->evaluations};
        result = lobe_search_run(search, &found);
        if (found.error < out->error) *out = found;
        out->evaluations = found.evaluations;
    }
    return result;
}

/* Fits once more, from what was found without a bound, so that E stays within 1. The start has the parameters of both, and
 * colours that a lobe which is no factor of them is searched from. */
static WeftResult keep_within_bound(LobeSearch search, LobeFound *found) {
    const WeftLobe base = found->base;
    LobeFound bound = {.lobe = found->lobe, .evaluations = found->evaluations};
    search.base = &base;
    search.bound = true;
    WeftResult result = lobe_search_run(&search, &bound);
    *found = bound;
    return result;
}

/* Fits one item of work. `hold` names what stays as it is: f90 of the baseline and, if a material has to express the
 * fit, parameters that no input of a material sets. */
static WeftResult fit_item(FitWork *work, int item, ItemProgress *item_progress) {
    bool baseline = item == work->count;
    const WeftLobe *base = baseline ? &work->lambert : &work->candidates[item].base;
    LobeFound found = {.lobe = baseline ? work->ggx : work->candidates[item].lobe};
    LobeSearch search = {.samples = &work->samples,
                         .base = base,
                         .hold = baseline ? WEFT_HOLD_COLOR_2 : 0,
                         .isotropic = work->isotropic,
                         .item_progress = item_progress};
    if (work->desc->expressible && !baseline) {
        search.hold |= params_without_input(&found.lobe);
        search.hold_base = params_without_input(base);
    }
    const bool weave = work->weave && !baseline;
    WeftResult result = weave ? weave_search_run(&work->samples, item_progress, &found) : fit_lobe(&search, &found);
    const double free_error = found.error;
    float albedo = result == WEFT_OK ? lobe_search_albedo(&found.base, &found.lobe) : 0.0f;
    if (result == WEFT_OK && !weave && !baseline && !work->desc->free && albedo > 1.0f) {
        result = keep_within_bound(search, &found);
        albedo = result == WEFT_OK ? lobe_search_albedo(&found.base, &found.lobe) : 0.0f;
    }
    work->fitted[item] = (WeftFitted){.lobe = found.lobe,
                                      .base = found.base,
                                      .numbers = found.numbers,
                                      .error = found.error,
                                      .free_error = free_error,
                                      .albedo = albedo,
                                      .evaluations = found.evaluations};
    return result;
}

static void fit_one(void *user, int item, int thread) {
    (void)thread;
    FitWork *work = user;
    ItemProgress item_progress = {.watch = &work->watch};
    work->results[item] =
        progress_report(&item_progress, 0.0) ? fit_item(work, item, &item_progress) : WEFT_INTERRUPTED;
    progress_report(&item_progress, 1.0);
}

/* Finds the least error of the bases alone, or of lambert for a weave. The lobe over them is black and stays so. */
static WeftResult bases_alone(const FitWork *work, double *error) {
    WeftResult result = WEFT_OK;
    *error = 1e30;
    for (int k = 0; k < work->base_count && result == WEFT_OK; k++) {
        const LobeSearch search = {
            .samples = &work->samples, .base = work->weave ? &work->lambert : &work->bases[k], .hold = WEFT_HOLD_COLOR};
        LobeFound found = {.lobe = work->lambert};
        memset(found.lobe.f0, 0, sizeof found.lobe.f0);
        result = lobe_search_run(&search, &found);
        *error = fmin(*error, found.error);
    }
    return result;
}

static int by_error(const void *a, const void *b) {
    const WeftFitted *x = a, *y = b;
    if (x->error < y->error || x->error > y->error) return x->error < y->error ? -1 : 1;
    return x->lobe.lobe != y->lobe.lobe ? x->lobe.lobe - y->lobe.lobe : x->base.lobe - y->base.lobe;
}

/* Sets the bases: the named lobe, or for "all" every diffuse one. A base that is a system of threads means a weave. */
static WeftResult set_bases(FitWork *work, const char *name, WeftError *error) {
    bool all = strcmp(name, "all") == 0;
    WeftResult result = WEFT_OK;
    if (!all) {
        result = weft_lobe_init(name, &work->bases[work->base_count++], error);
        if (result != WEFT_OK) return result;
        unsigned traits = weft_lobe_info(work->bases[0].lobe)->traits;
        work->weave = (traits & WEFT_LOBE_SYSTEM) != 0;
        if (!work->weave && !(traits & WEFT_LOBE_DIFFUSE))
            return fail(error, WEFT_MESSAGE_DESC, name, "is no diffuse lobe");
    }
    for (int k = 0; all && k < weft_lobe_count() && result == WEFT_OK; k++) {
        const WeftLobeInfo *info = weft_lobe_info(k);
        if (info->traits & WEFT_LOBE_DIFFUSE && work->base_count < WEFT_FITTED_BASES)
            result = weft_lobe_init(info->id, &work->bases[work->base_count++], error);
    }
    return result;
}

/* Adds a lobe over each of the bases. */
static WeftResult candidates_add(FitWork *work, const char *id, WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int k = 0; k < work->base_count && work->count < WEFT_FITTED_MOST && result == WEFT_OK; k++) {
        Candidate *candidate = &work->candidates[work->count++];
        candidate->base = work->bases[k];
        result = weft_lobe_init(id, &candidate->lobe, error);
    }
    return result;
}

/* Lists the candidates: of desc->only, of a weave's lobe, or of all but diffuse lobes and random-walk estimates. */
static WeftResult list_candidates(FitWork *work, WeftError *error) {
    const WeftFitDesc *desc = work->desc;
    WeftResult result = weft_lobe_init("lambert", &work->lambert, error);
    if (result == WEFT_OK) result = weft_lobe_init("ggx", &work->ggx, error);
    if (result == WEFT_OK) result = set_bases(work, desc->base ? desc->base : "body", error);
    WeftLobe only = {.lobe = -1};
    const char *id = work->weave && !desc->only ? weft_lobe_info(work->bases[0].lobe)->id : desc->only;
    if (result == WEFT_OK && id) result = weft_lobe_init(id, &only, error);
    if (result == WEFT_OK && work->weave && only.lobe != work->bases[0].lobe) {
        const char *base = weft_lobe_info(work->bases[0].lobe)->id;
        return fail(error, WEFT_MESSAGE_DESC, id, "base %s, which is the weft, goes with lobe %s, the warp", base,
                    base);
    }
    for (int k = 0; k < weft_lobe_count() && result == WEFT_OK; k++) {
        const WeftLobeInfo *info = weft_lobe_info(k);
        if (info->traits & (WEFT_LOBE_DIFFUSE | WEFT_LOBE_REFERENCE)) continue;
        if (only.lobe < 0 || only.lobe == k) result = candidates_add(work, info->id, error);
    }
    if (result != WEFT_OK) return result;
    return work->count ? WEFT_OK : fail(error, WEFT_MESSAGE_DESC, desc->only, "is diffuse, or known by its mean alone");
}

/* Orders candidates by their number of parameters, most first, since the largest fits take longest. */
static int by_param_count(const void *a, const void *b) {
    const Candidate *x = a, *y = b;
    int of_x = weft_lobe_info(x->lobe.lobe)->param_count + weft_lobe_info(x->base.lobe)->param_count;
    int of_y = weft_lobe_info(y->lobe.lobe)->param_count + weft_lobe_info(y->base.lobe)->param_count;
    if (of_x != of_y) return of_y - of_x;
    return x->lobe.lobe != y->lobe.lobe ? x->lobe.lobe - y->lobe.lobe : x->base.lobe - y->base.lobe;
}

/* Fits all items in parallel and ranks the candidates. */
static WeftResult work_run(FitWork *work, WeftFit *out, WeftError *error) {
    qsort(work->candidates, (size_t)work->count, sizeof *work->candidates, by_param_count);
    const WeftFitDesc *desc = work->desc;
    if (!watch_loop(&work->watch, desc->threads, work->count + 1, fit_one, work, desc->progress, desc->user))
        return WEFT_INTERRUPTED;
    WeftResult result = bases_alone(work, &out->base_alone);
    for (int k = 0; k <= work->count && result == WEFT_OK; k++) result = work->results[k];
    if (result != WEFT_OK) return fail(error, WEFT_MESSAGE_MEMORY, "a fit", NULL);
    out->baseline = work->fitted[work->count];
    out->count = work->count;
    memcpy(out->fitted, work->fitted, (size_t)work->count * sizeof *out->fitted);
    qsort(out->fitted, (size_t)out->count, sizeof *out->fitted, by_error);
    return WEFT_OK;
}

/* Makes samples of the data for the metric of desc, log or cosine. Release them with samples_free, even on failure. */
static WeftResult samples_of(const WeftData *data, const WeftFitDesc *desc, Samples *samples, WeftError *error) {
    WeftBrdfMetric metric = desc->chosen ? desc->metric : WEFT_BRDF_METRIC_LOG;
    *samples = (Samples){0};
    if (metric != WEFT_BRDF_METRIC_LOG && metric != WEFT_BRDF_METRIC_COSINE)
        return fail(error, WEFT_MESSAGE_DESC, "a fit", "its metric is log or cosine");
    return data_samples(data, metric, samples) ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, "a fit", NULL);
}

WeftResult weft_fit(const WeftData *data, const WeftFitDesc *desc, WeftFit *out, WeftError *error) {
    memset(out, 0, sizeof *out);
    FitWork *work = alloc_array(1, sizeof *work);
    if (!work) return fail(error, WEFT_MESSAGE_MEMORY, "a fit", NULL);
    work->desc = desc;
    work->isotropic = data_isotropic(data);
    WeftResult result = list_candidates(work, error);
    if (result == WEFT_OK) result = samples_of(data, desc, &work->samples, error);
    if (result == WEFT_OK && work->weave && (work->isotropic || !weave_search_sees(&work->samples)))
        result = fail(error, WEFT_MESSAGE_DESC, "woven over woven",
                      "the data are isotropic, or in one plane: they do not tell warp from weft");
    if (result == WEFT_OK) result = work_run(work, out, error);
    samples_free(&work->samples);
    free(work);
    return result;
}

WeftResult weft_fit_material(const WeftData *data, const WeftFitDesc *desc, WeftMaterial *material, WeftMatch *out,
                             WeftError *error) {
    Samples samples;
    *out = (WeftMatch){.copied = 0.0};
    WeftResult result = samples_of(data, desc, &samples, error);
    if (result == WEFT_OK) result = material_search_run(&samples, NULL, NULL, material, out, error);
    samples_free(&samples);
    return result;
}

WeftResult weft_data_distance(const WeftData *data, const WeftFitDesc *desc, const WeftReflection *reflection,
                              double *distance, WeftError *error) {
    Samples samples, other = {0};
    WeftResult result = samples_of(data, desc, &samples, error);
    *distance = 0.0;
    if (result == WEFT_OK && !samples_create(&other, samples.count, samples.metric))
        result = fail(error, WEFT_MESSAGE_MEMORY, "a fit", NULL);
    if (result == WEFT_OK) {
        samples_eval(&samples, reflection, WEFT_PART_ALL, other.x);
        *distance = samples_distance(&samples, samples.count, (const float *const *)other.x);
    }
    samples_free(&samples);
    samples_free(&other);
    return result;
}
