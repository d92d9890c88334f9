#include "measure/fit/samples.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/pi.h"
#include "measure/bsdf/halton.h"
#include "weft/raster.h"

static const char *const names[WEFT_BRDF_METRIC_COUNT] = {"cosine", "log", "picture"};

const char *weft_brdf_metric_name(WeftBrdfMetric metric) {
    return (unsigned)metric < WEFT_BRDF_METRIC_COUNT ? names[metric] : NULL;
}

bool samples_create(Samples *self, int count, WeftBrdfMetric metric) {
    size_t n = (size_t)count;
    *self = (Samples){.count = count, .first = count, .channels = 3, .metric = metric, .scale = 1.0f};
    self->block = n <= SIZE_MAX / 13 ? alloc_array(13 * n, sizeof(float)) : NULL;
    if (!self->block) return false;
    float *at = self->block;
    for (int c = 0; c < 3; c++, at += 4 * n)
        self->o[c] = at, self->i[c] = at + n, self->x[c] = at + 2 * n, self->goal[c] = at + 3 * n;
    self->weight = at;
    return true;
}

void samples_free(Samples *self) {
    free(self->block);
    *self = (Samples){0};
}

/* The roughnesses of half vectors distributed by ggx, each mirroring wo: from narrow ones for a highlight to
 * wide ones. */
enum { LOBES = 3 };
static const double alphas[LOBES] = {0.5, 0.12, 0.03};

static double ggx(double alpha, double cos_h) {
    double t = cos_h * cos_h * (alpha * alpha - 1.0) + 1.0;
    return alpha * alpha / (PI_DOUBLE * t * t);
}

/* Returns the density of a wi: half by the cosine, half about the mirror direction. */
static double density(const double o[3], const double i[3]) {
    double h[3] = {o[0] + i[0], o[1] + i[1], o[2] + i[2]};
    double length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]), cos_h = h[2] / length;
    double sum = 0.5 * i[2] / PI_DOUBLE, d = fmax(0.5 * length, 1e-6); /* wo . h */
    for (int k = 0; k < LOBES; k++) sum += 0.5 / LOBES * ggx(alphas[k], cos_h) * cos_h / (4.0 * d);
    return sum;
}

static void draw(const double o[3], double pick, double u, double v, double i[3]) {
    if (pick < 0.5) {
        double r = sqrt(u);
        i[0] = r * cos(2.0 * PI_DOUBLE * v), i[1] = r * sin(2.0 * PI_DOUBLE * v), i[2] = sqrt(1.0 - u);
        return;
    }
    double alpha = alphas[(int)fmin((pick - 0.5) * 2.0 * LOBES, LOBES - 1)];
    double z = sqrt((1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u)), r = sqrt(fmax(1.0 - z * z, 0.0));
    double h[3] = {r * cos(2.0 * PI_DOUBLE * v), r * sin(2.0 * PI_DOUBLE * v), z};
    double d = 2.0 * (o[0] * h[0] + o[1] * h[1] + o[2] * h[2]);
    for (int k = 0; k < 3; k++) i[k] = d * h[k] - o[k];
}

static void put(Samples *self, int k, const double o[3], const double i[3], double weight) {
    bool above = i[2] > 1e-3;
    for (int c = 0; c < 3; c++) {
        self->o[c][k] = (float)o[c];
        self->i[c][k] = (float)(above ? i[c] : c == 2);
    }
    self->weight[k] = (float)(above ? weight : 0.0);
}

/* Spreads samples over the hemisphere. wo are uniform in cos_o^2, as on the image of a sphere, at the middles
 * of strata, with azimuths all around. */
