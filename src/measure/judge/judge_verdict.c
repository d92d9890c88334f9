/* judge_verdict.c - pictures beside the reference, and beside what each cause would give */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/memory.h"
#include "measure/judge/judge.h"

/* A picture as means over the cells. */
typedef struct JudgeCase {
    const WeftJudgePicture *picture;
    WeftVerdict *verdict;
    CellMean *found, *expected; /* of the picture and of the reference as shown; owned */
    CellMean *noise;            /* squared standard errors of `expected`; owned */
    CellMean *scales;           /* of the squared difference of each cell and channel, without that of v; owned */
    double faint;               /* 0.01 M of weft/judge.h: less is as good as black */
    double *errors;             /* of the reference: over all, then of each object; owned */
    double *best;               /* least error of each object by a cause; owned */
} JudgeCase;

typedef struct Trial {
    WeftJudge *judge;
    JudgeCase *cases;
    int count;
    CellMean *given; /* means of what a cause gives; owned */
    double *errors;  /* over all, then of each object; owned */
    WeftProgress progress;
    void *user;
    double begun, part; /* share of the work done before this rendering, and of it */
} Trial;

WeftResult judge_linear(const WeftJudgePicture *picture, WeftImage *out, WeftError *error) {
    return weft_image_convert_f32(picture->image, !picture->linear_integers, out, error);
}

/* Limits values to 0 .. 1, as a file of integers does. */
static void clamp_values(WeftImage *image) {
    float *values = image->pixels;
    const size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t k = 0; k < count; k++) values[k] = fminf(fmaxf(values[k], 0.0f), 1.0f);
}

WeftResult judge_show(const WeftJudgePicture *picture, const WeftImage *linear, WeftImage *out, WeftError *error) {
    WeftImage shown;
    const bool integers = picture->image->type != WEFT_PIXEL_F32;
    if (!integers || picture->linear_integers) {
        WeftResult result = weft_image_convert_f32(linear, 0, out, error);
        if (result == WEFT_OK && integers) clamp_values(out);
        return result;
    }
    WeftResult result = weft_image_show(linear, &picture->tone, NULL, &shown, error);
    if (result != WEFT_OK) return result;
    result = weft_image_convert_f32(&shown, 1, out, error);
    weft_image_free(&shown);
    return result;
}

/* Fills the means over the cells of a linear picture as `picture` would show it. */
static WeftResult shown_cells(const WeftJudge *judge, const WeftJudgePicture *picture, const WeftImage *linear,
                              CellMean *means, WeftError *error) {
    WeftImage shown;
    WeftResult result = judge_show(picture, linear, &shown, error);
    if (result != WEFT_OK) return result;
    judge_cells(judge, &shown, means);
    weft_image_free(&shown);
    return WEFT_OK;
}

static double mean3(const double value[JUDGE_CHANNELS]) { return (value[0] + value[1] + value[2]) / 3.0; }

/* Fills the noise of the reference as it is shown, which has the slope of what shows it, and what is faint. */
static WeftResult measure_noise(const WeftJudge *judge, JudgeCase *c, WeftError *error) {
    double sum = 0.0, pixels = 0.0;
    CellMean *linear = alloc_array((size_t)judge->cell_count, sizeof(CellMean));
    if (!linear) return fail(error, WEFT_MESSAGE_MEMORY, "a picture to judge", NULL);
    judge_cells(judge, &judge->reference, linear);
    for (int k = 0; k < judge->cell_count; k++) {
        sum += mean3(c->expected[k].c) * judge->cells[k].pixels;
        pixels += judge->cells[k].pixels;
        for (int i = 0; i < JUDGE_CHANNELS; i++) {
            const double slope = linear[k].c[i] > 0.0 ? c->expected[k].c[i] / linear[k].c[i] : 1.0;
            c->noise[k].c[i] = judge->noise[k].c[i] * slope * slope;
        }
    }
    c->faint = 0.01 * sum / pixels;
    free(linear);
    return WEFT_OK;
}

/* Fills what the error divides by, as weft/judge.h has it, without the square of the other means. */
static void scale(const WeftJudge *judge, JudgeCase *c) {
    for (int object = 0; object < judge->object_count; object++) {
        double value[JUDGE_CHANNELS];
        judge_object_mean(judge, object, c->expected, value);
        const double m = 0.1 * mean3(value), least = m * m + c->faint * c->faint + 1e-12;
        for (int k = 0; k < judge->cell_count; k++)
            for (int i = 0; i < JUDGE_CHANNELS && judge->cells[k].object == object; i++) {
                const double p = c->found[k].c[i];
                c->scales[k].c[i] = p * p + least + 100.0 * c->noise[k].c[i];
            }
    }
}

/* Fills the errors of other means: over all, then of each object. */
static void measure_errors(const WeftJudge *judge, const JudgeCase *c, const CellMean *means, double *errors) {
    for (int k = 0; k <= judge->object_count; k++) errors[k] = 0.0;
    for (int k = 0; k < judge->cell_count; k++)
        for (int i = 0; i < JUDGE_CHANNELS; i++) {
            const double v = means[k].c[i], off = c->found[k].c[i] - v;
            const double error = judge->cells[k].pixels * (off * off - c->noise[k].c[i]) / (c->scales[k].c[i] + v * v);
            errors[0] += error;
            errors[1 + judge->cells[k].object] += error;
        }
    for (int k = 0; k <= judge->object_count; k++) errors[k] = fmax(errors[k], 0.0);
}

