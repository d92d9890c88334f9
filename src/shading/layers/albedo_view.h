/* albedo-view - a sheen that takes from the base what it reflects towards the viewer itself
 *
 *   f = sheen + (1 - c E(wo)) base
 *
 *   Alejandro Conty Estevez, Christopher Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH 2017
 * course, section on layering; Khronos Group, KHR_materials_sheen, 2020 (its view term).
 *   energy: E <= 1 where the sheen's own E is, exactly 1 over a lossless base.
 *   reciprocal: no, the factor depends on wo only. */
#pragma once

#include "shading/dialect/lang.h"

/* Returns 1 - c E(wo). A sheen that reflects more than it receives leaves 0 for the base. */
FN float albedo_view_base(float c, float e_o, float e_i, float e_avg) { return max(1.0f - c * e_o, 0.0f); }
