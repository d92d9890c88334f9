/* slab.h - reflection of a slab of fibres along the normal, solved without noise
 *
 * A medium of SGGX flakes around fibres that stand upright (Eric Heitz, Jonathan Dupuy, Cyril Crassin,
 * Carsten Dachsbacher, "The SGGX Microflake Distribution", ACM Transactions on Graphics 34(4), 2015), as
 * Tizian Zeltner, Brent Burley, Matt Jen-Yuan Chiang take it for sheen ("Practical Multiple-Scattering Sheen
 * Using Linearly Transformed Cosines", SIGGRAPH Talks, 2022). With s = alpha^2, mu the cosine of a direction
 * to the normal:
 *
 *   sigma = sqrt(1 - mu^2 + s^2 mu^2),  lambda = sigma / mu,
 *   D(h) = s^3 / (pi (s^2 (1 - h_z^2) + h_z^2)^2),  phase p = D(h) / (4 sigma),
 *   f = (1 / 2 pi) sum_m (2 - [m = 0]) r_m(mu_i, mu_o) cos(m phi).
 *
 * Each r_m is a problem in mu alone, solved by doubling.h. Angles phi are between the azimuths of wo and wi. */
#pragma once

#include <stdbool.h>

#include "fibre/doubling.h"

typedef struct Slab {
    double alpha;  /* square root of the flakes' cross-section along the fibre over that across it, (0, 1] */
    double albedo; /* of a flake, [0, 1] */
    double depth;  /* density times thickness, > 0 */
} Slab;

/* The resolution: nodes of the quadrature over mu, and halvings; the first layer has the thickness depth /
 * 2^halvings. */
typedef struct SlabEffort {
    int nodes, halvings;
} SlabEffort;

/* Returns the resolution that gives an albedo to 1e-4 at that alpha. */
SlabEffort slab_effort(double alpha);

/* Solves mode m of the BRDF between `count` cosines in (0, 1], with single scattering, at the depths
 * depth / 2^(kept - 1) .. depth, kept >= 1. For m = 0 the integrals are R and T. *defect (may be NULL) becomes the
 * largest relative error with which the quadrature conserves light before its correction. Returns false if memory is
 * short. */
bool slab_mode(const Slab *slab, SlabEffort effort, int m, int kept, int count, const double *mu, const Layered *out,
               double *defect);

/* Returns f of single scattering, exact, 1/sr. */
double slab_single(const Slab *slab, double mu_i, double mu_o, double cos_phi);

/* Returns mode m of single scattering, exact. */
double slab_single_mode(const Slab *slab, int m, double mu_i, double mu_o);
