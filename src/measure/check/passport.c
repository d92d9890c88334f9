#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#include "measure/check/passport.h"

#include "base/fail.h"
#include "base/thread.h"
#include "measure/bsdf/exceeds.h"
#include "measure/check/chi_square.h"
#include "measure/check/furnace.h"
#include "measure/check/half_floor.h"
#include "measure/check/parity.h"
#include "measure/check/reciprocity.h"
#include "measure/check/sweep.h"
#include "measure/check/weight.h"
#include "shading/material/choice.h"
#include "weft/progress.h"

static const float cosines[WEFT_PASSPORT_COSINES] = {1.0f, 0.95f, 0.9f,  0.85f, 0.8f,  0.7f,   0.6f,
                                                     0.5f, 0.4f,  0.35f, 0.3f,  0.25f, 0.2f,   0.15f,
                                                     0.1f, 0.07f, 0.05f, 0.02f, 0.01f, 0.005f, 0.001f};
static const float views[WEFT_PASSPORT_VIEWS] = {1.0f, 0.7f, 0.4f, 0.15f, 0.05f};
static const float sheens[WEFT_PASSPORT_SHEENS] = {0.2f, 0.5f, 0.8f};

enum { CELLS = 200, WHOLE_CELLS = 100, FURNACE_CELLS = 100 };

/* State that the parallel loops share. Each writes to its own places; extremes are found afterwards, in
 * order, so that threads cannot change them. */
typedef struct PassportWork {
    const Bsdf *bsdf;
    const WeftPassportDesc *desc;
    WeftPassport *out;
    Bsdf *colored; /* the BSDF in a middle colour, if it is tinted; else NULL */
    atomic_bool short_of_memory;

    Reciprocity reciprocity[WEFT_PASSPORT_ROWS];
    ChiSquare chi[WEFT_PASSPORT_ROWS][WEFT_PASSPORT_VIEWS];
    double missed[WEFT_PASSPORT_ROWS][WEFT_PASSPORT_VIEWS];
    bool drawn[WEFT_PASSPORT_ROWS];
    AlbedoTable sheens[WEFT_PASSPORT_SHEENS];
    Sweep sweeps[WEFT_PASSPORT_ROWS + BSDF_EXTREMES];
} PassportWork;

/* ---- directional albedo ---- */

static void measure_albedo(void *user, int item, int thread) {
    (void)thread;
    PassportWork *work = user;
    int row = item / WEFT_PASSPORT_COSINES, c = item % WEFT_PASSPORT_COSINES;
    Dir o = grid_direction((double)cosines[c], 0.0);
    if (work->bsdf->whole) {
        BsdfView view;
        work->bsdf->prepare(work->bsdf, row, o, &view);
        work->out->albedo[row][c] = (float)weight_albedo(&view, WHOLE_CELLS);
        return;
    }
    Lobe lobe = bsdf_lobe(work->bsdf, row);
    if (work->colored) {
        float tinted[3];
        albedo_in_color(&lobe, o, (const float[3]){1.0f, work->colored->albedo, 0.0f}, 1e-4, tinted);
        work->out->albedo[row][c] = tinted[0];
        work->out->albedo_half[row][c] = tinted[1];
        return;
    }
    Albedo e = albedo_quadrature(&lobe, o, 1e-4);
    work->out->albedo[row][c] = e.f0 + e.f90 * lobe_second(&lobe, 1.0f, 1.0f);
}

static void find_albedo(PassportWork *work) {
    WeftPassport *out = work->out;
    memcpy(out->cosines, cosines, sizeof cosines);
    parallel_for(work->desc->threads, out->rows * WEFT_PASSPORT_COSINES, measure_albedo, work);
    for (int row = 0; row < out->rows; row++)
        for (int c = 0; c < WEFT_PASSPORT_COSINES; c++) {
            float e = out->albedo[row][c];
            out->albedo_above += !(e <= 1.001f);
            /* equal up to rounding is not more: else rounding would choose the place */
            if (row + c > 0 && !exceeds_or_nan((double)e, (double)out->albedo_most * 1.0002)) continue;
            out->albedo_most = e;
            out->albedo_place = (WeftPlace){.value = out->values[row], .cos_o = cosines[c]};
        }
}

