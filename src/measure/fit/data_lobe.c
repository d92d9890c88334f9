#include "measure/fit/data_lobe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/pi.h"

enum { UNKNOWNS = SHAPE_TERMS * SHAPE_TERMS };

/* A sample: its place in the square, cos_i, f and its mean, and its weight in least squares. */
typedef struct LobePoint {
    double x, y, cos_i, f[3], mean, weight;
} LobePoint;

static void square_of(double sin2_h, double cos_d, double *x, double *y) {
    *x = 2.0 * sqrt(sqrt(fmin(fmax(sin2_h, 0.0), 1.0))) - 1.0;
    *y = 2.0 * sqrt(fmin(fmax(1.0 - cos_d, 0.0), 1.0)) - 1.0;
}

/* Evaluates the Chebyshev polynomials T_0 .. T_(count - 1) at x, none of which is nearly a sum of the others. */
static void chebyshev(double x, int count, double *t) {
    t[0] = 1.0, t[1] = x;
    for (int k = 2; k < count; k++) t[k] = 2.0 * x * t[k - 1] - t[k - 2];
}

/* Normal equations of a polynomial of terms x terms, regularized where there are no samples. */
typedef struct Equations {
    int terms;
    double a[UNKNOWNS][UNKNOWNS], b[UNKNOWNS];
} Equations;

static void equations_add(Equations *self, const LobePoint *point, double weight, double value) {
    double tx[SHAPE_TERMS], ty[SHAPE_TERMS], row[UNKNOWNS];
    const int n = self->terms * self->terms;
    chebyshev(point->x, self->terms, tx);
    chebyshev(point->y, self->terms, ty);
    for (int k = 0; k < n; k++) row[k] = ty[k / self->terms] * tx[k % self->terms];
    for (int k = 0; k < n; k++) {
        self->b[k] += weight * row[k] * value;
        for (int l = 0; l <= k; l++) self->a[k][l] += weight * row[k] * row[l];
    }
}

/* Solves the equations by Andre-Louis Cholesky's factors, after adding to each diagonal a part that grows
 * with the degree. */
static void equations_solve(Equations *self, double *x) {
    const int n = self->terms * self->terms;
    double mean = 0.0;
    for (int k = 0; k < n; k++) mean += self->a[k][k] / n;
    for (int k = 0; k < n; k++) {
        int i = k % self->terms, j = k / self->terms;
        self->a[k][k] += mean * 1e-6 * (1.0 + (double)((i * i + j * j) * (i * i + j * j)) / 16.0);
    }
    for (int k = 0; k < n; k++)
        for (int l = 0; l <= k; l++) {
            double sum = self->a[k][l];
            for (int m = 0; m < l; m++) sum -= self->a[k][m] * self->a[l][m];
            self->a[k][l] = k == l ? sqrt(fmax(sum, 1e-300)) : sum / self->a[l][l];
        }
    for (int k = 0; k < n; k++) {
        double sum = self->b[k];
        for (int m = 0; m < k; m++) sum -= self->a[k][m] * x[m];
        x[k] = sum / self->a[k][k];
    }
    for (int k = n - 1; k >= 0; k--) {
        double sum = x[k];
        for (int m = k + 1; m < n; m++) sum -= self->a[m][k] * x[m];
        x[k] = sum / self->a[k][k];
    }
}

/* Converts sums of Chebyshev polynomials to sums of powers, which the lobe's text contains. */
static void powers_of(const double *x, int terms, double *out) {
    double t[SHAPE_TERMS][SHAPE_TERMS] = {{1.0}, {0.0, 1.0}};
    for (int k = 2; k < terms; k++)
        for (int p = 0; p < terms; p++) t[k][p] = (p > 0 ? 2.0 * t[k - 1][p - 1] : 0.0) - t[k - 2][p];
    for (int k = 0; k < terms * terms; k++) {
        out[k] = 0.0;
        for (int l = 0; l < terms * terms; l++) out[k] += x[l] * t[l / terms][k / terms] * t[l % terms][k % terms];
    }
}

static double polynomial(const double *powers, int terms, double x, double y) {
    double sum = 0.0;
    for (int j = terms - 1; j >= 0; j--) {
        double row = 0.0;
        for (int i = terms - 1; i >= 0; i--) row = row * x + powers[j * terms + i];
        sum = sum * y + row;
    }
    return sum;
}

static double shape_at(const DataLobe *lobe, double x, double y) {
    return exp(fmin(fmax(polynomial(lobe->shape[0], SHAPE_TERMS, x, y), lobe->low), lobe->high));
}

static double share_at(const DataLobe *lobe, double x, double y) {
    return fmin(fmax(polynomial(lobe->share[0], SHARE_TERMS, x, y), 0.0), 1.0);
}

