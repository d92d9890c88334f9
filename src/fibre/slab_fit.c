#include "fibre/slab_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/matrix.h"
#include "base/memory.h"
#include "base/thread.h"

/* A pass over the slabs: cost, and with slopes its quadratic model. Every slab has its own result, and results are
 * summed in order, so that they do not depend on threads. */
typedef struct FitPass {
    const FitForm *form;
    const SolvedSet *set;
    FitEffort effort;
    const double *coefficients;
    double softness; /* errors below this fraction of f count by their square */
    bool logs;       /* compare logarithms, which converges from a distant start */
    bool slopes;
    double *cost, *gradient, *curvature; /* [slab], [slab][locals], [slab][locals^2] */
    bool failed;
} FitPass;

/* Computes the local numbers of a slab. */
static void theta_of(const FitForm *form, int slab, const double *coefficients, double *theta) {
    memcpy(theta, form->fixed[slab], (size_t)form->locals * sizeof *theta);
    for (int k = 0; k < form->term_counts[slab]; k++) {
        const FitTerm *term = &form->terms[slab][k];
        theta[form->moving[term->at]] += coefficients[term->coefficient] * term->basis;
    }
}

/* Returns V, the weight of a direction in the sum. */
static double side_weight(const SolvedSlab *t, int k, double grazing) { return 0.5 * (t->w[k] + grazing / t->sides); }

/* Adds S^T S to the curvature and S^T r to the gradient, for rows of weighted slopes. */
static bool add_rows(int rows, int n, const double *slope, const double *residual, double *gradient,
                     double *curvature) {
    Matrix rows_of = {slope, n, 1}, columns_of = {slope, 1, n};
    return matrix_product(n, n, rows, 1.0, columns_of, rows_of, 1.0, curvature, n) &&
           matrix_product(n, 1, rows, 1.0, columns_of, (Matrix){residual, 1, rows}, 1.0, gradient, n);
}

/* Computes the cost of a slab, sum over directions of V (x + worst x^2 / 2 + 2 albedo sqrt(dR^2 + 1e-8)), where x, the
 * error of a direction, is the weighted sum over its pairs of sqrt(r^2 + e^2) / R. */
