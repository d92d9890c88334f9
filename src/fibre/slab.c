#include "fibre/slab.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/pi.h"
#include "fibre/doubling.h"
#include "fibre/gauss.h"

static double extinction(double s, double mu) { return sqrt(1.0 - mu * mu + s * s * mu * mu); }

/* Returns G_n, an azimuthal mode of the phase function, in closed form. With h not normalised, q = |wi + wo|^2 and
 * m = mu_i + mu_o, D = (s^3 / pi) (q / (s^2 q + (1 - s^2) m^2))^2. Let P = cos^2((ti + to) / 2) and
 * M = cos^2((ti - to) / 2), of the polar angles: m^2 = 4 P M, q = 4 (M cos^2(phi / 2) + P sin^2(phi / 2)), and
 *
 *   G_n = mean over phi of (q / (s^2 q + k m^2))^2 cos(n phi),   k = 1 - s^2.
 *
 * (q / X)^2 = (1 - c / X)^2 / s^4 with X = s^2 q + c, c = 4 k P M, is linear in the Fourier series of
 * 1 / (A + B cos phi) and of its derivative by A. */
static double mode(double s, int n, double P, double M) {
    double k = 1.0 - s * s, uu = sqrt(s * s + k * P), vv = sqrt(s * s + k * M);
    double U = sqrt(M) * uu, V = sqrt(P) * vv, h = sqrt(P * M);
    if (n == 0)
        return (sqrt(M) * (2.0 * U + V) / (uu * uu * uu) + 2.0 * h / (uu * vv) +
                sqrt(P) * (2.0 * V + U) / (vv * vv * vv)) /
               (2.0 * (U + V) * (U + V));
    double w = uu * vv, S = 4.0 * h * w, A = 2.0 * (s * s * (M + P) + 2.0 * k * P * M), B = 2.0 * s * s * (M - P);
    double r = B / (A + S);
    return pow(-r, n) * k * h / (4.0 * s * s * s * s * w * w * w) * (k * (A + n * S) - 8.0 * w * w);
}

/* Modes of a flake's phase function: up (K_r) from an upward direction to another, and down (K_t) from an upward to a
 * downward one, which is named by its antipode. K_r = (s^3 / 2) G_n(P, M). K_t is the same with P = sin^2((ti - to) /
 * 2) and M = sin^2((ti + to) / 2), times (-1)^n for the azimuth of the antipode. */
typedef struct Kernels {
    double up, down;
} Kernels;

static Kernels kernels(double s, int n, double mu_i, double mu_o) {
    double si = sqrt(1.0 - mu_i * mu_i), so = sqrt(1.0 - mu_o * mu_o), c = mu_i * mu_o, sine = si * so;
    /* cos^2(x / 2) = (1 + cos x) / 2; differences of squares where that cancels */
    double gap = mu_i - mu_o, gap_sine = si - so;
    double P_up = 0.25 * ((mu_i + mu_o) * (mu_i + mu_o) + gap_sine * gap_sine), M_up = 0.5 * (1.0 + c + sine);
    double P_down = 0.25 * (gap * gap + gap_sine * gap_sine), M_down = 0.5 * (1.0 - c + sine);
    double scale = 0.5 * s * s * s;
    return (Kernels){scale * mode(s, n, P_up, M_up), (n & 1 ? -scale : scale) * mode(s, n, P_down, M_down)};
}

double slab_single(const Slab *slab, double mu_i, double mu_o, double cos_phi) {
    double s = slab->alpha * slab->alpha, m = mu_i + mu_o;
    double q = 2.0 * (1.0 + mu_i * mu_o + sqrt((1.0 - mu_i * mu_i) * (1.0 - mu_o * mu_o)) * cos_phi);
    double ratio = q / (s * s * q + (1.0 - s * s) * m * m);
    double sum = extinction(s, mu_i) * mu_o + extinction(s, mu_o) * mu_i;
    return slab->albedo * s * s * s / PI_DOUBLE * ratio * ratio * 0.25 * -expm1(-slab->depth * sum / (mu_i * mu_o)) /
           sum;
}

double slab_single_mode(const Slab *slab, int m, double mu_i, double mu_o) {
    double s = slab->alpha * slab->alpha;
    double sum = extinction(s, mu_i) * mu_o + extinction(s, mu_o) * mu_i;
    return slab->albedo * kernels(s, m, mu_i, mu_o).up * -expm1(-slab->depth * sum / (mu_i * mu_o)) / sum;
}

/* Fills nodes mu = x^2, x by Gauss-Legendre, which are dense at the horizon, and c = 2 x w mu. */
static void nodes_make(int nodes, double *mu, double *c) {
    gauss_legendre(nodes, mu, c);
    for (int j = 0; j < nodes; j++) {
        c[j] *= 2.0 * mu[j];
        mu[j] *= mu[j];
        c[j] *= mu[j];
    }
}

/* Fills lambda so that the quadrature conserves light, and returns the largest relative defect that it had. The sum of
 * K w over both hemispheres is sigma, except for the part of the forward peak that falls between nodes. Light scattered
 * there keeps its direction and therefore counts as not scattered: sigma is without it. Otherwise a slab of white
 * fibres, doubled thirty times, would visibly lose or gain light. */
static double extinctions(double s, double albedo, int nodes, int total, const double *mu, const double *c,
                          double *lambda) {
    double worst = 0.0;
    for (int i = 0; i < total; i++) {
        double sum = 0.0, sigma = extinction(s, mu[i]);
        for (int j = 0; j < nodes; j++) {
            Kernels k = kernels(s, 0, mu[i], mu[j]);
            sum += (k.up + k.down) * c[j] / mu[j];
        }
        worst = fmax(worst, fabs(sigma - sum) / sigma);
        lambda[i] = fmax(sigma - albedo * (sigma - sum), 1e-12) / mu[i];
    }
    return worst;
}

SlabEffort slab_effort(double alpha) {
    int nodes = alpha < 0.08 ? 216 : alpha < 0.11 ? 144 : alpha < 0.15 ? 112 : alpha < 0.24 ? 80 : 56;
    return (SlabEffort){nodes, 30};
}

bool slab_mode(const Slab *slab, SlabEffort effort, int m, int kept, int count, const double *mu, const Layered *out,
               double *defect) {
    int total = effort.nodes + count;
    size_t n = (size_t)total;
    double *block = alloc_array(2 * n * n + 3 * n, sizeof(double));
    if (!block) return false;
    double *r = block, *t = r + n * n, *all = t + n * n, *lambda = all + n, *c = lambda + n;
    double s = slab->alpha * slab->alpha;
    nodes_make(effort.nodes, all, c);
    for (int i = 0; i < count; i++) all[effort.nodes + i] = mu[i];
    double worst = extinctions(s, slab->albedo, effort.nodes, total, all, c, lambda);
    if (defect) *defect = worst;
    for (int j = 0; j < total; j++)
        for (int i = 0; i <= j; i++) {
            Kernels k = kernels(s, m, all[i], all[j]);
            double scale = slab->albedo / (all[i] * all[j]);
            r[(size_t)j * n + (size_t)i] = r[(size_t)i * n + (size_t)j] = scale * k.up;
            t[(size_t)j * n + (size_t)i] = t[(size_t)i * n + (size_t)j] = scale * k.down;
        }
    bool done =
        doubling_run(&(Doubling){effort.nodes, total, c, lambda, slab->depth, effort.halvings, kept}, r, t, out);
    free(block);
    return done;
}
