/* babylon-openpbr - Babylon.js' OpenPBR material: fuzz without a norm, over a base dimmed by the half vector
 *
 *   f      = w c f_fuzz + (1 - w R(n . h)) (coat + (1 - coat_F) (dielectric or metal))
 *   f_fuzz = R v_z / |v|, all read at n . h: lobe ltc-fibre-half,  alpha = sqrt(fuzz_roughness)
 *   dielectric = (1 - F) eon(base_color) + D_ggx V_ggx specular_color F,  F = F0 (1 - s) + s
 *   glass  : as in profile openpbr
 *   metal  = specular D_ggx V_ggx (base_color (1 - s) + s),  s = (1 - wi . h)^5,  alpha = roughness^2
 *
 *   BabylonJS/Babylon.js, packages/dev/core/src/Shaders/ShadersInclude: openpbrDirectLighting,
 * openpbrEnvironmentLighting, evalFuzz of pbrDirectLightingFunctions, getFuzzBRDFLookup of pbrBRDFFunctions (9.35.0,
 * 2026). docs/fuzz.md compares it with what the table means, and says how its own pictures were compared with this.
 *   IBL there differs: the weight of the mix is min(2 w R(n . v), 1), and the light of the fuzz is the mean of the map,
 * filtered at fuzz_roughness^2, in directions across the fibres (weft plot ambient has it).
 *   Inputs: fuzz; without it w is min(sheen, 1), c sheen_color and fuzz_roughness sheen_roughness. base_diffuse_roughness
 * is diffuse_roughness, specular_weight min(specular, 1).
 *   Departures: the coat is that of profile openpbr; E of fuzz is its R, not the integral; alpha is at least 0.05 of fuzz
 * and 0.001 of the base. Lamps and sky light glass from behind alike; there lamps do so by a formula of their own, and
 * of thin walls the colour deepens towards the edge. */
#pragma once

#include "shading/profiles/openpbr.h"

FN void babylon_openpbr_stack(Stack *m, const Surface *s) {
    openpbr_with(m, s, lobe_default(LOBE_LTC_FIBRE_HALF), BASE_FRESNEL_HALF);
    float roughness = m->has_fuzz ? s->fuzz_roughness : s->sheen_roughness;
    float alpha = clamp(sqrt(max(roughness, 0.0f)), 0.05f, 1.0f);
    m->sheen.lobe.params[0] = alpha;
    m->albedo = ALBEDO_BABYLON_FUZZ;
    m->albedo_coord = alpha;
    m->layer = LAYER_ALBEDO_HALF;
}
