#include "fibre/walk.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/pi.h"
#include "base/random.h"
#include "base/thread.h"

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Computes S^(1/2) w = w - (1 - s) (w . t) t. */
static void stretch(const WalkMedium *m, const double w[3], double out[3]) {
    double k = (1.0 - m->s) * dot(w, m->axis);
    for (int c = 0; c < 3; c++) out[c] = w[c] - k * m->axis[c];
}

double walk_sigma(const WalkMedium *m, const double w[3]) {
    double v[3];
    stretch(m, w, v);
    return sqrt(dot(v, v));
}

double walk_phase(const WalkMedium *m, const double wi[3], const double wo[3]) {
    double h[3] = {wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]}, s2 = m->s * m->s;
    double q = dot(h, h), along = dot(h, m->axis), g = s2 * q + (1.0 - s2) * along * along;
    if (!(g > 0.0)) return 1.0 / (4.0 * PI_DOUBLE * m->s * walk_sigma(m, wi)); /* forward: D at its largest */
    return m->s * s2 * (q / g) * (q / g) / (4.0 * PI_DOUBLE * walk_sigma(m, wi));
}

WalkMedium walk_medium(const WalkDesc *desc) {
    return (WalkMedium){
        .s = desc->alpha * desc->alpha,
        .thickness = desc->thickness,
        .axis = {sin(desc->tilt) * cos(desc->azimuth), sin(desc->tilt) * sin(desc->azimuth), cos(desc->tilt)}};
}

Walker walk_start(const double wo[3], uint64_t seed, uint64_t number) {
    return (Walker){.d = {-wo[0], -wo[1], -wo[2]}, .random = stream_start(seed, number)};
}

static double draw(Walker *walker) { return unit_double(stream_next(&walker->random)); }

/* Samples a distance that is exponential with mean 1 / sigma. */
bool walk_fly(const WalkMedium *m, Walker *walker) {
    walker->depth += walker->d[2] * log(1.0 - draw(walker)) / walk_sigma(m, walker->d);
    return walker->depth > 0.0 && walker->depth < m->thickness;
}

/* Samples a normal of an ellipsoid by its visible area, and mirrors the walk there. Visible normals are S^(1/2) u for u
 * distributed by the cosine about v = S^(1/2) wi. Such a u is, up to its length, the sum of v / |v| and a point of the
 * unit sphere. */
void walk_scatter(const WalkMedium *m, Walker *walker) {
    double v[3], h[3];
    double z = 2.0 * draw(walker) - 1.0, r = sqrt(1.0 - z * z), phi = 2.0 * PI_DOUBLE * draw(walker);
    stretch(m, walker->d, v);
    double back = -1.0 / sqrt(dot(v, v)); /* wi = -d */
    double u[3] = {back * v[0] + r * cos(phi), back * v[1] + r * sin(phi), back * v[2] + z};
    stretch(m, u, h);
    double square = dot(h, h), k = square > 0.0 ? 2.0 * dot(walker->d, h) / square : 0.0;
    for (int c = 0; c < 3; c++) walker->d[c] -= k * h[c];
}

/* ---- many walks ---------------------------------------------------------------------------------------- */

typedef struct WalkRun {
    const WalkDesc *desc;
    WalkMedium medium;
    double *sigma; /* of each wi */
    double *sums;  /* of f: a row of directions for each batch */
    WalkCount counts[WALK_BATCHES];
    long long length; /* of a batch, walks */
} WalkRun;

/* Adds the light that a flake scatters to each wi and that leaves without a further flake. */
static void connect(const WalkRun *run, const Walker *walker, double *sums) {
    const double back[3] = {-walker->d[0], -walker->d[1], -walker->d[2]};
    for (int k = 0; k < run->desc->directions; k++) {
        const double *wi = run->desc->wi + 3 * (size_t)k;
        double t = exp(-run->sigma[k] * walker->depth / wi[2]); /* transmittance */
        if (t > 0.0) sums[k] += run->desc->albedo * walk_phase(&run->medium, back, wi) * t / wi[2];
    }
}

static void one_walk(const WalkRun *run, uint64_t number, WalkCount *count, double *sums) {
    const WalkDesc *desc = run->desc;
    Walker walker = walk_start(desc->wo, desc->seed, number);
    long long met = 0;
    bool absorbed = false;
    while (!absorbed && walk_fly(&run->medium, &walker)) {
        if (met > 0 || !desc->multiple) connect(run, &walker, sums);
        met++;
        absorbed = desc->albedo < 1.0 && draw(&walker) >= desc->albedo;
        if (!absorbed) walk_scatter(&run->medium, &walker);
    }
    bool up = !absorbed && walker.depth <= 0.0;
    count->walks++;
    count->flakes += met;
    count->absorbed += absorbed;
    count->reflected += up;
    count->reflected_single += up && met == 1;
    count->transmitted += !absorbed && !up;
}

static void one_batch(void *user, int batch, int thread) {
    (void)thread;
    WalkRun *run = user;
    double *sums = run->sums + (size_t)batch * (size_t)run->desc->directions;
    for (long long k = 0; k < run->length; k++)
        one_walk(run, (uint64_t)(batch * run->length + k), &run->counts[batch], sums);
}

static WalkCount count_sum(const WalkCount *counts) {
    WalkCount all = {0};
    for (int k = 0; k < WALK_BATCHES; k++) {
        all.walks += counts[k].walks;
        all.reflected += counts[k].reflected;
        all.transmitted += counts[k].transmitted;
        all.absorbed += counts[k].absorbed;
        all.reflected_single += counts[k].reflected_single;
        all.flakes += counts[k].flakes;
    }
    return all;
}

/* Returns the mean of the batches and its standard error. */
static WalkEstimate batch_mean(const WalkRun *run, int k) {
    double sum = 0.0, squares = 0.0, length = (double)run->length;
    size_t stride = (size_t)run->desc->directions;
    for (size_t b = 0; b < WALK_BATCHES; b++) sum += run->sums[b * stride + (size_t)k] / length;
    double mean = sum / WALK_BATCHES;
    for (size_t b = 0; b < WALK_BATCHES; b++) {
        double off = run->sums[b * stride + (size_t)k] / length - mean;
        squares += off * off;
    }
    return (WalkEstimate){mean, sqrt(squares / (WALK_BATCHES * (WALK_BATCHES - 1.0)))};
}

bool walk_run(const WalkDesc *desc, WalkCount *count, WalkEstimate *f) {
    WalkRun *run = calloc(1, sizeof *run);
    size_t directions = (size_t)desc->directions;
    double *sigma = alloc_array(directions, sizeof *sigma);
    double *sums = alloc_array(directions, WALK_BATCHES * sizeof *sums);
    bool ready = run && sigma && sums;
    if (ready) {
        *run = (WalkRun){.desc = desc, .medium = walk_medium(desc), .sigma = sigma, .sums = sums};
        run->length = (desc->walks + WALK_BATCHES - 1) / WALK_BATCHES;
        for (size_t k = 0; k < directions; k++) sigma[k] = walk_sigma(&run->medium, desc->wi + 3 * k);
        parallel_for(desc->threads, WALK_BATCHES, one_batch, run);
        *count = count_sum(run->counts);
        for (int k = 0; k < desc->directions; k++) f[k] = batch_mean(run, k);
    }
    free(sums);
    free(sigma);
    free(run);
    return ready;
}

WalkEstimate walk_share(long long count, long long walks) {
    double n = (double)walks, p = (double)count / n;
    return (WalkEstimate){p, sqrt(p * (1.0 - p) / n)};
}
