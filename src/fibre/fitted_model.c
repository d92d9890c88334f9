#include "fibre/fitted_model.h"
#include "base/pi.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Parts of the formula: A, h, g and k of multiple scattering, the exponents p, and q, v, u and k' of colour. */
typedef enum ModelPart { PART_A, PART_H, PART_G, PART_K, PART_P, PART_Q, PART_V, PART_U, PART_C, PARTS } ModelPart;

enum { POWERS = 3 };

typedef enum StageKind {
    UPRIGHT,
    THIN, /* times thin_of(t), 0 from alpha_thin up, so that only fine fibres pay for these numbers */
    NAP   /* features that are 0 for upright fibres */
} StageKind;

/* Numbers of one part and kind of feature. They are polynomials of the material: `degree[b][c]` powers of t go with the
 * power b of tilt_of and the power c of l. */
typedef struct CoefficientGroup {
    ModelPart part;
    StageKind kind;
    int first; /* the logarithm that the first number of PART_P multiplies */
    int count;
    int degree[POWERS][POWERS];
} CoefficientGroup;

static const CoefficientGroup groups[] = {
    {PART_A, UPRIGHT, 0, 9, {{8, 6, 4}}},
    {PART_H, UPRIGHT, 0, 5, {{6, 5, 3}}},
    {PART_G, UPRIGHT, 0, 7, {{6, 5, 3}}},
    {PART_K, UPRIGHT, 0, 4, {{5, 3, 2}}},
    {PART_P, UPRIGHT, 0, 2, {{6, 5, 3}}},
    {PART_A, THIN, 0, 12, {{5, 3, 2}}},
    {PART_H, THIN, 0, 7, {{5, 2, 1}}},
    {PART_G, THIN, 0, 7, {{5, 2, 1}}},
    {PART_K, THIN, 0, 5, {{4, 1}}},
    {PART_P, THIN, 0, 3, {{5, 2, 1}}},
    {PART_A, NAP, 0, 25, {{5, 2, 1}, {4, 1}, {3}}},
    {PART_H, NAP, 0, 9, {{4, 2}, {3, 1}, {2}}},
    {PART_G, NAP, 0, 9, {{4, 2}, {3, 1}, {2}}},
    {PART_K, NAP, 0, 3, {{4, 2}, {3}, {2}}},
    {PART_P, NAP, 3, 4, {{4, 2}, {3, 1}, {2}}},
    {PART_Q, UPRIGHT, 0, 5, {{4, 3, 1}}},
    {PART_V, UPRIGHT, 0, 4, {{3, 2, 1}}},
    {PART_U, UPRIGHT, 0, 4, {{3, 2, 1}}},
    {PART_C, UPRIGHT, 0, 3, {{3, 2}}},
    {PART_Q, THIN, 0, 7, {{4, 3, 2}}},
    {PART_V, THIN, 0, 5, {{3, 2, 1}}},
    {PART_U, THIN, 0, 5, {{3, 2, 1}}},
    {PART_C, THIN, 0, 3, {{3, 2}}},
};
enum { GROUPS = sizeof groups / sizeof groups[0], SCATTER_GROUPS = 15, FEATURES = 12, NAPS = 25, LOCALS_MAX = 128 };

/* Returns the stage that fits a group's coefficients of l^c. */
static FibreStage stage_of(const CoefficientGroup *g, int c) {
    if (g->part >= PART_Q) return g->kind == THIN ? FIBRE_THIN_COLOR : FIBRE_COLOR;
    if (g->kind == NAP) return FIBRE_NAP;
    if (c) return FIBRE_DENSITY;
    return g->kind == THIN ? FIBRE_THIN : FIBRE_WHITE;
}

/* ---- features: those of shading/media/fibre_model.h in double precision, without its `hold` ---- */

static const double alpha_low = 0.045, alpha_thin = 0.19, alpha_nap = 0.38;
static double t_of(double alpha) { return 1.0 - 2.0 * log(alpha) / log(alpha_low); }
static double thin_of(double t) { return fmax(t_of(alpha_thin) - t, 0.0); }
static double l_of(double depth) { return log(depth) / log(4.0); }
static double tilt_of(double tilt) { return 2.0 * sin(tilt) * sin(tilt); }

