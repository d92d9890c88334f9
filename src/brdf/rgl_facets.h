/* rgl_facets.h - D and sigma of a BRDF
 *
 * Like the authors of the format, this solves D of a microfacet model with constant F from retroreflection:
 *
 *   D(w) ~ 4 f(w, w) cos(w) sigma(w),   sigma(w) = integral of max(w . m, 0) D(m) dm
 *
 * by power iteration, on few directions. Jonathan Dupuy, Eric Heitz, Jean-Claude Iehl, Pierre Poulin, Victor
 * Ostromoukhov, "Extracting Microfacet-based BRDF Parameters from Arbitrary Materials with Power Iterations",
 * Computer Graphics Forum 34(4), 2015; for the rest see rgl.h. A last iteration writes finer tables: R is the quotient
 * of f by them, so it has a crease wherever D has one, and R is sampled coarsely. 3 % of D's peak are added uniformly,
 * so that f can be represented where nothing is retroreflected. */
#pragma once

#include "brdf/rgl.h"

/* The BRDF to tabulate. */
typedef struct RglSource {
    /* Evaluates f for count directions wi. */
    void (*f)(void *user, const float wo[3], int count, const float (*wi)[3], float (*f)[3]);
    void *user;
    bool isotropic;
    int parts; /* equal parts of the circle of azimuths, as in rgl.h; not read if isotropic */
} RglSource;

/* Makes the tables ndf and sigma of out. Returns false if memory is short; release with rgl_free in any case. */
bool rgl_facets(const RglSource *source, int threads, Rgl *out);

/* Returns the direction of these angles, radians, not below the horizon. */
Dir rgl_direction(double theta, double phi);