/* ---- reciprocity ---- */

static void measure_reciprocity(void *user, int row, int thread) {
    (void)thread;
    PassportWork *work = user;
    int pairs = (work->bsdf->whole ? 4000 : 20000) / (work->desc->quick ? 4 : 1);
    Reciprocity *worst = &work->reciprocity[row];
    *worst = reciprocity_measure(work->bsdf, row, pairs);
    if (!work->colored) return;
    Reciprocity colored = reciprocity_measure(work->colored, row, pairs);
    if (exceeds_or_nan((double)colored.error, (double)worst->error)) *worst = colored;
}

static void find_reciprocity(PassportWork *work) {
    parallel_for(work->desc->threads, work->out->rows, measure_reciprocity, work);
    for (int row = 0; row < work->out->rows; row++) {
        const Reciprocity *r = &work->reciprocity[row];
        if (!exceeds_or_nan((double)r->error, (double)work->out->reciprocity)) continue;
        work->out->reciprocity = r->error;
        work->out->reciprocity_place = r->place;
    }
}

/* ---- the furnace ---- */

static void fill_sheen(void *user, int k, int thread) {
    (void)thread;
    PassportWork *work = user;
    Lobe lobe = work->bsdf->lobe, rough = lobe_rough(lobe.id, sheens[k]);
    lobe.params[0] = rough.params[0];
    albedo_table_fill(&work->sheens[k], &lobe, lobe.params[0], lobe.params[0], 1);
}

static void measure_furnace(void *user, int item, int thread) {
    (void)thread;
    PassportWork *work = user;
    int view = item % WEFT_PASSPORT_VIEWS, k = item / WEFT_PASSPORT_VIEWS % WEFT_PASSPORT_SHEENS;
    int layer = item / (WEFT_PASSPORT_VIEWS * WEFT_PASSPORT_SHEENS);
    double azimuth =
        lobe_depends_on_azimuth(&work->bsdf->lobe) ? 0.4 + view : 0.0; /* each from another side, as below */
    Dir o = grid_direction((double)views[view], azimuth);
    Furnace f = furnace_measure(&work->bsdf->lobe, sheens[k], layer, &work->sheens[k], o, FURNACE_CELLS,
                                work->desc->quick ? 10000 : 300000);
    work->out->furnace[layer][k][view] = (float)f.e;
    work->out->furnace_noise[layer][k][view] = (float)f.noise;
}

/* Which layer rules promise to conserve energy. */
#define LAYER_PROMISE(id, index, base, needs_wi, needs_average, conserves, by, help) [index] = conserves,
static const bool conserves[LAYER_COUNT] = {WEFT_LAYERS(LAYER_PROMISE)};

static void find_furnace(PassportWork *work) {
    if (work->bsdf->whole) return;
    memcpy(work->out->sheens, sheens, sizeof sheens);
    int layers = 0;
    while (layers < WEFT_PASSPORT_LAYERS && weft_layer_name(layers)) layers++;
    work->out->layers = layers;
    parallel_for(work->desc->threads, WEFT_PASSPORT_SHEENS, fill_sheen, work);
    parallel_for(work->desc->threads, layers * WEFT_PASSPORT_SHEENS * WEFT_PASSPORT_VIEWS, measure_furnace, work);
    for (int k = 0; k < layers * WEFT_PASSPORT_SHEENS * WEFT_PASSPORT_VIEWS; k++) {
        int view = k % WEFT_PASSPORT_VIEWS, sheen = k / WEFT_PASSPORT_VIEWS % WEFT_PASSPORT_SHEENS;
        int layer = k / (WEFT_PASSPORT_VIEWS * WEFT_PASSPORT_SHEENS);
        float e = work->out->furnace[layer][sheen][view] - 3.0f * work->out->furnace_noise[layer][sheen][view];
        if (conserves[layer] && exceeds_or_nan((double)e, (double)work->out->furnace_most)) work->out->furnace_most = e;
    }
}

/* ---- sampling ---- */

