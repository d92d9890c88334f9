#include "measure/fit/weave_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/matrix.h"
#include "base/memory.h"
#include "base/pi.h"
#include "measure/bsdf/halton.h"
#include "measure/fit/blend.h"
#include "shading/catalogue/registry.h"

/* COLUMNS: single and multiple scattering of each of two systems. UNKNOWNS: parameters, and the colours of
 * three channels. */
enum { NUMBERS = 13, COLUMNS = 4, UNKNOWNS = NUMBERS + 3 * COLUMNS };
enum { GRID = 512, STARTS = 16, ROUGH_STEPS = 20, FULL_STEPS = 180, FINISHED = 4 };

/* A parameter: its lobe, its range, and whether steps are those of its logarithm. */
typedef struct WeaveNumber {
    int system, param; /* system 2: both */
    double low, high;
    bool log;
} WeaveNumber;

static const WeaveNumber numbers[NUMBERS] = {
#define SYSTEM_NUMBERS(t)                                                                                              \
    {t, WOVEN_ALPHA, 0.05, 1.0, true}, {t, WOVEN_CRIMP, 0.0, 1.2, false}, {t, WOVEN_TWIST, -1.5, 1.5, false},          \
        {t, WOVEN_ROUNDNESS, 0.0, 1.5, false}, {t, WOVEN_FLOATS, 0.4, 16.0, true}, {                                   \
        t, WOVEN_CROSS_CRIMP, 0.0, 1.2, false                                                                          \
    }
    SYSTEM_NUMBERS(0),
    SYSTEM_NUMBERS(1),
    {2, WOVEN_SHARE, 0.02, 0.98, false},
};

/* A place: each parameter within its range, 0 .. 1, and the colours, [channel][column]. */
typedef struct WeavePlace {
    double x[UNKNOWNS], cost;
} WeavePlace;

typedef struct WeaveWalker {
    const Samples *samples;
    ItemProgress *item_progress;
    int count;                       /* number of samples in use */
    double soft;                     /* e of the cost */
    float *column[COLUMNS];          /* x for the colour 1 */
    float *slopes[NUMBERS][COLUMNS]; /* derivative of the columns by each parameter */
    float *work, *block;
    long long evaluations;
} WeaveWalker;

static double number_at(const WeaveNumber *n, double x) {
    return n->log ? n->low * (pow)(n->high / n->low, x) : n->low + (n->high - n->low) * x;
}

static void lobes_at(const double *x, WeftLobe lobes[2]) {
    for (int t = 0; t < 2; t++) {
        const Lobe lobe = lobe_default(LOBE_WOVEN);
        lobes[t] = (WeftLobe){.lobe = LOBE_WOVEN};
        memcpy(lobes[t].params, lobe.params, sizeof lobes[t].params);
        lobes[t].params[WOVEN_AZIMUTH] = t == 0 ? 0.5f * PI_FLOAT : 0.0f;
    }
    for (int k = 0; k < NUMBERS; k++) {
        const WeaveNumber *n = &numbers[k];
        const float value = (float)number_at(n, x[k]);
        lobes[n->system % 2].params[n->param] = value;
        if (n->system == 2) lobes[1].params[n->param] = 1.0f - value;
    }
}

/* Fills the columns of one system: single scattering, and multiple scattering. */
static void eval(WeaveWalker *self, const WeftLobe *threads, float *single, float *multiple) {
    const Samples *s = self->samples;
    Lobe lobe;
    lobe_of(threads, &lobe);
    lobe_eval_n(&lobe, (size_t)self->count, s->o[0], s->o[1], s->o[2], s->i[0], s->i[1], s->i[2], single, multiple);
    for (int k = 0; k < self->count; k++) {
        const float x = single[k] * s->i[2][k], share = multiple[k];
        single[k] = x * (1.0f - share), multiple[k] = x * share;
    }
    self->evaluations++;
}

static void eval_columns(WeaveWalker *self, const double *x, float *const column[COLUMNS]) {
    WeftLobe lobes[2];
    lobes_at(x, lobes);
    for (int t = 0; t < 2; t++) eval(self, &lobes[t], column[2 * t], column[2 * t + 1]);
}

