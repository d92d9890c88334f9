/* d_inverse_ggx - fuzz as Unreal Engine 4 draws it: an even floor of light and a rim with a soft inner edge
 *
 *   D(h) = (1 + 4 alpha^4 / (cos_h^2 + alpha^2 sin_h^2)^2) / (pi (1 + 4 alpha^2)),   integral of D cos_h = 1
 *
 *   Epic Games, Unreal Engine 4, 2014, D_InvGGX of its shaders, for the shading model Cloth, where it stands
 * for "asperity scattering". The same upside-down d_ggx in place of the exponential of d_ashikhmin; no paper
 * describes it. Its name for the idea: Jan Koenderink, Sylvia Pont, "The Secret of Velvety Skin", 2003.
 *   alpha: alpha = roughness^2 (its argument a2 is alpha^2). */
#pragma once

#include "shading/terms/d_ashikhmin.h"

FN float inverse_ggx_d(float alpha, Dir h) {
    float a2 = alpha * alpha, r = a2 / (h.z * h.z + a2 * (h.x * h.x + h.y * h.y));
    return (1.0f + 4.0f * r * r) / (PI * (1.0f + 4.0f * a2));
}

/* Returns h from D cos_h: the rim, as probable as that of d_ashikhmin, has cos_h^2 = alpha^2 u / (1 - u + alpha^2
 * u). */
FN Dir inverse_ggx_facet(float alpha, float u, float v) {
    float rim = ashikhmin_rim(alpha);
    if (u >= rim) return warp_cosine((u - rim) / (1.0f - rim), v);
    float w = u / rim, cos2 = alpha * alpha * w, sin2 = max(1.0f - w, 0.0f), s = 1.0f / (sin2 + cos2);
    return facet(sqrt(sin2 * s), sqrt(cos2 * s), v);
}
