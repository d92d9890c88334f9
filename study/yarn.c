/* yarn.c - light walked through cloth of fibre tubes, which lobe woven is measured by
 *
 *   study_yarn [WALKS] > tests/weave/yarn_truth.txt
 *
 * A thread is a tube about a chain of arcs, over and under; its section is a lens,
 *
 *   |z - c(v)| < (w / 4) q (1 - r^2),   c = +-(l / 2) m (1 - |s|^(k + 1)) / (k + 1)
 *
 * with the letters of shading/weave/weave_point.h, once more in double precision. It is full of flakes along the thread,
 * turned by the twist, so dense that half a tube is 12 free paths. Where two tubes overlap, the higher one is there.
 * A walk enters from above at a random place and is followed by delta tracking, E. Woodcock and others, "Techniques
 * Used in the GEM Code for Monte Carlo Neutronics Calculations in Reactors and Other Systems of Complex Geometry",
 * 1965: steps as long as if all were tubes seen from the side, and a flake with the chance that there is one.
 *   Prints a row for each case and kind of light: the case, the kind, the share that goes through the cloth, how far
 * both halves of the walks are apart (sum of differences over sum), and what goes up into each bin. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/pi.h"
#include "base/random.h"
#include "base/thread.h"
#include "fibre/walk.h"
#include "weave/yarn_cases.h"
#include "weft/weave.h"

enum { SIDE = 16, BATCHES = 64, FLAKES_MOST = 500 };

/* A run of crossings: how many came before in it, its length, and 1 on top, -1 below. */
typedef struct Run {
    int since, length, up;
} Run;

typedef struct Tubes {
    int count[2];
    Run runs[2][SIDE][SIDE]; /* of each system: thread, crossing */
    double slope, twist, floats, width, alpha, density;
    double half, reach; /* heights: of half a tube, and of the highest one's top */
} Tubes;

static int on_top(const WeftDraft *draft, int weft, int thread, int crossing) {
    return weft ? !weft_draft_warp_up(draft, crossing, thread) : weft_draft_warp_up(draft, thread, crossing);
}

static Run run_at(const WeftDraft *draft, int weft, int thread, int crossing, int count) {
    const int top = on_top(draft, weft, thread, crossing);
    Run run = {0, 1, top ? 1 : -1};
    while (run.since < count && on_top(draft, weft, thread, crossing + count - run.since - 1) == top) run.since++;
    run.length = run.since + 1;
    for (int k = 1; k < count && on_top(draft, weft, thread, crossing + k) == top; k++) run.length++;
    return run;
}

static int tubes_make(Tubes *tubes, const YarnCase *yarn) {
    WeftDraft *draft;
    if (weft_draft_parse(yarn->draft, &draft, NULL) != WEFT_OK) return 0;
    const WeftDraftInfo info = weft_draft_info(draft);
    int longest = 1;
    for (int t = 0; t < 2; t++) {
        longest = info.longest_float[t] > longest ? info.longest_float[t] : longest;
        tubes->count[t] = info.count[t];
        for (int k = 0; k < info.count[t]; k++)
            for (int c = 0; c < info.count[!t]; c++) tubes->runs[t][k][c] = run_at(draft, t, k, c, info.count[!t]);
    }
    weft_draft_free(draft);
    tubes->slope = tan(yarn->crimp * RADIANS);
    tubes->twist = yarn->twist * RADIANS;
    tubes->floats = yarn->floats;
    tubes->width = yarn->width;
    tubes->half = 0.25 * yarn->width * yarn_roundness;
    tubes->density = 12.0 / tubes->half;
    tubes->alpha = yarn->alpha;
    tubes->reach = tubes->half + 0.5 * longest * tubes->slope / (2.0 + yarn->floats * (longest - 1.0));
    return 1;
}

static int wrapped(double at, int count) {
    const int k = (int)fmod(floor(at), (double)count);
    return k < 0 ? k + count : k;
}

/* Returns true if the tube of a system is there whose thread lies at u, v; its top, and its fibres' direction. */
static bool tube_at(const Tubes *m, int weft, double u, double v, double z, double *top, double axis[3]) {
    const Run run = m->runs[weft][wrapped(u, m->count[weft])][wrapped(v, m->count[!weft])];
    const double l = run.length, s = 2.0 * (v - floor(v) + run.since) / l - 1.0, k = 1.0 + m->floats * (l - 1.0);
    const double steep = pow(fabs(s), k), r = 2.0 * (u - floor(u) - 0.5) / m->width;
    const double middle = run.up * 0.5 * l * m->slope * (1.0 - fabs(s) * steep) / (k + 1.0);
    const double high = m->half * (1.0 - r * r);
    if (fabs(z - middle) >= high) return false;
    const double sx = yarn_roundness * r, sy = run.up * m->slope * (s < 0.0 ? -steep : steep);
    const double t = 1.0 / sqrt(1.0 + sy * sy), n = t / sqrt(1.0 + sx * sx + sy * sy);
    const double twist = weft ? -m->twist : m->twist, a = cos(twist) * t, b = sin(twist) * n;
    const double across = -b * (1.0 + sy * sy), along = a + b * sx * sy; /* cos T + sin N x T */
    axis[0] = weft ? along : across;
    axis[1] = weft ? across : along;
    axis[2] = -a * sy + b * sx;
    *top = middle + high;
    return true;
}

