/* babylon-openpbr - Babylon.js' OpenPBR material: fuzz without a norm, over a base dimmed by the half vector
 *
 *   f      = w c f_fuzz + (1 - w R(n . h)) (coat + (1 - coat_F) (dielectric or metal))
 *   f_fuzz = R v_z / |v|, all read at n . h: lobe ltc-fibre-half,  alpha = sqrt(fuzz_roughness)
 *   dielectric = (1 - F) eon(base_color) + D_ggx V_ggx specular_color F,  F = F0 (1 - s) + s
 *   metal  = specular D_ggx V_ggx (base_color (1 - s) + s),  s = (1 - wi . h)^5,  alpha = roughness^2
 *
 *   BabylonJS/Babylon.js, packages/dev/core/src/Shaders/ShadersInclude: openpbrDirectLighting, evalFuzz of
 * pbrDirectLightingFunctions, getFuzzBRDFLookup of pbrBRDFFunctions (pull request 17308, 2025). docs/fuzz.md compares it
 * with what the table means.
 *   IBL there differs: the mix weight is w sqrt(R(n . v)), which is 0.5 where R is 0.25, so that fuzz is too bright and the
 * base too dark, unlike under direct light.
 *   Inputs: fuzz; without it w is min(sheen, 1), c sheen_color and fuzz_roughness sheen_roughness. base_diffuse_roughness
 * is diffuse_roughness, specular_weight min(specular, 1).
 *   Departures: F is that at wi . h, there at n . h; the coat is that of profile openpbr; E of fuzz is its R, not the
 * integral; alpha is at least 0.05 of fuzz and 0.001 of the base. */
#pragma once

#include "shading/lobes/ltc_fibre_half.h"
#include "shading/profiles/openpbr.h"

/* Returns R of the published table at a cosine. */
FN float babylon_openpbr_albedo(float cosine, float alpha) {
    return min(ltc_table_published(lobe_table_ltc_fibre_published(), cosine, alpha).f0, 1.0f);
}

FN void babylon_openpbr_stack(Stack *m, const Surface *s) {
    openpbr_with(m, s, lobe_default(LOBE_LTC_FIBRE_HALF), BASE_FRESNEL_HALF);
    float roughness = m->has_fuzz ? s->fuzz_roughness : s->sheen_roughness;
    float alpha = clamp(sqrt(max(roughness, 0.0f)), 0.05f, 1.0f);
    m->sheen.lobe.params[LTC_FIBRE_HALF_ALPHA] = alpha;
    m->albedo = ALBEDO_BABYLON_FUZZ;
    m->albedo_coord = alpha;
    m->layer = LAYER_ALBEDO_HALF;
}
