#include "weft/fit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/path.h"
#include "measure/brdf_table.h"
#include "measure/lobe_search.h"
#include "measure/merl.h"
#include "shading/choice.h"
#include "shading/registry.h"

struct WeftData {
    int count, all;
    bool isotropic;
    float (*wo)[3], (*wi)[3], (*f)[3];
};

/* The cosine of 80 degrees: what is lower grazes. */
static const float cosine_least = 0.17364818f;
enum { FILE_MOST = 1 << 28, SAMPLES_LEAST = 16 };

void weft_data_free(WeftData *self) {
    if (!self) return;
    free(self->wo);
    free(self->wi);
    free(self->f);
    free(self);
}

int weft_data_count(const WeftData *self, int *all) {
    if (all) *all = self->all;
    return self->count;
}

/* A step that meets every one of count before any for the second time. */
static size_t step_through(size_t count) {
    size_t step = (size_t)((double)count * 0.6180339887498949) | 1u;
    for (;; step++) {
        size_t a = count, b = step;
        while (b) {
            size_t rest = a % b;
            a = b;
            b = rest;
        }
        if (a <= 1) return step;
    }
}

static bool is_measured(const float f[3]) {
    return f[0] >= 0.0f && f[1] >= 0.0f && f[2] >= 0.0f && f[0] + f[1] + f[2] < 1e30f;
}

/* The skipped samples, and whether any other is above 0. */
typedef struct Passed {
    int unmeasured, grazing;
    bool any;
} Passed;

/* In an order in which any first part stands for all. */
static Passed take_samples(WeftData *self, const float (*wo)[3], const float (*wi)[3], const float (*f)[3]) {
    size_t n = (size_t)self->all, step = step_through(n), at = 0;
    Passed passed = {.any = false};
    for (size_t k = 0; k < n; k++, at = (at + step) % n) {
        bool measured = is_measured(f[at]), high = wo[at][2] >= cosine_least && wi[at][2] >= cosine_least;
        passed.unmeasured += !measured;
        passed.grazing += measured && !high;
        if (!measured || !high) continue;
        memcpy(self->wo[self->count], wo[at], sizeof *wo);
        memcpy(self->wi[self->count], wi[at], sizeof *wi);
        memcpy(self->f[self->count++], f[at], sizeof *f);
        passed.any |= f[at][0] + f[at][1] + f[at][2] > 0.0f;
    }
    return passed;
}

static WeftResult check_samples(const WeftData *self, const Passed *passed, const char *name,
                                WeftMessage message, WeftError *error) {
    if (self->all == 0) return fail(error, message, name, "nothing in it is a sample");
    if (self->count < SAMPLES_LEAST)
        return fail(
            error, message, name,
            "of %d samples %d were not measured and %d are more than 80 degrees off the normal, which leaves "
            "%d; %d are needed",
            self->all, passed->unmeasured, passed->grazing, self->count, SAMPLES_LEAST);
    if (!passed->any)
        return fail(
            error, message, name,
            "nothing in it is above 0, of %d samples; %d more were not measured, and %d are more than "
            "80 degrees off the normal",
            self->count, passed->unmeasured, passed->grazing);
    return WEFT_OK;
}

/* Makes data from a file of that name, or from a caller if message is DESC. */
static WeftResult data_make(int count, const float (*wo)[3], const float (*wi)[3], const float (*f)[3],
                            bool isotropic, const char *name, WeftMessage message, WeftData **out,
                            WeftError *error) {
    WeftData *self = alloc_array(1, sizeof *self);
    size_t n = (size_t)(count > 0 ? count : 0);
    if (self) {
        *self = (WeftData){.all = (int)n, .isotropic = isotropic};
        self->wo = alloc_array(n, sizeof *self->wo);
        self->wi = alloc_array(n, sizeof *self->wi);
        self->f = alloc_array(n, sizeof *self->f);
    }
    WeftResult result;
    if (self && self->wo && self->wi && self->f) {
        Passed passed = n ? take_samples(self, wo, wi, f) : (Passed){.any = false};
        result = check_samples(self, &passed, name, message, error);
    } else {
        result = fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    }
    if (result != WEFT_OK) {
        weft_data_free(self);
        self = NULL;
    }
    *out = self;
    return result;
}

