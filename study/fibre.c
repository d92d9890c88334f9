/* Prints how near the closed forms of fibres are to the solved slab, how long the solver takes, and how well
 * it holds. Directions and alphas are none that anything was fitted to.
 *
 *   build/release/study/study_fibre [solver|models|tiers|sampling] */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/memory.h"
#include "base/pi.h"
#include "fibre/slab.h"
#include "fibre/solver_reference.h"
#include "fibre/tilted.h"
#include "shading/catalogue/albedo.h"
#include "shading/catalogue/registry.h"

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---- the solver ---- */

enum { GRID = 32 };

/* R over the grid of (alpha, mu) that published tables have, alpha = k / 31 from 0.01. */
static double grid_albedo(int finer, double albedo[GRID][GRID], double *defect, double *balance) {
    double start = now(), mu[GRID];
    for (int k = 0; k < GRID; k++) mu[k] = k ? k / 31.0 : 0.01;
    for (int a = 0; a < GRID; a++) {
        double through[GRID], lost;
        Slab slab = {a ? a / 31.0 : 0.01, 1.0, 1.0};
        SlabEffort effort = slab_effort(slab.alpha);
        effort.nodes *= finer;
        effort.halvings += finer > 1 ? 4 : 0;
        slab_mode(&slab, effort, 0, 1, GRID, mu, &(Layered){.up = albedo[a], .down = through}, &lost);
        for (int k = 0; k < GRID && slab.alpha >= 0.1; k++) {
            *balance = fmax(*balance, fabs(albedo[a][k] + through[k] - 1.0));
            *defect = fmax(*defect, lost);
        }
    }
    return now() - start;
}

/* The whole BRDF: modes 0 .. 5 at 31 alphas, 32 mu_i, 32 theta_o. */
static double brdf_time(void) {
    double start = now(), mu[2 * GRID], *r = alloc_array(4 * GRID * GRID, sizeof *r);
    for (int k = 0; k < GRID; k++) {
        mu[k] = k ? k / 31.0 : 0.01;
        mu[GRID + k] = (cos)((k + 0.5) * 1.57079632679 / GRID);
    }
    for (int a = 1; a < GRID; a++)
        for (int m = 0; m < 6; m++)
            slab_mode(&(Slab){a / 31.0, 1.0, 1.0}, (SlabEffort){a < 6 ? 96 : 48, 26}, m, 1, 2 * GRID, mu,
                      &(Layered){.r = r}, NULL);
    free(r);
    return now() - start;
}

static void print_solver(void) {
    static double coarse[GRID][GRID], fine[GRID][GRID];
    double defect = 0.0, balance = 0.0, unused[2] = {0.0, 0.0}, worst = 0.0, square = 0.0;
    double seconds = grid_albedo(1, coarse, &defect, &balance);
    grid_albedo(2, fine, &unused[0], &unused[1]);
    for (int a = 2; a < GRID; a++)
        for (int k = 0; k < GRID; k++) {
            double d = fabs(coarse[a][k] - fine[a][k]);
            worst = fmax(worst, d);
            square += d * d / (30.0 * GRID);
        }
    printf("solver, one core\n");
    printf("  R, 32 alphas x 32 mu          %.2f s; against twice the nodes, alpha >= 0.065: %.1e at most, "
           "%.1e rms\n",
           seconds, worst, (sqrt)(square));
    printf("  BRDF, 31 x 32 x 32, any phi   %.2f s\n", brdf_time());
    printf("  R + T - 1, alpha >= 0.1       %.1e at most; %.1e of sigma before the quadrature is repaired\n", balance,
           defect);
}

/* ---- the models ---- */

static const char *const models[] = {"fibre", "fibre-table", "ltc-fibre"};

static void set(Lobe *lobe, const char *name, double value) {
    int k = weft_lobe_param_find(lobe->id, name);
    if (k >= 0) lobe_set(lobe, k, (float)value);
}

/* R by the lobe's own quadrature, where it can be had: a lobe may be thinner than the reference's directions. */
static void refine_albedo(const Lobe *lobe, const SolvedSlab *t, FitError *e) {
    if (t->tilt > 0.0 || t->slab.albedo < 1.0) return;
    e->albedo = e->most = 0.0;
    for (int k = 0; k < t->sides; k++) {
        Dir o = dir((float)(sqrt)(1.0 - t->mu[k] * t->mu[k]), 0.0f, (float)t->mu[k]);
        double r = (double)albedo_quadrature(lobe, o, 1e-5).f0;
        e->albedo = fmax(e->albedo, fabs(r - t->reflected[k]));
        e->most = fmax(e->most, r);
    }
}

