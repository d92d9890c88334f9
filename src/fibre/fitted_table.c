#include "fibre/fitted_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/half.h"
#include "shading/media/fibre_model.h"

enum {
    PARTS = 4,   /* A, h, g, k */
    RINGS = 56,  /* cosines of a slab */
    SPOKES = 5,  /* angles between azimuths */
    CORNERS = 4, /* nodes around a point of the table */
};

/* Returns the base of a power in M, as shading/lobes/fibre_table.h has it. */
static double base_of(double alpha, double sum) { return sum + 0.2 * alpha; }

/* Returns its exponent. */
static double power_of(double alpha) { return 1.4 - 2.5 * log(alpha) / log(2.0); }

static const double horizon = 1e-3; /* added to a cosine before its root is taken */

/* Returns the column of a cosine, in [0, 1]. */
static double column_of(double mu) {
    return ((sqrt)(mu + horizon) - (sqrt)(horizon)) / ((sqrt)(1.0 + horizon) - (sqrt)(horizon));
}
static double mu_of(double column) {
    double root = column * ((sqrt)(1.0 + horizon) - (sqrt)(horizon)) + (sqrt)(horizon);
    return fmin(fmax(root * root - horizon, 0.0), 1.0);
}

/* Returns alpha at the row y in [0, 1]. */
static double alpha_at(const FibreTableDesc *desc, double y) { return desc->low * (pow)(desc->high / desc->low, y); }

/* Gives the four nodes around a point in units of nodes, and their bilinear weights. */
static void corners(const FibreTableDesc *desc, double x, double y, int node[CORNERS], double weight[CORNERS]) {
    int column = (int)fmin(fmax((floor)(x), 0.0), desc->columns - 2),
        row = (int)fmin(fmax((floor)(y), 0.0), desc->rows - 2);
    double s = x - column, t = y - row;
    for (int c = 0; c < CORNERS; c++) {
        int right = c % 2, below = c / 2;
        node[c] = (row + below) * desc->columns + column + right;
        weight[c] = (right ? s : 1.0 - s) * (below ? t : 1.0 - t);
    }
}

/* Evaluates log M and its derivatives (FitForm). theta contains the four functions, in exponents of 2, at every side of
 * a slab. */
static void value(void *user, int slab, const SolvedSlab *t, const double *theta, double *log_f, double *slope) {
    static const double ln2 = 0.693147180559945309;
    const int n = t->sides;
    const double *a = theta, *h = a + n, *g = h + n, *k = g + n, power = power_of(t->slab.alpha);
    (void)user, (void)slab;
    for (int p = 0; p < t->pairs; p++) {
        int i = t->i[p], j = t->j[p];
        double x = t->x[p];
        log_f[p] = ln2 * (a[i] + a[j] + h[i] * h[j] - g[i] * g[j] - k[i] * k[j] * x) -
                   power * log(base_of(t->slab.alpha, t->mu[i] + t->mu[j]));
        if (!slope) continue;
        double *s = slope + (size_t)p * (size_t)(PARTS * n);
        memset(s, 0, (size_t)(PARTS * n) * sizeof *s);
        for (int end = 0; end < 2; end++) {
            int at = end ? j : i, other = end ? i : j;
            s[at] += ln2;
            s[n + at] += ln2 * h[other];
            s[2 * n + at] -= ln2 * g[other];
            s[3 * n + at] -= ln2 * k[other] * x;
        }
    }
}

/* Starts from the values of the fitted polynomial at the nodes, with A such that both agree at mu_o =
 * mu_i. */