WeftResult weft_data_create(int count, const float (*wo)[3], const float (*wi)[3], const float (*f)[3],
                            int isotropic, WeftData **out, WeftError *error) {
    return data_make(count, wo, wi, f, isotropic != 0, "samples", WEFT_MESSAGE_DESC, out, error);
}

/* The directions of a place in MERL's coordinates, turned about the normal by phi. Szymon Rusinkiewicz, "A
 * New Change of Variables for Efficient BRDF Representation", 1998. */
static void rusinkiewicz(double th, double td, double pd, double phi, float wo[3], float wi[3]) {
    double x = (sin)(td) * (cos)(pd), y = (sin)(td) * (sin)(pd), z = (cos)(td);
    double i[3] = {(cos)(th)*x + (sin)(th)*z, y, (cos)(th)*z - (sin)(th)*x};
    const double h[3] = {(sin)(th), 0.0, (cos)(th)};
    double o[3] = {2.0 * z * h[0] - i[0], 2.0 * z * h[1] - i[1], 2.0 * z * h[2] - i[2]};
    double c = (cos)(phi), s = (sin)(phi);
    wi[0] = (float)(c * i[0] - s * i[1]), wi[1] = (float)(s * i[0] + c * i[1]), wi[2] = (float)i[2];
    wo[0] = (float)(c * o[0] - s * o[1]), wo[1] = (float)(s * o[0] + c * o[1]), wo[2] = (float)o[2];
}

enum { SIDE_H = 24, SIDE_D = 24, SIDE_P = 12, MERL_SAMPLES = SIDE_H * SIDE_D * SIDE_P };

/* The middle of the bin that stands for cell k of n. */
static double middle(int k, int n, int bins, int *bin) {
    *bin = (int)((k + 0.5) * bins / n);
    return (*bin + 0.5) / bins;
}

/* Each pair is turned by another azimuth: f is the same, and what is not isotropic will not fit by chance. */
static void merl_samples(const Merl *merl, float (*wo)[3], float (*wi)[3], float (*f)[3]) {
    const double half_pi = 1.57079632679490;
    for (int k = 0; k < MERL_SAMPLES; k++) {
        int h, d, p;
        double root = middle(k / (SIDE_D * SIDE_P), SIDE_H, MERL_THETA_H, &h);
        double td = middle(k / SIDE_P % SIDE_D, SIDE_D, MERL_THETA_D, &d) * half_pi;
        double pd = middle(k % SIDE_P, SIDE_P, MERL_PHI_D, &p) * 2.0 * half_pi;
        size_t bin = ((size_t)h * MERL_THETA_D + (size_t)d) * MERL_PHI_D + (size_t)p;
        rusinkiewicz(root * root * half_pi, td, pd, 2.39996322972865 * k, wo[k], wi[k]);
        for (int c = 0; c < 3; c++) f[k][c] = merl->f[c][bin];
    }
}

static WeftResult data_of_merl(const Merl *merl, const char *name, WeftData **out, WeftError *error) {
    float(*block)[3] = alloc_array((size_t)3 * MERL_SAMPLES, sizeof *block);
    if (!block) return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    float(*wo)[3] = block, (*wi)[3] = block + MERL_SAMPLES, (*f)[3] = block + (size_t)2 * MERL_SAMPLES;
    merl_samples(merl, wo, wi, f);
    WeftResult result = data_make(MERL_SAMPLES, (const float(*)[3])wo, (const float(*)[3])wi,
                                  (const float(*)[3])f, true, name, WEFT_MESSAGE_MEASURED, out, error);
    free(block);
    return result;
}