/* The mean over slabs of the mean error, the largest of the rest. */
static FitError set_error(int id, const SolvedSet *slabs, double low, double high) {
    FitError all = {0}, one;
    int count = 0;
    for (int s = 0; s < slabs->count; s++) {
        const SolvedSlab *t = &slabs->slabs[s];
        if (t->slab.alpha < low || t->slab.alpha > high) continue;
        Lobe lobe = lobe_default(id);
        set(&lobe, "alpha", t->slab.alpha);
        set(&lobe, "density", t->slab.depth);
        set(&lobe, "tilt", t->tilt);
        double *f = alloc_array((size_t)t->pairs, sizeof *f);
        for (int p = 0; p < t->pairs; p++) {
            double wi[3], wo[3];
            solved_pair(t, p, wi, wo);
            Dir i = dir((float)wi[0], (float)wi[1], (float)wi[2]), o = dir((float)wo[0], (float)wo[1], (float)wo[2]);
            LobeValue v = lobe_value(&lobe, angles_between(o, i));
            f[p] = (double)(v.f * tint_color(v.tint, (float)t->slab.albedo)) - solved_single_scatter(t, p);
        }
        solved_error(t, f, &one);
        free(f);
        refine_albedo(&lobe, t, &one);
        all.mean += one.mean;
        all.worst = fmax(all.worst, one.worst);
        all.albedo = fmax(all.albedo, one.albedo);
        all.most = fmax(all.most, one.most);
        count++;
    }
    all.mean /= fmax(count, 1);
    return all;
}

static void print_row(const char *id, const char *what, const SolvedSet *slabs, double low, double high) {
    FitError e = set_error(weft_lobe_find(id), slabs, low, high);
    printf("  %-12s %-34s %6.2f %7.1f   %.1e   %.4f\n", id, what, 100.0 * e.mean, 100.0 * e.worst, e.albedo, e.most);
    fflush(stdout);
}

/* Alphas between those of the fits, which are even in the logarithm. */
static void alphas_from(double low, double high, int n, double *alpha) {
    for (int k = 0; k < n; k++) alpha[k] = low * (pow)(high / low, (k + 0.5) / n);
}
static void between(double low, int n, double *alpha) { alphas_from(low, 1.0, n, alpha); }

static void make(const SolvedGrid *grid, SolvedSet *slabs) {
    if (solved_set_make(grid, 0, NULL, NULL, slabs)) return;
    fputs("study_fibre: out of memory\n", stderr);
    exit(1);
}

static void print_slabs(const char *what, const SolvedGrid *grid, double low, double high) {
    SolvedSet slabs;
    make(grid, &slabs);
    print_row("fibre", what, &slabs, low, high);
    solved_set_free(&slabs);
}

