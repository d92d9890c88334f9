/* ltc_fit.h - the linearly transformed cosine nearest to what a lobe sends on, for one wo */
#ifndef WEFT_MEASURE_LTC_FIT_H
#define WEFT_MEASURE_LTC_FIT_H

#include "shading/catalogue/registry.h"
#include "shading/ltc/ltc.h"

/* The table's numbers: z > 0, q >= 0, r >= 0. */
typedef struct LtcEntries {
    float z, q, b, r;
} LtcEntries;

/* The values to fit: f cos_i at directions that crowd where lobes change fast, on one side of the plane of
 * incidence, wo being in the plane of the tangent. */
typedef struct LtcTarget {
    int rings, columns;
    bool level; /* r shall be 0; set after ltc_target_create */
    Dir o;
    float *x, *y, *z; /* wi, ring after ring */
    float *area;      /* solid angle of the direction and of its mirror image, sr */
    float *f;         /* f cos_i over e */
    double e;         /* the integral of f cos_i */
    double e0, e90;   /* of a lobe: the parts of the first and the second colour, both white */
} LtcTarget;

/* Room for cells / 2 directions in each of `cells` rings; cells is even, at most 400. False when memory is
 * short. */
bool ltc_target_create(LtcTarget *target, int cells);
void ltc_target_free(LtcTarget *target);

/* Sets wo and the directions. */
void ltc_target_fill(LtcTarget *target, float cos_o);

/* Fills in a lobe of two colours, isotropic as it stands. e may be 0: then there is nothing to fit. */
void ltc_target_lobe(LtcTarget *target, const Lobe *lobe, float f0, float second);

/* Makes of any f what integrates to 1, and sets e. */
void ltc_target_scale(LtcTarget *target);

/* The norm of the difference between f and the transform, scaled so that it too integrates to 1 above the
 * horizon: (integral of |f - D / above|^norm dwi)^(1 / norm), norm 1 to 3. With 1 it is between 0 and 2, and
 * 2 x is the share x of the light that goes to a wrong place. */
double ltc_error(const LtcTarget *target, LtcEntries entries, int norm);

/* Entries with about the target's mean direction and widths. */
LtcEntries ltc_guess(const LtcTarget *target);

/* The entries of least error, searched from the best of `count` >= 1 starts. */
LtcEntries ltc_fit(const LtcTarget *target, const LtcEntries *starts, int count, int norm);

#endif
