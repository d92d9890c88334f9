#include "measure/match/match.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/memory.h"
#include "measure/bsdf/reflection.h"
#include "measure/fit/lobe_search.h"
#include "measure/fit/material_search.h"

/* Refuses lobe `id`, which is evaluated by random walks. Only fibre-walk is. */
static WeftResult walks_refused(const char *id, WeftError *error) {
    return fail(error, WEFT_MESSAGE_DESC, id, "is an estimate by random walks; match fibre, which is its mean");
}

static WeftResult short_of_memory(WeftError *error) { return fail(error, WEFT_MESSAGE_MEMORY, "a match", NULL); }

/* Chooses the directions that a metric compares, and evaluates `from` in them. */
static WeftResult samples_from(Samples *samples, const WeftReflection *from, int part, WeftBrdfMetric metric,
                               WeftError *error) {
    char number[16];
    snprintf(number, sizeof number, "%d", (int)metric);
    *samples = (Samples){0};
    if (!weft_brdf_metric_name(metric)) return fail(error, WEFT_MESSAGE_DESC, number, NULL);
    if (!samples_spread(samples, metric)) return short_of_memory(error);
    samples_eval(samples, from, part, samples->x);
    samples_finish(samples);
    return WEFT_OK;
}

static WeftResult distance_of(const Samples *samples, const WeftReflection *to, int part, double *distance,
                              WeftError *error) {
    Samples other;
    bool made = samples_create(&other, samples->count, samples->metric);
    if (made) {
        samples_eval(samples, to, part, other.x);
        *distance = samples_distance(samples, samples->count, (const float *const *)other.x);
    }
    samples_free(&other);
    return made ? WEFT_OK : short_of_memory(error);
}

WeftResult weft_brdf_distance(const WeftReflection *to, const WeftReflection *from, int part, WeftBrdfMetric metric,
                              double *distance, WeftError *error) {
    Samples samples;
    *distance = 0.0;
    WeftResult result = samples_from(&samples, from, part, metric, error);
    if (result == WEFT_OK) result = distance_of(&samples, to, part, distance, error);
    samples_free(&samples);
    return result;
}

/* Sets *distance to that of a lobe with its present parameters. */
static WeftResult lobe_distance(const Samples *samples, const WeftLobe *lobe, double *distance, WeftError *error) {
    WeftReflection *to;
    WeftResult result = weft_reflection_of_lobe(lobe, &to, error);
    if (result == WEFT_OK) result = distance_of(samples, to, WEFT_PART_ALL, distance, error);
    weft_reflection_free(to);
    return result;
}

/* Searches for parameters; the lobe stays as it is unless they bring it nearer. hold: as in weft_match_lobe. */
static WeftResult search_lobe(const Samples *samples, const WeftReflection *from, unsigned hold,
                              ItemProgress *item_progress, WeftLobe *lobe, WeftMatch *out, WeftError *error) {
    const LobeSearch search = {.samples = samples,
                               .hold = hold,
                               .isotropic = samples_isotropic(samples, from),
                               .item_progress = item_progress};
    LobeFound found = {.lobe = *lobe};
    double reached = 0.0; /* distance of what was found, measured as `copied` is */
    WeftResult result = lobe_distance(samples, lobe, &out->copied, error);
    out->matched = out->copied;
    if (result != WEFT_OK || out->copied < 1e-7) return result;
    result = lobe_search_run(&search, &found);
    if (result != WEFT_OK) return result == WEFT_RESOURCES ? short_of_memory(error) : result;
    out->evaluations = found.evaluations;
    result = lobe_distance(samples, &found.lobe, &reached, error);
    if (result != WEFT_OK || !(reached < out->copied)) return result;
    out->matched = reached;
    *lobe = found.lobe;
    return WEFT_OK;
}

static WeftResult match_lobe(const WeftReflection *from, WeftBrdfMetric metric, unsigned hold,
                             ItemProgress *item_progress, WeftLobe *lobe, WeftMatch *out, WeftError *error) {
    Samples samples;
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    char number[16];
    *out = (WeftMatch){.copied = 0.0};
    snprintf(number, sizeof number, "%d", lobe->lobe);
    if (!info) return fail(error, WEFT_MESSAGE_LOBE_NAME, number, NULL);
    if (info->traits & WEFT_LOBE_REFERENCE) return walks_refused(info->id, error);
    if (reflection_walks(from)) return walks_refused(reflection_walks(from), error);
    WeftResult result = samples_from(&samples, from, WEFT_PART_ALL, metric, error);
    if (result == WEFT_OK) result = search_lobe(&samples, from, hold, item_progress, lobe, out, error);
    samples_free(&samples);
    return result;
}

