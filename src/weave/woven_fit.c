/* woven_fit.c - lobe woven of one system, fitted to yarns that lie between others
 *
 *   width = r (1 - taper m^2),  middle = lean m,  weight = g_k times that of an arc
 *
 * of the slopes across bin k (WovenSlopes), where m is its slope along the yarn, 0 to 1, and r the roundness of the
 * lobe. The formula of the lobe describes a yarn alone. In a cloth other yarns cover both ends of its visible part, so
 * that it is narrower there (taper). In a twill they cover one corner more than the other (lean). And its slopes are
 * not as frequent as those of an arc (g_k).
 *   The lobe's alpha, crimp, roundness and floats make a shape together with taper and lean. A search finds the shape.
 * For each shape that it tries, the gains g_k are those of least squares, since light is linear in them. The slopes by
 * which yarns hide each other are those of the points. */
#include "weave/woven_fit.h"

#include <math.h>

#include <nlopt.h>

enum {
    SHAPE_NUMBERS = 6,
    SHAPES_MOST = 600, /* tried by the search */
    GAIN_ROUNDS = 200, /* over the gains of a shape */
};

/* Returns a direction within 80 degrees of the normal. height: 0 to 1, uniform in the cosine; part: of a full
 * circle. */
static Dir direction_of(double height, double part) {
    const double z = 0.17 + 0.83 * height, r = (sqrt)(1.0 - z * z), phi = 2.0 * (double)PI * part;
    return dir((float)(r * (cos)(phi)), (float)(r * (sin)(phi)), (float)z);
}

static void put(float to[3][LIT_PAIRS], int k, Dir w) { to[0][k] = w.x, to[1][k] = w.y, to[2][k] = w.z; }

void lit_start(Lit *lit) {
    for (int k = 0; k < LIT_PAIRS; k++) {
        const double n = (double)k + 0.5;
        put(lit->o, k, direction_of(n / LIT_PAIRS, fmod(0.7548776662 * n, 1.0)));
        put(lit->i, k, direction_of(fmod(0.5698402910 * n, 1.0), fmod(0.3819660113 * n, 1.0)));
        lit->single[k] = lit->multiple[k] = 0.0;
    }
}

void lit_add(Lit *lit, const PairsLit *pairs, double single, double multiple) {
    for (int k = 0; k < LIT_PAIRS; k++) {
        lit->single[k] += (double)pairs->single[k] * single;
        lit->multiple[k] += (double)pairs->multiple[k] * multiple;
    }
}

double lit_sum(const double values[LIT_PAIRS]) {
    double sum = 0.0;
    for (int k = 0; k < LIT_PAIRS; k++) sum += values[k];
    return sum;
}

typedef struct SystemFit {
    const Weave *weave;
    bool weft;
    WeaveFar *far;   /* the system's, in weave: alpha, crimp, roundness and floats of the shape */
    const Lit *near; /* what the points reflect */
    float taper;
    float lean; /* -1 to 1, of the most that is possible */
    float gains[WOVEN_BINS];
} SystemFit;

/* Prepares the lobe of the shape, without gains. |s_x| stays within ROUNDNESS_MOST, where woven_inverse_root is
 * accurate, and within 1.8 r, beyond which the weight 1 - 0.3 (s_x / r)^2 would be negative. */
static void prepare_shape(const SystemFit *fit, WovenPrepared *p) {
    woven_prepare(weave_woven(fit->weave, fit->weft), p);
    const float r = p->width, most = min(1.8f * r, ROUNDNESS_MOST);
    p->v_roundness = max(fit->far->slope_across, 1e-2f);
    p->v_crimp = fit->far->slope_along;
    p->lean = fit->lean * min(0.5f * r, most - r);
    p->taper = max(fit->taper * r, r + abs(p->lean) - most);
}

