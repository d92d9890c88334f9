/* albedo-min - a sheen that takes from the base the least it reflects, towards the viewer or towards the
 * light
 *
 *   f = sheen + (1 - c min(E(wo), E(wi))) base
 *
 *   The counterpart of albedo-max (Khronos Group, KHR_materials_sheen, 2020), and what that formula becomes
 * where the smaller E is taken for the smaller scaling.
 *   energy: no, over a lossless base it gains wherever E(wi) < E(wo).
 *   reciprocal: yes. */
#pragma once

#include "shading/dialect/lang.h"

FN float albedo_min_base(float c, float e_o, float e_i, float e_avg) { return max(1.0f - c * min(e_o, e_i), 0.0f); }