/* Returns u in [-1, 1] of mu: a power, from the square root at alpha 1 to the sixth root below 0.11, with a finite
 * slope at the horizon. */
static double u_of(double mu, double t) {
    const double c = 1e-3;
    double q = 0.26 + 0.24 * fmax(t, -0.4);
    return 2.0 * (pow(mu + c, q) - pow(c, q)) / (pow(1.0 + c, q) - pow(c, q)) - 1.0;
}

/* The features of a direction. */
typedef struct Side {
    double upright[FEATURES], nap[NAPS];
} Side;

static void features(const SolvedSlab *reference, int k, Side *side) {
    double mu = reference->mu[k], u = u_of(mu, t_of(reference->slab.alpha)), d = reference->nu[k] - mu,
           s = tilt_of(reference->tilt);
    double *f = side->upright, *n = side->nap, g = 0.03 / (mu + 0.03);
    f[0] = 1.0;
    f[1] = u;
    for (int j = 2; j < FEATURES; j++) f[j] = 2.0 * u * f[j - 1] - f[j - 2];
    double list[NAPS] = {d,
                         s,
                         d * u,
                         d * d,
                         s * u,
                         d * d * u,
                         d * d * d,
                         d * u * u,
                         s * u * u,
                         d * d * d * d,
                         d * d * d * u,
                         d * d * u * u,
                         d * u * u * u,
                         s * u * u * u,
                         d * d * d * d * d,
                         d * d * d * d * u,
                         d * d * d * u * u,
                         d * d * u * u * u,
                         d * u * u * u * u,
                         g * d,
                         g * d * d,
                         g * d * d * d,
                         g * d * d * d * d,
                         g * d * d * d * d * d,
                         g * s};
    memcpy(n, list, sizeof list);
}

/* Computes the logarithms that the exponents p multiply; the last four are 0 for upright fibres. */
enum { LOGS = 7 };
static void logarithms(const SolvedSlab *reference, int pair, double *l) {
    double a = reference->mu[reference->i[pair]], b = reference->mu[reference->j[pair]];
    double x = reference->nu[reference->i[pair]], y = reference->nu[reference->j[pair]],
           s = reference->slab.alpha * reference->slab.alpha;
    double ridge = 0.3 * s + 0.01, narrow = 0.3 * s * s + 1e-3, m = (a + b) * (a + b), n = (x + y) * (x + y);
    l[0] = log(a + b + 0.04);
    l[1] = log(a * a - a * b + b * b + ridge * ridge);
    l[2] = log(a + b + 0.002);
    l[3] = 0.5 * log((n + 0.09) / (m + 0.09));
    l[4] = 0.5 * log((n + 0.5) / (m + 0.5));
    l[5] = 0.5 * log((n + narrow) / (m + narrow));
    l[6] = log((x * x - x * y + y * y + 0.01) / (a * a - a * b + b * b + 0.01));
}

/* ---- values ---- */

/* Returns the index of a group's first number in theta. The forms of scattering and of colour are numbered
 * separately. */
static int first_local(int group) {
    int first = 0;
    for (int k = group >= SCATTER_GROUPS ? SCATTER_GROUPS : 0; k < group; k++) first += groups[k].count;
    return first;
}
/* Returns the length of theta. */
static int locals_of(bool color) {
    int last = (color ? GROUPS : SCATTER_GROUPS) - 1;
    return first_local(last) + groups[last].count;
}

static const double *features_of(const Side *side, int group) {
    return groups[group].kind == NAP ? side->nap : side->upright;
}

/* Returns the sum of features that makes a part of one direction. */
static double part_value(const Side *side, ModelPart part, const double *theta) {
    double sum = 0.0;
    for (int k = 0; k < GROUPS; k++) {
        if (groups[k].part != part) continue;
        const double *f = features_of(side, k), *at = theta + first_local(k);
        for (int q = 0; q < groups[k].count; q++) sum += f[q] * at[q];
    }
    return sum;
}