/* Sets the colours to the best for these numbers, and returns the error. */
static double paint(WeaveWalker *self, double *x) {
    double sum = 0.0;
    Blend blend = {.columns = COLUMNS, .work = self->work};
    eval_columns(self, x, self->column);
    for (int c = 0; c < self->samples->channels; c++) {
        for (int j = 0; j < COLUMNS; j++) blend.column[j][c] = self->column[j];
        sum += blend_solve(self->samples, self->count, c, &blend, x + NUMBERS + c * COLUMNS);
    }
    return sum;
}

static float x_of(const WeaveWalker *self, const double *x, int c, int k) {
    const double *color = x + NUMBERS + c * COLUMNS;
    double sum = 0.0;
    for (int j = 0; j < COLUMNS; j++) sum += color[j] * (double)self->column[j][k];
    return (float)sum;
}

/* Returns dg / dx. */
static double slope(const Samples *s, float x) {
    return s->metric == WEFT_BRDF_METRIC_LOG ? 1.0 / (double)(s->scale + x) : 1.0;
}

/* Returns sum sqrt(r^2 + e^2) - e, r = g(x) - goal, for the columns in place. */
static double cost_of(const WeaveWalker *self, const double *x) {
    const Samples *s = self->samples;
    double sum = 0.0;
    for (int c = 0; c < s->channels; c++)
        for (int k = 0; k < self->count; k++) {
            const double r = (double)(samples_goal(s, x_of(self, x, c, k)) - s->goal[c][k]);
            sum += (double)s->weight[k] * ((sqrt)(r * r + self->soft * self->soft) - self->soft);
        }
    return sum;
}

static double cost_at(WeaveWalker *self, const double *x) {
    eval_columns(self, x, self->column);
    return cost_of(self, x);
}

/* Fills `slopes` with differences towards the middle of each parameter's range; `column` must be at x. */
static void differentiate(WeaveWalker *self, const double *x) {
    for (int n = 0; n < NUMBERS; n++) {
        const double h = x[n] < 0.5 ? 2e-3 : -2e-3;
        double moved[UNKNOWNS];
        WeftLobe lobes[2];
        memcpy(moved, x, sizeof moved);
        moved[n] += h;
        lobes_at(moved, lobes);
        for (int t = 0; t < 2; t++) {
            float **slopes = &self->slopes[n][(ptrdiff_t)2 * t];
            const bool moves = numbers[n].system == 2 || numbers[n].system == t;
            if (moves) eval(self, &lobes[t], slopes[0], slopes[1]);
            for (int j = 0; j < 2; j++)
                for (int k = 0; k < self->count; k++)
                    slopes[j][k] = moves ? (slopes[j][k] - self->column[2 * t + j][k]) / (float)h : 0.0f;
        }
    }
}

/* The normal equations of least squares, a step = -b. */
typedef struct WeaveNormal {
    double a[UNKNOWNS][UNKNOWNS], b[UNKNOWNS];
} WeaveNormal;

/* Makes the normal equations. A square counts like an absolute difference: its weight is 1 / sqrt(r^2 + e^2). */
static void normal_make(const WeaveWalker *self, const double *x, WeaveNormal *normal) {
    const Samples *s = self->samples;
    memset(normal, 0, sizeof *normal);
    for (int c = 0; c < s->channels; c++) {
        const double *color = x + NUMBERS + c * COLUMNS;
        for (int k = 0; k < self->count; k++) {
            double row[NUMBERS + COLUMNS];
            const float value = x_of(self, x, c, k);
            const double r = (double)(samples_goal(s, value) - s->goal[c][k]), g = slope(s, value);
            const double w = (double)s->weight[k] / (sqrt)(r * r + self->soft * self->soft);
            for (int n = 0; n < NUMBERS; n++) {
                row[n] = 0.0;
                for (int j = 0; j < COLUMNS; j++) row[n] += g * color[j] * (double)self->slopes[n][j][k];
            }
            for (int j = 0; j < COLUMNS; j++) row[NUMBERS + j] = g * (double)self->column[j][k];
            for (int m = 0; m < NUMBERS + COLUMNS; m++) {
                const int p = m < NUMBERS ? m : m + c * COLUMNS;
                normal->b[p] += w * row[m] * r;
                for (int n = 0; n <= m; n++) normal->a[p][n < NUMBERS ? n : n + c * COLUMNS] += w * row[m] * row[n];
            }
        }
    }
}

