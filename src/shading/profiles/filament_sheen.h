/* filament-sheen - Filament's lit material with a sheen: a soft rim, the base dimmed by a table
 *
 *   f      = c D V + keep (base_color (1 - metallic) / pi + D_ggx V_ggx F (1 + f0 (1 / Ess - 1)))
 *   D      = charlie with sin_h^2 >= 1/128,  V = V_neubelt,  alpha = max(sheen_roughness, 0.045)^2
 *   F      = f0 (1 - s) + f90 s,  f90 = min(16.5 (f0.r + f0.g + f0.b), 1),  alpha = max(roughness, 0.045)^2
 *   keep   = 1 - max3(c) E(cos_o);  E, Ess: engine_tables.h
 *   glass  : of transmission t, 1 - t of the diffuse lobe stays, and t (1 - metallic) base_color (1 - F), F with
 *            f90 = 1, comes through the facets of the highlight (stack.h)
 *
 *   google/filament, shaders/src/surface_shading_model_standard.fs (1b47d18), surface_brdf.fs (04d50d4),
 * common_material.fs; surface_light_indirect.fs (1de6d8a) for glass; libs/ibl/src/CubemapIBL.cpp (13d3ade) for the
 * tables. As on desktop: on phones roughness starts at 0.089 and V_ggx is smith-ggx-fast. F takes nothing from the
 * diffuse lobe.
 *   IBL there differs: the diffuse lobe keeps 1 - E of the specular one; the sheen is a mirror image
 * blurred for ggx, times E.
 *   Inputs: f0 as in workflow metallic; clear coat, anisotropy and specular's share in f90 are not looked
 * at.
 *   Departures: D_ggx is not cut off at 65464, which it reaches below roughness 0.047; alpha of the sheen
 * is at least 0.005; keep at least 0, where the table's E passes 1 (there it makes the base negative). Glass of
 * thickness 0 has one surface, there two, which leave (1 - E) / (1 + E) where one leaves 1 - E; the sheen dims what
 * comes through glass, there it does not; an ior below 1.5 blurs it no less. That the shift of the table's rows
 * reaches the sampler is inferred; Babylon.js's image shows the same. */
#pragma once

#include "shading/catalogue/engine_tables.h"
#include "shading/lobes/cook_torrance.h"
#include "shading/workflows/metallic.h"

FN float filament_roughness(float r) { return clamp(r, 0.045f, 1.0f); }

FN Lobe filament_charlie(float r) {
    Lobe lobe = lobe_default(LOBE_COOK_TORRANCE);
    lobe.params[COOK_TORRANCE_ALPHA] = max(r * r, 0.005f);
    lobe.params[COOK_TORRANCE_D] = to_float(D_CHARLIE_FLOORED);
    lobe.params[COOK_TORRANCE_V] = to_float(V_NEUBELT);
    lobe.params[COOK_TORRANCE_F] = to_float(F_NONE);
    return lobe;
}

/* Sets the sheen slot in a colour, multiplied by the gain by which d_charlie_floored is divided. */
FN void filament_fuzz(Stack *m, float r, Rgb color, int layer) {
    Lobe lobe = filament_charlie(r);
    workflow_sheen(m, lobe, color, color, layer);
    m->sheen.f0 = rgb_scale(m->sheen.f0, charlie_floored_gain(lobe.params[COOK_TORRANCE_ALPHA]));
    m->sheen.f90 = m->sheen.f0;
}

/* Adds the highlight times f0 (1 / Ess - 1) to itself: Ess towards wo, by the roughness. */
FN void filament_compensate(Stack *m, Rgb f0, int view, float roughness) {
    m->view = view;
    m->gloss = roughness;
    m->extra_f0 = rgb_mul(m->specular.f0, f0);
    m->extra_f90 = rgb_mul(m->specular.f90, f0);
}
FN void filament_view(TableRef ess, const Stack *m, StackView *w) {
    w->extra = 1.0f / max(table_albedo(ess, w->o.z, m->gloss), 1e-3f) - 1.0f;
}

/* Lets light through as glass does, less F of the highlight, which takes nothing from the diffuse lobe. */
FN void filament_glass(Stack *m, const Surface *s, Rgb f0, float f90) {
    m->interface_f0 = f0;
    m->interface_f90 = f90;
    workflow_glass(m, s, 1.0f - s->metallic);
}

FN void filament_sheen_stack(Stack *m, const Surface *s) {
    float r = filament_roughness(s->roughness), r_s = filament_roughness(s->sheen_roughness);
    filament_fuzz(m, r_s, rgb_scale(s->sheen_color, s->sheen), LAYER_ALBEDO_VIEW);
    m->albedo = ALBEDO_FILAMENT;
    m->albedo_coord = r_s;
    Rgb f0 = rgb_mix(metallic_f0(s), s->base_color, s->metallic);
    float f90 = min(16.5f * (f0.r + f0.g + f0.b), 1.0f);
    workflow_base(m, s, rgb_scale(s->base_color, 1.0f - s->metallic), f0, f90);
    m->specular.lobe = lobe_rough(LOBE_GGX, r);
    filament_compensate(m, f0, VIEW_FILAMENT, r);
    filament_glass(m, s, f0, 1.0f);
}