WeftResult weft_match_lobe(const WeftReflection *from, WeftBrdfMetric metric, unsigned hold, WeftLobe *lobe,
                           WeftMatch *out, WeftError *error) {
    return match_lobe(from, metric, hold, NULL, lobe, out, error);
}

/* Works as search_lobe, for a material. */
static WeftResult search_material(const Samples *samples, const int *locked, ItemProgress *item_progress,
                                  WeftMaterial *material, WeftMatch *out, WeftError *error) {
    WeftReflection *copy;
    WeftMaterial changed = *material;
    WeftMatch found = {.copied = 0.0};
    WeftResult result = weft_reflection_create(material, &copy, error);
    if (result == WEFT_OK && reflection_walks(copy)) result = walks_refused(reflection_walks(copy), error);
    if (result == WEFT_OK) result = distance_of(samples, copy, WEFT_PART_ALL, &out->copied, error);
    weft_reflection_free(copy);
    out->matched = out->copied;
    if (result != WEFT_OK || out->copied < 1e-7) return result;
    result = material_search_run(samples, locked, item_progress, &changed, &found, error);
    out->evaluations = found.evaluations;
    if (result != WEFT_OK || !(found.matched < out->copied)) return result;
    out->matched = found.matched;
    *material = changed;
    return WEFT_OK;
}

WeftResult match_material(const WeftReflection *from, WeftBrdfMetric metric, const int *locked,
                          ItemProgress *item_progress, WeftMaterial *material, WeftMatch *out, WeftError *error) {
    Samples samples;
    *out = (WeftMatch){.copied = 0.0};
    if (reflection_walks(from)) return walks_refused(reflection_walks(from), error);
    WeftResult result = samples_from(&samples, from, WEFT_PART_ALL, metric, error);
    if (result == WEFT_OK) result = search_material(&samples, locked, item_progress, material, out, error);
    samples_free(&samples);
    return result;
}

WeftResult weft_match_material(const WeftReflection *from, WeftBrdfMetric metric, const int *held,
                               WeftMaterial *material, WeftMatch *out, WeftError *error) {
    return match_material(from, metric, held, NULL, material, out, error);
}

/* The jobs of weft_match_many, each of which is one item of a loop. */
typedef struct Batch {
    WeftMatchJob *jobs;
    WeftBrdfMetric metric;
    LoopWatch watch;
    WeftError *errors;
} Batch;

static void job_run(void *user, int item, int thread) {
    (void)thread;
    Batch *batch = user;
    WeftMatchJob *job = &batch->jobs[item];
    ItemProgress item_progress = {.watch = &batch->watch};
    WeftError *error = &batch->errors[item];
    job->result = WEFT_INTERRUPTED;
    if (!progress_report(&item_progress, 0.0)) return;
    job->result =
        job->is_lobe
            ? match_lobe(job->from, batch->metric, job->hold, &item_progress, &job->lobe, &job->found, error)
            : match_material(job->from, batch->metric, job->held, &item_progress, &job->material, &job->found, error);
    progress_report(&item_progress, 1.0);
}

WeftResult weft_match_many(WeftMatchJob *jobs, int count, WeftBrdfMetric metric, int threads, WeftProgress progress,
                           void *user, WeftError *error) {
    Batch batch = {.jobs = jobs, .metric = metric};
    batch.errors = alloc_array((size_t)count, sizeof *batch.errors);
    if (!batch.errors) return short_of_memory(error);
    bool whole = watch_loop(&batch.watch, threads, count, job_run, &batch, progress, user);
    WeftResult result = whole ? WEFT_OK : WEFT_INTERRUPTED;
    for (int k = 0; k < count && result == WEFT_OK; k++)
        if (jobs[k].result != WEFT_OK) {
            result = jobs[k].result;
            if (error) *error = batch.errors[k];
        }
    free(batch.errors);
    return result;
}
