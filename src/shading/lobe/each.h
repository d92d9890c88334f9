/* each.h - lobes of one kind, each with numbers of its own: loops over arrays of parameters, colours and
 * directions
 *
 * Every array has n elements, a multiple of EACH_GROUP, and none that is written overlaps another. */
#pragma once

#include <stddef.h>

#include "shading/lobe/lobe.h"

enum { EACH_GROUP = 64 };

typedef struct Each {
    Lobe lobe;                            /* the lobe's id and choices of terms */
    const float *params[LOBE_PARAMS_MAX]; /* clamped; of a choice it is not read */
    const float *f0[3], *f90[3];          /* colours, as WeftLobe has them */
    const float *o[3], *i[3], *u, *v;     /* u and v in [0, 1) */
    float *f[3], *pdf;                    /* f in colour; a part of those below the horizon is 0 */
    float *drawn[3];
} Each;

/* Computes f and pdf of o and i; 0 if a direction is not above the horizon or a component is infinite or NaN. Writes
 * none of the other outputs. */
void each_eval(const Each *e, size_t n);

/* Computes `drawn` from o, u and v; 0 if o is not above the horizon or not finite. */
void each_sample(const Each *e, size_t n);
