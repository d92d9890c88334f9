/* truncated_walk.h - the reflection of a slab of fibres by walks that end with their 16th flake: a published table has it so
 *
 *   Tizian Zeltner, Brent Burley, Matt Jen-Yuan Chiang, "Practical Multiple-Scattering Sheen Using Linearly
 * Transformed Cosines", SIGGRAPH Talks 2022, and the program published with it: white flakes around upright
 * fibres, density 1 (walk.h). Unlike walk.h's own, a walk ends with its 16th flake, and if it is then inside the slab,
 * counts as what its last direction says (docs/fibre.md, section 3). */
#ifndef WEFT_FIBRE_TRUNCATED_WALK_H
#define WEFT_FIBRE_TRUNCATED_WALK_H

#include <stdint.h>

enum { TRUNCATED_SIDE = 32 };

/* f mu, f in 1/sr, as means over cells of equal theta (rows, 0 to pi / 2) and of equal phi (columns, 0 to pi, from wo's
 * own side; both halves of the turn together). The first row is one mean: little light is there. */
typedef struct TruncatedSlab {
    double reflected; /* R */
    long long seen;   /* walks that are in it */
    double f[TRUNCATED_SIDE][TRUNCATED_SIDE];
} TruncatedSlab;

/* Walks from a wo of cosine mu. All slabs take the same random numbers, which leaves tables of them smooth. */
void truncated_walk(double alpha, double mu, long long walks, TruncatedSlab *out);

/* The middles of a row and of a column, radians. */
double truncated_theta(int row);
double truncated_phi(int column);

#endif
