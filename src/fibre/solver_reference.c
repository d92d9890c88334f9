#include "fibre/solver_reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/pi.h"
#include "base/thread.h"
#include "fibre/gauss.h"
#include "fibre/tilted.h"

enum { MODES = 5 };

/* The work of all threads. */
typedef struct SolveWork {
    const SolvedGrid *grid;
    SolvedSet *set;
    int runs; /* of the solver: one for each alpha, albedo and tilt */
    SolveProgress progress;
    void *user;
    int done;
    bool failed;
} SolveWork;

/* The sides and pairs that all slabs share. */
typedef struct SlabLayout {
    int sides, pairs;
    double *mu, *w, *phi;
    int *i, *j;
    double *share, *delta_phi;
} SlabLayout;

static int runs_of(const SolvedGrid *g) { return g->alphas * g->albedos * (g->tilts ? g->tilts : 1); }

/* Solves the slabs of all depths with upright fibres, mode by mode; f is without single scattering. */
static bool solve_upright(const SolveWork *work, const SlabLayout *at, const Slab *slab, SolvedSlab *slabs) {
    int kept = work->grid->kept, n = at->sides;
    size_t cells = (size_t)n * (size_t)n;
    double *r = alloc_array((size_t)kept * (cells + (size_t)n), sizeof(double));
    if (!r) return false;
    double *up = r + (size_t)kept * cells;
    SlabEffort effort = slab_effort(slab->alpha);
    bool done = true;
    for (int m = 0; m < MODES && done; m++) {
        done = slab_mode(slab, effort, m, kept, n, at->mu, &(Layered){.r = r, .up = m ? NULL : up}, NULL);
        for (int k = 0; k < kept && done; k++) {
            if (m == 0) memcpy(slabs[k].reflected, up + (size_t)k * (size_t)n, (size_t)n * sizeof *up);
            for (int p = 0; p < at->pairs; p++) {
                size_t cell = (size_t)k * cells + (size_t)(at->i[p] * n + at->j[p]);
                double single = slab_single_mode(&slabs[k].slab, m, at->mu[at->i[p]], at->mu[at->j[p]]);
                slabs[k].f[p] += (m ? 2.0 : 1.0) * (r[cell] - single) * cos(m * at->delta_phi[p]) / (2.0 * PI_DOUBLE);
            }
        }
    }
    free(r);
    return done;
}

/* Solves the slabs of all depths with tilted fibres; f is without single scattering. */
static bool solve_tilted(const SolveWork *work, const SlabLayout *at, const Slab *slab, double tilt,
                         SolvedSlab *slabs) {
    int kept = work->grid->kept, n = at->sides;
    size_t cells = (size_t)n * (size_t)n;
    double *same = alloc_array((size_t)kept * (2 * cells + (size_t)n), sizeof(double));
    Heading *headings = alloc_array((size_t)n, sizeof *headings);
    bool done = same && headings;
    if (done) {
        double *across = same + (size_t)kept * cells, *up = across + (size_t)kept * cells;
        for (int k = 0; k < n; k++) headings[k] = (Heading){at->mu[k], at->phi[k]};
        done = tilted_f(slab, tilt, tilt_effort(slab->alpha), kept, n, headings, same, across, up);
        for (int k = 0; k < kept && done; k++) {
            memcpy(slabs[k].reflected, up + (size_t)k * (size_t)n, (size_t)n * sizeof *up);
            for (int p = 0; p < at->pairs; p++) {
                size_t cell = (size_t)k * cells + (size_t)(at->i[p] * n + at->j[p]);
                Heading o = headings[at->j[p]];
                o.phi += at->delta_phi[p];
                slabs[k].f[p] = (at->delta_phi[p] < 0.0 ? across : same)[cell] -
                                tilted_single(&slabs[k].slab, tilt, headings[at->i[p]], o);
            }
        }
    }
    free(same);
    free(headings);
    return done;
}

typedef struct SlabJob {
    SolveWork *work;
    const SlabLayout *at;
} SlabJob;

