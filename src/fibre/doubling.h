/* doubling.h - reflection and transmission of a homogeneous slab from those of a thin layer, by doubling
 *
 * Directions are numbered. The first `nodes` carry a quadrature, sum_j c_j g_j ~ integral of g mu dw; the
 * rest, up to `total`, are passengers: nothing is integrated over them, so what comes out for them has no
 * interpolation in it. A kernel is a symmetric total x total matrix without weights: r[i][j] = f, the BRDF,
 * and likewise t for light that goes through. Downward directions are named by their antipodes; that makes
 * every operator of a slab of even flakes symmetric.
 *
 *   J. E. Hansen, L. D. Travis, "Light Scattering in Planetary Atmospheres", Space Science Reviews 16, 1974,
 *     section 3.2, gives the method; the thin layer is van de Hulst's, by exact single scattering. */
#ifndef WEFT_FIBRE_DOUBLING_H
#define WEFT_FIBRE_DOUBLING_H

#include <stdbool.h>

typedef struct Doubling {
    int nodes, total;
    const double *c;      /* [nodes] */
    const double *lambda; /* [total]: extinction along a direction over its cosine */
    double depth;         /* of the slab, > 0 */
    int halvings;         /* the thin layer's depth is depth / 2^halvings */
    int kept;             /* results are of depth / 2^(kept - 1) .. depth / 2, depth; 1 .. halvings + 1 */
} Doubling;

/* Between passengers, for each kept depth; results whose pointer is NULL are not computed. */
typedef struct Layered {
    double *r, *t;     /* [kept][guests * guests] f of what comes back and of what goes through diffusely */
    double *up, *down; /* [kept][guests] integrals over the hemisphere, down with direct light */
} Layered;

/* r and t come as what a layer scatters per depth, albedo K / (mu_i mu_j), total * total each, and are used
 * up. False where memory is short. */
bool doubling_run(const Doubling *slab, double *r, double *t, const Layered *out);

#endif