double data_lobe_shape(const DataLobe *lobe, double sin2_h, double cos_d) {
    double x, y;
    square_of(sin2_h, cos_d, &x, &y);
    return shape_at(lobe, x, y);
}

double data_lobe_share(const DataLobe *lobe, double sin2_h, double cos_d) {
    double x, y;
    square_of(sin2_h, cos_d, &x, &y);
    return share_at(lobe, x, y);
}

static LobePoint point_of(const WeftData *data, int k) {
    float wo[3], wi[3], f[3];
    double h[3], length = 0.0;
    LobePoint point;
    weft_data_sample(data, k, wo, wi, f);
    for (int c = 0; c < 3; c++) h[c] = (double)wo[c] + (double)wi[c], length += h[c] * h[c];
    square_of((h[0] * h[0] + h[1] * h[1]) / length, 0.5 * sqrt(length), &point.x, &point.y);
    point.cos_i = (double)wi[2];
    point.mean = point.weight = 0.0;
    for (int c = 0; c < 3; c++) point.f[c] = (double)f[c], point.mean += (double)f[c] / 3.0;
    return point;
}

/* The state of a fit. */
typedef struct LobeFitting {
    int count;
    LobePoint *points;
    double middle; /* the mean of f cos_i, the m of the log metric */
    Equations equations;
} LobeFitting;

/* Fits P to ln f, with least absolute differences of g = ln(1 + f cos_i / m): least squares of ln f, repeated
 * with weights from the slope of g and the previous residuals. */
static void shape_fit(LobeFitting *self, DataLobe *out) {
    enum { ROUNDS = 8 };
    double x[UNKNOWNS];
    for (int round = 0; round < ROUNDS; round++) {
        self->equations = (Equations){.terms = SHAPE_TERMS};
        for (int k = 0; k < self->count; k++) {
            LobePoint *p = &self->points[k];
            const double value = fmax(p->mean, 1e-3 * self->middle), lit = value * p->cos_i;
            const double slope = lit / (lit + self->middle), fit = shape_at(out, p->x, p->y) * p->cos_i;
            const double off = fabs(log1p(fit / self->middle) - log1p(lit / self->middle));
            p->weight = slope * slope;
            double weight = round == 0 ? p->weight : p->weight / fmax(off, 0.003);
            equations_add(&self->equations, p, weight, log(value));
        }
        equations_solve(&self->equations, x);
        powers_of(x, SHAPE_TERMS, out->shape[0]);
    }
}

/* Fits the two colours for given shares, by least squares of the colours of the samples over their mean. */
static void colors_fit(const LobeFitting *self, DataLobe *out) {
    double a = 0.0, b = 0.0, c = 0.0, p[3] = {0.0}, q[3] = {0.0};
    for (int k = 0; k < self->count; k++) {
        const LobePoint *point = &self->points[k];
        const double s = share_at(out, point->x, point->y), w = point->weight;
        if (!(point->mean > 0.0)) continue;
        a += w * (1.0 - s) * (1.0 - s), b += w * s * (1.0 - s), c += w * s * s;
        for (int n = 0; n < 3; n++) {
            p[n] += w * (1.0 - s) * point->f[n] / point->mean;
            q[n] += w * s * point->f[n] / point->mean;
        }
    }
    const double whole = a * c - b * b;
    for (int n = 0; n < 3; n++) {
        bool differ = whole > 1e-9 * a * c;
        out->f0[n] = fmax(differ ? (c * p[n] - b * q[n]) / whole : (p[n] + q[n]) / (a + 2.0 * b + c), 0.0);
        out->f90[n] = fmax(differ ? (a * q[n] - b * p[n]) / whole : out->f0[n], 0.0);
    }
}

/* Fits the shares for given colours: for each sample the nearest point on the line between them. */
static void shares_fit(LobeFitting *self, DataLobe *out) {
    double x[UNKNOWNS] = {0.0}, across = 0.0;
    for (int c = 0; c < 3; c++) across += (out->f90[c] - out->f0[c]) * (out->f90[c] - out->f0[c]);
    if (!(across > 1e-9)) return;
    self->equations = (Equations){.terms = SHARE_TERMS};
    for (int k = 0; k < self->count; k++) {
        const LobePoint *p = &self->points[k];
        double along = 0.0;
        if (!(p->mean > 0.0)) continue;
        for (int c = 0; c < 3; c++) along += (p->f[c] / p->mean - out->f0[c]) * (out->f90[c] - out->f0[c]) / across;
        equations_add(&self->equations, p, p->weight, fmin(fmax(along, -0.5), 1.5));
    }
    equations_solve(&self->equations, x);
    powers_of(x, SHARE_TERMS, out->share[0]);
}

