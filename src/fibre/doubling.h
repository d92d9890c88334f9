/* doubling.h - reflection and transmission of a homogeneous slab from those of a thin layer, by doubling
 *
 * Directions are numbered. The first `nodes` carry a quadrature, sum_j c_j g_j ~ integral of g mu dw. The rest, up to
 * `total`, are passengers: nothing is integrated over them, so that their results need no interpolation. A kernel is a
 * symmetric total x total matrix without weights: r[i][j] = f, the BRDF, and t likewise for transmission. Downward
 * directions are named by their antipodes, which makes every operator of a slab of symmetric flakes symmetric.
 *
 *   J. E. Hansen, L. D. Travis, "Light Scattering in Planetary Atmospheres", Space Science Reviews 16, 1974,
 *     section 3.2, gives the method; the thin layer is van de Hulst's, by exact single scattering. */
#pragma once

#include <stdbool.h>

typedef struct Doubling {
    int nodes, total;
    const double *c;      /* [nodes] */
    const double *lambda; /* [total]: extinction along a direction over its cosine */
    double depth;         /* of the slab, > 0 */
    int halvings;         /* the thin layer's depth is depth / 2^halvings */
    int kept;             /* results are of depth / 2^(kept - 1) .. depth / 2, depth; 1 .. halvings + 1 */
} Doubling;

/* Results between passengers, for each kept depth. Those whose pointer is NULL are not computed. */
typedef struct Layered {
    double *r, *t;     /* [kept][passengers * passengers] f of reflection and of diffuse transmission */
    double *up, *down; /* [kept][passengers] their integrals over the hemisphere, `down` with direct light */
} Layered;

/* Computes the results of a slab. r and t contain the scattering per depth, albedo K / (mu_i mu_j), total * total each,
 * and are overwritten. Returns false if memory is short. */
bool doubling_run(const Doubling *slab, double *r, double *t, const Layered *out);
