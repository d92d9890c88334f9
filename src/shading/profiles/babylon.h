/* babylon - Babylon.js PBRMaterial with albedoScaling: a soft bright rim, the base dimmed by a table
 *
 *   f      = c D V + keep (base_color (1 - F0) (1 - metallic) / pi + D_ggx V_ggx F (1 + f0 (1 / Ess - 1)))
 *   D      = charlie,  V = V_neubelt,  alpha = r^2 + 0.0005 of base and sheen
 *   F      = f0 (1 - s) + specular s,  f0 = mix(F0, base_color, metallic)
 *   keep   = 1 - max3(c) E(cos_o);  E, Ess: engine_tables.h
 *   glass  : of transmission t, 1 - t of the diffuse lobe stays, and t (1 - metallic) base_color (1 - F0) (1 - F) comes
 *            through the facets of the highlight (stack.h)
 *
 *   npm package @babylonjs/core 9.34.0, Shaders/ShadersInclude: pbrBlockSheen, pbrBRDFFunctions,
 * pbrDirectLightingFunctions, pbrBlockFinalLitComponents, pbrBlockReflectivity, pbrBlockSubSurface (9.35.0);
 * brdfTextureTools. Its defaults: legacy specular conservation, so that F0 and not F dims the diffuse lobe.
 * albedoScaling on and intensity 1, as the loader of glTF is said to set them (not read); off, the sheen is dimmed by
 * the reflectance of the base instead, which keeps all.
 *   IBL there differs: the sheen is the mirror image blurred for ggx, times c E.
 *   Inputs: F0 as in workflow metallic; clear coat and anisotropy are not looked at; lights have no radius.
 *   Departures: alpha of the sheen is at least 0.005; keep at least 0. The sheen dims what comes through glass, there
 * it does not; an ior below 1.5 blurs it no less.
 *   Substitute: E is within .0012 on average of the image that it ships, as measured when that was read. */
#pragma once

#include "shading/profiles/filament_sheen.h"

FN float babylon_alpha(float r) { return r * r + 0.0005f; }

FN void babylon_stack(Stack *m, const Surface *s) {
    float r = clamp(s->roughness, 0.0f, 1.0f), r_s = clamp(s->sheen_roughness, 0.0f, 1.0f);
    Lobe sheen = lobe_default(LOBE_CHARLIE_NEUBELT);
    sheen.params[CHARLIE_NEUBELT_ALPHA] = max(babylon_alpha(r_s), 0.005f);
    workflow_sheen(m, sheen, rgb_scale(s->sheen_color, s->sheen), s->sheen_second, LAYER_ALBEDO_VIEW);
    m->albedo = ALBEDO_BABYLON;
    m->albedo_coord = r_s;
    Rgb f0 = metallic_f0(s), mixed = rgb_mix(f0, s->base_color, s->metallic);
    float dielectric = 1.0f - s->metallic;
    Rgb below = rgb(max(1.0f - f0.r, 0.0f) * dielectric, max(1.0f - f0.g, 0.0f) * dielectric,
                    max(1.0f - f0.b, 0.0f) * dielectric);
    workflow_base(m, s, rgb_mul(s->base_color, below), mixed, s->specular);
    m->specular.lobe = lobe_default(LOBE_GGX);
    m->specular.lobe.params[GGX_ALPHA] = max(babylon_alpha(r), 0.001f);
    filament_compensate(m, mixed, VIEW_BABYLON, r);
    filament_glass(m, s, mixed, s->specular);
    m->glass_tint = rgb_mul(m->glass_tint, stack_one_minus(f0));
}
