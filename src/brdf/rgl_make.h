/* rgl_make.h - a BRDF as tables of the RGL format: R is what D and sigma leave of f (rgl_facets.h, rgl.h)
 *
 * The authors' W spreads points by q^2 = D(m) (wo . m) u_theta sin theta_m. Here it is
 *
 *   k (q + Q),   k = 1 above the horizon, 0.1 well below,   Q the mean of q where k counts
 *
 * so that points are left where little comes straight back, and few lie where mirroring wo at m ends below the
 * horizon. A reader looks W up, whatever made it. Own form, by how near lobes come back (docs/measured.md). */
#ifndef WEFT_BRDF_RGL_MAKE_H
#define WEFT_BRDF_RGL_MAKE_H

#include "brdf/rgl_facets.h"

/* The sizes of the tables. */
typedef struct RglDesc {
    int thetas, phis; /* slices; phis counts where the source is not isotropic */
    int side;         /* of the tables of each slice */
    int threads;      /* 0: one a processor; no influence on the numbers */
} RglDesc;

enum { RGL_SIDE_MOST = 512, RGL_SLICES_MOST = 256 };

/* Makes all tables but D and sigma, which out has (rgl_facets), in place of those that it has. False where memory is
 * short; release with rgl_free in any case. */
bool rgl_make(const RglSource *source, const RglDesc *desc, Rgl *out);

/* Takes h^2 f'' / 12 from every number of R, along each of its four axes, h the step from node to node. Linear interpolation
 * of a function that is quadratic between nodes is off by h^2 f'' x (1 - x) / 2, at x from one node to the next, and so by a
 * twelfth in the mean. What is left cancels in the mean, over each axis. False where memory is short. */
bool rgl_sharpen(Rgl *rgl);

#endif