static void slab_pass(void *user, int item, int thread) {
    (void)thread;
    FitPass *pass = user;
    const FitForm *form = pass->form;
    const SolvedSlab *t = &pass->set->slabs[item];
    int n = form->movings;
    size_t pairs = (size_t)t->pairs, sides = (size_t)t->sides, slopes = pass->slopes ? (size_t)n : 0;
    size_t locals = (size_t)form->locals, wide = pass->slopes ? pairs * locals : 0;
    double *block = alloc_array(3 * pairs + wide + 2 * sides + sides * slopes + locals, sizeof(double));
    if (!block) {
        pass->failed = true;
        return;
    }
    double *log_f = block, *r = log_f + pairs, *q = r + pairs, *slope = q + pairs, *dr = slope + wide;
    double *x = dr + sides, *row = x + sides, *theta = row + sides * slopes, cost = 0.0;
    theta_of(form, item, pass->coefficients, theta);
    form->value(form->user, item, t, theta, log_f, pass->slopes ? slope : NULL);
    for (int p = 0; p < t->pairs; p++) {
        double reference = fmax(t->f[p], 1e-14), l = fmin(fmax(log_f[p], -60.0), 25.0), e = pass->softness * reference;
        r[p] = pass->logs ? reference * (l - log(reference)) : exp(l) - reference;
        q[p] = sqrt(r[p] * r[p] + e * e);
        dr[t->i[p]] += solved_weight_i(t, p) * r[p];
        dr[t->j[p]] += solved_weight_j(t, p) * r[p];
        x[t->i[p]] += solved_weight_i(t, p) * q[p] / fmax(t->reflected[t->i[p]], 1e-3);
        x[t->j[p]] += solved_weight_j(t, p) * q[p] / fmax(t->reflected[t->j[p]], 1e-3);
        log_f[p] = pass->logs ? reference : exp(l); /* from now on, r by log f */
    }
    for (int k = 0; k < t->sides; k++) {
        double v = side_weight(t, k, pass->effort.grazing), worst = pass->effort.worst * x[k];
        cost += v * x[k] * (1.0 + 0.5 * worst);
        x[k] = v * (1.0 + worst) / fmax(t->reflected[k], 1e-3); /* from now on, cost by r */
    }
    for (int p = 0; p < t->pairs; p++) {
        double w = solved_weight_i(t, p) * x[t->i[p]] + solved_weight_j(t, p) * x[t->j[p]], root = sqrt(w / q[p]);
        const double *from = slope + (size_t)p * locals; /* what moves is gathered at the front */
        double *s = slope + (size_t)p * slopes;
        for (size_t k = 0; k < slopes; k++) {
            s[k] = log_f[p] * from[form->moving[k]];
            row[(size_t)t->i[p] * slopes + k] += solved_weight_i(t, p) * s[k];
            row[(size_t)t->j[p] * slopes + k] += solved_weight_j(t, p) * s[k];
            s[k] *= root;
        }
        r[p] *= root;
    }
    for (int k = 0; k < t->sides; k++) {
        double norm = sqrt(dr[k] * dr[k] + 1e-8),
               v = 2.0 * pass->effort.albedo * side_weight(t, k, pass->effort.grazing);
        if (dr[k] > 0.0 && t->reflected[k] + dr[k] > 0.96) v *= 100.0;
        cost += v * norm;
        double root = sqrt(v / norm);
        dr[k] *= root;
        for (size_t c = 0; c < slopes; c++) row[(size_t)k * slopes + c] *= root;
    }
    pass->cost[item] = cost;
    if (pass->slopes) {
        double *g = pass->gradient + item * n, *h = pass->curvature + (size_t)item * (size_t)n * (size_t)n;
        memset(g, 0, (size_t)n * sizeof *g);
        memset(h, 0, (size_t)n * (size_t)n * sizeof *h);
        if (!add_rows(t->pairs, n, slope, r, g, h) || !add_rows(t->sides, n, row, dr, g, h)) pass->failed = true;
    }
    free(block);
}

/* Runs a pass; returns the cost of all slabs and of the coefficients' size. */
static double pass_run(FitPass *pass, int threads) {
    double cost = 0.0;
    for (int k = 0; k < pass->form->coefficients; k++)
        cost += 0.5 * pass->effort.size * pass->coefficients[k] * pass->coefficients[k];
    parallel_for(threads, pass->set->count, slab_pass, pass);
    for (int k = 0; k < pass->set->count; k++) cost += pass->cost[k];
    return cost;
}

/* Assembles the system of the coefficients from those of theta: H = sum B^T H_slab B, g = sum B^T g_slab, and the
 * derivatives of their size. */
static void assemble(const FitPass *pass, double *h, double *g) {
    const FitForm *form = pass->form;
    size_t n = (size_t)form->coefficients, m = (size_t)form->movings;
    memset(h, 0, n * n * sizeof *h);
    memset(g, 0, n * sizeof *g);
    for (size_t k = 0; k < n; k++) {
        h[k * n + k] = pass->effort.size;
        g[k] = pass->effort.size * pass->coefficients[k];
    }
    for (int slab = 0; slab < pass->set->count; slab++) {
        const FitTerm *terms = form->terms[slab];
        const double *gs = pass->gradient + (size_t)slab * m, *hs = pass->curvature + (size_t)slab * m * m;
        for (int a = 0; a < form->term_counts[slab]; a++) {
            const FitTerm *s = &terms[a];
            g[s->coefficient] += s->basis * gs[s->at];
            for (int b = 0; b < form->term_counts[slab]; b++) {
                const FitTerm *t = &terms[b];
                if (t->coefficient > s->coefficient) continue;
                size_t high = (size_t)(s->at > t->at ? s->at : t->at);
                size_t low = (size_t)(s->at > t->at ? t->at : s->at);
                h[(size_t)t->coefficient * n + (size_t)s->coefficient] += s->basis * t->basis * hs[high * m + low];
            }
        }
    }
}

