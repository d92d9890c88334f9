/* woven_fit.c - lobe woven of one system, and what its formula does not know of yarns between others
 *
 *   wide = r (1 - narrow x^2),  middle = lean s_y,  gain = g_k times that of an arc
 *
 * of bin k, where x is its middle along the yarn (woven_place) and r the lobe's roundness. Other yarns cross over both ends of
 * the visible part of a yarn, so that it is narrower there; in a twill they cover one corner more than the other, so that it
 * leans; and its slopes are not as frequent as those of an arc. The lobe's alpha, crimp, roundness and floats, narrow and lean
 * make a shape, which is fitted in turn with the gains g_k: the light of each bin is a term of a sum, so that gains cost no
 * look at the lobe. The slopes by which yarns hide each other are those of points. */
#include "weave/woven_fit.h"

#include <math.h>
#include <string.h>

#include <nlopt.h>

#include "shading/loop.h"

enum {
    SHAPE_NUMBERS = 6,
    SHAPES_MOST = 600, /* looks at what a shape reflects, */
    GAINS_MOST = 4000, /* and at sums of bins */
    FIT_ROUNDS = 2,
};

/* Directions within 80 degrees of the normal, evenly by their cosine. */
static Dir direction_of(double mu, double turn) {
    const double z = 0.17 + 0.83 * mu, r = (sqrt)(1.0 - z * z), phi = 2.0 * (double)PI * turn;
    return dir((float)(r * (cos)(phi)), (float)(r * (sin)(phi)), (float)z);
}

static void put(float to[3][LIT_PAIRS], int k, Dir w) { to[0][k] = w.x, to[1][k] = w.y, to[2][k] = w.z; }

void lit_start(Lit *lit) {
    for (int k = 0; k < LIT_PAIRS; k++) {
        const double n = (double)k + 0.5;
        put(lit->o, k, direction_of(n / LIT_PAIRS, fmod(0.7548776662 * n, 1.0)));
        put(lit->i, k, direction_of(fmod(0.5698402910 * n, 1.0), fmod(0.3819660113 * n, 1.0)));
        lit->once[k] = lit->again[k] = 0.0;
    }
}

void lit_add(Lit *lit, const PairsLit *pairs, double once, double again) {
    for (int k = 0; k < LIT_PAIRS; k++) {
        lit->once[k] += (double)pairs->once[k] * once;
        lit->again[k] += (double)pairs->again[k] * again;
    }
}

double lit_sum(const double values[LIT_PAIRS]) {
    double sum = 0.0;
    for (int k = 0; k < LIT_PAIRS; k++) sum += values[k];
    return sum;
}

static void woven_pairs(WovenPrepared p, const Lit *lit, PairsLit *restrict out) {
    BY_COUNT(EACH_LIT(woven, Woven))
}

typedef struct SystemFit {
    const Weave *weave;
    bool weft;
    WeaveFar *far; /* of the weave */
    const Lit *near;
    Lit lobe;
    float narrow, lean, gains[WOVEN_BINS];
} SystemFit;

/* The lobe with these gains. |s_x| stays within 1.5, as far as woven_flat is good, and within 1.8 r, beyond which the weight
 * 1 - 0.3 (s_x / r)^2 would be negative; so its middle stays within r / 2. */
#define BIN_PLACE(name) &p->name,
static void prepare_fitted(const SystemFit *fit, const float gains[WOVEN_BINS], WovenPrepared *p) {
    const Woven m = weave_woven(fit->weave, fit->weft);
    woven_prepare(m, p);
    const float n = woven_count(m), r = p->roundness, most = min(1.8f * r, ROUNDNESS_MOST);
    p->roundness = max(fit->far->slope_across, 1e-2f);
    p->crimp = fit->far->slope_along;
    WovenBin *const bins[] = {WOVEN_EACH_BIN(BIN_PLACE)};
    for (int k = 0; k < WOVEN_BINS; k++) {
        const float x = k > 0 ? 0.5f * (woven_place(n, (float)k) + woven_place(n, (float)k + 1.0f)) : 0.0f;
        bins[k]->middle = clamp(fit->lean * bins[k]->slope, -0.5f * r, 0.5f * r);
        bins[k]->wide = min(r * (1.0f - fit->narrow * x * x), most - abs(bins[k]->middle));
        bins[k]->gain *= gains[k];
    }
}

static void light_lobe(const WovenPrepared *p, Lit *far) {
    PairsLit pairs;
    woven_pairs(*p, far, &pairs);
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
    SystemFit *fit = user;
    WovenPrepared p;
    (void)n, (void)gradient;
    fit->far->alpha = (float)x[0], fit->far->crimp = (float)x[1], fit->far->roundness = (float)x[2];
    fit->far->floats = (float)x[3], fit->narrow = (float)x[4], fit->lean = (float)x[5];
    prepare_fitted(fit, fit->gains, &p);
    light_lobe(&p, &fit->lobe);
    return error_of(fit->lobe.once, fit->near);
}