static bool fibre_at(const Tubes *m, const double p[3], double axis[3]) {
    double top[2], axes[2][3];
    const bool warp = tube_at(m, 0, p[0], p[1], p[2], &top[0], axes[0]),
               weft = tube_at(m, 1, p[1], p[0], p[2], &top[1], axes[1]);
    const int higher = weft && (!warp || top[1] > top[0]);
    for (int c = 0; c < 3; c++) axis[c] = axes[higher][c];
    return warp || weft;
}

typedef struct Tally {
    double up[2][KINDS_OF_LIGHT][BINS], through[KINDS_OF_LIGHT]; /* up: of either half of the walks */
} Tally;

static int bin_of(const double d[3]) {
    const int row = (int)fmin(d[2] * COSINES, COSINES - 1.0);
    const double turn = atan2(d[1], d[0]) / (2.0 * PI_DOUBLE);
    return row * AZIMUTHS + wrapped(turn * AZIMUTHS, AZIMUTHS);
}

static void one_walk(const Tubes *m, const double wo[3], uint64_t number, int half, Tally *tally) {
    Walker walker = walk_start(wo, 29, number);
    double p[3] = {m->count[0] * unit_double(stream_next(&walker.random)),
                   m->count[1] * unit_double(stream_next(&walker.random)), m->reach};
    int met = 0;
    while (fabs(p[2]) <= m->reach && met < FLAKES_MOST) {
        const double step = -log(1.0 - unit_double(stream_next(&walker.random))) / m->density;
        WalkMedium medium = {.s = m->alpha};
        for (int c = 0; c < 3; c++) p[c] += step * walker.d[c];
        if (!fibre_at(m, p, medium.axis)) continue;
        if (unit_double(stream_next(&walker.random)) >= walk_sigma(&medium, walker.d)) continue;
        walk_scatter(&medium, &walker);
        met++;
    }
    if (met == FLAKES_MOST) return;
    const double weights[KINDS_OF_LIGHT] = {met == 1 ? 1.0 : 0.0, pow(yarn_albedos[0], met), pow(yarn_albedos[1], met),
                                            pow(yarn_albedos[2], met)};
    for (int k = 0; k < KINDS_OF_LIGHT; k++)
        if (p[2] > 0.0)
            tally->up[half][k][bin_of(walker.d)] += weights[k];
        else
            tally->through[k] += weights[k];
}

typedef struct Walking {
    const Tubes *tubes;
    double wo[3];
    long walks; /* of a batch */
    Tally tallies[BATCHES];
} Walking;

static void one_batch(void *user, int batch, int thread) {
    Walking *w = user;
    (void)thread;
    for (long k = 0; k < w->walks; k++)
        one_walk(w->tubes, w->wo, (uint64_t)(batch * w->walks + k), batch % 2, &w->tallies[batch]);
}

static void print_kind(const Walking *w, int number, int kind) {
    double halves[2][BINS] = {{0.0}}, through = 0.0, apart = 0.0, sum = 0.0;
    for (int b = 0; b < BATCHES; b++) {
        through += w->tallies[b].through[kind] / (double)(BATCHES * w->walks);
        for (int k = 0; k < 2 * BINS; k++)
            halves[k / BINS][k % BINS] +=
                w->tallies[b].up[k / BINS][kind][k % BINS] / (0.5 * BATCHES * (double)w->walks);
    }
    for (int k = 0; k < BINS; k++) {
        apart += fabs(halves[0][k] - halves[1][k]);
        sum += halves[0][k] + halves[1][k];
    }
    printf("%d %d %.5f %.4f", number, kind, through, apart / (0.5 * sum));
    for (int k = 0; k < BINS; k++) printf(" %.4g", 0.5 * (halves[0][k] + halves[1][k]));
    printf("\n");
    fflush(stdout);
}

int main(int argc, char **argv) {
    const long walks = argc > 1 ? atol(argv[1]) : 1000000;
    static Tubes tubes;
    static Walking walking;
    if (walks < BATCHES) return 2;
    printf("# study_yarn %ld\n", walks);
    for (int k = 0; k < YARN_CASES; k++) {
        const double theta = yarn_cases[k].theta * RADIANS, phi = yarn_azimuth * RADIANS;
        if (!tubes_make(&tubes, &yarn_cases[k])) return 3;
        walking = (Walking){.tubes = &tubes,
                            .wo = {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)},
                            .walks = walks / BATCHES};
        parallel_for(0, BATCHES, one_batch, &walking);
        for (int kind = 0; kind < KINDS_OF_LIGHT; kind++) print_kind(&walking, k, kind);
    }
    return 0;
}
