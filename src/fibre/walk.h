/* walk.h - light walking through a slab of fibres, flake by flake: the independent check of whatever solves
 * the slab otherwise
 *
 * The medium is that of shading/media/fibre_medium.h, once more in double precision. A walk enters against wo and
 * is simulated as it is: distances by sigma, flakes by how much of them is seen, an end at a flake by the
 * share that it does not reflect; nothing is cut off after some number of flakes. Every estimate is unbiased.
 *
 *   reflected = integral over wi of f mu_i,   reflected + transmitted + absorbed = 1
 *   f(wo, wi) = mean over walks of the sum over flakes of w p(-d, wi) exp(-sigma(wi) z / mu_i) / mu_i [1/sr]
 *
 * where z is the depth of a flake and d the direction in which light came to it. This is next-event
 * estimation; where the sum has few large terms, at low alpha, its error is itself known badly. */
#ifndef WEFT_FIBRE_WALK_H
#define WEFT_FIBRE_WALK_H

#include <stdbool.h>
#include <stdint.h>

/* Directions have z up, out of the slab. */
typedef struct WalkDesc {
    double alpha;         /* (0, 1]; what a fibre shows along its axis is alpha^2 */
    double thickness;     /* times density, >= 0 */
    double albedo;        /* w of a flake, [0, 1] */
    double tilt, azimuth; /* of the fibres' axis: from z, and from x towards y; radians */
    double wo[3];         /* unit, z > 0 */
    int directions;       /* f is asked for at so many wi: 3 * directions numbers, unit, z > 0 */
    const double *wi;     /* may be NULL where there are none */
    bool multiple;        /* f without light that met one flake only */
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
    long long reflected_once; /* of those reflected: after one flake */
    long long flakes;         /* met by all together */
} WalkCount;

/* Walks. f must have room for desc->directions estimates, by batch means; it may be NULL where there are
 * none. False where memory is short. */
bool walk_run(const WalkDesc *desc, WalkCount *count, WalkEstimate *f);

/* A share of the walks. */
WalkEstimate walk_share(long long count, long long walks);

/* ---- step by step, for tests that end a walk in another way ------------------------------------------- */

typedef struct WalkMedium {
    double s, thickness, axis[3];
} WalkMedium;

typedef struct Walker {
    double d[3], depth; /* where it goes, and how deep it is */
    uint64_t random;
} Walker;

WalkMedium walk_medium(const WalkDesc *desc);
Walker walk_start(const double wo[3], uint64_t seed, uint64_t number);

/* To the next flake; false where the walk has left the slab before: through the top where depth < 0. */
bool walk_fly(const WalkMedium *medium, Walker *walker);

/* Off a flake. */
void walk_turn(const WalkMedium *medium, Walker *walker);

/* sigma(w), and p(wi, wo) for unit vectors that point away from the flake, 1/sr. */
double walk_sigma(const WalkMedium *medium, const double w[3]);
double walk_phase(const WalkMedium *medium, const double wi[3], const double wo[3]);

#endif
