/* v_smith_ggx - shadowing and masking of GGX as if the two were independent: too dark at grazing
 *
 *   V = 1 / ((cos_o + |A wo|) (cos_i + |A wi|)),   A = diag(alpha, alpha, 1)
 *
 *   Bruce Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, Equation 34,
 * for each direction. alpha >= 0.001 keeps |A w| from 0: no floor is needed. */
#pragma once

#include "shading/terms/d_ggx.h"

FN float smith_ggx_v(float alpha, Dir o, Dir i) {
    float lo = ggx_length(alpha, alpha, o), li = ggx_length(alpha, alpha, i);
    return 1.0f / ((o.z + lo) * (i.z + li));
}
