/* v_smith_ggx_aniso - shadowing and masking of brushed GGX by the height of the facet
 *
 *   V = 1 / (2 (cos_i |A wo| + cos_o |A wi|)),   A = diag(ax, ay, 1)
 *
 *   v_smith_ggx_correlated with the two widths of d_ggx_aniso. Eric Heitz, "Understanding the
 * Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014. This is what Unreal Engine,
 * Filament and glTF have; Burley 2012 multiplies two single factors instead, as v_smith_ggx does. */
#pragma once

#include "shading/terms/v_smith_ggx_correlated.h"

FN float smith_ggx_aniso_v(float ax, float ay, Dir o, Dir i) { return smith_ggx_correlated_v(ax, ay, o, i); }