/* Computes the derivatives of sign (value_i value_j) by a part's numbers: sign (f_i value_j + f_j value_i). */
static void part_slope(ModelPart part, double sign, const Side *i, const Side *j, double value_i, double value_j,
                       double *slope) {
    for (int k = 0; k < GROUPS; k++) {
        if (groups[k].part != part) continue;
        const double *fi = features_of(i, k), *fj = features_of(j, k);
        double *at = slope + first_local(k);
        for (int q = 0; q < groups[k].count; q++) at[q] = sign * (fi[q] * value_j + fj[q] * value_i);
    }
}

/* The features and parts of all directions of a slab. */
typedef struct Sides {
    Side *side;
    double *part[PARTS];
} Sides;

static bool sides_make(const SolvedSlab *reference, const double *theta, ModelPart first, ModelPart last, Sides *out) {
    size_t n = (size_t)reference->sides;
    out->side = alloc_array(n, sizeof(Side));
    out->part[0] = alloc_array(n * PARTS, sizeof(double));
    if (!out->side || !out->part[0]) return false;
    for (int part = 1; part < PARTS; part++) out->part[part] = out->part[0] + n * (size_t)part;
    for (int k = 0; k < reference->sides; k++) {
        features(reference, k, &out->side[k]);
        for (int part = (int)first; part <= (int)last; part++)
            out->part[part][k] = part_value(&out->side[k], (ModelPart)part, theta);
    }
    return true;
}
static void sides_free(Sides *sides) {
    free(sides->side);
    free(sides->part[0]);
}

/* Evaluates log M and its derivatives (FitForm). */
static void scatter(void *user, int slab, const SolvedSlab *reference, const double *theta, double *log_f,
                    double *slope) {
    (void)user;
    (void)slab;
    Sides s;
    int n = locals_of(false), exponents = 0, at[2 * LOGS], which[2 * LOGS]; /* p_which += theta_at */
    for (int k = 0; k < SCATTER_GROUPS; k++)
        for (int q = 0; groups[k].part == PART_P && q < groups[k].count; q++, exponents++)
            at[exponents] = first_local(k) + q, which[exponents] = groups[k].first + q;
    if (sides_make(reference, theta, PART_A, PART_K, &s))
        for (int p = 0; p < reference->pairs; p++) {
            int i = reference->i[p], j = reference->j[p];
            double l[LOGS], h = s.part[PART_H][i], g = s.part[PART_G][i], k = s.part[PART_K][i];
            double h2 = s.part[PART_H][j], g2 = s.part[PART_G][j], k2 = s.part[PART_K][j], x = reference->x[p];
            logarithms(reference, p, l);
            double sum = s.part[PART_A][i] + s.part[PART_A][j] + h * h2 - g * g2 - k * k2 * x;
            for (int b = 0; b < exponents; b++) sum -= l[which[b]] * theta[at[b]];
            log_f[p] = sum;
            if (!slope) continue;
            double *row = slope + (size_t)p * (size_t)n;
            const Side *a = &s.side[i], *b = &s.side[j];
            part_slope(PART_A, 1.0, a, b, 1.0, 1.0, row);
            part_slope(PART_H, 1.0, a, b, h, h2, row);
            part_slope(PART_G, -1.0, a, b, g, g2, row);
            part_slope(PART_K, -x, a, b, k, k2, row);
            for (int c = 0; c < exponents; c++) row[at[c]] = -l[which[c]];
        }
    sides_free(&s);
}

static const double q_most = 6.9; /* log(0.999 / 0.001) */

/* Evaluates log M(w) and its derivatives (FitForm) as shading/dialect/tint.h does, with its bounds: q is 0.999 at most, and
 * multiple scattering is at most w^2 of that of white fibres. */
