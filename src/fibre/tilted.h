/* tilted.h - the same slab with its fibres brushed over: tilted in the plane of azimuth 0
 *
 * Without symmetry about the normal there are no modes, and doubling.h works on directions over the whole
 * hemisphere. The plane of the tilt remains a mirror: functions even and odd in the azimuth separate. */
#ifndef WEFT_FIBRE_TILTED_H
#define WEFT_FIBRE_TILTED_H

#include "fibre/slab.h"

/* A direction by its cosine to the normal, in (0, 1], and its azimuth in [0, pi]; fibres lean towards 0. */
typedef struct Heading {
    double mu, phi;
} Heading;

/* Cosines, azimuths over half a turn, halvings as in SlabEffort: the quadrature has rings * spokes nodes. */
typedef struct TiltEffort {
    int rings, spokes, halvings;
} TiltEffort;

/* Returns the resolution that gives f to about 0.2 percent at that alpha; docs/fibre.md has its limits. */
TiltEffort tilt_effort(double alpha);

/* f between `count` directions, single scattering included, 1/sr, at depths as slab_mode has them:
 * same[k][i * count + j] for wi = at[i], wo = at[j], across[...] for wo mirrored at the plane of the tilt,
 * and reflected[k][count]: R. same and across may both be NULL, or reflected may. tilt in radians, [0, pi /
 * 2). False where memory is short. */
bool tilted_f(const Slab *slab, double tilt, TiltEffort effort, int kept, int count, const Heading *at,
              double *same, double *across, double *reflected);

/* Light scattered once, exact, for the pair of headings, phi_o of either sign. */
double tilted_single(const Slab *slab, double tilt, Heading i, Heading o);

#endif