static void print_models(void) {
    static const double white[] = {1.0}, colors[] = {0.2, 0.35, 0.5, 0.7, 0.9, 0.96, 1.0}, few[] = {0.2, 0.5, 0.9};
    static const double radians = RADIANS;
    double alpha[21], tilts[] = {7.5 * radians, 22.5 * radians, 40.0 * radians};
    SolvedSet slabs;
    SolvedGrid grid = {21, 1, 0, 1, 33, 7, alpha, white, tilts, 1.0};
    printf("\nmodels: error of f in %% of R, of directions with R > 1e-3; of R at any, where white\n"
           "fibres stand upright by the lobe's own quadrature; largest R\n");
    printf("  lobe         over                                 mean   worst   R         most\n");
    between(0.05, 21, alpha);
    make(&grid, &slabs);
    for (size_t m = 0; m < sizeof models / sizeof models[0]; m++) {
        if (weft_lobe_find(models[m]) < 0) continue;
        print_row(models[m], "white, alpha 0.19 .. 1", &slabs, 0.19, 1.0);
        if (weft_lobe_info(weft_lobe_find(models[m]))->params[0].hard_low < 0.1f)
            print_row(models[m], "white, alpha 0.05 .. 0.19", &slabs, 0.0, 0.19);
    }
    solved_set_free(&slabs);
    between(0.19, 9, alpha);
    grid.alphas = 9, grid.kept = 4, grid.depth = 2.8;
    print_slabs("density .35 .. 2.8, alpha 0.19 .. 1", &grid, 0.0, 1.0);
    grid.albedos = 7, grid.albedo = colors, grid.kept = 1, grid.depth = 1.0, grid.rings = 25, grid.spokes = 5;
    print_slabs("colour .2 .. 1, alpha 0.19 .. 1", &grid, 0.0, 1.0);
    grid.kept = 4, grid.depth = 2.8;
    print_slabs("colour, density, alpha 0.19 .. 1", &grid, 0.0, 1.0);
    alphas_from(0.05, 0.19, 9, alpha);
    grid.kept = 1, grid.depth = 1.0;
    print_slabs("colour, alpha 0.05 .. 0.19", &grid, 0.0, 1.0);
    grid.kept = 4, grid.depth = 2.8;
    print_slabs("colour, density, alpha .05 .. .19", &grid, 0.0, 1.0);
    between(0.3, 6, alpha);
    grid = (SolvedGrid){6, 1, 3, 1, 9, 9, alpha, white, tilts, 1.0};
    make(&grid, &slabs);
    print_row("fibre", "tilt 7.5 .. 40, alpha 0.45 .. 1", &slabs, 0.45, 1.0);
    print_row("fibre", "tilt 7.5 .. 40, alpha 0.3 .. 0.45", &slabs, 0.0, 0.45);
    solved_set_free(&slabs);
    grid.kept = 4, grid.depth = 2.8;
    print_slabs("tilt and density, alpha 0.45 .. 1", &grid, 0.45, 1.0);
    grid.albedos = 3, grid.albedo = few, grid.kept = 1, grid.depth = 1.0;
    print_slabs("tilt, colour, alpha 0.45 .. 1", &grid, 0.45, 1.0);
    grid.kept = 4, grid.depth = 2.8;
    print_slabs("all three, alpha 0.45 .. 1", &grid, 0.45, 1.0);
}

/* ---- the tiers ---- */

/* The materials of a row, drawn from a range, and the error in % of R that we want to stay below, mean and worst; 0
 * where none is set. */
typedef struct Tier {
    const char *what, *parameter; /* what a lobe needs to have, or NULL */
    bool colored;
    double low, high; /* alpha */
    double mean, worst;
} Tier;

static double drawn_between(unsigned *state, double low, double high) {
    *state = *state * 1664525u + 1013904223u;
    return low + (high - low) * ((double)(*state >> 8) + 0.5) / 16777216.0;
}

/* Why a lobe has no figures over a row, or NULL where it has. */
static const char *refusal(int id, const Tier *tier) {
    const WeftLobeInfo *info = weft_lobe_info(id);
    if (tier->parameter && weft_lobe_param_find(id, tier->parameter) < 0) return tier->parameter;
    if (tier->colored && !(info->traits & TRAIT_TINTED)) return "colour of fibres";
    return (double)info->params[0].hard_low > tier->low + 1e-6 ? "such alpha" : NULL;
}

static void print_tier(const Tier *tier, unsigned *state) {
    enum { ALPHAS = 6, COLORS = 3, TILTS = 2 };
    double alpha[ALPHAS], color[COLORS], tilt[TILTS];
    const bool leans = tier->parameter && strcmp(tier->parameter, "tilt") == 0, dense = tier->parameter && !leans;
    for (int k = 0; k < ALPHAS; k++)
        alpha[k] = tier->low * (pow)(tier->high / tier->low, drawn_between(state, 0.0, 1.0));
    for (int k = 0; k < COLORS; k++) color[k] = tier->colored ? drawn_between(state, 0.2, 1.0) : 1.0;
    if (tier->colored) color[COLORS - 1] = 1.0; /* the last is what others are compared with */
    for (int k = 0; k < TILTS; k++) tilt[k] = drawn_between(state, 0.05, 0.75);
    SolvedGrid grid = {.alphas = ALPHAS,
                       .albedos = tier->colored ? COLORS : 1,
                       .tilts = leans ? TILTS : 0,
                       .kept = dense ? 4 : 1,
                       .rings = leans ? 9 : 25,
                       .spokes = leans ? 9 : 7,
                       .alpha = alpha,
                       .albedo = color,
                       .tilt = tilt,
                       .depth = dense ? drawn_between(state, 2.0, 4.0) : 1.0};
    SolvedSet slabs;
    make(&grid, &slabs);
    for (size_t m = 0; m < sizeof models / sizeof models[0]; m++) {
        const int id = weft_lobe_find(models[m]);
        const char *none = refusal(id, tier);
        printf("  %-24s %5.2f ", tier->what, tier->mean);
        if (tier->worst > 0.0)
            printf("%6.2f", tier->worst);
        else
            printf("%6s", "-");
        printf("  %-12s ", models[m]);
        if (none) {
            printf("has no %s\n", none);
            continue;
        }
        const FitError e = set_error(id, &slabs, 0.0, 1.0);
        const double mean = 100.0 * e.mean, worst = 100.0 * e.worst;
        const bool holds = mean <= tier->mean && (tier->worst <= 0.0 || worst <= tier->worst);
        printf("%6.2f %7.1f  %s\n", mean, worst, holds ? "yes" : "no");
    }
    fflush(stdout);
    solved_set_free(&slabs);
}

