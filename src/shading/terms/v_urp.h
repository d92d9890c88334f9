/* v_urp - shadowing and Fresnel of a highlight in one quotient, as phones have it
 *
 *   V = (q / (q + 1e-5))^2 / (max(d^2, 0.1) (4 alpha + 2)),  q = 1 - (1 - alpha^2) cos_h^2,  d = wi . h
 *
 *   Unity Technologies, Universal Render Pipeline, DirectBRDFSpecular of BRDF.hlsl, after Renaldas Zioma,
 * "Optimizing PBR for Mobile", SIGGRAPH 2015 course "Moving Mobile Graphics". The first factor is the 1e-5
 * which it adds inside d_ggx. Not quite a V: the rise of Fresnel's term is in it, so F should be none. */
#pragma once

#include "shading/dialect/angles.h"

FN float urp_v(float alpha, Angles a) {
    float q = a.h.x * a.h.x + a.h.y * a.h.y + alpha * alpha * a.h.z * a.h.z, r = q / (q + 1e-5f);
    return r * r / (max(a.d * a.d, 0.1f) * (4.0f * alpha + 2.0f));
}
