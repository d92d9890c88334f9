/* unreal4 - Unreal's cloth: a highlight that gives way to a haze of fuzz, on a diffuse colour left whole
 *
 *   f     = base_color (1 - metallic) / pi
 *           + mix(D_ggx V_fast F(F0), D_inverse_ggx V_neubelt F(fuzz), cloth)
 *   F(f0) = f0 (1 - s) + min(50 f0.g, 1) s,  s = (1 - wi . h)^5;  alpha = max(roughness, 0.02)^2 in all
 *
 *   Epic Games, Unreal Engine 4.27, ShadingModels.ush (ClothBxDF) and BRDF.ush (D_InvGGX, Vis_Cloth,
 * Vis_SmithJointApprox, F_Schlick); in words and formulas of our own, since the text is not free.
 *   IBL there differs: cloth fuzz joins the diffuse colour, flat; there is no rim. Lights of an area have
 * none either.
 *   Inputs: fuzz is sheen_color and cloth is sheen, 0 where the colour is black; F0 as in workflow
 * metallic, for mix(0.08 specular, base_color, metallic). One roughness serves both: sheen_roughness is not
 * looked at.
 *   Inferred: F0, the diffuse colour and the least roughness.
 *   Departures: alpha is at least 0.001 of ggx and 0.005 of the fuzz; fuzz is not rounded to 8 bits; cos_o
 * has no 1e-5 added. */
#pragma once

#include "shading/lobes/cook_torrance.h"
#include "shading/workflows/metallic.h"

FN Lobe unreal4_lobe(float alpha, int d, int v) {
    Lobe lobe = lobe_default(LOBE_COOK_TORRANCE);
    lobe.params[COOK_TORRANCE_ALPHA] = alpha;
    lobe.params[COOK_TORRANCE_D] = to_float(d);
    lobe.params[COOK_TORRANCE_V] = to_float(v);
    lobe.params[COOK_TORRANCE_F] = to_float(F_SCHLICK_F90);
    return lobe;
}

FN float unreal4_f90(Rgb f0) { return clamp(50.0f * f0.g, 0.0f, 1.0f); }

FN void unreal4_stack(Stack *m, const Surface *s) {
    float r = clamp(s->roughness, 0.02f, 1.0f), alpha = r * r;
    float cloth = rgb_max3(s->sheen_color) > 0.0f ? clamp(s->sheen, 0.0f, 1.0f) : 0.0f;
    Rgb f0 = rgb_mix(metallic_f0(s), s->base_color, s->metallic), fuzz = s->sheen_color;
    Rgb diffuse = rgb_scale(s->base_color, 1.0f - s->metallic);
    Lobe haze = unreal4_lobe(max(alpha, 0.005f), D_INVERSE_GGX, V_NEUBELT);
    m->color = rgb_scale(fuzz, cloth);
    m->sheen_color = m->color;
    m->albedo_coord = haze.params[COOK_TORRANCE_ALPHA];
    slot_even(&m->sheen, haze, fuzz, rgb_grey(unreal4_f90(fuzz)), cloth);
    slot_make(&m->specular, unreal4_lobe(max(alpha, 0.001f), D_GGX, V_SMITH_GGX_FAST), f0, rgb_grey(unreal4_f90(f0)),
              1.0f - cloth, (1.0f - cloth) * rgb_mean(f0), (1.0f - cloth) * unreal4_f90(f0));
    slot_even(&m->diffuse, lobe_default(LOBE_LAMBERT), diffuse, diffuse, 1.0f);
}
