/* ltc_fit.c - compiled with -ffinite-math-only, as loops over arrays are (CMakeLists.txt) */
#include <stdlib.h>

#include <nlopt.h>

#include "measure/ltc/ltc_fit.h"

#include "base/memory.h"
#include "measure/bsdf/grid.h"

bool ltc_target_create(LtcTarget *target, int cells) {
    size_t n = (size_t)cells * (size_t)(cells / 2);
    float *all = alloc_array(5 * n, sizeof(float));
    *target = (LtcTarget){.rings = cells, .columns = cells / 2, .x = all};
    if (!all) return false;
    target->y = all + n, target->z = all + 2 * n, target->area = all + 3 * n, target->f = all + 4 * n;
    return true;
}

void ltc_target_free(LtcTarget *target) {
    free(target->x);
    *target = (LtcTarget){0};
}

void ltc_target_fill(LtcTarget *target, float cos_o) {
    Grid grid;
    Ring ring;
    target->o = grid_direction((double)cos_o, 0.0);
    grid_make(&grid, target->o, target->rings);
    for (int row = 0; row < target->rings; row++) {
        grid_ring(&grid, row, &ring); /* the first half mirrors the second */
        for (int k = 0; k < target->columns; k++) {
            int at = row * target->columns + k, from = target->columns + k;
            target->x[at] = ring.x[from], target->y[at] = ring.y[from], target->z[at] = ring.z[from];
            target->area[at] = (float)(2.0 * ring.area[from]);
        }
    }
}

void ltc_target_scale(LtcTarget *target) {
    int n = target->rings * target->columns;
    target->e = 0.0;
    for (int k = 0; k < n; k++) target->e += (double)target->f[k] * (double)target->area[k];
    for (int k = 0; k < n && target->e > 0.0; k++) target->f[k] = (float)((double)target->f[k] / target->e);
}

void ltc_target_lobe(LtcTarget *target, const Lobe *lobe, float f0, float second) {
    float ox[GRID_MAX / 2], oy[GRID_MAX / 2], oz[GRID_MAX / 2], share[GRID_MAX / 2];
    size_t columns = (size_t)target->columns;
    for (size_t k = 0; k < columns; k++) ox[k] = target->o.x, oy[k] = target->o.y, oz[k] = target->o.z;
    target->e0 = target->e90 = 0.0;
    for (int row = 0; row < target->rings; row++) {
        size_t at = (size_t)row * columns;
        float *f = target->f + at;
        const float *z = target->z + at, *area = target->area + at;
        lobe_eval_n(lobe, columns, ox, oy, oz, target->x + at, target->y + at, z, f, share);
        for (size_t k = 0; k < columns; k++) {
            float s = fresnel_weight_uncolored(share[k]), first = f[k] * z[k] * (1.0f - s), rest = f[k] * z[k] * s;
            target->e0 += (double)first * (double)area[k];
            target->e90 += (double)rest * (double)area[k];
            f[k] = first * f0 + rest * second;
        }
    }
    ltc_target_scale(target);
}

/* Returns the error of one ring of directions. The norm is a constant wherever this is inlined. */
FN float ring_error(const LtcTarget *target, int row, Ltc m, float scale, int norm) {
    size_t at = (size_t)row * (size_t)target->columns;
    const float *x = target->x + at, *y = target->y + at, *z = target->z + at;
    const float *area = target->area + at, *f = target->f + at;
    Dir o = target->o;
    float sum = 0.0f;
#pragma omp simd reduction(+ : sum)
    for (int k = 0; k < target->columns; k++) {
        float off = fabsf(scale * ltc_pdf(m, o, dir(x[k], y[k], z[k])) - f[k]);
        sum += area[k] * (norm == 1 ? off : norm == 2 ? off * off : off * off * off);
    }
    return sum;
}

double ltc_error(const LtcTarget *target, LtcEntries at, int norm) {
    Ltc m = ltc_of(at.z, at.q, at.b, at.r, target->o.z);
    float scale = 1.0f / max(ltc_above(m, target->o), 1e-6f);
    double sum = 0.0;
    switch (norm) {
    case 1:
        for (int row = 0; row < target->rings; row++) sum += (double)ring_error(target, row, m, scale, 1);
        return sum;
    case 2:
        for (int row = 0; row < target->rings; row++) sum += (double)ring_error(target, row, m, scale, 2);
        return (sqrt)(sum);
    default:
        for (int row = 0; row < target->rings; row++) sum += (double)ring_error(target, row, m, scale, 3);
        return cbrt(sum);
    }
}

/* The coordinates of the search: numbers that mean the same for sharp and for blunt lobes, each in a unit of its own.
 *
 *   tilt   phi of the lobe's peak, where v_xy = 0: tan phi = b s / m11, against o
 *   q      as m11 = cos_o^2 + q s^2, which makes the width at the peak in the plane of incidence: along = v_z
 * / (d v_x / d phi) = across cos phi / m11 across ln of the width across that plane: v_z / (d v_y / d w_y) = cos phi
 * |M^-1| / m11 lean   how far the pole of the hemisphere follows the peak: tan of its angle over tan phi, r m11 / z
 *
 * At normal incidence there is one width. */
enum { TILT, Q, ACROSS, LEAN, STEPS };
static const double low[STEPS] = {-1e9, 0.0, -16.0, 0.0}, high[STEPS] = {1e9, 1e3, 6.0, 20.0};
enum { EVALUATIONS_MOST = 400, ROUNDS_MOST = 4 };

typedef struct LtcSearch {
    const LtcTarget *target;
    int norm;
    double unit[STEPS], step[STEPS];
} LtcSearch;

static bool is_normal(const LtcTarget *target) { return !(target->o.x > 1e-3f); }