static void measure_sampling(void *user, int item, int thread) {
    (void)thread;
    PassportWork *work = user;
    const Bsdf *bsdf = work->bsdf;
    int row = item / WEFT_PASSPORT_VIEWS, v = item % WEFT_PASSPORT_VIEWS;
    BsdfView view;
    bsdf->prepare(bsdf, row, grid_direction((double)views[v], 0.4 + v), &view);
    Weight weight = weight_measure(&view, bsdf->whole ? WHOLE_CELLS : CELLS);
    work->out->variance[row][v] = (float)weight.own;
    work->out->variance_cosine[row][v] = (float)weight.by_cosine;
    work->missed[row][v] = weight.missed;
    if (!work->drawn[row]) return;
    int count = work->desc->quick ? 15000 : 60000;
    if (!chi_square_measure(&view, count, bsdf->whole ? 10 : 20, (uint32_t)item, &work->chi[row][v]))
        work->short_of_memory = true;
}

/* Returns own / by_cosine of a row, both at least 1e-3: a variance of 1e-3 is a deviation of 3 % a sample. */
static double row_ratio(const WeftPassport *out, int row) {
    double own = 0.0, by_cosine = 0.0;
    for (int v = 0; v < WEFT_PASSPORT_VIEWS; v++) {
        own += (double)out->variance[row][v] / WEFT_PASSPORT_VIEWS;
        by_cosine += (double)out->variance_cosine[row][v] / WEFT_PASSPORT_VIEWS;
    }
    return (own + 1e-3) / (by_cosine + 1e-3);
}

static void find_sampling(PassportWork *work) {
    const Bsdf *bsdf = work->bsdf;
    WeftPassport *out = work->out;
    memcpy(out->views, views, sizeof views);
    for (int row = 0; row < out->rows; row++) /* materials take long: only the ends and the default */
        work->drawn[row] =
            !work->desc->brief && (!bsdf->whole || row == 0 || row == bsdf->row_default || row == out->rows - 1);
    parallel_for(work->desc->threads, out->rows * WEFT_PASSPORT_VIEWS, measure_sampling, work);
    out->p = 1.0;
    for (int row = 0; row < out->rows; row++) {
        double ratio = row_ratio(out, row);
        if (exceeds_or_nan(ratio, (double)out->variance_worst * 1.0002)) {
            out->variance_worst = (float)ratio;
            out->variance_value = out->values[row];
        }
        if (row == bsdf->row_default) out->variance_ratio = (float)ratio;
        for (int v = 0; v < WEFT_PASSPORT_VIEWS; v++) {
            WeftPlace place = {.value = out->values[row], .cos_o = views[v]};
            if (exceeds_or_nan(work->missed[row][v], (double)out->missed * 1.0002)) {
                out->missed = (float)work->missed[row][v];
                out->missed_place = place;
            }
            if (!work->drawn[row]) continue;
            const ChiSquare *chi = &work->chi[row][v];
            out->tests++;
            out->stray += chi->stray;
            if (exceeds_or_nan(chi->integral, (double)out->pdf_most * 1.0002)) {
                out->pdf_most = (float)chi->integral;
                out->pdf_place = place;
            }
            if (!(chi->p >= out->p)) {
                out->p = chi->p;
                out->p_place = place;
            }
        }
    }
}

/* ---- the sweep ---- */

static void measure_sweep(void *user, int setting, int thread) {
    (void)thread;
    PassportWork *work = user;
    Sweep *sweep = &work->sweeps[setting];
    *sweep = sweep_setting(work->bsdf, setting);
    if (!work->colored) return;
    Sweep colored = sweep_setting(work->colored, setting);
    sweep->count += colored.count;
    sweep->infinite += colored.infinite;
    sweep->negative += colored.negative;
    sweep->below += colored.below;
}

static void find_sweep(PassportWork *work) {
    WeftPassport *out = work->out;
    parallel_for(work->desc->threads, work->bsdf->settings, measure_sweep, work);
    for (int k = 0; k < work->bsdf->settings; k++) {
        out->sweep_count += work->sweeps[k].count;
        out->sweep_infinite += work->sweeps[k].infinite;
        out->sweep_negative += work->sweeps[k].negative;
        out->sweep_below += work->sweeps[k].below;
    }
}