/* Returns the root of the mean squared difference over an object's cells, and sets *noise to that of noise. */
static double spread_of(const WeftJudge *judge, const JudgeCase *c, int object, double *noise) {
    const double count = JUDGE_CHANNELS * (double)judge->objects[object].pixels;
    double sum = 0.0, noisy = 0.0;
    for (int k = 0; k < judge->cell_count; k++)
        for (int i = 0; i < JUDGE_CHANNELS && judge->cells[k].object == object; i++) {
            const double off = c->found[k].c[i] - c->expected[k].c[i];
            sum += off * off * judge->cells[k].pixels;
            noisy += c->noise[k].c[i] * judge->cells[k].pixels;
        }
    *noise = sqrt(noisy / count);
    return sqrt(sum / count);
}

/* Compares an object's means and decides whether it fails. */
static void judge_object(const WeftJudge *judge, const JudgeCase *c, int object) {
    WeftVerdictObject *out = &c->verdict->objects[object];
    double found[JUDGE_CHANNELS], expected[JUDGE_CHANNELS], largest = 0.0, noisy;
    judge_object_mean(judge, object, c->found, found);
    judge_object_mean(judge, object, c->expected, expected);
    for (int k = 0; k < JUDGE_CHANNELS; k++) largest = fmax(largest, expected[k]);
    *out = (WeftVerdictObject){.cause = {.cause = -1}};
    const double spread = spread_of(judge, c, object, &noisy), least = fmax(0.1 * largest, c->faint);
    const double unit = fmax(mean3(expected), fmax(c->faint, 1e-12));
    out->spread = spread / unit;
    out->failed = !(spread <= judge->desc.spread * unit + 3.0 * noisy); /* of no number too */
    for (int k = 0; k < JUDGE_CHANNELS; k++) {
        const double off = found[k] - expected[k], noise = (double)judge->objects[object].noise[k];
        out->value[k] = (float)found[k];
        out->expected[k] = (float)expected[k];
        out->off[k] = (float)off;
        if (!(fabs(off) <= judge->desc.tolerance * fmax(expected[k], least) + 3.0 * noise)) out->failed = 1;
    }
}

/* Returns true if a case has all its arrays. */
static bool has_arrays(const JudgeCase *c) {
    return c->found && c->expected && c->noise && c->scales && c->errors && c->best && c->verdict->objects &&
           c->verdict->causes;
}

static WeftResult case_begin(const WeftJudge *judge, JudgeCase *c, WeftError *error) {
    WeftImage linear;
    const size_t cells = (size_t)judge->cell_count, objects = (size_t)judge->object_count;
    const WeftImage *image = c->picture->image;
    if (image->width != judge->reference.width || image->height != judge->reference.height)
        return fail(error, WEFT_MESSAGE_DESC, "picture", "is %d x %d pixels, but the reference %d x %d", image->width,
                    image->height, judge->reference.width, judge->reference.height);
    c->found = alloc_array(cells, sizeof(CellMean));
    c->expected = alloc_array(cells, sizeof(CellMean));
    c->noise = alloc_array(cells, sizeof(CellMean));
    c->scales = alloc_array(cells, sizeof(CellMean));
    c->errors = alloc_array(objects + 1, sizeof(double));
    c->best = alloc_array(objects, sizeof(double));
    c->verdict->objects = alloc_array(objects, sizeof(WeftVerdictObject));
    c->verdict->causes = alloc_array((size_t)judge_cause_count(), sizeof(WeftCauseShare));
    if (!has_arrays(c)) return fail(error, WEFT_MESSAGE_MEMORY, "a picture to judge", NULL);
    c->verdict->object_count = judge->object_count;
    WeftResult result = judge_linear(c->picture, &linear, error);
    if (result != WEFT_OK) return result;
    judge_cells(judge, &linear, c->found);
    weft_image_free(&linear);
    result = shown_cells(judge, c->picture, &judge->reference, c->expected, error);
    return result == WEFT_OK ? measure_noise(judge, c, error) : result;
}

/* Compares a picture with the reference. */
static void case_compare(const WeftJudge *judge, JudgeCase *c) {
    scale(judge, c);
    measure_errors(judge, c, c->expected, c->errors);
    for (int k = 0; k < judge->object_count; k++) {
        judge_object(judge, c, k);
        c->verdict->failed += c->verdict->objects[k].failed;
        c->best[k] = c->errors[1 + k];
    }
}

/* Returns the share of an error that another one leaves out. */
static double share_of(double error, double other) { return error > 0.0 ? 1.0 - other / error : 0.0; }

/* Returns the share by which causes are ranked: one with a number that is fitted to the picture must be better by 1 %
 * than one without. */
static double rank_of(WeftCauseShare share) { return share.share - (judge_cause_is_fitted(share.cause) ? 0.01 : 0.0); }

