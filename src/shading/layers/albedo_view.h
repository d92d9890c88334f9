/* albedo-view - a sheen that takes from the base what it reflects towards the viewer itself
 *
 *   f = sheen + (1 - max3(color) E(cos_o)) base
 *
 *   Alejandro Conty Estevez, Christopher Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH 2017
 * course, section on layering; Khronos Group, KHR_materials_sheen, 2020 (its view term).
 *   energy: E <= 1 where the sheen's own E is, exactly 1 over a lossless base when the sheen is white.
 *   reciprocal: no, the factor knows wo alone. */
#ifndef WEFT_LAYER_ALBEDO_VIEW_H
#define WEFT_LAYER_ALBEDO_VIEW_H

#include "shading/angles.h"

/* Where the sheen reflects more than it receives nothing is left for the base. */
FN float albedo_view_base(Rgb color, float e_o) {
    return max(1.0f - max(color.r, max(color.g, color.b)) * e_o, 0.0f);
}

#endif
