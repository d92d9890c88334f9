/* v_smith_ggx_correlated - shadowing and masking of GGX by the height of the facet
 *
 *   V = 1 / (2 (cos_i |A wo| + cos_o |A wi|)),   A = diag(ax, ay, 1)
 *
 *   Eric Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014,
 *   Equation 99, with Lambda of Equations 72 and 86. */
#pragma once

#include "shading/terms/d_ggx.h"

FN float smith_ggx_correlated_v(float ax, float ay, Dir o, Dir i) {
    return 0.5f / max(i.z * ggx_length(ax, ay, o) + o.z * ggx_length(ax, ay, i), 1e-12f);
}
