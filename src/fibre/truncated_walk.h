/* truncated_walk.h - reflection of a slab of fibres by walks that end with their 16th flake, as in a published table
 *
 *   Tizian Zeltner, Brent Burley, Matt Jen-Yuan Chiang, "Practical Multiple-Scattering Sheen Using Linearly
 * Transformed Cosines", SIGGRAPH Talks 2022, and the program published with it: white flakes around upright fibres,
 * density 1 (walk.h). Unlike walk.h's, a walk ends with its 16th flake. If it is then inside the slab, it counts as
 * reflected or transmitted by its last direction (docs/fibre.md, section 3). */
#pragma once

#include <stdint.h>

enum { TRUNCATED_SIDE = 32 };

/* f mu, f in 1/sr, as means over cells of equal theta (rows, 0 to pi / 2) and of equal |phi| (columns, 0 to pi, 0 on
 * wo's side). The first row, which few walks reach, is replaced by its mean. */
typedef struct TruncatedSlab {
    double reflected; /* R */
    long long seen;   /* reflected walks */
    double f[TRUNCATED_SIDE][TRUNCATED_SIDE];
} TruncatedSlab;

/* Simulates walks from a wo of cosine mu. All slabs use the same random numbers, so that tables of them are smooth. */
void truncated_walk(double alpha, double mu, long long walks, TruncatedSlab *out);

/* Returns theta at the middle of a row, radians. */
double truncated_theta(int row);

/* Returns phi at the middle of a column, radians. */
double truncated_phi(int column);
