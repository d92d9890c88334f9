#include "fibre/tilted.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/pi.h"
#include "fibre/doubling.h"
#include "fibre/gauss.h"

typedef struct TiltedVec {
    double x, y, z, nu; /* nu: cosine to the fibre */
} TiltedVec;

static TiltedVec vec(double tilt, double mu, double phi) {
    double r = sqrt(1.0 - mu * mu);
    TiltedVec v = {r * cos(phi), r * sin(phi), mu, 0.0};
    v.nu = v.x * sin(tilt) + v.z * cos(tilt);
    return v;
}

static double extinction(double s, double nu) { return sqrt(1.0 - (1.0 - s * s) * nu * nu); }

/* Returns D(a + b) / 4 with the half vector not normalised; 0 for opposite directions, where the limit does not exist.
 * sign = -1: b names its antipode. */
static double flakes(double s, TiltedVec a, TiltedVec b, double sign) {
    double x = a.x + sign * b.x, y = a.y + sign * b.y, z = a.z + sign * b.z, m = a.nu + sign * b.nu;
    double q = x * x + y * y + z * z;
    if (q < 1e-14) return 0.0;
    double ratio = q / (s * s * q + (1.0 - s * s) * m * m);
    return s * s * s / PI_DOUBLE * ratio * ratio * 0.25;
}

double tilted_single(const Slab *slab, double tilt, Heading i, Heading o) {
    double s = slab->alpha * slab->alpha;
    TiltedVec a = vec(tilt, i.mu, i.phi), b = vec(tilt, o.mu, o.phi);
    double sum = extinction(s, a.nu) * b.z + extinction(s, b.nu) * a.z;
    return slab->albedo * flakes(s, a, b, 1.0) * -expm1(-slab->depth * sum / (a.z * b.z)) / sum;
}

typedef struct Directions {
    int nodes, total;
    TiltedVec *v, *mirrored;
    double *c, *lambda;
} Directions;

/* Fills the directions as slab.c does: mu = x^2. The azimuths are the middles of `spokes` equal parts of [0, pi], the
 * trapezoidal rule for even periodic functions. */
static void directions_fill(Directions *d, double tilt, TiltEffort effort, int count, const Heading *at, double *x,
                            double *w) {
    gauss_legendre(effort.rings, x, w);
    for (int j = 0; j < effort.rings; j++)
        for (int k = 0; k < effort.spokes; k++) {
            int n = j * effort.spokes + k;
            double mu = x[j] * x[j], phi = PI_DOUBLE * (k + 0.5) / effort.spokes;
            d->v[n] = vec(tilt, mu, phi);
            d->c[n] = 2.0 * x[j] * w[j] * mu * PI_DOUBLE / effort.spokes;
        }
    for (int k = 0; k < count; k++) d->v[d->nodes + k] = vec(tilt, at[k].mu, at[k].phi);
    for (int k = 0; k < d->total; k++) {
        d->mirrored[k] = d->v[k];
        d->mirrored[k].y = -d->v[k].y;
    }
}

/* Fills lambda. The forward peak between nodes counts as not scattered, as in slab.c. */
static void extinctions(Directions *d, double s, double albedo) {
    for (int i = 0; i < d->total; i++) {
        double sum = 0.0, sigma = extinction(s, d->v[i].nu);
        for (int j = 0; j < d->nodes; j++)
            sum += (flakes(s, d->v[i], d->v[j], 1.0) + flakes(s, d->v[i], d->v[j], -1.0) +
                    flakes(s, d->v[i], d->mirrored[j], 1.0) + flakes(s, d->v[i], d->mirrored[j], -1.0)) *
                   d->c[j] / d->v[j].z;
        d->lambda[i] = fmax(sigma - albedo * (sigma - sum), 1e-12) / d->v[i].z;
    }
}

/* Solves the problem for functions even (sign 1) or odd (sign -1) in the azimuth. */
static bool parity(const Directions *d, const Slab *slab, int halvings, int kept, double sign, double *r, double *t,
                   const Layered *out) {
    double s = slab->alpha * slab->alpha;
    size_t n = (size_t)d->total;
    for (int j = 0; j < d->total; j++)
        for (int i = 0; i <= j; i++) {
            TiltedVec a = d->v[i], b = d->v[j], m = d->mirrored[j];
            double scale = slab->albedo / (a.z * b.z);
            double up = scale * (flakes(s, a, b, 1.0) + sign * flakes(s, a, m, 1.0));
            double down = scale * (flakes(s, a, b, -1.0) + sign * flakes(s, a, m, -1.0));
            r[(size_t)j * n + (size_t)i] = r[(size_t)i * n + (size_t)j] = up;
            t[(size_t)j * n + (size_t)i] = t[(size_t)i * n + (size_t)j] = down;
        }
    return doubling_run(&(Doubling){d->nodes, d->total, d->c, d->lambda, slab->depth, halvings, kept}, r, t, out);
}

TiltEffort tilt_effort(double alpha) { return alpha < 0.35 ? (TiltEffort){20, 40, 28} : (TiltEffort){14, 28, 28}; }

bool tilted_f(const Slab *slab, double tilt, TiltEffort effort, int kept, int count, const Heading *at, double *same,
              double *across, double *reflected) {
    int nodes = effort.rings * effort.spokes, total = nodes + count;
    size_t n = (size_t)total, pairs = (size_t)kept * (size_t)count * (size_t)count;
    double *block = alloc_array(2 * n * n + 2 * n + 2 * (size_t)effort.rings, sizeof(double));
    TiltedVec *v = alloc_array(2 * n, sizeof(TiltedVec));
    bool done = block && v;
    if (done) {
        double *r = block, *t = r + n * n, *c = t + n * n, *x = c + 2 * n;
        Directions d = {nodes, total, v, v + n, c, c + n};
        directions_fill(&d, tilt, effort, count, at, x, x + effort.rings);
        extinctions(&d, slab->alpha * slab->alpha, slab->albedo);
        done = parity(&d, slab, effort.halvings, kept, 1.0, r, t, &(Layered){.r = same, .up = reflected});
        if (done && same) done = parity(&d, slab, effort.halvings, kept, -1.0, r, t, &(Layered){.r = across});
    }
    for (size_t k = 0; done && same && k < pairs; k++) {
        double even = 0.5 * same[k], odd = 0.5 * across[k];
        same[k] = even + odd;
        across[k] = even - odd;
    }
    free(block);
    free(v);
    return done;
}