static void run(void *user, int item, int thread) {
    (void)thread;
    SlabJob *job = user;
    SolveWork *work = job->work;
    const SolvedGrid *g = work->grid;
    if (work->failed) return;
    SolvedSlab *slabs = work->set->slabs + (size_t)item * (size_t)g->kept;
    Slab slab = slabs[g->kept - 1].slab;
    bool done =
        g->tilts ? solve_tilted(work, job->at, &slab, slabs->tilt, slabs) : solve_upright(work, job->at, &slab, slabs);
    int count = __atomic_add_fetch(&work->done, 1, __ATOMIC_RELAXED);
    if (!done || (work->progress && !work->progress(work->user, count, work->runs)))
        __atomic_store_n(&work->failed, true, __ATOMIC_RELAXED);
}

/* Makes directions and pairs in memory that the set owns. Returns false if that is short. */
static bool layout_make(const SolvedGrid *g, SolvedSet *set, SlabLayout *at, double **rest) {
    bool lean = g->tilts > 0;
    int sides = lean ? g->rings * g->spokes : g->rings, angles = lean ? 2 : g->spokes;
    int pairs = sides * (sides + 1) / 2 * angles;
    size_t slabs = (size_t)set->count, tilts = lean ? (size_t)g->tilts : 1;
    size_t size =
        5 * (size_t)sides + 2 * (size_t)pairs + tilts * (size_t)(sides + pairs) + slabs * (size_t)(pairs + sides);
    set->block = alloc_array(size, sizeof(double));
    set->numbers = alloc_array(2 * (size_t)pairs, sizeof(int));
    set->slabs = alloc_array(slabs, sizeof(SolvedSlab));
    if (!set->block || !set->numbers || !set->slabs) return false;
    double *mu = set->block, *w = mu + sides, *phi = w + sides, *x = phi + sides, *v = x + sides;
    *at = (SlabLayout){sides, pairs, mu, w, phi, set->numbers, set->numbers + pairs, v + sides, v + sides + pairs};
    *rest = v + sides + 2 * (size_t)pairs;
    gauss_legendre(g->rings, x, v);
    for (int k = 0; k < sides; k++) {
        int ring = lean ? k / g->spokes : k, spoke = lean ? k % g->spokes : 0;
        mu[k] = x[ring] * x[ring];
        w[k] = 2.0 * x[ring] * v[ring] / (lean ? g->spokes : 1);
        phi[k] = lean ? PI_DOUBLE * (spoke + 0.5) / g->spokes : 0.0;
    }
    int p = 0;
    for (int i = 0; i < sides; i++)
        for (int j = i; j < sides; j++)
            for (int k = 0; k < angles; k++, p++) {
                at->i[p] = i;
                at->j[p] = j;
                at->share[p] = 1.0 / angles;
                at->delta_phi[p] = !lean ? PI_DOUBLE * (k + 0.5) / angles : k ? -2.0 * phi[j] : 0.0;
            }
    return true;
}

/* Fills the slabs of the set but for their results. */
static void slabs_fill(const SolvedGrid *g, SolvedSet *set, const SlabLayout *at, double *rest) {
    int tilts = g->tilts ? g->tilts : 1, n = 0;
    for (int q = 0; q < tilts; q++) {
        double tilt = g->tilts ? g->tilt[q] : 0.0, *nu = rest, *x = nu + at->sides;
        rest = x + at->pairs;
        for (int k = 0; k < at->sides; k++)
            nu[k] = g->tilts ? sqrt(1.0 - at->mu[k] * at->mu[k]) * cos(at->phi[k]) * sin(tilt) + at->mu[k] * cos(tilt)
                             : at->mu[k];
        for (int k = 0; k < at->pairs; k++) {
            int i = at->i[k], j = at->j[k];
            double r = sqrt((1.0 - at->mu[i] * at->mu[i]) * (1.0 - at->mu[j] * at->mu[j]));
            x[k] = r * cos(at->phi[j] + at->delta_phi[k] - at->phi[i]) + at->mu[i] * at->mu[j] - nu[i] * nu[j];
        }
        for (int a = 0; a < g->alphas; a++)
            for (int b = 0; b < g->albedos; b++)
                for (int k = 0; k < g->kept; k++, n++) {
                    Slab slab = {g->alpha[a], g->albedo[b], ldexp(g->depth, k + 1 - g->kept)};
                    set->slabs[n] = (SolvedSlab){slab,      tilt, at->sides, at->pairs,       at->mu,        at->phi,
                                                 at->w,     nu,   at->i,     at->j,           at->delta_phi, x,
                                                 at->share, rest, NULL,      rest + at->pairs};
                    rest += at->pairs + at->sides;
                }
    }
    for (int k = 0; k < n; k++) { /* the same slab of the last albedo */
        int run = k / g->kept, last = run - run % g->albedos + g->albedos - 1;
        set->slabs[k].white = set->slabs[last * g->kept + k % g->kept].f;
    }
}

