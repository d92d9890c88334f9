#include "measure/fit/blend.h"

#include <math.h>

#include "base/pi.h"

/* Normal equations of one channel: A weights = b; and the limits on the weights. */
typedef struct Normal {
    double a[BLEND_MOST][BLEND_MOST], b[BLEND_MOST];
    int limits;
    double limit[BLEND_LIMITS][BLEND_MOST], room[BLEND_LIMITS];
} Normal;

/* Returns the sum of w x y, computed as LANES independent sums. */
static double dot(const float *w, const float *x, const float *y, int count) {
    enum { LANES = 8 };
    double sums[LANES] = {0.0}, sum = 0.0;
    int k = 0;
    for (; k + LANES <= count; k += LANES)
        for (int l = 0; l < LANES; l++) sums[l] += (double)(w[k + l] * x[k + l]) * (double)y[k + l];
    for (; k < count; k++) sum += (double)(w[k] * x[k]) * (double)y[k];
    for (int l = 0; l < LANES; l++) sum += sums[l];
    return sum;
}

/* Copies the limits of channel c. */
static void normal_limit(Normal *normal, const Blend *blend, int c) {
    normal->limits = blend->limits;
    for (int l = 0; l < blend->limits; l++) {
        normal->room[l] = blend->room[l][c];
        for (int j = 0; j < blend->columns; j++) normal->limit[l][j] = blend->limit[l][j];
    }
}

static void normal_make(Normal *normal, int columns, const float *const column[], const float *w, const float *rest,
                        int count) {
    for (int j = 0; j < columns; j++) {
        normal->b[j] = dot(w, column[j], rest, count);
        for (int l = 0; l <= j; l++) normal->a[j][l] = normal->a[l][j] = dot(w, column[j], column[l], count);
    }
}

/* Limits that hold with equality: their weights make the last rows of a system. */
enum { HELD_MOST = 2, SYSTEM_MOST = BLEND_MOST + HELD_MOST };
typedef struct Held {
    int count, limit[HELD_MOST];
} Held;

/* Solves for the columns in `active`, a set of bits, under the held limits with a multiplier for each, by Gauss
 * elimination. Returns false if they are linearly dependent. The multipliers come last, so that without held limits no
 * pivot is small. */
static bool solve_active(const Normal *normal, int columns, unsigned active, const Held *held, double *weights) {
    double m[SYSTEM_MOST][SYSTEM_MOST + 1] = {{0.0}}, solved[SYSTEM_MOST];
    int index[BLEND_MOST], free_columns = 0;
    for (int j = 0; j < columns; j++) {
        weights[j] = 0.0;
        if (active >> j & 1u) index[free_columns++] = j;
    }
    const int n = free_columns + held->count;
    for (int r = 0; r < free_columns; r++) {
        for (int c = 0; c < free_columns; c++) m[r][c] = normal->a[index[r]][index[c]];
        for (int h = 0; h < held->count; h++)
            m[r][free_columns + h] = m[free_columns + h][r] = normal->limit[held->limit[h]][index[r]];
        m[r][n] = normal->b[index[r]];
    }
    for (int h = 0; h < held->count; h++) m[free_columns + h][n] = normal->room[held->limit[h]];
    for (int p = 0; p < n; p++) {
        const bool column = p < free_columns;
        const double least = column ? 1e-10 * normal->a[index[p]][index[p]] : 1e-30;
        if (!((column ? m[p][p] : -m[p][p]) > least)) return false;
        for (int r = p + 1; r < n; r++) {
            double t = m[r][p] / m[p][p];
            for (int c = p; c <= n; c++) m[r][c] -= t * m[p][c];
        }
    }
    for (int r = n - 1; r >= 0; r--) {
        double sum = m[r][n];
        for (int c = r + 1; c < n; c++) sum -= m[r][c] * solved[c];
        solved[r] = sum / m[r][r];
        if (r < free_columns) weights[index[r]] = solved[r];
    }
    return true;
}

static double cost_of(const Normal *normal, int columns, const double *weights) {
    double cost = 0.0;
    for (int j = 0; j < columns; j++) {
        for (int l = 0; l < columns; l++) cost += weights[j] * normal->a[j][l] * weights[l];
        cost -= 2.0 * weights[j] * normal->b[j];
    }
    return cost;
}

/* Returns true if all weights are at least 0 and, if asked, all limits hold. */
static bool is_allowed(const Normal *normal, int columns, const double *weights, bool limits) {
    for (int j = 0; j < columns; j++)
        if (weights[j] < 0.0) return false;
    for (int l = 0; limits && l < normal->limits; l++) {
        double sum = 0.0;
        for (int j = 0; j < columns; j++) sum += normal->limit[l][j] * weights[j];
        if (sum > normal->room[l] + 1e-9) return false;
    }
    return true;
}

