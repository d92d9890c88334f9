/* data_lobe.h - a measurement as a lobe of two colours
 *
 *   f_c = k exp(P(x, y)) (f0_c (1 - s) + f90_c s),   s = Q(x, y) in [0, 1]
 *   x = 2 sqrt(sin theta_h) - 1,   y = 2 sqrt(1 - cos theta_d) - 1
 *
 * P and Q are polynomials over the square: f hardly depends on phi_d (docs/fabrics.md), and the colours of one
 * cloth are nearly mixtures of two. k makes the largest E of the white lobe less than 1. */
#pragma once

#include <stdbool.h>

#include "weft/fit.h"

enum { SHAPE_TERMS = 8, SHARE_TERMS = 4 };

typedef struct DataLobe {
    double shape[SHAPE_TERMS][SHAPE_TERMS]; /* P: [power of y][power of x] */
    double share[SHARE_TERMS][SHARE_TERMS]; /* Q */
    double low, high;                       /* range of ln f in the data, to which P is clamped */
    double scale;                           /* k */
    double f0[3], f90[3];
    double alpha; /* of sampling: half by half vectors of ggx, half by the cosine */
    double error; /* the log error, as in weft/fit.h */
} DataLobe;

/* Fits the polynomials and colours. Returns false if memory is short. */
bool data_lobe_fit(const WeftData *data, DataLobe *out);

/* Returns exp(P), and the second function s, at a pair with wi . h = cos_d and the squared sine sin2_h of theta_h. */
double data_lobe_shape(const DataLobe *lobe, double sin2_h, double cos_d);
double data_lobe_share(const DataLobe *lobe, double sin2_h, double cos_d);