static int unknowns(const WeaveWalker *self) { return NUMBERS + COLUMNS * self->samples->channels; }

static bool is_locked(const WeaveNormal *normal, const double *x, int p) {
    const bool low = x[p] <= 0.0 && normal->b[p] > 0.0;
    const bool high = p < NUMBERS && x[p] >= 1.0 && normal->b[p] < 0.0;
    return low || high || !(normal->a[p][p] > 0.0);
}

/* Moves x by the step of a damped least-squares problem, clamped to the ranges. Donald W. Marquardt, "An
 * Algorithm for Least-Squares Estimation of Nonlinear Parameters", 1963. */
static bool take_step(const WeaveWalker *self, const WeaveNormal *normal, double damp, double *x) {
    double a[UNKNOWNS * UNKNOWNS], step[UNKNOWNS];
    int index[UNKNOWNS], n = 0;
    for (int p = 0; p < unknowns(self); p++)
        if (!is_locked(normal, x, p)) index[n++] = p;
    for (int c = 0; c < n; c++) {
        for (int r = c; r < n; r++) a[c * n + r] = normal->a[index[r]][index[c]];
        a[c * n + c] *= 1.0 + damp;
        step[c] = -normal->b[index[c]];
    }
    if (!matrix_factor(n, a, n) || !matrix_solve(n, a, n, 1, step, n)) return false;
    for (int r = 0; r < n; r++) {
        const double moved = x[index[r]] + step[r];
        x[index[r]] = index[r] < NUMBERS ? fmin(fmax(moved, 0.0), 1.0) : fmax(moved, 0.0);
    }
    return true;
}

/* Descends from a place, in `steps` steps at most. */
static void descend(WeaveWalker *self, WeavePlace *place, int steps) {
    double damp = 1e-2;
    place->cost = cost_at(self, place->x);
    for (int step = 0; step < steps && progress_report(self->item_progress, 0.0); step++) {
        WeaveNormal normal;
        const double before = place->cost;
        differentiate(self, place->x);
        normal_make(self, place->x, &normal);
        for (int trial = 0; trial < 10; trial++, damp *= 4.0) {
            WeavePlace next = *place;
            if (!take_step(self, &normal, damp, next.x)) continue;
            next.cost = cost_at(self, next.x);
            if (!(next.cost < place->cost)) continue;
            *place = next;
            damp = fmax(damp * 0.1, 1e-9);
            break;
        }
        if (!(place->cost < before * (1.0 - 1e-5)))
            break; /* else the columns are those of this place, which was evaluated last */
    }
}

/* Keeps the best places of a grid, sorted by cost. */
static void keep(WeavePlace *best, const WeavePlace *place) {
    int at = STARTS;
    while (at > 0 && place->cost < best[at - 1].cost) at--;
    if (at == STARTS) return;
    memmove(&best[at + 1], &best[at], (size_t)(STARTS - 1 - at) * sizeof *best);
    best[at] = *place;
}

/* Fills the starts with the best points of a grid in the middle of all ranges. */
static void find_starts(WeaveWalker *self, WeavePlace starts[STARTS]) {
    static const int primes[NUMBERS] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41};
    for (int k = 0; k < STARTS; k++) starts[k].cost = HUGE_VAL;
    for (int k = 0; k < GRID && progress_report(self->item_progress, 0.2 * k / GRID); k++) {
        WeavePlace place = {.cost = 0.0};
        for (int n = 0; n < NUMBERS; n++) place.x[n] = 0.15 + 0.7 * halton(k + 1, primes[n]);
        place.cost = paint(self, place.x);
        keep(starts, &place);
    }
}