static void tint(void *user, int slab, const SolvedSlab *reference, const double *theta, double *log_f, double *slope) {
    (void)user;
    (void)slab;
    Sides s;
    int n = locals_of(true);
    double w = reference->slab.albedo;
    if (sides_make(reference, theta, PART_Q, PART_C, &s)) {
        double *r = s.part[PART_A], *r_slope = s.part[PART_H]; /* parts that are not used here */
        for (int k = 0; k < reference->sides; k++) {
            double q = 1.0 / (1.0 + exp(-fmin(fmax(s.part[PART_Q][k], -30.0), q_most)));
            r[k] = log1p(-q) - log1p(-w * q);
            r_slope[k] = -q * (1.0 - w) / (1.0 - w * q);
        }
        for (int p = 0; p < reference->pairs; p++) {
            int i = reference->i[p], j = reference->j[p];
            double v = s.part[PART_V][i], u = s.part[PART_U][i], c = s.part[PART_C][i], x = reference->x[p];
            double v2 = s.part[PART_V][j], u2 = s.part[PART_U][j], c2 = s.part[PART_C][j];
            double more = r[i] + r[j] + (1.0 - w) * (v * v2 - u * u2 - c * c2 * x);
            log_f[p] = log(fmax(w * w * reference->white[p], 1e-14)) + fmin(more, 0.0);
            if (!slope) continue;
            double *row = slope + (size_t)p * (size_t)n;
            if (more > 0.0) {
                memset(row, 0, (size_t)n * sizeof *row);
                continue;
            }
            const Side *a = &s.side[i], *b = &s.side[j];
            part_slope(PART_Q, 1.0, a, b, r_slope[j], r_slope[i], row);
            part_slope(PART_V, 1.0 - w, a, b, v, v2, row);
            part_slope(PART_U, w - 1.0, a, b, u, u2, row);
            part_slope(PART_C, (w - 1.0) * x, a, b, c, c2, row);
        }
    }
    sides_free(&s);
}

/* ---- coefficients ---- */

/* A coefficient: local number q of a group times T_a(t) tilt^b l^c. */
typedef struct Coefficient {
    int group, number, a, b, c;
} Coefficient;

static int coefficients_list(Coefficient *list) {
    int n = 0;
    for (int g = 0; g < GROUPS; g++)
        for (int q = 0; q < groups[g].count; q++)
            for (int b = 0; b < POWERS; b++)
                for (int c = 0; c < POWERS; c++)
                    for (int a = 0; a < groups[g].degree[b][c]; a++, n++)
                        if (list) list[n] = (Coefficient){g, q, a, b, c};
    return n;
}

int fibre_model_count(FibreStage stage) {
    int n = 0;
    for (int g = 0; g < GROUPS; g++)
        for (int b = 0; b < POWERS; b++)
            for (int c = 0; c < POWERS; c++)
                if (stage_of(&groups[g], c) == stage) n += groups[g].count * groups[g].degree[b][c];
    return n;
}

static double basis_of(const Coefficient *k, const SolvedSlab *reference) {
    double t = t_of(reference->slab.alpha), l = l_of(reference->slab.depth), s = tilt_of(reference->tilt);
    bool is_thin = groups[k->group].kind == THIN;
    double thin = thin_of(t), x = is_thin ? thin : t + thin;
    double chebyshev = cos(k->a * acos(fmin(fmax(x, -1.0), 1.0)));
    return chebyshev * (is_thin ? thin : 1.0) * pow(s, k->b) * pow(l, k->c);
}

/* The form of one stage: its own coefficients are free terms, those of earlier stages are fixed. */
typedef struct Staged {
    FitForm form;
    FitTerm **terms;
    int *counts;
    double **fixed;
    int *columns; /* coefficient of each free column */
    int *moving;
    Arena arena;
} Staged;