/* Tries every set of columns with the held limits; improves on *least. */
static void try_columns(const Normal *normal, int columns, const Held *held, bool limits, double *least,
                        double *weights) {
    for (unsigned active = 0; active < 1u << columns; active++) {
        double trial[BLEND_MOST];
        if (!solve_active(normal, columns, active, held, trial)) continue;
        if (!is_allowed(normal, columns, trial, limits)) continue;
        double cost = cost_of(normal, columns, trial);
        if (!(cost < *least)) continue;
        *least = cost;
        for (int j = 0; j < columns; j++) weights[j] = trial[j];
    }
}

/* Solves least squares without negative weights, by trying every set of columns, since there are few. If the result breaks
 * a limit, tries every set with one or two limits held, too; without columns none is broken. */
static void solve_positive(const Normal *normal, int columns, double *weights) {
    double least = 1e300;
    Held held = {0};
    try_columns(normal, columns, &held, false, &least, weights);
    if (is_allowed(normal, columns, weights, true)) return;
    least = 1e300;
    try_columns(normal, columns, &held, true, &least, weights);
    for (int first = 0; first < normal->limits; first++)
        for (int second = first; second < normal->limits; second++) {
            held = (Held){second > first ? 2 : 1, {first, second}};
            try_columns(normal, columns, &held, true, &least, weights);
        }
}

/* Computes x of the blend. */
static void blend_add(const Blend *blend, int count, int c, const double *weights, float *x) {
    const float *fixed = blend->fixed[c];
    for (int k = 0; k < count; k++) x[k] = fixed ? fixed[k] : 0.0f;
    for (int j = 0; j < blend->columns; j++) {
        const float *column = blend->column[j][c];
        float a = (float)weights[j];
        for (int k = 0; k < count; k++) x[k] += a * column[k];
    }
}

/* Returns d goal / dx at x. Above the displayable range a small slope remains, so that such samples are not ignored. */
static inline float goal_slope(WeftBrdfMetric metric, float scale, float x) {
    if (metric == WEFT_BRDF_METRIC_COSINE) return 1.0f;
    if (metric == WEFT_BRDF_METRIC_LOG) return 1.0f / (scale + x);
    float y = PI_FLOAT * x;
    return y > 1.0f ? 0.1f : y <= 0.0031308f ? 40.0f : 1.381f * powf(y, -1.4f / 2.4f);
}

/* Computes the weights of samples in least squares, so that a square counts like an absolute difference. `soft` limits
 * the weight of samples that are already matched. The metric is a constant wherever this is inlined. */
static inline void weigh_by(WeftBrdfMetric metric, const Samples *self, int count, int c, const float *x, float soft,
                            float *w) {
    const float *from = self->x[c], *weight = self->weight;
    const float scale = self->scale;
    for (int k = 0; k < count; k++) {
        const float off = fabsf(x[k] - from[k]);
        w[k] = weight[k] * goal_slope(metric, scale, 0.5f * (x[k] + from[k])) / (off > soft ? off : soft);
    }
}

static void weigh(const Samples *self, int count, int c, const float *x, float soft, float *w) {
    switch (self->metric) {
    case WEFT_BRDF_METRIC_COSINE: weigh_by(WEFT_BRDF_METRIC_COSINE, self, count, c, x, soft, w); break;
    case WEFT_BRDF_METRIC_LOG: weigh_by(WEFT_BRDF_METRIC_LOG, self, count, c, x, soft, w); break;
    default: weigh_by(WEFT_BRDF_METRIC_PICTURE, self, count, c, x, soft, w);
    }
}

double blend_solve(const Samples *self, int count, int c, const Blend *blend, double weights[BLEND_MOST]) {
    const int rounds = count == self->count ? 9 : 5;
    float *x = blend->work, *rest = x + self->count, *w = rest + self->count, soft = self->scale;
    const float *columns[BLEND_MOST];
    for (int j = 0; j < blend->columns; j++) columns[j] = blend->column[j][c], weights[j] = 0.0;
    for (int k = 0; k < count; k++) rest[k] = self->x[c][k] - (blend->fixed[c] ? blend->fixed[c][k] : 0.0f);
    Normal normal;
    normal_limit(&normal, blend, c);
    for (int round = 0; round < rounds && blend->columns > 0; round++, soft *= 0.3f) {
        blend_add(blend, count, c, weights, x);
        if (round == 0)
            for (int k = 0; k < count; k++) w[k] = self->weight[k];
        else
            weigh(self, count, c, x, soft, w);
        normal_make(&normal, blend->columns, columns, w, rest, count);
        solve_positive(&normal, blend->columns, weights);
    }
    blend_add(blend, count, c, weights, x);
    return samples_channel_error(self, count, c, x);
}
