/* v_smith_ggx_fast - v_smith_ggx_correlated without its square roots, as games on weak hardware have it
 *
 *   V = 1 / (2 mix(2 cos_o cos_i, cos_o + cos_i, alpha))
 *
 *   Earl Hammon, "PBR Diffuse Lighting for GGX+Smith Microsurfaces", GDC 2017: |A w| is taken for
 * mix(cos_w, 1, alpha). The same is Vis_SmithJointApprox of Unreal Engine 4.
 *   The floor 1e-12 keeps V finite at the horizon; at alpha 0.005 and both cosines 1e-6 the denominator is
 * still 1e-8. */
#pragma once

#include "shading/dialect/lang.h"

FN float smith_ggx_fast_v(float alpha, float o, float i) { return 0.5f / max(mix(2.0f * o * i, o + i, alpha), 1e-12f); }