static bool staged_make(FibreStage stage, const SolvedSet *set, const Coefficient *list, int n, const double *values,
                        Staged *out) {
    size_t slabs = (size_t)set->count;
    bool color = stage >= FIBRE_COLOR;
    int locals = locals_of(color);
    *out = (Staged){0};
    out->terms = arena_array(&out->arena, slabs, sizeof(FitTerm *));
    out->counts = arena_array(&out->arena, slabs, sizeof *out->counts);
    out->fixed = arena_array(&out->arena, slabs, sizeof(double *));
    out->columns = arena_array(&out->arena, (size_t)n, sizeof *out->columns);
    out->moving = arena_array(&out->arena, (size_t)locals, sizeof *out->moving);
    if (!out->terms || !out->counts || !out->fixed || !out->columns || !out->moving) return false;
    int free_count = fibre_model_count(stage), movings = 0, place[LOCALS_MAX];
    for (int k = 0; k < locals; k++) place[k] = -1;
    for (int c = 0; c < n; c++) {
        const CoefficientGroup *g = &groups[list[c].group];
        int local = first_local(list[c].group) + list[c].number;
        if (stage_of(g, list[c].c) != stage || place[local] >= 0) continue;
        place[local] = movings;
        out->moving[movings++] = local;
    }
    for (size_t k = 0; k < slabs; k++) {
        out->terms[k] = arena_array(&out->arena, (size_t)free_count, sizeof(FitTerm));
        out->fixed[k] = arena_array(&out->arena, (size_t)locals, sizeof(double));
        if (!out->terms[k] || !out->fixed[k]) return false;
        int column = 0;
        for (int c = 0; c < n; c++) {
            const Coefficient *at = &list[c];
            const CoefficientGroup *g = &groups[at->group];
            if ((g->part >= PART_Q) != color) continue;
            int local = first_local(at->group) + at->number;
            double basis = basis_of(at, &set->slabs[k]);
            if (stage_of(g, at->c) == stage) {
                out->columns[column] = c;
                out->terms[k][column] = (FitTerm){place[local], column, basis};
                column++;
            } else {
                out->fixed[k][local] += values[c] * basis;
            }
        }
        out->counts[k] = column;
    }
    out->form = (FitForm){locals,
                          free_count,
                          movings,
                          out->moving,
                          NULL,
                          color ? tint : scatter,
                          (const FitTerm *const *)out->terms,
                          out->counts,
                          (const double *const *)out->fixed};
    return true;
}

/* Returns the start of a coefficient: roughly right, with no part at 0, since a product of two zeros has no slope. */
static double start_of(const Coefficient *k) {
    static const double exponent[] = {2.6, -2.1, 0.0, -0.2};
    if (k->b || k->c || groups[k->group].kind != UPRIGHT) return 0.0;
    bool constant = k->a == 0;
    switch (groups[k->group].part) {
    case PART_A: return constant && k->number == 0 ? -1.5 : 0.0;
    case PART_H: return constant && k->number < 2 ? (k->number ? -0.3 : 0.3) : 0.0;
    case PART_G: return constant && k->number == 0 ? 0.2 : 0.0;
    case PART_K: return constant && k->number == 0 ? 0.3 : 0.0;
    case PART_P: return k->number == 0 && k->a < 4 ? exponent[k->a] : constant && k->number == 1 ? 0.1 : 0.0;
    case PART_Q: return constant && k->number < 2 ? (k->number ? 0.6 : -0.28) : 0.0;
    case PART_V: return constant && k->number < 2 ? (k->number ? 0.1 : 0.3) : 0.0;
    case PART_U: return constant && k->number < 2 ? (k->number ? -0.1 : 0.3) : 0.0;
    case PART_C: return constant && k->number == 0 ? 0.3 : 0.0;
    case PARTS: break;
    }
    return 0.0;
}

/* Fills n alphas from low to 1, uniform in their logarithms. */
static void alphas_fill(double low, int n, double *alpha) {
    for (int k = 0; k < n; k++) alpha[k] = exp(log(low) * (1.0 - k / (n - 1.0)));
}