#define BIN_PLACE(name) &p->bins.name,
static void prepare_fitted(const SystemFit *fit, WovenPrepared *p) {
    prepare_shape(fit, p);
    WovenBin *const bins[] = {WOVEN_EACH_BIN(BIN_PLACE)};
    p->level *= fit->gains[0];
    for (int k = 1; k < WOVEN_BINS; k++) bins[k - 1]->weight *= fit->gains[k];
}

/* f cos_i of each bin alone, of light that met one fibre, with a gain of 1. */
typedef struct BinsLit {
    int count;
    double last; /* the part of the last bin that there is, 0 to 1 */
    float single[WOVEN_BINS][LIT_PAIRS];
} BinsLit;

static void light_bin(const WovenPrepared *p, WovenBin b, const Lit *lit, float *restrict single) {
    const WovenSlopes s = woven_slopes(p, b.slope), opposite = woven_opposite(s);
    for (int k = 0; k < LIT_PAIRS; k++) {
        const Dir o = {lit->o[0][k], lit->o[1][k], lit->o[2][k]};
        const Dir i = {lit->i[0][k], lit->i[1][k], lit->i[2][k]};
        const WovenView v = woven_view_of(p, o), w = woven_view_of(p, i);
        const float q = yarn_per_sum2(angles_between(o, i));
        const float both = woven_across(p, s, &v, &w, q) + woven_across(p, opposite, &v, &w, q);
        single[k] = p->scale * b.weight * both * v.per_v * w.per_v * i.z;
    }
}

#define BIN_OF(name) p.bins.name,
static void light_bins(const SystemFit *fit, BinsLit *bins) {
    WovenPrepared p;
    prepare_shape(fit, &p);
    const WovenBin level = {.slope = 0.0f, .weight = 0.5f * p.level}; /* light_bin adds it twice */
    const WovenBin all[] = {level, WOVEN_EACH_BIN(BIN_OF)};
    bins->count = (int)p.count;
    bins->last = (double)woven_count(weave_woven(fit->weave, fit->weft)) - (double)(bins->count - 1);
    for (int k = 0; k < bins->count; k++) light_bin(&p, all[k], fit->near, bins->single[k]);
}

/* Returns the weight of a pair's squared error: between weights for absolute errors, and for errors relative to the
 * light of the pair. */
static double weight_of(const Lit *near, int k) { return 1.0 / (near->single[k] + 0.1 * near->multiple[k] + 1e-9); }

/* The equations m g = v of the gains g that make
 *   sum over pairs of weight (sum_k g_k bin_k - near)^2  +  sum_k d_k m_kk (g_k - even)^2
 * least. `even` is the gain that all bins would have if they had one in common. d_k is 1e-4, so that bins which pairs
 * cannot tell apart stay alike. For a fraction of a last bin it is larger, so that the bin becomes effective by
 * degrees. */
typedef struct Gains {
    double m[WOVEN_BINS][WOVEN_BINS], v[WOVEN_BINS], even;
} Gains;

static void gains_start(Gains *g, const BinsLit *bins, const Lit *near) {
    double sum = 0.0;
    for (int i = 0; i < bins->count; i++)
        for (int k = 0; k < LIT_PAIRS; k++) sum += (double)bins->single[i][k];
    g->even = lit_sum(near->single) / fmax(sum, 1e-30);
    for (int i = 0; i < bins->count; i++) {
        double weighted[LIT_PAIRS];
        for (int k = 0; k < LIT_PAIRS; k++) weighted[k] = weight_of(near, k) * (double)bins->single[i][k];
        for (int j = 0; j <= i; j++) {
            double product = 0.0;
            for (int k = 0; k < LIT_PAIRS; k++) product += weighted[k] * (double)bins->single[j][k];
            g->m[i][j] = g->m[j][i] = product;
        }
        const double part = i < bins->count - 1 ? 1.0 : fmax(bins->last, 1e-6);
        const double d = 1e-4 / part * g->m[i][i] + 1e-30;
        g->v[i] = d * g->even;
        for (int k = 0; k < LIT_PAIRS; k++) g->v[i] += weighted[k] * near->single[k];
        g->m[i][i] += d;
    }
}