/* Copies a tinted BSDF with an albedo of 0.5. Returns false if memory is short. */
static bool color_tinted(PassportWork *work) {
    const Bsdf *bsdf = work->bsdf;
    if (bsdf->whole || !(weft_lobe_info(bsdf->lobe.id)->traits & TRAIT_TINTED)) return true;
    work->colored = malloc(sizeof *work->colored);
    if (!work->colored) return false;
    *work->colored = *bsdf;
    work->colored->albedo = 0.5f;
    return true;
}

bool passport_measure(const Bsdf *bsdf, const WeftPassportDesc *desc, WeftPassport *out) {
    PassportWork *work = calloc(1, sizeof *work);
    if (!work) return false;
    work->bsdf = bsdf;
    work->desc = desc;
    work->out = out;
    if (!color_tinted(work)) {
        free(work);
        return false;
    }
    out->rows = bsdf->rows;
    out->row_default = bsdf->row_default;
    memcpy(out->values, bsdf->values, sizeof out->values);
    snprintf(out->parameter, sizeof out->parameter, "%s", bsdf->parameter);
    find_albedo(work);
    find_reciprocity(work);
    if (!desc->brief) find_furnace(work);
    find_sampling(work);
    if (!desc->brief) find_sweep(work);
    half_floor_measure(bsdf, out, desc->threads);
    if (desc->no_gpu || desc->brief)
        snprintf(out->parity_words, sizeof out->parity_words, "skipped (--no-gpu)");
    else
        parity_measure(bsdf, out);
    bool done = !work->short_of_memory;
    free(work->colored);
    free(work);
    return done;
}

WeftResult weft_passport_measure(const WeftPassportDesc *desc, WeftPassport *out, WeftError *error) {
    const bool woven = desc->material && desc->cloth;
    const WeftLobe *given = woven ? NULL : desc->lobe;
    int lobe = given ? given->lobe : desc->id && !woven ? weft_lobe_find(desc->id) : -1;
    int profile = !given && !woven && lobe < 0 && desc->id ? choice_find(CHOICE_profile, desc->id) : -1;
    if (given ? !weft_lobe_info(lobe) : lobe < 0 && profile < 0 && !woven)
        return fail(error, WEFT_MESSAGE_CHECK_NAME, desc->id ? desc->id : "index", NULL);
    if (desc->threads < 0 || desc->threads > WEFT_THREADS_MAX)
        return fail(error, WEFT_MESSAGE_DESC, "threads", "%d", desc->threads);
    *out = (WeftPassport){.profile = woven || profile >= 0, .woven = woven};
    snprintf(out->id, sizeof out->id, "%s",
             woven          ? (desc->id ? desc->id : "weave")
             : profile >= 0 ? weft_profile_name(profile)
                            : weft_lobe_info(lobe)->id);
    Bsdf *bsdf = calloc(1, sizeof *bsdf);
    bool done = bsdf != NULL;
    if (done && woven) {
        done = bsdf_of_weave(bsdf, desc->material, desc->cloth, desc->threads);
        snprintf(out->surface, sizeof out->surface, "a woven material from afar, in its own colours");
    } else if (done && profile >= 0) {
        done = bsdf_of_profile(bsdf, profile, desc->quick != 0, desc->threads);
        snprintf(out->surface, sizeof out->surface, "%s", bsdf_velvet);
    } else if (done) {
        Lobe inner = lobe_default(lobe);
        if (given) lobe_of(given, &inner);
        out->traits = weft_lobe_info(lobe)->traits;
        bsdf_of_lobe(bsdf, &inner, desc->quick != 0);
    }
    done = done && passport_measure(bsdf, desc, out);
    if (bsdf) bsdf_free(bsdf);
    free(bsdf);
    return done ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, out->id, NULL);
}

double weft_passport_significance(double p, int tests) { return -expm1(tests * log1p(-fmin(fmax(p, 0.0), 1.0))); }
