/* woven_fit.c - what lobe woven of a system does not know of yarns between others, fitted to points of its threads
 *
 *   wide = r (1 - narrow x^2),  middle = lean s_y,  gain = g_k that of an arc
 *
 * of bin k, about x. Others go over both ends of what is seen of a yarn, which is a lens; in a twill more over one corner
 * than over the other, so that it leans; and there is more or less of each slope than of an arc. Alpha, crimp, roundness
 * and floats of the lobe, narrow and lean make a shape, which is fitted in turn with the gains g_k: the light of each bin is a
 * term of a sum, so that gains cost no look at the lobe. The slopes by which yarns hide each other are those of points. */
#include "weave/woven_fit.h"

#include <string.h>

#include <nlopt.h>

enum {
    SHAPE_NUMBERS = 6,
    LOOKS_MOST = 600, /* at what a shape reflects, or a sum of bins */
    FIT_ROUNDS = 2,
};

PAIRS_LOOP(woven, Woven)

typedef struct Fit {
    const Weave *weave;
    bool weft;
    WeaveFar *far;
    const Lit *near;
    Lit lobe;
    float narrow, lean, gains[WOVEN_BINS];
} Fit;

/* The lobe, with bins no wider than the steepest roundness. */
#define BIN_PLACE(name) &p->name,
static void prepare(const Fit *fit, WovenPrepared *p) {
    const Woven m = weave_woven(fit->weave, fit->weft);
    woven_prepare(m, p);
    p->roundness = max(fit->far->slope_across, 1e-2f);
    p->crimp = fit->far->slope_along;
    WovenBin *const bins[] = {WOVEN_EACH_BIN(BIN_PLACE)};
    const float n = woven_count(m), r = m.roundness;
    for (int k = 0; k < WOVEN_BINS; k++) {
        const float x = k > 0 ? 0.5f * (woven_place(n, (float)k) + woven_place(n, (float)k + 1.0f)) : 0.0f;
        bins[k]->middle = clamp(fit->lean * bins[k]->slope, -0.5f * r, 0.5f * r);
        bins[k]->wide =
            min(bins[k]->wide * (1.0f - fit->narrow * x * x), ROUNDNESS_MOST - abs(bins[k]->middle));
        bins[k]->gain *= fit->gains[k];
    }
}

static void light_lobe(const WovenPrepared *p, Lit *far) {
    PairsLit pairs;
    woven_pairs(p, far, &pairs);
    for (int k = 0; k < LIT_PAIRS; k++) far->once[k] = far->again[k] = 0.0;
    lit_add(far, &pairs, 1.0, 1.0);
}

/* Sum |s lobe - near| / sqrt(near) over the pairs, near with a tenth of what was met again, s the factor that makes both
 * alike on the mean: between the worst of bright pairs and the worst of all. */
static double error_of(const double lobe[LIT_PAIRS], const Lit *near) {
    const double s = lit_sum(near->once) / fmax(lit_sum(lobe), 1e-30);
    double error = 0.0;
    for (int k = 0; k < LIT_PAIRS; k++)
        error += fabs(s * lobe[k] - near->once[k]) / (sqrt)(near->once[k] + 0.1 * near->again[k] + 1e-9);
    return error;
}

static double shape_error(unsigned n, const double *x, double *gradient, void *user) {
    Fit *fit = user;
    WovenPrepared p;
    (void)n, (void)gradient;
    fit->far->alpha = (float)x[0], fit->far->crimp = (float)x[1], fit->far->roundness = (float)x[2];
    fit->far->floats = (float)x[3], fit->narrow = (float)x[4], fit->lean = (float)x[5];
    prepare(fit, &p);
    light_lobe(&p, &fit->lobe);
    return error_of(fit->lobe.once, fit->near);
}

/* What each bin alone reflects. */
typedef struct BinsLit {
    const Lit *near;
    double once[WOVEN_BINS][LIT_PAIRS];
} BinsLit;

static double gains_error(unsigned n, const double *x, double *gradient, void *user) {
    const BinsLit *bins = user;
    double once[LIT_PAIRS] = {0.0};
    (void)gradient;
    for (unsigned bin = 0; bin < n; bin++)
        for (int k = 0; k < LIT_PAIRS; k++) once[k] += x[bin] * bins->once[bin][k];
    return error_of(once, bins->near);
}

