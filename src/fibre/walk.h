/* walk.h - random walks of light through a slab of fibres, flake by flake: an independent check of other solvers
 *
 * The medium is that of shading/media/fibre_medium.h, here in double precision. A walk enters against wo. Distances are
 * sampled by sigma and flakes by their visible area; a flake absorbs with the probability 1 - albedo. Walks are not
 * truncated after some number of flakes: every estimate is unbiased.
 *
 *   reflected = integral over wi of f mu_i,   reflected + transmitted + absorbed = 1
 *   f(wo, wi) = mean over walks of the sum over flakes of w p(-d, wi) exp(-sigma(wi) z / mu_i) / mu_i [1/sr]
 *
 * where z is the depth of a flake and d the direction in which light reached it. This is next-event estimation. At low
 * alpha the sum has few large terms, and the estimate of its error is itself inaccurate. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/* Directions have z up, out of the slab. */
typedef struct WalkDesc {
    double alpha;         /* (0, 1]; the projected area of a fibre along its axis is alpha^2 of that across */
    double thickness;     /* times density, >= 0 */
    double albedo;        /* w of a flake, [0, 1] */
    double tilt, azimuth; /* of the fibres' axis: from z, and from x towards y; radians */
    double wo[3];         /* unit, z > 0 */
    int directions;       /* for which f is estimated */
    const double *wi;     /* 3 * directions numbers, unit, z > 0; may be NULL without directions */
    bool multiple;        /* f without single scattering */
    long long walks;      /* at least 1; rounded up to a multiple of WALK_BATCHES */
    uint64_t seed;        /* a walk is a function of this and its number */
    int threads;          /* 0: all; no influence on the numbers */
} WalkDesc;

enum { WALK_BATCHES = 256 };

typedef struct WalkEstimate {
    double mean, error; /* standard error */
} WalkEstimate;

/* The number of walks and how they ended. */
typedef struct WalkCount {
    long long walks, reflected, transmitted, absorbed;
    long long reflected_single; /* of those reflected: after one flake */
    long long flakes;           /* met by all walks together */
} WalkCount;

/* Simulates walks. f receives desc->directions estimates, by batch means; it may be NULL without directions. Returns
 * false if memory is short. */
bool walk_run(const WalkDesc *desc, WalkCount *count, WalkEstimate *f);

/* Returns the fraction of walks that ended in some way, with its standard error. */
WalkEstimate walk_share(long long count, long long walks);

/* ---- step by step, for tests that end a walk in another way ------------------------------------------- */

typedef struct WalkMedium {
    double s, thickness, axis[3];
} WalkMedium;

typedef struct Walker {
    double d[3];  /* direction of flight, unit */
    double depth; /* below the top, in the unit of WalkDesc.thickness */
    uint64_t random;
} Walker;

WalkMedium walk_medium(const WalkDesc *desc);
Walker walk_start(const double wo[3], uint64_t seed, uint64_t number);

/* Moves to the next flake; returns false if the walk leaves the slab before: through the top if depth <= 0. */
bool walk_fly(const WalkMedium *medium, Walker *walker);

/* Reflects the walk off a flake. */
void walk_scatter(const WalkMedium *medium, Walker *walker);

/* Returns sigma(w), the extinction along a unit vector. */
double walk_sigma(const WalkMedium *medium, const double w[3]);

/* Returns the phase function p(wi, wo), 1/sr, for unit vectors that point away from the flake. */
double walk_phase(const WalkMedium *medium, const double wi[3], const double wo[3]);