static void print_tiers(void) {
    static const Tier tiers[] = {
        {"white, alpha .19 .. 1", NULL, false, 0.19, 1.0, 0.25, 1.2},
        {"white, alpha .05 .. .19", NULL, false, 0.05, 0.19, 0.25, 1.2},
        {"density, alpha .19 .. 1", "density", false, 0.19, 1.0, 1.0, 0.0},
        {"colour, alpha .19 .. 1", NULL, true, 0.19, 1.0, 1.0, 0.0},
        {"colour, alpha .05 .. .19", NULL, true, 0.05, 0.19, 3.0, 0.0},
        {"nap, alpha .38 .. 1", "tilt", false, 0.38, 1.0, 1.0, 0.0},
    };
    unsigned state = 28;
    printf("\ntiers: error of f in %% of R, at materials drawn at random, and the aim\n");
    printf("  materials                  aim  worst  lobe           mean   worst  within\n");
    for (size_t k = 0; k < sizeof tiers / sizeof *tiers; k++) print_tier(&tiers[k], &state);
}

/* ---- sampling ---- */

/* The weight f cos / pdf of stratified samples: its variance in parts of its mean's square, and its largest.
 */
static void weights(Lobe lobe, double mu, double *variance, double *most) {
    enum { SIDE = 96 };
    Dir o = dir((float)(sqrt)(1.0 - mu * mu), 0.0f, (float)mu);
    double sum = 0.0, squares = 0.0, top = 0.0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        Dir i = lobe_sample(&lobe, o, ((float)(k % SIDE) + 0.5f) / SIDE, ((float)(k / SIDE) + 0.5f) / SIDE);
        if (!(i.z > 0.0f)) continue;
        LobeValue v = lobe_value(&lobe, angles_between(o, i));
        double w = v.pdf > 0.0f ? (double)(v.f * i.z / v.pdf) : 0.0;
        sum += w;
        squares += w * w;
        top = fmax(top, w);
    }
    double n = SIDE * SIDE, mean = sum / n;
    *variance = squares / n / (mean * mean) - 1.0;
    *most = top / mean;
}

static void print_sampling(void) {
    printf("\nsampling, white: variance of the weight in parts of its mean's square, and the largest weight "
           "over its mean\n");
    for (size_t m = 0; m < sizeof models / sizeof models[0]; m++) {
        int id = weft_lobe_find(models[m]), count = 0;
        double mean = 0.0, worst = 0.0, largest = 0.0, variance, top;
        if (id < 0) continue;
        for (int a = 6; a < GRID; a += 2)
            for (int k = 0; k < GRID; k++) {
                Lobe lobe = lobe_default(id);
                set(&lobe, "alpha", a / 31.0);
                weights(lobe, k ? k / 31.0 : 0.01, &variance, &top);
                mean += variance;
                worst = fmax(worst, variance);
                largest = fmax(largest, top);
                count++;
            }
        printf("  %-12s alpha 0.19 .. 1: variance %.4f in the mean, %.3f at worst; largest weight %.1f\n", models[m],
               mean / count, worst, largest);
    }
}

int main(int count, char **arguments) {
    const char *only = count > 1 ? arguments[1] : "";
    if (!only[0] || strcmp(only, "solver") == 0) print_solver();
    if (!only[0] || strcmp(only, "models") == 0) print_models();
    if (!only[0] || strcmp(only, "tiers") == 0) print_tiers();
    if (!only[0] || strcmp(only, "sampling") == 0) print_sampling();
    return 0;
}