static double error_of(const LobeFitting *self, const DataLobe *lobe) {
    double off = 0.0, all = 0.0;
    for (int k = 0; k < self->count; k++) {
        const LobePoint *p = &self->points[k];
        const double f = shape_at(lobe, p->x, p->y), s = share_at(lobe, p->x, p->y);
        for (int c = 0; c < 3; c++) {
            double fit = f * (lobe->f0[c] * (1.0 - s) + lobe->f90[c] * s), m = self->middle;
            off += fabs(log1p(fit * p->cos_i / m) - log1p(p->f[c] * p->cos_i / m));
            all += log1p(p->f[c] * p->cos_i / m);
        }
    }
    return off / all;
}

/* Directions of the hemisphere, uniform in solid angle, and sums over them. */
enum { RINGS = 64, AZIMUTHS = 64 };
typedef struct LobeSums {
    double e, squares; /* E, and the integral of (f cos_i)^2 / pdf */
} LobeSums;

static LobeSums sums_at(const DataLobe *lobe, double cos_o, double alpha) {
    LobeSums sums = {0.0, 0.0};
    const double area = 2.0 * PI_DOUBLE / (RINGS * AZIMUTHS), sin_o = sqrt(1.0 - cos_o * cos_o), a2 = alpha * alpha;
    for (int k = 0; k < RINGS * AZIMUTHS; k++) {
        const int ring = k / AZIMUTHS;
        const double z = (ring + 0.5) / RINGS, phi = 2.0 * PI_DOUBLE * (k % AZIMUTHS + 0.5) / AZIMUTHS,
                     r = sqrt(1.0 - z * z);
        const double hx = r * cos(phi) + sin_o, hy = r * sin(phi), hz = z + cos_o,
                     length2 = hx * hx + hy * hy + hz * hz, cos2 = hz * hz / length2;
        const double f = data_lobe_shape(lobe, 1.0 - cos2, 0.5 * sqrt(length2)), t = 1.0 + (a2 - 1.0) * cos2;
        const double pdf = 0.5 * z / PI_DOUBLE + 0.5 * a2 / (PI_DOUBLE * t * t) * sqrt(cos2) / (2.0 * sqrt(length2));
        sums.e += f * z * area;
        sums.squares += f * z * f * z / pdf * area;
    }
    return sums;
}

/* Sets k, and the width of sampling that has the least variance over some directions. */
static void scale_and_width(DataLobe *lobe) {
    static const double cosines[] = {1.0, 0.9, 0.7, 0.5, 0.3, 0.15, 0.07, 0.03, 0.01},
                        widths[] = {0.08, 0.15, 0.25, 0.4, 0.6, 0.9};
    double most = 1e-9, least = 1e300;
    for (size_t k = 0; k < sizeof cosines / sizeof *cosines; k++) most = fmax(most, sums_at(lobe, cosines[k], 0.5).e);
    lobe->scale = 1.0 / (1.05 * most);
    for (size_t k = 0; k < sizeof widths / sizeof *widths; k++) {
        double sum = 0.0;
        for (int c = 1; c < 6; c++) {
            LobeSums sums = sums_at(lobe, cosines[c], widths[k]);
            sum += sums.squares / (sums.e * sums.e);
        }
        if (sum < least) least = sum, lobe->alpha = widths[k];
    }
    for (int c = 0; c < 3; c++) lobe->f0[c] /= lobe->scale, lobe->f90[c] /= lobe->scale;
}

static void fit(LobeFitting *self, DataLobe *out) {
    enum { ALTERNATIONS = 6 };
    double low = 1e300, high = 0.0;
    for (int k = 0; k < self->count; k++) {
        self->middle += self->points[k].mean * self->points[k].cos_i / self->count;
        if (self->points[k].mean > 0.0) low = fmin(low, self->points[k].mean);
        high = fmax(high, self->points[k].mean);
    }
    *out = (DataLobe){.low = log(fmax(low, 1e-4 * self->middle)), .high = log(high)};
    shape_fit(self, out);
    out->share[0][0] = 0.5, out->share[1][0] = 0.5; /* at first s grows with theta_d */
    for (int k = 0; k < ALTERNATIONS; k++) {
        colors_fit(self, out);
        shares_fit(self, out);
    }
    colors_fit(self, out);
    out->error = error_of(self, out);
    scale_and_width(out);
}

bool data_lobe_fit(const WeftData *data, DataLobe *out) {
    LobeFitting *self = alloc_array(1, sizeof *self);
    if (self) {
        self->count = weft_data_count(data, NULL);
        self->points = alloc_array((size_t)self->count, sizeof *self->points);
    }
    bool made = self && self->points;
    for (int k = 0; made && k < self->count; k++) self->points[k] = point_of(data, k);
    if (made) fit(self, out);
    if (self) free(self->points);
    free(self);
    return made;
}