static bool stage_solved(FibreStage stage, int threads, SolveProgress progress, void *user, SolvedSet *out) {
    static const double white[] = {1.0}, colors[] = {0.05, 0.2, 0.4, 0.6, 0.8, 0.92, 0.98, 1.0};
    static const double radians = RADIANS;
    double alpha[36], tilts[] = {9 * radians, 18 * radians, 27 * radians, 36 * radians, 45 * radians};
    SolvedGrid grid = {0, 1, 0, 1, 40, 5, alpha, white, tilts, 1.0};
    switch (stage) {
    case FIBRE_WHITE:
        alphas_fill(alpha_thin, 16, alpha);
        grid.alphas = 16;
        break;
    case FIBRE_THIN:
        alphas_fill(alpha_low, 36, alpha); /* the first 16: 0.045 to 0.17 */
        grid.alphas = 16;
        break;
    case FIBRE_DENSITY:
        alphas_fill(alpha_low, 14, alpha);
        grid.alphas = 14, grid.kept = 5, grid.depth = 4.0;
        break;
    case FIBRE_NAP:
        alphas_fill(alpha_nap, 8, alpha);
        grid.alphas = 8, grid.tilts = 5, grid.kept = 5, grid.depth = 4.0, grid.rings = 10, grid.spokes = 8;
        break;
    case FIBRE_COLOR:
        alphas_fill(0.19, 10, alpha);
        grid.alphas = 10, grid.albedos = 8, grid.albedo = colors, grid.kept = 5, grid.depth = 4.0, grid.rings = 24;
        break;
    case FIBRE_THIN_COLOR:
        alphas_fill(alpha_low, 24, alpha); /* the first 11: 0.045 to 0.17 */
        grid.alphas = 11, grid.albedos = 8, grid.albedo = colors, grid.kept = 5, grid.depth = 4.0, grid.rings = 24;
        break;
    case FIBRE_STAGES: break;
    }
    return solved_set_make(&grid, threads, progress, user, out);
}

static bool stage_fit(FibreStage stage, const Coefficient *list, int n, int rounds, int threads, SolveProgress progress,
                      void *user, FibreModelFit *model) {
    SolvedSet set;
    Staged staged = {0};
    double *found = NULL;
    if (!stage_solved(stage, threads, progress, user, &set)) return false;
    bool done = staged_make(stage, &set, list, n, model->coefficients, &staged);
    if (done) found = alloc_array((size_t)staged.form.coefficients, sizeof *found);
    done = done && found;
    if (done) {
        for (int k = 0; k < staged.form.coefficients; k++) found[k] = start_of(&list[staged.columns[k]]);
        FitEffort effort = {rounds, 10.0, 0.4, stage == FIBRE_NAP ? 300.0 : 0.0, stage <= FIBRE_THIN ? 1e-4 : 0.0};
        done = fit_run(&staged.form, &set, effort, threads, progress, user, found);
    }
    if (done) {
        for (int k = 0; k < staged.form.coefficients; k++) model->coefficients[staged.columns[k]] = found[k];
        done = fit_error(&staged.form, &set, found, &model->errors[stage]);
    }
    free(found);
    arena_free(&staged.arena);
    solved_set_free(&set);
    return done;
}

bool fibre_model_fit(FibreStage last, int rounds, int threads, SolveProgress progress, void *user, FibreModelFit *out) {
    int n = coefficients_list(NULL);
    Coefficient *list = alloc_array((size_t)n, sizeof *list);
    *out = (FibreModelFit){.count = n, .coefficients = alloc_array((size_t)n, sizeof(double))};
    bool done = list && out->coefficients;
    if (done) coefficients_list(list);
    for (int stage = 0; done && stage <= (int)last; stage++)
        done = stage_fit((FibreStage)stage, list, n, rounds, threads, progress, user, out);
    free(list);
    if (!done) fibre_model_free(out);
    return done;
}

void fibre_model_free(FibreModelFit *model) {
    free(model->coefficients);
    *model = (FibreModelFit){0};
}

/* ---- the generated text ---- */

static const char *const part_letters[PARTS] = {"a", "h", "g", "k", "p", "q", "v", "u", "c"};

/* Gives the name of a group's number. Names begin with a t for thin fibres, and with an n for nap. */
static void name_of(int group, int number, char name[16]) {
    const CoefficientGroup *g = &groups[group];
    static const char *const kinds[] = {"", "t", "n"};
    snprintf(name, 16, "%s%s%d", kinds[g->kind], part_letters[g->part], number);
}

