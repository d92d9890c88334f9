/* khr-fuzz - glTF's coming fuzz as it is written: the table that its authors published, over the coat
 *
 *   f      = w c f_fuzz + (1 - w R(cos_o)) (coat + (1 - coat_F) base)
 *   f_fuzz = R(cos_o) D / cos_i,  alpha = fuzz_roughness;  R, D: lobe ltc-fibre-published
 *   base   = as in profile khronos, with diffuse_roughness, retroreflection and the coat's colour and darkening
 *
 *   Khronos Group, KHR_materials_fuzz, KHR_materials_coat, KHR_materials_diffuse_roughness, 2025,
 * KHR_materials_retroreflection, 2026: pull requests 2538, 2534, 2481 and 2610 of KhronosGroup/glTF, not ratified.
 *   IBL there: R c times the irradiance, or the transformed cosine itself.
 *   Inputs: fuzz; without it w is min(sheen, 1), c sheen_color and alpha sheen_roughness, so that cloths for other
 * engines can be compared.
 *   Departures: fuzz has the normal of the base, where the text mixes it with that of the coat; coat colour and
 * darkening act by the amount of the coat, which the text leaves open; alpha is at least 0.05; R and D are made anew
 * (lobe ltc-fibre-published). */
#pragma once

#include "shading/workflows/metallic.h"

FN void khr_fuzz_with(Stack *m, const Surface *s, Lobe fuzz) {
    metallic_with(m, s, fuzz, LAYER_ALBEDO_VIEW, BASE_FRESNEL_HALF);
    workflow_fuzz(m, s, fuzz);
    workflow_coming(m, s);
}
FN void khr_fuzz_stack(Stack *m, const Surface *s) { khr_fuzz_with(m, s, lobe_default(LOBE_LTC_FIBRE_PUBLISHED)); }