static bool walker_make(WeaveWalker *self, const Samples *samples, ItemProgress *item_progress) {
    const size_t n = (size_t)samples->count;
    *self = (WeaveWalker){.samples = samples, .item_progress = item_progress};
    self->block = alloc_array((COLUMNS * (NUMBERS + 1) + 3) * n, sizeof(float));
    if (!self->block) return false;
    float *at = self->block;
    for (int j = 0; j < COLUMNS; j++, at += n) self->column[j] = at;
    for (int k = 0; k < NUMBERS * COLUMNS; k++, at += n) self->slopes[k / COLUMNS][k % COLUMNS] = at;
    self->work = at;
    return true;
}

static double mean_goal(const Samples *s) {
    double sum = 0.0;
    for (int c = 0; c < s->channels; c++)
        for (int k = 0; k < s->count; k++) sum += (double)s->goal[c][k];
    return sum / s->channels / s->count;
}

static void set_found(const WeaveWalker *self, const double *x, LobeFound *out) {
    WeftLobe lobes[2];
    lobes_at(x, lobes);
    for (int t = 0; t < 2; t++)
        for (int c = 0; c < 3; c++) {
            const double *color = x + NUMBERS + (c < self->samples->channels ? c : 0) * COLUMNS + 2 * t;
            lobes[t].f0[c] = (float)color[0], lobes[t].f90[c] = (float)color[1];
        }
    out->lobe = lobes[0];
    out->base = lobes[1];
    out->numbers = unknowns(self);
    out->evaluations = self->evaluations;
}

static int by_cost(const void *a, const void *b) {
    const WeavePlace *x = a, *y = b;
    return (x->cost > y->cost) - (x->cost < y->cost);
}

/* Descends with all samples, at first by squares and then more and more by absolute differences. */
static void finish(WeaveWalker *self, WeavePlace *place, double soft) {
    self->soft = soft;
    for (int k = 0; k < 3; k++, self->soft *= 0.1) descend(self, place, FULL_STEPS / 3);
}

/* Searches roughly from several starts with few samples, then accurately from the best of them with all
 * samples: the deepest valley with few samples need not be the deepest with all. */
WeftResult weave_search_run(const Samples *samples, ItemProgress *item_progress, LobeFound *out) {
    WeaveWalker self;
    WeavePlace starts[STARTS];
    if (!walker_make(&self, samples, item_progress)) return WEFT_RESOURCES;
    const double soft = 0.3 * mean_goal(samples);
    self.count = samples->first;
    self.soft = soft;
    find_starts(&self, starts);
    out->start = starts[0].cost;
    for (int k = 0; k < STARTS && progress_report(item_progress, 0.2 + 0.5 * k / STARTS); k++)
        descend(&self, &starts[k], ROUGH_STEPS);
    qsort(starts, STARTS, sizeof *starts, by_cost);
    self.count = samples->count;
    for (int k = 0; k < FINISHED && progress_report(item_progress, 0.7 + 0.3 * k / FINISHED); k++)
        finish(&self, &starts[k], soft);
    qsort(starts, FINISHED, sizeof *starts, by_cost);
    out->error = paint(&self, starts[0].x);
    set_found(&self, starts[0].x, out);
    free(self.block);
    return progress_report(item_progress, 0.0) ? WEFT_OK : WEFT_INTERRUPTED;
}

/* Measures the spread of azimuths: the length of the mean of e^(2 i phi) over all directions, which is 1 if
 * they lie in one plane. */
bool weave_search_sees(const Samples *samples) {
    double sum[3] = {0.0};
    for (int k = 0; k < samples->count; k++)
        for (int both = 0; both < 2; both++) {
            const float *const *w = (const float *const *)(both ? samples->i : samples->o);
            const double x = (double)w[0][k], y = (double)w[1][k], r = hypot(x, y);
            if (!(r > 1e-6)) continue;
            sum[0] += (x * x - y * y) / r, sum[1] += 2.0 * x * y / r, sum[2] += r;
        }
    return hypot(sum[0], sum[1]) < 0.95 * sum[2];
}