WeftResult weft_data_read_memory(const void *data, size_t size, const char *name, WeftData **out,
                                 WeftError *error) {
    WeftResult result;
    *out = NULL;
    if (path_ends(name, ".binary")) {
        Merl merl;
        result = merl_read_memory(data, size, name, &merl, error);
        if (result == WEFT_OK) result = data_of_merl(&merl, name, out, error);
        merl_free(&merl);
        return result;
    }
    BrdfTable table;
    result = brdf_table_read(data, size, name, &table, error);
    if (result == WEFT_OK)
        result = data_make(table.count, (const float(*)[3])table.wo, (const float(*)[3])table.wi,
                           (const float(*)[3])table.f, false, name, WEFT_MESSAGE_BRDF_TABLE, out, error);
    brdf_table_free(&table);
    return result;
}

WeftResult weft_data_read(const char *path, WeftData **out, WeftError *error) {
    FileBytes bytes;
    *out = NULL;
    WeftResult result = file_read(path, FILE_MOST, &bytes, error);
    if (result != WEFT_OK) return result;
    result = weft_data_read_memory(bytes.data, bytes.size, path, out, error);
    free(bytes.data);
    return result;
}

/* The fit. */

typedef struct FitWork {
    const WeftFitDesc *desc;
    Samples samples;
    WeftLobe base, lambert, ggx;
    WeftLobe lobes[WEFT_FITTED_MOST];
    int count;
    WeftFitted fitted[WEFT_FITTED_MOST + 1]; /* the last is the baseline */
    WeftResult results[WEFT_FITTED_MOST + 1];
    bool isotropic;
    LoopWatch watch;
} FitWork;

static bool samples_make(FitWork *work, const WeftData *data, WeftBrdfMetric metric) {
    Samples *s = &work->samples;
    if (!samples_create(s, data->count, metric)) return false;
    for (int k = 0; k < data->count; k++) {
        s->weight[k] = 1.0f;
        for (int c = 0; c < 3; c++) {
            s->o[c][k] = data->wo[k][c];
            s->i[c][k] = data->wi[k][c];
            s->x[c][k] = data->f[k][c] * data->wi[k][2];
        }
    }
    s->first = data->count > 4000 ? data->count / 4 : data->count > 1000 ? 1000 : data->count;
    samples_finish(s);
    return true;
}

/* The lobes that deserve a search, the best first. */
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

/* The next of all that choices may be put together to; false after the last. */
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

/* Picks the terms that a lobe may be put together of: D, V and F. */
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

/* The best that a lobe can do, with its choices as they are or as others. */
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