/* Returns the factor with which exp and log of the form become exp2 and log2: log2 e for exponents, its root for
 * factors of products. The p, which multiply logarithms, stay; q is the argument of a logistic. */
static double scale_of(ModelPart part) {
    const double log2_e = 1.44269504088896340736;
    if (part == PART_P) return 1.0;
    return part == PART_A || part == PART_Q ? log2_e : sqrt(log2_e);
}

/* Converts sum_a k_a T_a(t) to sum_a m_a t^a: T_0 = 1, T_1 = t, T_{a+1} = 2 t T_a - T_{a-1}. */
static void monomials(int n, const double *chebyshev, double power[FEATURES]) {
    double before[FEATURES] = {1.0}, now[FEATURES] = {0.0, 1.0};
    memset(power, 0, FEATURES * sizeof *power);
    for (int a = 0; a < n; a++) {
        double next[FEATURES] = {0.0};
        for (int k = 0; k < FEATURES; k++) {
            power[k] += chebyshev[a] * before[k];
            next[k] = (k ? 2.0 * now[k - 1] : 0.0) - before[k];
        }
        memcpy(before, now, sizeof before);
        memcpy(now, next, sizeof now);
    }
}

/* Writes a polynomial in x by Horner's rule. */
static void write_polynomial(FILE *file, int n, const char *x, const double *chebyshev, double scale) {
    double power[FEATURES];
    monomials(n, chebyshev, power);
    for (int k = 0; k < n - 2; k++) fputc('(', file);
    fprintf(file, "%.8e", scale * power[n - 1]);
    fputc('f', file);
    for (int k = n - 2; k >= 0; k--)
        fprintf(file, " * %s %c %.8ef%s", x, power[k] < 0.0 ? '-' : '+', fabs(scale * power[k]), k ? ")" : "");
}

/* Returns the index of a number's first coefficient for the powers b and c. */
static int block_of(int group, int number, int b, int c) {
    int n = 0, last = group * 10000 + number * 100 + b * 10 + c;
    for (int g = 0; g < GROUPS; g++)
        for (int q = 0; q < groups[g].count; q++)
            for (int i = 0; i < POWERS; i++)
                for (int j = 0; j < POWERS; j++) {
                    if (g * 10000 + q * 100 + i * 10 + j >= last) return n;
                    n += groups[g].degree[i][j];
                }
    return n;
}

/* Converts the sums from T_q(u) to powers of u. Each factor is a polynomial in t, l and s, whose coefficients are
 * converted one by one. Returns false if memory is short. */
static bool powers_of_u(const FibreModelFit *model, FibreModelFit *out) {
    *out = *model;
    out->coefficients = alloc_array((size_t)model->count, sizeof(double));
    if (!out->coefficients) return false;
    memcpy(out->coefficients, model->coefficients, (size_t)model->count * sizeof(double));
    for (int g = 0; g < GROUPS; g++)
        for (int b = 0; b < POWERS && groups[g].kind == UPRIGHT && groups[g].part != PART_P; b++)
            for (int c = 0; c < POWERS; c++)
                for (int a = 0; a < groups[g].degree[b][c]; a++) {
                    double chebyshev[FEATURES], power[FEATURES];
                    for (int q = 0; q < groups[g].count; q++)
                        chebyshev[q] = model->coefficients[block_of(g, q, b, c) + a];
                    monomials(groups[g].count, chebyshev, power);
                    for (int q = 0; q < groups[g].count; q++) out->coefficients[block_of(g, q, b, c) + a] = power[q];
                }
    return true;
}

/* Writes a number as a polynomial in t, l and s, with the powers first .. last of l: a sum of products. */
static void write_number(FILE *file, const FibreModelFit *model, int group, int number, int first, int last) {
    static const char *const s[POWERS] = {"", "s * ", "s * s * "}, *const l[POWERS] = {"", "l * ", "l * l * "};
    bool any = false;
    for (int b = 0; b < POWERS; b++)
        for (int c = first; c <= last; c++) {
            int n = groups[group].degree[b][c];
            if (!n) continue;
            fprintf(file, "%s%s%s(", any ? " + " : "", s[b], l[c]);
            write_polynomial(file, n, groups[group].kind == THIN ? "m.thin" : "t",
                             model->coefficients + block_of(group, number, b, c), scale_of(groups[group].part));
            fputc(')', file);
            any = true;
        }
}

