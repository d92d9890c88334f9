/* rgl_make.h - tables of the RGL format made of a BRDF; R is the quotient of f by D and sigma (rgl_facets.h, rgl.h)
 *
 * The authors' W distributes points by the density q^2 = D(m) (wo . m) u_theta sin theta_m. Here the density is
 *
 *   k (q + Q),   k = 1 where mirroring wo at m ends above the horizon, 0.1 well below,   Q the mean of q weighted by k
 *
 * so that there are points where little light is retroreflected, and few below the horizon. A reader of the file needs
 * no formula for W. This density is our own, chosen by the error of the tabulated lobes (docs/measured.md). */
#pragma once

#include "brdf/rgl_facets.h"

/* The sizes of the tables. */
typedef struct RglDesc {
    int thetas, phis; /* slices; phis is not read if the source is isotropic */
    int side;         /* of the tables of each slice */
    int threads;      /* 0: one a processor; no influence on the numbers */
} RglDesc;

enum { RGL_SIDE_MOST = 512, RGL_SLICES_MOST = 256 };

/* Makes or replaces all tables of out but D and sigma, which it must have (rgl_facets). Returns false if memory is
 * short; release with rgl_free in any case. */
bool rgl_make(const RglSource *source, const RglDesc *desc, Rgl *out);

/* Subtracts h^2 f'' / 12 from every number of R along each of its four axes, where h is the step between nodes. Linear
 * interpolation of a function that is quadratic between nodes has the error h^2 f'' x (1 - x) / 2 at x in [0, 1] from
 * one node to the next, and thus h^2 f'' / 12 in the mean. The remaining error has mean 0 along each axis. Returns
 * false if memory is short. */
bool rgl_sharpen(Rgl *rgl);
