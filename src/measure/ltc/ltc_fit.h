/* ltc_fit.h - the linearly transformed cosine nearest to the reflection of a lobe, for one wo */
#pragma once

#include "shading/catalogue/registry.h"
#include "shading/ltc/ltc.h"

/* The numbers of a texel: z > 0, q >= 0, r >= 0. */
typedef struct LtcEntries {
    float z, q, b, r;
} LtcEntries;

/* The values to fit: f cos_i at directions that are dense where lobes change fast, on one side of the plane
 * of incidence; wo is in the plane of the tangent. */
typedef struct LtcTarget {
    int rings, columns;
    bool level; /* r shall be 0; set after ltc_target_create */
    Dir o;
    float *x, *y, *z; /* wi, ring after ring */
    float *area;      /* solid angle of the direction and of its mirror image, sr */
    float *f;         /* f cos_i over e */
    double e;         /* the integral of f cos_i */
    double e0, e90;   /* of a lobe: the parts of E of the first and the second colour, both white */
} LtcTarget;

/* Allocates cells / 2 directions in each of `cells` rings; cells is even, at most 400. Returns false if
 * memory is short. */
bool ltc_target_create(LtcTarget *target, int cells);
void ltc_target_free(LtcTarget *target);

/* Sets wo and the directions. */
void ltc_target_fill(LtcTarget *target, float cos_o);

/* Fills in an isotropic lobe of two colours. e may be 0: then there is nothing to fit. */
void ltc_target_lobe(LtcTarget *target, const Lobe *lobe, float f0, float second);

/* Scales f to the integral 1, and sets e. */
void ltc_target_scale(LtcTarget *target);

/* Returns the norm of the difference between f and the transform, scaled so that it too has the integral 1
 * above the horizon: (integral of |f - D / above|^norm dwi)^(1 / norm), norm 1 to 3. With norm 1 it is
 * between 0 and 2: twice the fraction of the light that goes into a wrong direction. */
double ltc_error(const LtcTarget *target, LtcEntries entries, int norm);

/* Returns entries with about the mean direction and widths of the target. */
LtcEntries ltc_guess(const LtcTarget *target);

/* Returns the entries of least error, searched from the best of `count` >= 1 starts. */
LtcEntries ltc_fit(const LtcTarget *target, const LtcEntries *starts, int count, int norm);
