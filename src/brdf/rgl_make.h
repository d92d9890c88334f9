/* rgl_make.h - a BRDF as tables of the RGL format
 *
 * As its authors do, D is solved from what comes straight back, F held constant in a microfacet model:
 *
 *   D(w) ~ 4 f(w, w) cos(w) sigma(w),   sigma(w) = integral of max(w . m, 0) D(m) dm
 *
 * by power iteration; R is what remains of f. Jonathan Dupuy, Eric Heitz, Jean-Claude Iehl, Pierre Poulin,
 * Victor Ostromoukhov, "Extracting Microfacet-based BRDF Parameters from Arbitrary Materials with Power
 * Iterations", Computer Graphics Forum 34(4), 2015; for the rest rgl.h. A part of D is even, 3 % of its peak,
 * so that f is met where nothing comes straight back.
 *
 * The authors' W spreads points by q^2 = D(m) (wo . m) u_theta sin theta_m. Here it is
 *
 *   k (q + Q),   k = 1 above the horizon, 0.1 well below,   Q the mean of q where k counts
 *
 * so that points are left where little comes straight back, and few lie where mirroring wo at m ends below the
 * horizon. A reader looks W up, whatever made it. Own form, by how near lobes come back (docs/measured.md). */
#ifndef WEFT_BRDF_RGL_MAKE_H
#define WEFT_BRDF_RGL_MAKE_H

#include "brdf/rgl.h"

/* The BRDF to tabulate. */
typedef struct RglSource {
    /* f of count directions wi. */
    void (*f)(void *user, const float wo[3], int count, const float (*wi)[3], float (*f)[3]);
    void *user;
    bool isotropic;
    int parts; /* of the circle of azimuths that are alike, as in rgl.h; counts where it is not isotropic */
} RglSource;

/* The sizes of the tables. */
typedef struct RglDesc {
    int thetas, phis; /* slices; phis counts where the source is not isotropic */
    int side;         /* of the tables of each slice */
    int threads;      /* 0: one a processor; no influence on the numbers */
} RglDesc;

enum { RGL_SIDE_MOST = 512, RGL_SLICES_MOST = 256 };

/* Makes the tables. False where memory is short; release with rgl_free in any case. */
bool rgl_make(const RglSource *source, const RglDesc *desc, Rgl *out);

#endif