/* Solves (H + damping diag H) step = -g; returns false if that is singular. */
static bool solve(int n, const double *h, const double *g, double damping, double *work, double *step) {
    double most = 0.0;
    memcpy(work, h, (size_t)n * (size_t)n * sizeof *work);
    for (int k = 0; k < n; k++) most = fmax(most, h[k * n + k]);
    for (int k = 0; k < n; k++) {
        work[k * n + k] += damping * h[k * n + k] + 1e-12 * most;
        step[k] = -g[k];
    }
    return matrix_factor(n, work, n) && matrix_solve(n, work, n, 1, step, n);
}

/* Minimises the cost from `at`, by least squares with weights that make it least absolute error. The softness decreases
 * from round to round. Returns false on failure or if progress stops it. Kenneth Levenberg, "A Method for the Solution
 * of Certain Non-Linear Problems in Least Squares", 1944. */
static bool descend(FitPass *pass, int threads, SolveProgress progress, void *user, double *at, double *h, double *g,
                    double *work, double *step) {
    int n = pass->form->coefficients, rounds = pass->effort.rounds;
    double damping = 1e-2, *next = step + n;
    for (int round = 0; round < rounds; round++) {
        pass->logs = round < 10;
        pass->softness = round < 10 ? 0.3 : fmax(2e-3, 0.3 * pow(0.85, round - 10));
        if (round == 10) damping = fmax(damping, 1e-2);
        pass->coefficients = at;
        pass->slopes = true;
        double cost = pass_run(pass, threads);
        if (pass->failed) return false;
        assemble(pass, h, g);
        pass->slopes = false;
        bool better = false;
        for (int attempt = 0; attempt < 8 && !better; attempt++, damping = fmin(damping * 4.0, 1e6)) {
            if (!solve(n, h, g, damping, work, step)) continue;
            for (int k = 0; k < n; k++) next[k] = at[k] + step[k];
            pass->coefficients = next;
            better = pass_run(pass, threads) < cost;
            if (pass->failed) return false;
            if (better) break;
        }
        if (better) {
            memcpy(at, next, (size_t)n * sizeof *at);
            damping = fmax(damping * 0.3, 1e-10);
        }
        if (progress && !progress(user, round + 1, rounds)) return false;
    }
    return true;
}

bool fit_run(const FitForm *form, const SolvedSet *set, FitEffort effort, int threads, SolveProgress progress,
             void *user, double *coefficients) {
    size_t n = (size_t)form->coefficients, m = (size_t)form->movings, slabs = (size_t)set->count;
    double *block = alloc_array(slabs * (1 + m + m * m) + 2 * n * n + 3 * n, sizeof(double));
    if (!block) return false;
    FitPass pass = {.form = form, .set = set, .effort = effort, .cost = block};
    pass.gradient = pass.cost + slabs;
    pass.curvature = pass.gradient + slabs * m;
    double *h = pass.curvature + slabs * m * m, *work = h + n * n, *g = work + n * n;
    bool done = descend(&pass, threads, progress, user, coefficients, h, g, work, g + n);
    free(block);
    return done;
}

static bool slab_error(const FitForm *form, const SolvedSet *set, int slab, const double *coefficients, FitError *out) {
    const SolvedSlab *t = &set->slabs[slab];
    double *f = alloc_array((size_t)t->pairs + (size_t)form->locals, sizeof(double));
    if (!f) return false;
    theta_of(form, slab, coefficients, f + t->pairs);
    form->value(form->user, slab, t, f + t->pairs, f, NULL);
    for (int p = 0; p < t->pairs; p++) f[p] = exp(fmin(f[p], 25.0));
    bool done = solved_error(t, f, out);
    free(f);
    return done;
}

bool fit_error(const FitForm *form, const SolvedSet *set, const double *coefficients, FitError *all) {
    FitError one;
    *all = (FitError){0};
    for (int k = 0; k < set->count; k++) {
        if (!slab_error(form, set, k, coefficients, &one)) return false;
        all->mean += one.mean / set->count;
        all->worst = fmax(all->worst, one.worst);
        all->albedo = fmax(all->albedo, one.albedo);
        all->most = fmax(all->most, one.most);
    }
    return true;
}