static bool spread_wide(Samples *self, WeftBrdfMetric metric) {
    enum { OUTS = 16, INS = 256 };
    if (!samples_create(self, OUTS * INS, metric)) return false;
    self->outs = OUTS;
    self->first = self->count / 4;
    for (int k = 0; k < self->count; k++) {
        int out = k % OUTS, in = k / OUTS;
        double z2 = (out + 0.5) / OUTS, r = sqrt(1.0 - z2), phi = 2.0 * PI_DOUBLE * halton(out + 1, 2), i[3];
        const double o[3] = {r * cos(phi), r * sin(phi), sqrt(z2)};
        /* every wo has another part of the sequence */
        int at = in + INS * out + 1;
        draw(o, (in + 0.5) * 0.6180339887498949 - floor((in + 0.5) * 0.6180339887498949), halton(at, 2), halton(at, 3),
             i);
        put(self, k, o, i, i[2] > 0.0 ? 1.0 / density(o, i) : 0.0);
    }
    return true;
}

/* Makes samples of the pixels of spheres in a square. A light is in the plane of view and up, at an angle off
 * the viewer. */
static bool spread_pictures(Samples *self) {
    enum { SIDE = 15, LIGHTS = 4, SAMPLES = SIDE * SIDE * LIGHTS };
    static const double degrees[LIGHTS] = {15.0, 60.0, 105.0, 150.0};
    if (!samples_create(self, SAMPLES, WEFT_BRDF_METRIC_PICTURE)) return false;
    int outs = 0;
    double normals[SIDE * SIDE][3];
    for (int p = 0; p < SIDE * SIDE; p++) {
        int row = p / SIDE;
        double x = (p % SIDE + 0.5) / SIDE * 2.0 - 1.0, y = 1.0 - (row + 0.5) / SIDE * 2.0;
        if (x * x + y * y > 0.998) continue;
        normals[outs][0] = x, normals[outs][1] = y;
        normals[outs++][2] = sqrt(1.0 - x * x - y * y);
    }
    self->outs = outs;
    self->count = self->first = outs * LIGHTS;
    for (int k = 0; k < self->count; k++) {
        const double *n = normals[k % outs], a = degrees[k / outs] * PI_DOUBLE / 180.0;
        const double light[3] = {sin(a) * 0.8, sin(a) * 0.6, cos(a)};
        double s = hypot(n[0], n[2]), t[3] = {n[2] / s, 0.0, -n[0] / s}; /* horizontal */
        const double b[3] = {n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]};
        const double o[3] = {t[2], b[2], n[2]};
        const double i[3] = {light[0] * t[0] + light[1] * t[1] + light[2] * t[2],
                             light[0] * b[0] + light[1] * b[1] + light[2] * b[2],
                             light[0] * n[0] + light[1] * n[1] + light[2] * n[2]};
        put(self, k, o, i, 1.0);
    }
    return true;
}

bool samples_spread(Samples *self, WeftBrdfMetric metric) {
    return metric == WEFT_BRDF_METRIC_PICTURE ? spread_pictures(self) : spread_wide(self, metric);
}

/* Evaluates samples that each have their own wo. */
static void eval_each(const Samples *self, const WeftReflection *reflection, int part, float *const x[3]) {
    for (int k = 0; k < self->count; k++) {
        const float wo[3] = {self->o[0][k], self->o[1][k], self->o[2][k]};
        const float wi[1][3] = {{self->i[0][k], self->i[1][k], self->i[2][k]}};
        float f[1][3];
        weft_reflection_eval(reflection, part, wo, 1, wi, f);
        for (int c = 0; c < 3; c++) x[c][k] = f[0][c] * wi[0][2];
    }
}

void samples_eval(const Samples *self, const WeftReflection *reflection, int part, float *const x[3]) {
    float wi[256][3], f[256][3];
    if (self->outs == 0) eval_each(self, reflection, part, x);
    for (int out = 0; out < self->outs; out++) {
        const float wo[3] = {self->o[0][out], self->o[1][out], self->o[2][out]};
        for (int first = out; first < self->count;) {
            int n = 0;
            for (int k = first; k < self->count && n < 256; k += self->outs, n++)
                for (int c = 0; c < 3; c++) wi[n][c] = self->i[c][k];
            weft_reflection_eval(reflection, part, wo, n, (const float(*)[3])wi, f);
            for (int j = 0; j < n; j++, first += self->outs)
                for (int c = 0; c < 3; c++) x[c][first] = f[j][c] * self->i[2][first];
        }
    }
}