/* Writes the contribution of the powers first .. last of l to the numbers of one kind. */
static void write_kind(FILE *file, const FibreModelFit *model, StageKind kind, int first, int last) {
    char name[16];
    for (int g = 0; g < GROUPS; g++)
        for (int q = 0; groups[g].kind == kind && q < groups[g].count; q++) {
            int terms = 0;
            for (int b = 0; b < POWERS; b++)
                for (int c = first; c <= last; c++) terms += groups[g].degree[b][c];
            if (!terms) continue;
            name_of(g, q, name);
            fprintf(file, "%*sm.%s = ", first || kind != UPRIGHT ? 8 : 4, "", name);
            if (first) fprintf(file, "m.%s + ", name);
            if (kind == THIN) fputs("m.thin * (", file);
            write_number(file, model, g, q, first, last);
            fputs(kind == THIN ? ");\n" : ";\n", file);
        }
}

bool fibre_model_write(const FibreModelFit *fit, const char *command, FILE *file) {
    char name[16];
    FibreModelFit converted, *model = &converted;
    if (!powers_of_u(fit, model)) return false;
    fprintf(file, "/* %s\n", command);
    fputs(" *\n * Numbers of shading/media/fibre_model.h for a material, fitted to the solved slab: "
          "polynomials in "
          "t, which runs\n"
          " * over the logarithm of alpha, in l, the logarithm to base 4 of density, and in s, twice the "
          "square of the\n"
          " * tilt's sine. Errors over what they were fitted to:\n *\n",
          file);
    static const char *const names[FIBRE_STAGES] = {"white", "thin", "density", "nap", "colour", "thin colour"};
    for (int k = 0; k < FIBRE_STAGES; k++)
        fprintf(file, " *   %-11s %4d coefficients, error %.2f %% in the mean, %.1f %% at worst, of R %.1e\n", names[k],
                fibre_model_count((FibreStage)k), 100.0 * model->errors[k].mean, 100.0 * model->errors[k].worst,
                model->errors[k].albedo);
    fputs(" */\n/* clang-format off */\n#pragma once\n\n"
          "#include \"shading/dialect/lang.h\"\n\nSTRUCT(FibreNumbers) {\n    float thin;\n",
          file);
    for (int g = 0; g < GROUPS; g++) {
        for (int q = 0; q < groups[g].count; q++) {
            name_of(g, q, name);
            fprintf(file, "%s%s", q ? ", " : "    float ", name);
        }
        fputs(";\n", file);
    }
    fprintf(file,
            "};\n\nFN_APART FibreNumbers fibre_numbers(float t, float l, float s) {\n"
            "    FibreNumbers m;\n    m.thin = max(%.8ef - t, 0.0f);\n    t = t + m.thin;\n",
            t_of(alpha_thin));
    for (int g = 0; g < GROUPS; g++)
        for (int q = 0; groups[g].kind != UPRIGHT && q < groups[g].count; q++) {
            name_of(g, q, name);
            fprintf(file, "    m.%s = 0.0f;\n", name);
        }
    write_kind(file, model, UPRIGHT, 0, 0);
    fputs("    if (l != 0.0f) {\n", file);
    write_kind(file, model, UPRIGHT, 1, POWERS - 1);
    fputs("    }\n    if (m.thin > 0.0f) {\n", file);
    write_kind(file, model, THIN, 0, POWERS - 1);
    /* nap was fitted from there up */
    fprintf(file, "    }\n    if (s > 0.0f) {\n        t = max(t, %.8ef);\n", t_of(alpha_nap));
    write_kind(file, model, NAP, 0, POWERS - 1);
    fputs("    }\n    return m;\n}\n", file);
    fibre_model_free(model);
    return true;
}
