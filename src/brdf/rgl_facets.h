/* rgl_facets.h - D and sigma of a BRDF
 *
 * As the authors of the format do, D is solved from what comes straight back, F held constant in a microfacet model:
 *
 *   D(w) ~ 4 f(w, w) cos(w) sigma(w),   sigma(w) = integral of max(w . m, 0) D(m) dm
 *
 * by power iteration, on few directions. Jonathan Dupuy, Eric Heitz, Jean-Claude Iehl, Pierre Poulin, Victor
 * Ostromoukhov, "Extracting Microfacet-based BRDF Parameters from Arbitrary Materials with Power Iterations",
 * Computer Graphics Forum 34(4), 2015; for the rest rgl.h. One more iteration writes the tables, finer: R, which is
 * what they leave of f, has a crease wherever D has one, and R is sampled coarsely. A part of D is even, 3 % of its
 * peak, so that f is met where nothing comes straight back. */
#ifndef WEFT_BRDF_RGL_FACETS_H
#define WEFT_BRDF_RGL_FACETS_H

#include "brdf/rgl.h"

/* The BRDF to tabulate. */
typedef struct RglSource {
    /* f of count directions wi. */
    void (*f)(void *user, const float wo[3], int count, const float (*wi)[3], float (*f)[3]);
    void *user;
    bool isotropic;
    int parts; /* of the circle of azimuths that are alike, as in rgl.h; counts where it is not isotropic */
} RglSource;

/* Makes the tables ndf and sigma of out. False where memory is short; release with rgl_free in any case. */
bool rgl_facets(const RglSource *source, int threads, Rgl *out);

/* A direction above the horizon. */
Dir rgl_direction(double theta, double phi);

#endif
