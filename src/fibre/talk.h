/* talk.h - the reflection of a slab of fibres by the walk of a talk, whose table engines ship
 *
 *   Tizian Zeltner, Brent Burley, Matt Jen-Yuan Chiang, "Practical Multiple-Scattering Sheen Using Linearly
 * Transformed Cosines", SIGGRAPH Talks 2022, and the program published with it: white flakes around upright
 * fibres, density 1 (walk.h). Unlike walk.h's own, a walk ends with its 16th flake, and if it is then inside the slab,
 * counts as what its last direction says (docs/fibre.md, section 3). */
#ifndef WEFT_FIBRE_TALK_H
#define WEFT_FIBRE_TALK_H

#include <stdint.h>

enum { TALK_SIDE = 32 };

/* f mu, f in 1/sr, as means over cells of equal theta (rows, 0 to pi / 2) and of equal phi (columns, 0 to pi, from wo's
 * own side; both halves of the turn together). The first row is one mean: little light is there. */
typedef struct TalkSlab {
    double reflected; /* R */
    long long seen;   /* walks that are in it */
    double f[TALK_SIDE][TALK_SIDE];
} TalkSlab;

/* Walks from a wo of cosine mu. All slabs take the same random numbers, which leaves tables of them smooth. */
void talk_walk(double alpha, double mu, long long walks, TalkSlab *out);

/* The middles of a row and of a column, radians. */
double talk_theta(int row);
double talk_phi(int column);

#endif
