/* woven_fit.c - lobe woven of one system, and what its formula does not know of yarns between others
 *
 *   wide = r (1 - narrow m^2),  middle = lean m,  gain = g_k times that of an arc
 *
 * of bin k, where m is its mean slope over the steepest and r the lobe's roundness. Other yarns cross over both ends of
 * the visible part of a yarn, so that it is narrower there; in a twill they cover one corner more than the other, so that
 * it leans; and its slopes are not as frequent as those of an arc. The lobe's alpha, crimp, roundness and floats, narrow and
 * lean make a shape, which is searched for. The light of each bin is a term of a sum, so that the gains g_k of a shape are
 * those of least squares. The slopes by which yarns hide each other are those of points. */
#include "weave/woven_fit.h"

#include <math.h>

#include <nlopt.h>

enum {
    SHAPE_NUMBERS = 6,
    SHAPES_MOST = 600, /* looks at what a shape reflects, */
    GAIN_ROUNDS = 200, /* and at each of its gains */
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

/* lean: in parts of the most that there is room for. */
typedef struct SystemFit {
    const Weave *weave;
    bool weft;
    WeaveFar *far; /* of the weave */
    const Lit *near;
    float narrow, lean, gains[WOVEN_BINS];
} SystemFit;

/* The lobe of the shape, without gains. |s_x| stays within 1.5, as far as woven_flat is good, and within 1.8 r, beyond which
 * the weight 1 - 0.3 (s_x / r)^2 would be negative. */
static void prepare_shape(const SystemFit *fit, WovenPrepared *p) {
    woven_prepare(weave_woven(fit->weave, fit->weft), p);
    const float r = p->wide, most = min(1.8f * r, ROUNDNESS_MOST);
    p->roundness = max(fit->far->slope_across, 1e-2f);
    p->crimp = fit->far->slope_along;
    p->lean = fit->lean * min(0.5f * r, most - r);
    p->narrow = max(fit->narrow * r, r + abs(p->lean) - most);
}

#define BIN_PLACE(name) &p->name,
static void prepare_fitted(const SystemFit *fit, WovenPrepared *p) {
    prepare_shape(fit, p);
    WovenBin *const bins[] = {WOVEN_EACH_BIN(BIN_PLACE)};
    p->level *= fit->gains[0];
    for (int k = 1; k < WOVEN_BINS; k++) bins[k - 1]->gain *= fit->gains[k];
}

/* Light that met one fibre, of each bin without the others, with a gain of 1. last: the part of the last bin that there
 * is. */
typedef struct BinsLit {
    int count;
    double last;
    float once[WOVEN_BINS][LIT_PAIRS];
} BinsLit;

static void light_bin(const WovenPrepared *p, WovenBin b, const Lit *lit, float *restrict once) {
    const WovenSlopes s = woven_slopes(p, b.mean), opposite = woven_opposite(s);
    for (int k = 0; k < LIT_PAIRS; k++) {
        const Dir o = {lit->o[0][k], lit->o[1][k], lit->o[2][k]};
        const Dir i = {lit->i[0][k], lit->i[1][k], lit->i[2][k]};
        const WovenView v = woven_look(p, o), w = woven_look(p, i);
        const float q = yarn_half(angles_between(o, i));
        const float rows = woven_row(p, s, &v, &w, q) + woven_row(p, opposite, &v, &w, q);
        once[k] = p->part * b.gain * rows * v.over_seen * w.over_seen * i.z;
    }
}

#define BIN_OF(name) p.name,
static void light_bins(const SystemFit *fit, BinsLit *bins) {
    WovenPrepared p;
    prepare_shape(fit, &p);
    const WovenBin level = {.mean = 0.0f, .gain = 0.5f * p.level}; /* twice, as its own opposite */
    const WovenBin all[] = {level, WOVEN_EACH_BIN(BIN_OF)};
    bins->count = (int)p.count;
    bins->last = (double)woven_count(weave_woven(fit->weave, fit->weft)) - (double)(bins->count - 1);
    for (int k = 0; k < bins->count; k++) light_bin(&p, all[k], fit->near, bins->once[k]);
}

/* The weight of a pair's square: between squares of errors and of errors in parts of a pair's light. */
static double weight_of(const Lit *near, int k) {
    return 1.0 / (near->once[k] + 0.1 * near->again[k] + 1e-9);
}

/* m g = v of the gains g for which
 *   sum over pairs of weight (sum_k g_k bin_k - near)^2  +  sum_k d_k m_kk (g_k - even)^2
 * is least, where no gain is negative; `even` is the gain that all would have. d_k is 1e-4, which keeps bins alike that pairs
 * cannot tell apart, but more for a last bin of which there is only a part: it comes into the sum by degrees. */
typedef struct Gains {
    double m[WOVEN_BINS][WOVEN_BINS], v[WOVEN_BINS], even;
} Gains;

static void gains_start(Gains *g, const BinsLit *bins, const Lit *near) {
    double sum = 0.0;
    for (int i = 0; i < bins->count; i++)
        for (int k = 0; k < LIT_PAIRS; k++) sum += (double)bins->once[i][k];
    g->even = lit_sum(near->once) / fmax(sum, 1e-30);
    for (int i = 0; i < bins->count; i++) {
        double weighted[LIT_PAIRS];
        for (int k = 0; k < LIT_PAIRS; k++) weighted[k] = weight_of(near, k) * (double)bins->once[i][k];
        for (int j = 0; j <= i; j++) {
            double product = 0.0;
            for (int k = 0; k < LIT_PAIRS; k++) product += weighted[k] * (double)bins->once[j][k];
            g->m[i][j] = g->m[j][i] = product;
        }
        const double part = i < bins->count - 1 ? 1.0 : fmax(bins->last, 1e-6);
        const double d = 1e-4 / part * g->m[i][i] + 1e-30;
        g->v[i] = d * g->even;
        for (int k = 0; k < LIT_PAIRS; k++) g->v[i] += weighted[k] * near->once[k];
        g->m[i][i] += d;
    }
}

/* One gain after the other is made the best that it can be beside the others, until they hardly move: Vojtech Franc, Vaclav
 * Hlavac, Mirko Navara, "Sequential Coordinate-Wise Algorithm for the Non-negative Least Squares Problem", 2005. */
static void gains_solve(const Gains *g, int count, double gains[WOVEN_BINS]) {
    double moved = 1.0;
    for (int i = 0; i < count; i++) gains[i] = g->even;
    for (int round = 0; round < GAIN_ROUNDS && moved > 1e-5 * g->even; round++) {
        moved = 0.0;
        for (int i = 0; i < count; i++) {
            double left = g->v[i];
            for (int j = 0; j < count; j++) left -= g->m[i][j] * gains[j];
            const double best = fmax(gains[i] + left / g->m[i][i], 0.0);
            moved = fmax(moved, fabs(best - gains[i]));
            gains[i] = best;
        }
    }
}

/* The weighted squares that a shape leaves with its gains, which become those of the fit. */
static double shape_error(unsigned n, const double *x, double *gradient, void *user) {
    SystemFit *fit = user;
    BinsLit bins;
    Gains g;
    double gains[WOVEN_BINS], error = 0.0;
    (void)n, (void)gradient;
    fit->far->alpha = (float)x[0], fit->far->crimp = (float)x[1], fit->far->roundness = (float)x[2];
    fit->far->floats = (float)x[3], fit->narrow = (float)x[4], fit->lean = (float)x[5];
    light_bins(fit, &bins);
    gains_start(&g, &bins, fit->near);
    gains_solve(&g, bins.count, gains);
    for (int k = 0; k < LIT_PAIRS; k++) {
        double off = -fit->near->once[k];
        for (int i = 0; i < bins.count; i++) off += gains[i] * (double)bins.once[i][k];
        error += weight_of(fit->near, k) * off * off;
    }
    for (int i = 0; i < bins.count; i++) fit->gains[i] = (float)gains[i];
    return error;
}

/* Searches for the shape: M. J. D. Powell, "The BOBYQA Algorithm for Bound Constrained Optimization without Derivatives",
 * 2009, as NLopt has it. Gains could make up for any crimp and floats, so these have bounds: bins beyond what the yarn has
 * would take time for nothing. Yarns that float look steeper and less level than their moments, so the search starts there,
 * and does not stop at shapes that are best only near the moments. Returns false where it fails, as it does where memory is
 * short. */
static bool fit_shape(SystemFit *fit) {
    const WeaveFar *far = fit->far;
    const double crimp = (double)far->crimp, floats = (double)far->floats;
    const double longer = (pow)(floats, 0.3), steep = fmin(longer, 1.15) * crimp;
    const double low[SHAPE_NUMBERS] = {0.05, fmax(0.9 * crimp - 0.01, 0.0), 0.0, 0.5 * floats, -0.9, -1.0};
    const double high[SHAPE_NUMBERS] = {1.0,
                                        fmin(1.2 * steep + 0.01, (double)CRIMP_MOST),
                                        (double)ROUNDNESS_MOST,
                                        fmin(1.2 * floats, (double)FLOATS_MOST),
                                        0.9,
                                        1.0};
    double x[SHAPE_NUMBERS] = {(double)far->alpha, steep, (double)far->roundness, floats / longer, 0.0, 0.0},
           step[SHAPE_NUMBERS];
    for (int k = 0; k < SHAPE_NUMBERS; k++) {
        x[k] = fmin(fmax(x[k], low[k]), high[k]);
        step[k] = 0.1 * (high[k] - low[k]);
    }
    double least;
    nlopt_opt method = nlopt_create(NLOPT_LN_BOBYQA, SHAPE_NUMBERS);
    const bool made = method && nlopt_set_min_objective(method, shape_error, fit) > 0 &&
                      nlopt_set_lower_bounds(method, low) > 0 && nlopt_set_upper_bounds(method, high) > 0 &&
                      nlopt_set_initial_step(method, step) > 0 &&
                      nlopt_set_maxeval(method, SHAPES_MOST) > 0 && nlopt_set_xtol_rel(method, 1e-3) > 0;
    const nlopt_result result = made ? nlopt_optimize(method, x, &least) : NLOPT_FAILURE;
    nlopt_destroy(method);
    if (result <= 0 && result != NLOPT_ROUNDOFF_LIMITED) return false;
    (void)shape_error(SHAPE_NUMBERS, x, NULL, fit);
    return true;
}

static void woven_pairs(WovenPrepared p, const Lit *lit, PairsLit *out) { EACH_LIT(woven, Woven) }

static void light_lobe(const WovenPrepared *p, Lit *far) {
    PairsLit pairs;
    woven_pairs(*p, far, &pairs);
    for (int k = 0; k < LIT_PAIRS; k++) far->once[k] = far->again[k] = 0.0;
    lit_add(far, &pairs, 1.0, 1.0);
}

/* Makes the lobe as bright, in light that met one fibre, as the one of its numbers alone, for which the environment is
 * convolved (raster/material/materials.c). */
static void level_gains(SystemFit *fit) {
    Lit lobe = *fit->near;
    WovenPrepared p;
    woven_prepare(weave_woven(fit->weave, fit->weft), &p);
    light_lobe(&p, &lobe);
    const double plain = lit_sum(lobe.once);
    prepare_fitted(fit, &p);
    light_lobe(&p, &lobe);
    const double fitted = lit_sum(lobe.once);
    for (int k = 0; k < WOVEN_BINS && fitted > 0.0; k++) fit->gains[k] *= (float)(plain / fitted);
}

Lit woven_fit(Weave *m, bool weft, const Lit *near, WovenPrepared *woven) {
    WeaveFar *far = weft ? &m->weft_far : &m->warp_far;
    SystemFit fit = {.weave = m, .weft = weft, .far = far, .near = near};
    Lit lobe = *near;
    for (int k = 0; k < WOVEN_BINS; k++) fit.gains[k] = 1.0f;
    const SystemFit plain = fit;
    const WeaveFar moments = *far;
    if (lit_sum(near->once) > 0.0 && fit_shape(&fit)) {
        level_gains(&fit);
    } else {
        *far = moments;
        fit = plain;
    }
    prepare_fitted(&fit, woven);
    light_lobe(woven, &lobe);
    return lobe;
}
