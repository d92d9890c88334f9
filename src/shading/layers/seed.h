/* seed - a number k blends from diffuse to sheen, below the highlight's interface
 *
 *   f = (1 - F) (1 - k) diffuse + specular + (1 - F) k sheen
 *   F = f0 (1 - s) + f90 s,  s = (1 - wi . h)^5,  each channel
 *
 *   The blend that weft began with: the (1 - F) of a dielectric's diffuse lobe, on the sheen too; no paper
 * with it was found. F as in the glTF 2.0 Specification, Khronos Group, 2021, Appendix B; f0 and f90 are
 * those of the highlight, a metal's too. k is the material's `sheen`, at most 1; `sheen` of the formula is
 * the lobe in the colour sheen_color. This function returns 1 - k; stack_value.h does the rest. A sheen that is black
 * counts as none: the base stays as its workflow has it.
 *   energy: no. F at wi . h is not F at grazing cos_o or cos_i. There diffuse and specular lobe of a white dielectric
 * together reflect the more the smoother it is, up to 2 - f0 times what they receive: 1.84 times at roughness 0.05 and
 * 89.3 degrees, 1.88 at roughness 0 (weft plot albedo metallic:layer=seed,base_color=1,sheen_color=1,sheen=1e-4,
 * roughness=0.05 --csv). A sheen whose own E is above 1 adds to that. At k = 1 nothing of the diffuse lobe is left,
 * however little the sheen reflects. The safer form is side-by-side.
 *   reciprocal: yes. */
#pragma once

#include "shading/dialect/lang.h"

FN float seed_base(float c, float e_o, float e_i, float e_avg) { return max(1.0f - c, 0.0f); }