bool solved_set_make(const SolvedGrid *grid, int threads, SolveProgress progress, void *user, SolvedSet *out) {
    *out = (SolvedSet){.count = runs_of(grid) * grid->kept};
    SlabLayout at;
    double *rest;
    SolveWork work = {grid, out, runs_of(grid), progress, user, 0, false};
    if (layout_make(grid, out, &at, &rest)) {
        slabs_fill(grid, out, &at, rest);
        parallel_for(threads, work.runs, run, &(SlabJob){&work, &at});
        if (!work.failed) return true;
    }
    solved_set_free(out);
    return false;
}

void solved_set_free(SolvedSet *set) {
    free(set->block);
    free(set->numbers);
    free(set->slabs);
    *set = (SolvedSet){0};
}

void solved_pair(const SolvedSlab *reference, int pair, double wi[3], double wo[3]) {
    int i = reference->i[pair], j = reference->j[pair];
    double ri = sqrt(1.0 - reference->mu[i] * reference->mu[i]), ro = sqrt(1.0 - reference->mu[j] * reference->mu[j]);
    double phi = reference->phi[j] + reference->delta_phi[pair];
    wi[0] = ri * cos(reference->phi[i]), wi[1] = ri * sin(reference->phi[i]), wi[2] = reference->mu[i];
    wo[0] = ro * cos(phi), wo[1] = ro * sin(phi), wo[2] = reference->mu[j];
}

double solved_weight_i(const SolvedSlab *t, int p) {
    return 2.0 * PI_DOUBLE * t->share[p] * t->w[t->j[p]] * t->mu[t->j[p]];
}
double solved_weight_j(const SolvedSlab *t, int p) {
    return t->i[p] == t->j[p] ? 0.0 : 2.0 * PI_DOUBLE * t->share[p] * t->w[t->i[p]] * t->mu[t->i[p]];
}

bool solved_error(const SolvedSlab *t, const double *f, FitError *out) {
    size_t sides = (size_t)t->sides;
    double *error = alloc_array(2 * sides, sizeof(double)), *dr = error + sides, all = 0.0;
    if (!error) return false;
    for (int p = 0; p < t->pairs; p++) {
        double d = f[p] - t->f[p];
        dr[t->i[p]] += solved_weight_i(t, p) * d;
        dr[t->j[p]] += solved_weight_j(t, p) * d;
        error[t->i[p]] += solved_weight_i(t, p) * fabs(d);
        error[t->j[p]] += solved_weight_j(t, p) * fabs(d);
    }
    *out = (FitError){0.0, 0.0, 0.0, 0.0};
    for (size_t k = 0; k < sides; k++) {
        double r = t->reflected[k];
        out->albedo = fmax(out->albedo, fabs(dr[k]));
        out->most = fmax(out->most, r + dr[k]);
        if (r <= 1e-3) continue;
        out->mean += error[k] / r * t->w[k];
        out->worst = fmax(out->worst, error[k] / r);
        all += t->w[k];
    }
    out->mean /= fmax(all, 1e-30);
    free(error);
    return true;
}

double solved_single_scatter(const SolvedSlab *t, int p) {
    Heading i = {t->mu[t->i[p]], t->phi[t->i[p]]}, o = {t->mu[t->j[p]], t->phi[t->j[p]] + t->delta_phi[p]};
    return tilted_single(&t->slab, t->tilt, i, o);
}
