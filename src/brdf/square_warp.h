/* square_warp.h - maps of the unit square onto itself that put more points where a tabulated density is high
 *
 * A slice of the table has width x height numbers at the corners of equal cells, and is bilinear between. It is scaled
 * to a density p(x, y) with an integral of 1 over the square:
 *
 *   v = integral from 0 to y of P(y') dy',          P(y) = integral over x of p(x, y)
 *   u = integral from 0 to x of p(x', y) dx' / P(y)
 *
 * maps (x, y) to uniform (u, v), and the inverse gives points of density p. Slices belong to azimuths and polar angles
 * of one direction; between them density and integrals are linear in both. Jonathan Dupuy,
 * Wenzel Jakob, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", 2018,
 * section 4.3 and supplemental material. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* The slices that a direction lies between, and their weights, which sum to 1. */
typedef struct SliceBlend {
    int count;
    size_t slice[4];
    double weight[4];
} SliceBlend;

/* Blends slices at phis azimuths times thetas polar angles, both ascending; angles beyond the ends are clamped. */
SliceBlend slice_blend(const float *phi, int phis, const float *theta, int thetas, double at_phi, double at_theta);

/* A place in the square. */
typedef struct SquarePoint {
    double x, y;
} SquarePoint;

typedef struct SquareWarp {
    int width, height;
    float *density; /* [slice][y][x], numbers below 0 count as 0 */
    float *along;   /* [slice][y][x]: the integral of the row up to x */
    float *up;      /* [slice][y]: that of all rows up to y */
} SquareWarp;

/* Integrates and scales `slices` slices of the density, which must be allocated and then belongs to the warp. A slice
 * without any positive number becomes uniform. Returns false if memory is short. */
bool square_warp_create(SquareWarp *warp, int width, int height, size_t slices, float *density);
void square_warp_free(SquareWarp *warp);

/* Evaluates p at a point. */
double square_warp_density(const SquareWarp *warp, const SliceBlend *blend, SquarePoint at);

/* Returns the point of (u, v), and inversely (u, v) of a point. */
SquarePoint square_warp_point(const SquareWarp *warp, const SliceBlend *blend, double u, double v);
SquarePoint square_warp_inverse(const SquareWarp *warp, const SliceBlend *blend, SquarePoint at);

/* Interpolates channel `channel` of `channels` in a table of slices, without a warp. */
double square_table_at(const float *table, int width, int height, const SliceBlend *blend, int channels, int channel,
                       SquarePoint at);