bool samples_isotropic(const Samples *self, const WeftReflection *reflection) {
    enum { TRIED = 64 };
    for (int k = 0; k < self->count && k < TRIED; k++) {
        float f[2][1][3];
        for (int rotated = 0; rotated < 2; rotated++) {
            float c = rotated ? 0.28f : 1.0f, s = rotated ? 0.96f : 0.0f;
            const float *o[3] = {self->o[0] + k, self->o[1] + k, self->o[2] + k};
            const float *i[3] = {self->i[0] + k, self->i[1] + k, self->i[2] + k};
            const float wo[3] = {c * *o[0] - s * *o[1], s * *o[0] + c * *o[1], *o[2]};
            const float wi[1][3] = {{c * *i[0] - s * *i[1], s * *i[0] + c * *i[1], *i[2]}};
            weft_reflection_eval(reflection, WEFT_PART_ALL, wo, 1, wi, f[rotated]);
        }
        for (int c = 0; c < 3; c++)
            if (fabsf(f[0][0][c] - f[1][0][c]) > 1e-3f * (fabsf(f[0][0][c]) + 1e-6f)) return false;
    }
    return true;
}

/* Returns the sRGB curve of IEC 61966-2-1. */
static float display(float linear) {
    float x = fminf(fmaxf(linear, 0.0f), 1.0f);
    return x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1.0f / 2.4f) - 0.055f;
}

float samples_goal(const Samples *self, float x) {
    switch (self->metric) {
    case WEFT_BRDF_METRIC_LOG: return log1pf(x / self->scale);
    case WEFT_BRDF_METRIC_PICTURE: return display(PI_FLOAT * x);
    default: return x;
    }
}

static bool same_channels(const Samples *self) {
    for (int k = 0; k < self->count; k++)
        for (int c = 1; c < 3; c++)
            if (fabsf(self->x[c][k] - self->x[0][k]) > 1e-6f * self->x[0][k]) return false;
    return true;
}

/* Returns the denominator of the error, over all channels that count. */
static double whole_of(const Samples *self, int count) {
    double sum = 0.0;
    for (int c = 0; c < self->channels; c++)
        for (int k = 0; k < count; k++)
            sum +=
                (double)self->weight[k] * (self->metric == WEFT_BRDF_METRIC_PICTURE ? 1.0 : (double)self->goal[c][k]);
    return sum;
}

void samples_finish(Samples *self) {
    double sum = 0.0, weights = 0.0;
    self->channels = same_channels(self) ? 1 : 3;
    for (int k = 0; k < self->count; k++) {
        weights += (double)self->weight[k];
        for (int c = 0; c < 3; c++) sum += (double)self->weight[k] * (double)self->x[c][k] / 3.0;
    }
    self->scale = sum > 0.0 ? (float)(sum / weights) : 1.0f;
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < self->count; k++) self->goal[c][k] = samples_goal(self, self->x[c][k]);
    self->whole[0] = whole_of(self, self->first);
    self->whole[1] = whole_of(self, self->count);
}

static double channel_distance(const Samples *self, int count, int c, const float *x) {
    double sum = 0.0;
    const float *w = self->weight, *goal = self->goal[c], *from = self->x[c];
    if (self->metric == WEFT_BRDF_METRIC_COSINE)
        for (int k = 0; k < count; k++) sum += (double)(w[k] * fabsf(x[k] - from[k]));
    else
        for (int k = 0; k < count; k++) sum += (double)(w[k] * fabsf(samples_goal(self, x[k]) - goal[k]));
    return sum;
}

static double share(const Samples *self, int count, double sum) {
    double whole = self->whole[count == self->count];
    return whole > 0.0 ? sum / whole : sum > 0.0 ? 1.0 : 0.0;
}

double samples_channel_error(const Samples *self, int count, int c, const float *x) {
    return share(self, count, channel_distance(self, count, c, x));
}

double samples_distance(const Samples *self, int count, const float *const x[3]) {
    double sum = 0.0;
    for (int c = 0; c < 3; c++) sum += channel_distance(self, count, c, x[c]) * self->channels / 3.0;
    return share(self, count, sum);
}