static LtcEntries entries_at(const LtcSearch *search, const double *step) {
    double s = (double)search->target->o.x, cos_o = (double)search->target->o.z, across = (exp)(step[ACROSS]);
    if (is_normal(search->target))
        return (LtcEntries){(float)across, 1.0f, 0.0f, search->target->level ? 0.0f : (float)across};
    double phi = fmin(fmax(search->unit[TILT] * step[TILT], -1.56), 1.56), t = tan(phi);
    double q = search->unit[Q] * step[Q], m11 = cos_o * cos_o + q * s * s;
    double z = across / ((cos)(phi) * (1.0 + step[LEAN] * t * t));
    return (LtcEntries){(float)z, (float)q, (float)(m11 * t / s), (float)(step[LEAN] * z / m11)};
}

/* Begins a search from a peak at phi with these widths. The unit of a coordinate is a width, or what changes one. */
static LtcSearch search_from(const LtcTarget *target, int norm, double phi, double along, double across, double lean) {
    double s = (double)target->o.x, c2 = (double)target->o.z * (double)target->o.z;
    double m11 = fmax(across * (cos)(phi) / along, c2), tilt = fmin(along, 1.0), q = m11 / fmax(s * s, 1e-6);
    LtcSearch search = {target, norm, {tilt, q, 1.0, 1.0}, {phi / tilt, (m11 - c2) / m11, log(across)}};
    search.step[LEAN] = target->level ? 0.0 : lean;
    for (int k = 0; k < STEPS; k++) search.step[k] = fmin(fmax(search.step[k], low[k]), high[k]);
    return search;
}

/* Returns the coordinates of these entries. */
static LtcSearch search_at(const LtcTarget *target, int norm, LtcEntries at) {
    Ltc m = ltc_of(at.z, at.q, at.b, at.r, target->o.z);
    double m11 = (double)m.m11, phi = atan((double)at.b * (double)target->o.x / m11);
    double across = (cos)(phi) * (double)m.det / m11;
    return search_from(target, norm, phi, across * (cos)(phi) / m11, across, (double)at.r * m11 / (double)at.z);
}

LtcEntries ltc_guess(const LtcTarget *target) {
    int n = target->rings * target->columns;
    double x = 0.0, z = 0.0, along = 0.0, across = 0.0;
    for (int k = 0; k < n; k++) {
        double w = (double)target->f[k] * (double)target->area[k];
        x += w * (double)target->x[k], z += w * (double)target->z[k];
    }
    double r = fmax(hypot(x, z), 1e-9);
    x /= r, z /= r;
    /* |v_x / v_z| and |v_y / v_z| of a clamped cosine are 1 on average */
    for (int k = 0; k < n; k++) {
        double w = (double)target->f[k] * (double)target->area[k];
        double up = fmax(x * (double)target->x[k] + z * (double)target->z[k], 0.05);
        along += w * fmin(fabs(z * (double)target->x[k] - x * (double)target->z[k]) / up, 4.0);
        across += w * fmin(fabs((double)target->y[k]) / up, 4.0);
    }
    LtcSearch search = search_from(target, 1, -atan2(x, z), fmax(along, 1e-4), fmax(across, 1e-4), 1.0);
    return entries_at(&search, search.step);
}

static double error_at(unsigned n, const double *step, double *gradient, void *user) {
    const LtcSearch *search = user;
    double all[STEPS];
    for (int k = 0; k < STEPS; k++) all[k] = n == 1 ? step[0] : k < (int)n ? step[k] : 0.0;
    return ltc_error(search->target, entries_at(search, all), search->norm);
}

/* Thomas Harvey Rowan, "Functional Stability Analysis of Numerical Algorithms", PhD thesis, University of
 * Texas at Austin, 1990: the simplex search on subspaces, as Steven G. Johnson wrote it for NLopt. It draws
 * no random numbers. */
static void descend(LtcSearch *search) {
    int first = is_normal(search->target) ? ACROSS : 0;
    unsigned n = first ? 1 : search->target->level ? LEAN : STEPS;
    nlopt_opt method = nlopt_create(NLOPT_LN_SBPLX, n);
    if (!method) return; /* the start stands */
    nlopt_set_min_objective(method, error_at, search);
    nlopt_set_lower_bounds(method, low + first);
    nlopt_set_upper_bounds(method, high + first);
    nlopt_set_initial_step1(method, 0.1);
    nlopt_set_maxeval(method, EVALUATIONS_MOST);
    nlopt_set_ftol_rel(method, 1e-5);
    nlopt_set_xtol_rel(method, 1e-7);
    double least, step[STEPS];
    memcpy(step, search->step, sizeof step);
    if (nlopt_optimize(method, step + first, &least) > 0) memcpy(search->step, step, sizeof step);
    nlopt_destroy(method);
}

static double error_of(const LtcSearch *search) {
    return ltc_error(search->target, entries_at(search, search->step), search->norm);
}

LtcEntries ltc_fit(const LtcTarget *target, const LtcEntries *starts, int count, int norm) {
    LtcSearch best = search_at(target, norm, starts[0]);
    double least = error_of(&best);
    for (int k = 1; k < count; k++) {
        LtcSearch search = search_at(target, norm, starts[k]);
        double error = error_of(&search);
        if (error < least) best = search, least = error;
    }
    /* a simplex that has shrunk along a valley is opened again, where it stands */
    for (int round = 0; round < ROUNDS_MOST; round++) {
        descend(&best);
        double before = least;
        least = error_of(&best);
        if (!(least < 0.99 * before && least > 1e-4)) break;
        best = search_at(target, norm, entries_at(&best, best.step));
    }
    return entries_at(&best, best.step);
}
