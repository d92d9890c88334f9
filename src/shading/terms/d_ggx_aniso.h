/* d_ggx_aniso - the highlight of brushed metal, satin or long floats: d_ggx drawn out along the tangent
 *
 *   alpha_x = alpha + (1 - alpha) anisotropy^2,   alpha_y = alpha
 *
 *   The density is ggx_d of d_ggx, where its papers are named. The two widths: Khronos Group,
 * KHR_materials_anisotropy, 2023; engines differ in this and share the density. */
#pragma once

#include "shading/terms/d_ggx.h"

FN float ggx_aniso_ax(float alpha, float anisotropy) { return mix(alpha, 1.0f, anisotropy * anisotropy); }
