#include "fibre/truncated_walk.h"

#include <math.h>
#include <string.h>

#include "base/pi.h"
#include "fibre/walk.h"

enum { FLAKES_MOST = 16 };

double truncated_theta(int row) { return (row + 0.5) / TRUNCATED_SIDE * 0.5 * PI_DOUBLE; }
double truncated_phi(int column) { return (column + 0.5) / TRUNCATED_SIDE * PI_DOUBLE; }

static int cell(double part) { return part < 1.0 ? (int)(part * TRUNCATED_SIDE) : TRUNCATED_SIDE - 1; }

/* Adds a walk with the weight 1 / (its cell's solid angle), which uses sin theta of the walk's own direction, as the
 * talk's program does. */
static void count(TruncatedSlab *out, const double d[3]) {
    double sine = hypot(d[0], d[1]), theta = atan2(sine, d[2]), phi = fabs(atan2(d[1], d[0]));
    out->f[cell(theta / (0.5 * PI_DOUBLE))][cell(phi / PI_DOUBLE)] += 1.0 / fmax(sine, 1e-9);
    out->seen++;
}

void truncated_walk(double alpha, double mu, long long walks, TruncatedSlab *out) {
    WalkMedium medium = walk_medium(&(WalkDesc){.alpha = alpha, .thickness = 1.0});
    const double wo[3] = {sqrt(1.0 - mu * mu), 0.0, mu};
    memset(out, 0, sizeof *out);
    for (long long n = 0; n < walks; n++) {
        Walker walker = walk_start(wo, 1, (uint64_t)n);
        for (int flake = 0; flake < FLAKES_MOST && walk_fly(&medium, &walker); flake++) walk_scatter(&medium, &walker);
        if (walker.d[2] > 0.0) count(out, walker.d);
    }
    /* a cell is pi / 2 by pi over TRUNCATED_SIDE^2, and stands for both halves of the azimuth */
    double scale = TRUNCATED_SIDE * TRUNCATED_SIDE / (PI_DOUBLE * PI_DOUBLE * (double)walks), first = 0.0;
    for (int row = 0; row < TRUNCATED_SIDE; row++)
        for (int c = 0; c < TRUNCATED_SIDE; c++) out->f[row][c] *= scale;
    for (int c = 0; c < TRUNCATED_SIDE; c++) first += out->f[0][c] / TRUNCATED_SIDE;
    for (int c = 0; c < TRUNCATED_SIDE; c++) out->f[0][c] = first;
    out->reflected = (double)out->seen / (double)walks;
}