/* Solves for gains that are not negative. One gain after the other is set to the best value beside the others, until
 * they hardly change: Vojtech Franc, Vaclav Hlavac, Mirko Navara, "Sequential Coordinate-Wise Algorithm for the
 * Non-negative Least Squares Problem", 2005. */
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

/* Returns the weighted sum of squared errors of a shape x with its best gains. Sets shape and gains of the fit, which
 * is user. */
static double shape_error(unsigned n, const double *x, double *gradient, void *user) {
    SystemFit *fit = user;
    BinsLit bins;
    Gains g;
    double gains[WOVEN_BINS], error = 0.0;
    (void)n, (void)gradient;
    fit->far->alpha = (float)x[0], fit->far->crimp = (float)x[1], fit->far->roundness = (float)x[2];
    fit->far->floats = (float)x[3], fit->taper = (float)x[4], fit->lean = (float)x[5];
    light_bins(fit, &bins);
    gains_start(&g, &bins, fit->near);
    gains_solve(&g, bins.count, gains);
    for (int k = 0; k < LIT_PAIRS; k++) {
        double off = -fit->near->single[k];
        for (int i = 0; i < bins.count; i++) off += gains[i] * (double)bins.single[i][k];
        error += weight_of(fit->near, k) * off * off;
    }
    for (int i = 0; i < bins.count; i++) fit->gains[i] = (float)gains[i];
    return error;
}

/* Searches for the shape: M. J. D. Powell, "The BOBYQA Algorithm for Bound Constrained Optimization without
 * Derivatives", 2009, as NLopt has it. Crimp and floats are bounded near the moments: gains could make up for other
 * values, but bins beyond the slopes of the yarn would cost time for nothing. Yarns that float look steeper and less
 * level than their moments. The search starts there, so that it does not end at a shape which is the best only near the
 * moments. Returns false where it fails, as it does where memory is short. */
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
                      nlopt_set_initial_step(method, step) > 0 && nlopt_set_maxeval(method, SHAPES_MOST) > 0 &&
                      nlopt_set_xtol_rel(method, 1e-3) > 0;
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
    for (int k = 0; k < LIT_PAIRS; k++) far->single[k] = far->multiple[k] = 0.0;
    lit_add(far, &pairs, 1.0, 1.0);
}

/* Scales the gains so that light that met one fibre is as bright as without them: light that bounces has the albedo of
 * the lobe without gains (raster/light/ray_albedos.c). */
static void level_gains(SystemFit *fit) {
    Lit lobe = *fit->near;
    WovenPrepared p;
    woven_prepare(weave_woven(fit->weave, fit->weft), &p);
    light_lobe(&p, &lobe);
    const double without = lit_sum(lobe.single);
    prepare_fitted(fit, &p);
    light_lobe(&p, &lobe);
    const double fitted = lit_sum(lobe.single);
    for (int k = 0; k < WOVEN_BINS && fitted > 0.0; k++) fit->gains[k] *= (float)(without / fitted);
}

Lit woven_fit(Weave *m, bool weft, const Lit *near, WovenPrepared *woven) {
    WeaveFar *far = weft ? &m->weft_far : &m->warp_far;
    SystemFit fit = {.weave = m, .weft = weft, .far = far, .near = near};
    Lit lobe = *near;
    for (int k = 0; k < WOVEN_BINS; k++) fit.gains[k] = 1.0f;
    const SystemFit start = fit;
    const WeaveFar moments = *far;
    if (lit_sum(near->single) > 0.0 && fit_shape(&fit)) {
        level_gains(&fit);
    } else {
        *far = moments;
        fit = start;
    }
    prepare_fitted(&fit, woven);
    light_lobe(woven, &lobe);
    return lobe;
}
