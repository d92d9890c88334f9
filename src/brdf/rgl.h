/* rgl.h - a measured BRDF in the format of the RGL material database, ".bsdf"
 *
 *   f cos_i = R(s) D(u_m) / (4 sigma(u_o)),   u_m = W(s),   u = (sqrt(2 theta / pi), (phi + pi) / (2 pi))
 *
 * m is the half vector; its azimuth is relative to that of wo if the material is isotropic. D and sigma are tables over
 * u. W is the warp (square_warp.h) of a density of half vectors visible from wo. R is a table over s of colours or of
 * spectra. W and R have slices for azimuths and polar angles of wo. A sample is an s from the warp of a table of
 * luminances, mapped by W. Jonathan Dupuy, Wenzel Jakob, "An Adaptive Parameterization for Efficient Material
 * Acquisition and Rendering", ACM Transactions on Graphics 37(6), 2018, sections 4 and 5.
 *
 *   field               extents
 *   theta_i, phi_i      T, P        ascending, radians; isotropic if P <= 2
 *   ndf, sigma          any two     rows of azimuths
 *   vndf                P, T, any two
 *   luminance           P, T, n, n
 *   rgb                 P, T, 3, n, n
 *   or spectra          P, T, L, n, n   with wavelengths, L, nm
 *   description, jacobian           u8, not needed to evaluate
 *
 * phi_i may span a half or a quarter of the circle, from -pi on: the material is then symmetric under rotation by pi,
 * or under mirroring in x and in y. The direction that the fields call i is wo here. */
#pragma once

#include <stdbool.h>
#include <stdio.h>

#include "brdf/square_warp.h"
#include "shading/dialect/angles.h"
#include "weft/result.h"

/* A table over u, height rows of width numbers. */
typedef struct RglTable {
    int width, height;
    float *value;
} RglTable;

typedef struct Rgl {
    int phis, thetas, side; /* side: n */
    int parts;              /* equal parts of the circle: 1, 2 or 4 */
    float *phi, *theta;     /* angles of the slices, radians */
    RglTable ndf, sigma;    /* D and sigma */
    SquareWarp normals;     /* W */
    SquareWarp luminance;   /* the warp that draws s */
    float *color;           /* R: [slice][channel][y][x] */
} Rgl;

/* Reads size bytes of a file. Fails with WEFT_MESSAGE_BSDF or _MEMORY; release with rgl_free in any case. */
WeftResult rgl_read_memory(const void *data, size_t size, const char *name, Rgl *out, WeftError *error);
void rgl_free(Rgl *rgl);

/* Returns true if f does not change when both directions rotate about the normal. */
bool rgl_isotropic(const Rgl *rgl);

/* Evaluates f, 1/sr; 0 below the horizon. */
void rgl_at(const Rgl *rgl, Dir o, Dir i, float f[3]);

/* Draws a direction for two numbers in [0, 1), and returns a direction's density, 1/sr; z <= 0 is no sample. */
Dir rgl_sample(const Rgl *rgl, Dir o, float u, float v);
float rgl_pdf(const Rgl *rgl, Dir o, Dir i);

/* Converts between angles, radians, and u. */
SquarePoint rgl_square_of(double theta, double phi);
void rgl_angles_of(SquarePoint u, double *theta, double *phi);

/* Interpolates a table at u. */
double rgl_table_at(const RglTable *table, SquarePoint u);

/* Writes a file with rgb and that description. Returns false on failure. */
bool rgl_write(const Rgl *rgl, const char *description, FILE *stream);
