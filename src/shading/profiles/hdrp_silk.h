/* hdrp-silk - Unity's silk: a stretched highlight over a diffuse colour, and no rim of fuzz
 *
 *   f     = base_color burley / (1.03571 pi) + D V F
 *   D V   = lobe silk: alpha (1 + anisotropy) along x, alpha (1 - anisotropy) along y,  alpha = roughness^2
 *   F     = f0 (1 - s) + s
 *
 *   Unity-Technologies/Graphics, com.unity.render-pipelines.high-definition,
 * Runtime/Material/Fabric/Fabric.hlsl (2a67652); BSDF.hlsl and CommonMaterial.hlsl of
 * com.unity.render-pipelines.core (05639b3). F takes nothing from the diffuse lobe.
 *   IBL there differs: a table of ggx, along a direction deflected by the anisotropy.
 *   Inputs: 1 - smoothness is roughness; its specular colour f0 is that of a dielectric as in workflow
 * metallic; sheen and metallic are not looked at.
 *   Departures: alpha is at least 0.001 and anisotropy at most 0.9, where y would narrow to its floor of
 * 1/1024. */
#pragma once

#include "shading/workflows/metallic.h"

FN void hdrp_silk_stack(Stack *m, const Surface *s) {
    float r = clamp(s->roughness, 0.0f, 1.0f);
    Lobe silk = lobe_rough(LOBE_SILK, r), diffuse = lobe_default(LOBE_BURLEY);
    silk.params[SILK_ANISOTROPY] = clamp(s->anisotropy, 0.0f, 0.9f);
    diffuse.params[BURLEY_ROUGHNESS] = r;
    Rgb f0 = metallic_f0(s), color = rgb_scale(s->base_color, 1.0f / 1.03571f);
    slot_make(&m->specular, silk, f0, rgb_grey(1.0f), 1.0f, rgb_mean(f0), 1.0f);
    slot_even(&m->diffuse, diffuse, color, color, 1.0f);
}