/* Fits one item of work: the last is the baseline. */
static WeftResult fit_item(FitWork *work, int item, ItemProgress *item_progress) {
    WeftFitted *fitted = &work->fitted[item];
    LobeSearch search = {.samples = &work->samples,
                         .base = &work->base,
                         .isotropic = work->isotropic,
                         .item_progress = item_progress};
    LobeFound found = {.error = 0.0};
    if (item == work->count) {
        search.base = &work->lambert;
        search.hold = WEFT_HOLD_COLOR_2;
        found.lobe = work->ggx;
    } else {
        found.lobe = work->lobes[item];
    }
    WeftResult result = fit_lobe(&search, &found);
    *fitted = (WeftFitted){.lobe = found.lobe, .error = found.error, .evaluations = found.evaluations};
    memcpy(fitted->base, found.base, sizeof fitted->base);
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

static WeftResult base_alone(FitWork *work, double *error) {
    const LobeSearch search = {.samples = &work->samples, .base = &work->base, .hold = WEFT_HOLD_COLOR};
    LobeFound found = {.lobe = work->lambert};
    memset(found.lobe.f0, 0, sizeof found.lobe.f0);
    WeftResult result = lobe_search_run(&search, &found);
    *error = found.error;
    return result;
}

static int by_error(const void *a, const void *b) {
    const WeftFitted *x = a, *y = b;
    return (x->error > y->error) - (x->error < y->error);
}

static WeftResult candidates(FitWork *work, WeftError *error) {
    const WeftFitDesc *desc = work->desc;
    WeftResult result = weft_lobe_init(desc->base ? desc->base : "lambert", &work->base, error);
    if (result == WEFT_OK) result = weft_lobe_init("lambert", &work->lambert, error);
    if (result == WEFT_OK) result = weft_lobe_init("ggx", &work->ggx, error);
    WeftLobe only = {.lobe = -1};
    if (result == WEFT_OK && desc->only) result = weft_lobe_init(desc->only, &only, error);
    if (result != WEFT_OK) return result;
    if (!(weft_lobe_info(work->base.lobe)->traits & WEFT_LOBE_DIFFUSE))
        return fail(error, WEFT_MESSAGE_DESC, desc->base, "is no diffuse lobe");
    for (int k = 0; k < weft_lobe_count() && work->count < WEFT_FITTED_MOST && result == WEFT_OK; k++) {
        const WeftLobeInfo *info = weft_lobe_info(k);
        if (info->traits & (WEFT_LOBE_DIFFUSE | WEFT_LOBE_REFERENCE)) continue;
        if (only.lobe < 0 || only.lobe == k)
            result = weft_lobe_init(info->id, &work->lobes[work->count++], error);
    }
    if (result != WEFT_OK) return result;
    return work->count ? WEFT_OK
                       : fail(error, WEFT_MESSAGE_DESC, desc->only, "is diffuse, or known by its mean alone");
}

static int params_of(const WeftLobe *lobe) { return weft_lobe_info(lobe->lobe)->param_count; }

static WeftResult work_run(FitWork *work, WeftFit *out, WeftError *error) {
    /* those that take longest first */
    for (int k = 0; k < work->count; k++)
        for (int j = k; j > 0 && params_of(&work->lobes[j]) > params_of(&work->lobes[j - 1]); j--) {
            WeftLobe swapped = work->lobes[j];
            work->lobes[j] = work->lobes[j - 1];
            work->lobes[j - 1] = swapped;
        }
    const WeftFitDesc *desc = work->desc;
    if (!watch_loop(&work->watch, desc->threads, work->count + 1, fit_one, work, desc->progress, desc->user))
        return WEFT_INTERRUPTED;
    WeftResult result = base_alone(work, &out->base_alone);
    for (int k = 0; k <= work->count && result == WEFT_OK; k++) result = work->results[k];
    if (result != WEFT_OK) return fail(error, WEFT_MESSAGE_MEMORY, "a fit", NULL);
    out->baseline = work->fitted[work->count];
    out->count = work->count;
    memcpy(out->fitted, work->fitted, (size_t)work->count * sizeof *out->fitted);
    qsort(out->fitted, (size_t)out->count, sizeof *out->fitted, by_error);
    return WEFT_OK;
}

WeftResult weft_fit(const WeftData *data, const WeftFitDesc *desc, WeftFit *out, WeftError *error) {
    WeftBrdfMetric metric = desc->chosen ? desc->metric : WEFT_BRDF_METRIC_LOG;
    memset(out, 0, sizeof *out);
    if (metric != WEFT_BRDF_METRIC_LOG && metric != WEFT_BRDF_METRIC_COSINE)
        return fail(error, WEFT_MESSAGE_DESC, "a fit", "its metric is log or cosine");
    FitWork *work = alloc_array(1, sizeof *work);
    if (!work) return fail(error, WEFT_MESSAGE_MEMORY, "a fit", NULL);
    work->desc = desc;
    work->isotropic = data->isotropic;
    WeftResult result = candidates(work, error);
    if (result == WEFT_OK && !samples_make(work, data, metric))
        result = fail(error, WEFT_MESSAGE_MEMORY, "a fit", NULL);
    if (result == WEFT_OK) result = work_run(work, out, error);
    samples_free(&work->samples);
    free(work);
    return result;
}

unsigned weft_fitted_notes(const WeftFitted *fitted) {
    const WeftLobe *lobe = &fitted->lobe;
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    float most = 0.0f, base = 0.0f;
    unsigned notes = 0;
    for (int c = 0; c < 3; c++) {
        most = fmaxf(most, lobe->f0[c]);
        base = fmaxf(base, fitted->base[c]);
        if (info->traits & TRAIT_TWO_COLORS) most = fmaxf(most, lobe->f90[c]);
    }
    if (!(most > 1e-6f)) notes |= WEFT_FITTED_NOTHING;
    if (fmaxf(most, base) > 1.0f) notes |= WEFT_FITTED_BRIGHT;
    for (int k = 0; k < info->param_count; k++) {
        const WeftParamInfo *p = &info->params[k];
        float value = lobe->params[k], near = 1e-3f * (p->high - p->low);
        bool moved = value < p->def || value > p->def;
        if (!p->choices && moved && (value <= p->low + near || value >= p->high - near))
            notes |= WEFT_FITTED_EDGE;
    }
    return notes;
}

/* The material. */

/* The roughness of which a lobe makes that first parameter; it grows with it, or falls. */
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

static float param_or(const WeftLobe *lobe, const char *name, float none) {
    int k = weft_lobe_param_find(lobe->lobe, name);
    return k >= 0 ? lobe->params[k] : none;
}

static void input_set(WeftMaterial *material, InputId input, const float *values, int count) {
    memcpy(material->inputs[input].value, values, (size_t)count * sizeof *values);
    material->inputs[input].given = 1;
}

/* The terms of a lobe that is put together. */
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

int weft_fitted_material(const WeftFitted *fitted, const char *base, WeftMaterial *out) {
    const WeftLobe *lobe = &fitted->lobe;
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    float roughness = info->param_count > 0 ? roughness_of(lobe) : 0.0f;
    float density = param_or(lobe, "density", 1.0f), tilt = param_or(lobe, "tilt", 0.0f);
    float azimuth = param_or(lobe, "azimuth", 0.0f);
    Lobe said = lobe_fibres(lobe_rough(lobe->lobe, roughness), density, tilt, azimuth);
    bool same = true;
    for (int k = 0; k < info->param_count; k++)
        if (info->params[k].choices) said.params[k] = lobe->params[k]; /* as choices of the material */
    for (int k = 0; k < info->param_count; k++)
        same &= fabsf(said.params[k] - lobe->params[k]) <= 1e-4f * (fabsf(lobe->params[k]) + 1e-3f);
    for (int c = 0; c < 3; c++) same &= fitted->base[c] <= 1.0f && lobe->f0[c] <= 1000.0f;
    weft_material_default(out);
    weft_material_choose(out, CHOICE_workflow, choice_find(CHOICE_workflow, "cloth"));
    weft_material_choose(out, CHOICE_diffuse, choice_find(CHOICE_diffuse, base ? base : "lambert"));
    weft_material_choose(out, CHOICE_sheen_lobe, choice_find(CHOICE_sheen_lobe, info->id));
    weft_material_choose(out, CHOICE_layer, choice_find(CHOICE_layer, "additive"));
    choose_terms(lobe, out);
    input_set(out, INPUT_base_color, fitted->base, 3);
    input_set(out, INPUT_sheen_color, lobe->f0, 3);
    input_set(out, INPUT_sheen_second, lobe->f90, 3);
    input_set(out, INPUT_sheen_roughness, &roughness, 1);
    input_set(out, INPUT_sheen_density, &density, 1);
    input_set(out, INPUT_nap, &tilt, 1);
    input_set(out, INPUT_nap_direction, &azimuth, 1);
    return same;
}
