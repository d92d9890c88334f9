/* albedo-max - a sheen that takes from the base the most it reflects, towards the viewer or towards the light
 *
 *   f = sheen + (1 - c max(E(wo), E(wi))) base
 *
 *   Khronos Group, KHR_materials_sheen, 2020, whose scaling is the smaller of 1 - c E(wo) and 1 - c E(wi);
 * three.js has it for direct light.
 *   energy: E <= 1 where the sheen's own E is; over a lossless base it loses what albedo-view would keep.
 *   reciprocal: yes. */
#pragma once

#include "shading/dialect/lang.h"

FN float albedo_max_base(float c, float e_o, float e_i, float e_avg) { return max(1.0f - c * max(e_o, e_i), 0.0f); }