static void start(const FibreTableDesc *desc, double *coefficients) {
    for (int row = 0; row < desc->rows; row++) {
        double alpha = alpha_at(desc, (double)row / (desc->rows - 1));
        FibreModel m = fibre_model((float)alpha, 0.0f);
        FibreNumbers n = fibre_material_numbers((float)alpha, 1.0f, 0.0f);
        for (int column = 0; column < desc->columns; column++) {
            double mu = mu_of((double)column / (desc->columns - 1));
            FibreSide side = fibre_side(m, n, (float)mu, (float)mu);
            double theirs = (double)fibre_bases(m, n, side, side, 0.0f),
                   ours = -power_of(alpha) * log(base_of(alpha, 2.0 * mu)) / log(2.0);
            double *to = coefficients + PARTS * (row * desc->columns + column);
            to[0] = (double)side.a + 0.5 * (theirs - ours);
            to[1] = (double)side.h, to[2] = (double)side.g, to[3] = (double)side.k;
        }
    }
}

/* Fills the terms of interpolation between the nodes around each side: term[slab][side][part][corner]. */
static void place(const SolvedSet *set, const FibreTableDesc *desc, FitTerm *term) {
    for (int slab = 0; slab < set->count; slab++) {
        const SolvedSlab *t = &set->slabs[slab];
        double y = log(t->slab.alpha / desc->low) / log(desc->high / desc->low) * (desc->rows - 1);
        for (int side = 0; side < t->sides; side++) {
            double weight[CORNERS], x = column_of(t->mu[side]) * (desc->columns - 1);
            int node[CORNERS];
            corners(desc, x, y, node, weight);
            for (int part = 0; part < PARTS; part++)
                for (int c = 0; c < CORNERS; c++)
                    *term++ = (FitTerm){part * t->sides + side, PARTS * node[c] + part, weight[c]};
        }
    }
}

static bool fit(const FibreTableDesc *desc, const SolvedSet *set, float *texels, FitError *error) {
    enum { LOCALS = PARTS * RINGS };
    size_t slabs = (size_t)set->count, per_slab = LOCALS * CORNERS;
    int count = PARTS * desc->rows * desc->columns, moving[LOCALS];
    double zeros[LOCALS] = {0.0};
    FitTerm *all = alloc_array(slabs * per_slab, sizeof(FitTerm));
    const FitTerm **terms = alloc_array(slabs, sizeof(FitTerm *));
    const double **fixed = alloc_array(slabs, sizeof(double *));
    int *counts = alloc_array(slabs, sizeof *counts);
    double *found = alloc_array((size_t)count, sizeof *found);
    bool done = all && terms && fixed && counts && found;
    for (int k = 0; k < LOCALS; k++) moving[k] = k;
    for (size_t s = 0; done && s < slabs; s++)
        terms[s] = all + s * per_slab, fixed[s] = zeros, counts[s] = (int)per_slab;
    FitForm form = {LOCALS, count, LOCALS, moving, NULL, value, terms, counts, fixed};
    if (done) {
        place(set, desc, all);
        start(desc, found);
        done = fit_run(&form, set, (FitEffort){desc->rounds, 5.0, 0.4, 60.0, 0.0}, desc->threads, desc->progress,
                       desc->user, found);
    }
    for (int k = 0; done && k < count; k++) found[k] = (double)(texels[k] = half_near(found[k]));
    done = done && fit_error(&form, set, found, error);
    free(all);
    free(terms);
    free(fixed);
    free(counts);
    free(found);
    return done;
}

bool fibre_table_fit(const FibreTableDesc *desc, float *texels, FitError *error) {
    static const double white[] = {1.0};
    int count = 2 * desc->rows - 1;
    double *alpha = alloc_array((size_t)count, sizeof *alpha);
    if (!alpha) return false;
    for (int k = 0; k < count; k++) alpha[k] = alpha_at(desc, (double)k / (count - 1));
    SolvedGrid grid = {count, 1, 0, 1, RINGS, SPOKES, alpha, white, NULL, 1.0};
    SolvedSet set;
    bool done = solved_set_make(&grid, desc->threads, desc->progress, desc->user, &set);
    if (done) {
        done = fit(desc, &set, texels, error);
        solved_set_free(&set);
    }
    free(alpha);
    return done;
}