static void light_bins(Fit *fit, int count, BinsLit *bins) {
    const Fit all = *fit;
    bins->near = fit->near;
    for (int bin = 0; bin < count; bin++) {
        WovenPrepared p;
        for (int k = 0; k < WOVEN_BINS; k++) fit->gains[k] = k == bin ? all.gains[k] : 0.0f;
        prepare(fit, &p);
        light_lobe(&p, &fit->lobe);
        memcpy(bins->once[bin], fit->lobe.once, sizeof fit->lobe.once);
    }
    memcpy(fit->gains, all.gains, sizeof fit->gains);
}

/* Makes the error least from x on: Thomas Harvey Rowan, "Functional Stability Analysis of Numerical Algorithms", 1990, as
 * NLopt has it. Returns false where memory is short. */
static bool make_least(nlopt_func error, void *user, unsigned n, const double *low, const double *high,
                       double *x) {
    double least;
    nlopt_opt method = nlopt_create(NLOPT_LN_SBPLX, n);
    const bool made = method && nlopt_set_min_objective(method, error, user) > 0 &&
                      nlopt_set_lower_bounds(method, low) > 0 && nlopt_set_upper_bounds(method, high) > 0 &&
                      nlopt_set_maxeval(method, LOOKS_MOST) > 0 && nlopt_set_xtol_rel(method, 1e-4) > 0 &&
                      nlopt_set_xtol_abs1(method, 1e-5) > 0 && /* of numbers that are 0 */
                      nlopt_optimize(method, x, &least) > 0;
    nlopt_destroy(method);
    return made;
}

static bool fit_shape(Fit *fit) {
    const double low[SHAPE_NUMBERS] = {0.05, 0.0, 0.0, (double)FLOATS_LEAST, -0.9, -2.0};
    const double high[SHAPE_NUMBERS] = {
        1.0, (double)CRIMP_MOST, (double)ROUNDNESS_MOST, (double)FLOATS_MOST, 0.9, 2.0};
    const WeaveFar *far = fit->far;
    double x[SHAPE_NUMBERS] = {(double)far->alpha,  (double)far->crimp,  (double)far->roundness,
                               (double)far->floats, (double)fit->narrow, (double)fit->lean};
    for (int k = 0; k < SHAPE_NUMBERS; k++) x[k] = fmin(fmax(x[k], low[k]), high[k]);
    if (!make_least(shape_error, fit, SHAPE_NUMBERS, low, high, x)) return false;
    (void)shape_error(SHAPE_NUMBERS, x, NULL, fit);
    return true;
}

/* Gains leave the sum over the pairs as it was. */
static bool fit_gains(Fit *fit) {
    const int count = (int)ceilf(woven_count(weave_woven(fit->weave, fit->weft)));
    double low[WOVEN_BINS], high[WOVEN_BINS], x[WOVEN_BINS];
    BinsLit bins;
    for (int k = 0; k < count; k++) low[k] = 0.0, high[k] = 4.0, x[k] = 1.0;
    light_bins(fit, count, &bins);
    if (!make_least(gains_error, &bins, (unsigned)count, low, high, x)) return false;
    double before = 0.0, after = 0.0;
    for (int k = 0; k < count; k++) {
        before += lit_sum(bins.once[k]);
        after += x[k] * lit_sum(bins.once[k]);
    }
    for (int k = 0; k < count && after > 0.0; k++) fit->gains[k] *= (float)(x[k] * before / after);
    return true;
}

static void fit_lobe(Fit *fit) {
    const WeaveFar moments = *fit->far;
    const Fit plain = *fit;
    bool made = true;
    for (int round = 0; round < FIT_ROUNDS; round++) made = made && fit_shape(fit) && fit_gains(fit);
    if (made) return;
    *fit->far = moments;
    *fit = plain;
}

Lit woven_fit(const Weave *m, bool weft, const Lit *near, WeaveFar *far, WovenPrepared *woven) {
    Fit fit = {.weave = m, .weft = weft, .far = far, .near = near, .lobe = *near};
    for (int k = 0; k < WOVEN_BINS; k++) fit.gains[k] = 1.0f;
    if (lit_sum(near->once) > 0.0) fit_lobe(&fit);
    prepare(&fit, woven);
    light_lobe(woven, &fit.lobe);
    return fit.lobe;
}