/* Light of each bin without the others, with a gain of 1. */
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

/* Returns how many bins there are. */
static int light_bins(SystemFit *fit, BinsLit *bins) {
    WovenPrepared p;
    int bin = 0;
    bins->near = fit->near;
    do {
        float gains[WOVEN_BINS] = {0.0f};
        gains[bin] = 1.0f;
        prepare_fitted(fit, gains, &p);
        light_lobe(&p, &fit->lobe);
        memcpy(bins->once[bin], fit->lobe.once, sizeof fit->lobe.once);
    } while (++bin < (int)p.count);
    return bin;
}

/* Makes the error least from x on: Thomas Harvey Rowan, "Functional Stability Analysis of Numerical Algorithms", 1990, as
 * NLopt has it. Returns false where that fails, as it does where memory is short. */
static bool make_least(nlopt_func error, void *user, unsigned n, int looks, const double *low,
                       const double *high, double *x) {
    double least;
    nlopt_opt method = nlopt_create(NLOPT_LN_SBPLX, n);
    const bool made = method && nlopt_set_min_objective(method, error, user) > 0 &&
                      nlopt_set_lower_bounds(method, low) > 0 && nlopt_set_upper_bounds(method, high) > 0 &&
                      nlopt_set_maxeval(method, looks) > 0 && nlopt_set_xtol_rel(method, 1e-4) > 0 &&
                      nlopt_set_xtol_abs1(method, 1e-5) > 0; /* of numbers that are 0 */
    const nlopt_result result = made ? nlopt_optimize(method, x, &least) : NLOPT_FAILURE;
    nlopt_destroy(method);
    return result > 0 || result == NLOPT_ROUNDOFF_LIMITED;
}

static bool fit_shape(SystemFit *fit) {
    const double low[SHAPE_NUMBERS] = {0.05, 0.0, 0.0, (double)FLOATS_LEAST, -0.9, -2.0};
    const double high[SHAPE_NUMBERS] = {
        1.0, (double)CRIMP_MOST, (double)ROUNDNESS_MOST, (double)FLOATS_MOST, 0.9, 2.0};
    const WeaveFar *far = fit->far;
    double x[SHAPE_NUMBERS] = {(double)far->alpha,  (double)far->crimp,  (double)far->roundness,
                               (double)far->floats, (double)fit->narrow, (double)fit->lean};
    for (int k = 0; k < SHAPE_NUMBERS; k++) x[k] = fmin(fmax(x[k], low[k]), high[k]);
    if (!make_least(shape_error, fit, SHAPE_NUMBERS, SHAPES_MOST, low, high, x)) return false;
    (void)shape_error(SHAPE_NUMBERS, x, NULL, fit);
    return true;
}

static bool fit_gains(SystemFit *fit) {
    double low[WOVEN_BINS], high[WOVEN_BINS], x[WOVEN_BINS];
    BinsLit bins;
    const int count = light_bins(fit, &bins);
    for (int k = 0; k < count; k++) low[k] = 0.0, high[k] = 8.0, x[k] = fmin((double)fit->gains[k], high[k]);
    if (!make_least(gains_error, &bins, (unsigned)count, GAINS_MOST, low, high, x)) return false;
    for (int k = 0; k < count; k++) fit->gains[k] = (float)x[k];
    return true;
}

/* Makes the lobe as bright, in light that met one fibre, as the one of its numbers alone, for which the environment is
 * convolved (raster/materials.c). */
static void level_gains(SystemFit *fit) {
    WovenPrepared p;
    woven_prepare(weave_woven(fit->weave, fit->weft), &p);
    light_lobe(&p, &fit->lobe);
    const double plain = lit_sum(fit->lobe.once);
    prepare_fitted(fit, fit->gains, &p);
    light_lobe(&p, &fit->lobe);
    const double fitted = lit_sum(fit->lobe.once);
    for (int k = 0; k < WOVEN_BINS && fitted > 0.0; k++) fit->gains[k] *= (float)(plain / fitted);
}

static void fit_lobe(SystemFit *fit) {
    const WeaveFar moments = *fit->far;
    const SystemFit plain = *fit;
    bool made = true;
    for (int round = 0; made && round < FIT_ROUNDS; round++) {
        made = fit_shape(fit) && fit_gains(fit);
        level_gains(fit);
    }
    if (made) return;
    *fit->far = moments;
    *fit = plain;
}

Lit woven_fit(Weave *m, bool weft, const Lit *near, WovenPrepared *woven) {
    WeaveFar *far = weft ? &m->weft_far : &m->warp_far;
    SystemFit fit = {.weave = m, .weft = weft, .far = far, .near = near, .lobe = *near};
    for (int k = 0; k < WOVEN_BINS; k++) fit.gains[k] = 1.0f;
    if (lit_sum(near->once) > 0.0) fit_lobe(&fit);
    prepare_fitted(&fit, fit.gains, woven);
    light_lobe(woven, &fit.lobe);
    return fit.lobe;
}