/* Notes how close a cause comes, in its place among those before, the best first. */
static void note(const Trial *trial, JudgeCase *c, int cause) {
    WeftVerdict *verdict = c->verdict;
    const WeftCauseShare found = {cause, share_of(c->errors[0], trial->errors[0])};
    int place = verdict->cause_count++;
    for (; place > 0 && rank_of(verdict->causes[place - 1]) < rank_of(found); place--)
        verdict->causes[place] = verdict->causes[place - 1];
    verdict->causes[place] = found;
    for (int k = 0; k < verdict->object_count; k++) {
        if (!verdict->objects[k].failed || !(trial->errors[1 + k] < c->best[k])) continue;
        c->best[k] = trial->errors[1 + k];
        verdict->objects[k].cause = (WeftCauseShare){cause, share_of(c->errors[1 + k], c->best[k])};
    }
}

static int heed(void *user, double fraction) {
    const Trial *trial = user;
    return trial->progress ? trial->progress(trial->user, trial->begun + trial->part * fraction) : 0;
}

/* Tries one cause on all pictures that fail. */
static WeftResult try_cause(Trial *trial, int cause, const SceneKept *kept, WeftError *error) {
    WeftJudge *judge = trial->judge;
    WeftImage linear = {0};
    bool made = false;
    WeftResult result = WEFT_OK;
    const bool values = judge_cause_is_of_values(cause);
    if (!values) result = judge_cause_render(judge, cause, kept, heed, trial, &linear, &made, error);
    for (int k = 0; k < trial->count && result == WEFT_OK && (made || values); k++) {
        JudgeCase *c = &trial->cases[k];
        if (!c->verdict->failed) continue;
        if (values)
            judge_cause_values(judge, cause, c->found, c->expected, c->scales, trial->given);
        else
            result = shown_cells(judge, c->picture, &linear, trial->given, error);
        measure_errors(judge, c, trial->given, trial->errors);
        if (result == WEFT_OK) note(trial, c, cause);
    }
    weft_image_free(&linear);
    return result;
}

static WeftResult try_causes(Trial *trial, WeftError *error) {
    SceneKept kept;
    const int count = judge_cause_count();
    trial->given = alloc_array((size_t)trial->judge->cell_count, sizeof(CellMean));
    trial->errors = alloc_array((size_t)trial->judge->object_count + 1, sizeof(double));
    WeftResult result = scene_keep(trial->judge->scene, &kept, error);
    if (result == WEFT_OK && (!trial->given || !trial->errors))
        result = fail(error, WEFT_MESSAGE_MEMORY, "a picture to judge", NULL);
    for (int k = 0; k < count && result == WEFT_OK && trial->given && trial->errors; k++) {
        trial->begun = (double)k / count;
        trial->part = 1.0 / count;
        result = try_cause(trial, k, &kept, error);
    }
    scene_kept_free(&kept);
    return result;
}

static WeftResult judge_cases(Trial *trial, WeftError *error) {
    WeftResult result = WEFT_OK;
    int failed = 0;
    for (int k = 0; k < trial->count && result == WEFT_OK; k++) {
        result = case_begin(trial->judge, &trial->cases[k], error);
        if (result == WEFT_OK && has_arrays(&trial->cases[k])) case_compare(trial->judge, &trial->cases[k]);
        failed += trial->cases[k].verdict->failed;
    }
    if (result == WEFT_OK && failed) result = try_causes(trial, error);
    for (int k = 0; k < trial->count; k++) {
        WeftVerdict *verdict = trial->cases[k].verdict;
        verdict->explained = verdict->cause_count && verdict->causes[0].share >= trial->judge->desc.explained;
    }
    return result;
}

static void case_free(JudgeCase *c) {
    free(c->found);
    free(c->expected);
    free(c->noise);
    free(c->scales);
    free(c->errors);
    free(c->best);
}

WeftResult weft_judge_pictures(WeftJudge *judge, const WeftJudgePicture *pictures, int count, WeftProgress progress,
                               void *user, WeftVerdict *verdicts, WeftError *error) {
    for (int k = 0; k < count; k++) verdicts[k] = (WeftVerdict){0};
    Trial trial = {.judge = judge, .count = count, .progress = progress, .user = user};
    trial.cases = alloc_array((size_t)count, sizeof(JudgeCase));
    if (!trial.cases) return fail(error, WEFT_MESSAGE_MEMORY, "pictures to judge", NULL);
    for (int k = 0; k < count; k++) trial.cases[k] = (JudgeCase){.picture = &pictures[k], .verdict = &verdicts[k]};
    WeftResult result = judge_cases(&trial, error);
    for (int k = 0; k < count; k++) {
        case_free(&trial.cases[k]);
        if (result != WEFT_OK) weft_verdict_free(&verdicts[k]);
    }
    free(trial.cases);
    free(trial.given);
    free(trial.errors);
    return result;
}

void weft_verdict_free(WeftVerdict *verdict) {
    if (!verdict) return;
    free(verdict->objects);
    free(verdict->causes);
    *verdict = (WeftVerdict){0};
}
