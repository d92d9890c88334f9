/* tilted.h - the same slab with its fibres brushed over: tilted in the plane of azimuth 0
 *
 * Without symmetry about the normal there are no modes, and doubling.h works on directions over the whole
 * hemisphere. The plane of the tilt remains a mirror: functions even and odd in the azimuth separate. */
#pragma once

#include "fibre/slab.h"

/* A direction by its cosine to the normal, in (0, 1], and its azimuth in [0, pi]; fibres lean towards 0. */
typedef struct Heading {
    double mu, phi;
} Heading;

/* Numbers of cosines and of azimuths over pi, and halvings as in SlabEffort: the quadrature has rings * spokes
 * nodes. */
typedef struct TiltEffort {
    int rings, spokes, halvings;
} TiltEffort;

/* Returns the resolution that gives f to about 0.2 percent at that alpha; docs/fibre.md has its limits. */
TiltEffort tilt_effort(double alpha);

/* Solves f between `count` directions, with single scattering, 1/sr, at the depths of slab_mode:
 * same[k][i * count + j] for wi = at[i] and wo = at[j], across[...] for wo mirrored at the plane of the tilt, and
 * reflected[k][count]: R. same and across may both be NULL, or reflected may. tilt: radians, [0, pi / 2). Returns false
 * if memory is short. */
bool tilted_f(const Slab *slab, double tilt, TiltEffort effort, int kept, int count, const Heading *at, double *same,
              double *across, double *reflected);

/* Returns f of single scattering, exact, 1/sr, for a pair of headings; phi_o may be negative. */
double tilted_single(const Slab *slab, double tilt, Heading i, Heading o);
