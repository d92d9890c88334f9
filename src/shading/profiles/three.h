/* three - three.js MeshPhysicalMaterial: a soft rim, cut off at its brightest, that the base hardly notices
 *
 *   f      = coat + (1 - coat_F(cos_o)) (c D V + keep base),  c = sheen_color sheen
 *   base   = (1 - metallic) (1 - F) base_color / pi + D_ggx V_ggx F_mixed (1 + F0 (1 / Ess - 1))
 *   F      = f0 (1 - s) + f90 s,  s = 2^((-5.55473 d - 6.98316) d),  d = wi . h
 *   D      = charlie with sin_h^2 >= 1/128,  V = min(V_neubelt, 1),  alpha = sheen_roughness^2
 *   keep   = 1 - max3(c) max(E(cos_o), E(cos_i)),  E by three_albedo
 *   alpha  = max(roughness, 0.045)^2, of base and coat
 *   Ess    = E of white ggx towards wo, from a table of 16 x 16
 *   glass  : of transmission t, 1 - t of the diffuse lobe stays, and t (1 - metallic) base_color (1 - F) comes
 *            through the facets of the highlight (stack.h)
 *
 *   npm package three 0.187.0, src/renderers/shaders/ShaderChunk: lights_physical_pars_fragment,
 * lights_physical_fragment, lights_fragment_begin, common, transmission_fragment, transmission_pars_fragment;
 * ShaderLib/meshphysical; repository mrdoob/three.js. Earlier releases dim the base by 0.157 max3(c) or have another
 * E, and leave the diffuse lobe whole.
 *   E is far from the sheen's own at low roughness, so grazing light is returned more than once over: at
 * roughness 0.1 and cos_o 0.02 the lobe has E 1.54, the formula gives .27.
 *   IBL there differs: the sheen is diffuse irradiance times c E(cos_o), keep looks at cos_o alone, the
 * base has Fdez-Aguera's scattering; lights of an area have no sheen. Glass shows a blurred picture of what is opaque
 * behind it, times 1 - E of the highlight, which is what the facets here let through of an even light.
 *   Departures: nothing is added to roughness where the normal changes from pixel to pixel; alpha of the
 * sheen is at least 0.005 (there 1e-8). The sheen dims what comes through glass, there it does not; F of a base between
 * glass and metal is that of glass for this light, there the mean of both; an ior below 1.5 blurs it no less.
 *   Substitute: Ess is made anew by the procedure that the table states. The shipped texels at cos_o
 * 1/32 are up to .015 less, all others within .009 (ten of them in tests/shading/test_profiles). F0 without
 * an ior is weft's. */
#pragma once

#include "shading/profiles/filament_sheen.h"

#define THREE_ROUGHNESS_LEAST 0.045f

FN float three_albedo(float cosine, float r) {
    float inverse = 1.0f / (r + 0.1f);
    float a = -1.9362f + 1.0678f * r + 0.4573f * r * r - 0.8469f * inverse;
    float b = -0.6014f + 0.5538f * r - 0.4670f * r * r - 0.1255f * inverse;
    return clamp(exp(a * cosine + b), 0.0f, 1.0f);
}

FN Lobe three_ggx(float roughness, float anisotropy) {
    float r = clamp(roughness, THREE_ROUGHNESS_LEAST, 1.0f), alpha = r * r;
    Lobe lobe = lobe_default(LOBE_COOK_TORRANCE);
    lobe.params[COOK_TORRANCE_ALPHA] = alpha;
    lobe.params[COOK_TORRANCE_D] = to_float(D_GGX_ANISO);
    lobe.params[COOK_TORRANCE_V] = to_float(V_SMITH_GGX_ANISO);
    lobe.params[COOK_TORRANCE_F] = to_float(F_SCHLICK_GAUSSIAN);
    lobe.params[COOK_TORRANCE_STRETCH] = ggx_aniso_ax(alpha, anisotropy) / alpha;
    return lobe;
}

FN void three_coat(Stack *m, const Surface *s) {
    if (s->clearcoat <= 0.0f) return;
    stack_coat_frame(m, s->clearcoat_normal);
    m->coat_rule = COAT_GAUSSIAN;
    m->coat_weight = s->clearcoat;
    slot_make(&m->coat, three_ggx(s->clearcoat_roughness, 0.0f), rgb_grey(0.04f), rgb_grey(1.0f), s->clearcoat, 1.0f,
              1.0f);
}

FN Lobe three_charlie(float alpha) {
    Lobe lobe = lobe_default(LOBE_COOK_TORRANCE);
    lobe.params[COOK_TORRANCE_ALPHA] = max(alpha, 0.005f);
    lobe.params[COOK_TORRANCE_D] = to_float(D_CHARLIE_FLOORED);
    lobe.params[COOK_TORRANCE_V] = to_float(V_NEUBELT_CLAMPED);
    lobe.params[COOK_TORRANCE_F] = to_float(F_NONE);
    return lobe;
}

FN void three_stack(Stack *m, const Surface *s) {
    three_coat(m, s);
    float r = clamp(s->roughness, THREE_ROUGHNESS_LEAST, 1.0f), r_s = clamp(s->sheen_roughness, 1e-4f, 1.0f);
    Lobe sheen = three_charlie(r_s * r_s);
    workflow_sheen(m, sheen, rgb_scale(s->sheen_color, s->sheen), s->sheen_second, LAYER_ALBEDO_MAX);
    m->sheen.f0 = rgb_scale(m->sheen.f0, charlie_floored_gain(sheen.params[COOK_TORRANCE_ALPHA]));
    m->sheen.f90 = m->sheen.f0;
    m->albedo = ALBEDO_THREE;
    m->albedo_coord = r_s;

    Rgb f0 = metallic_f0(s), mixed = rgb_mix(f0, s->base_color, s->metallic);
    float f90 = mix(s->specular, 1.0f, s->metallic);
    m->base_fresnel = BASE_FRESNEL_GAUSSIAN;
    m->interface_f0 = f0;
    m->interface_f90 = f90;
    workflow_base(m, s, rgb_scale(s->base_color, 1.0f - s->metallic), mixed, f90);
    m->specular.lobe = three_ggx(s->roughness, s->anisotropy);
    filament_compensate(m, mixed, VIEW_THREE, r);
    workflow_glass(m, s, 1.0f - s->metallic);
}
