/* materialx - MaterialX's graph of glTF's material: a soft rim, and a base that may vanish under it
 *
 *   f      = c D V + keep mix(under base_color / pi + D_ggx V_ggx F (1 + k F), metal, metallic)
 *   metal  = D_ggx V_ggx F (1 + k F) with F0 = base_color, F90 = 1
 *   D      = charlie,  V = V_neubelt,  alpha = max(rho, 0.005),  rho = sheen_roughness^2
 *   keep   = 1 - max3(c) E(cos_o, rho),  E by materialx_albedo
 *   F      = F0 (1 - s) + F90 s, at wi . h;  k = (1 - A - B) / (A + B)
 *   under  = 1 - mean((1 + k F) (A F0 + B F90))
 *   A, B   = white ggx towards wo, parts of F0 and of F90, by a quotient of polynomials
 *
 *   AcademySoftwareFoundation/MaterialX, libraries/pbrlib/genglsl: lib/mx_microfacet_sheen.glsl
 * (69579a2), mx_sheen_bsdf.glsl (2293df8), lib/mx_microfacet_specular.glsl (ed72433),
 * mx_generalized_schlick_bsdf.glsl (915650a); libraries/bxdf/gltf_pbr.mtlx (863a6bb). The sheen's mode
 * conty_kulla and the analytic albedo are its defaults; other generators integrate or look up.
 * standard_surface does not square the roughness and puts the sheen below the highlight.
 *   F enters squared, so f is a + b s + c s^2: SlotColors.f_quadratic has the last.
 *   IBL there: diffuse irradiance times c E, the rest alike.
 *   Inputs: F0 as in workflow metallic, F90 = specular; clear coat, anisotropy and transmission are not looked at.
 *   Departures: alpha of ggx is at least 0.001; A + B at least 1e-3. */
#pragma once

#include "shading/workflows/metallic.h"

FN float materialx_albedo(float x, float y) {
    float n = 13.67300f - 68.78018f * x + 799.08825f * y - 905.00061f * x * y + 60.28956f * x * x + 1086.96473f * y * y;
    float d = 1.0f + 61.57746f * x + 442.78211f * y + 2597.49308f * x * y + 121.81241f * x * x + 3045.55075f * y * y;
    return clamp(n / d, 0.0f, 1.0f);
}

/* Returns one of the four polynomials of A and B from the coefficients of 1, x, y, xy, x^2, y^2, x^2 y, x y^2, x^2
 * y^2. */
FN float materialx_sum(float x, float y, float c, float cx, float cy, float cxy, float cxx, float cyy, float cxxy,
                       float cxyy, float cxxyy) {
    return c + cx * x + cy * y + cxy * x * y + cxx * x * x + cyy * y * y + cxxy * x * x * y + cxyy * x * y * y +
           cxxyy * x * x * y * y;
}
FN float materialx_a(float x, float y) {
    float n = materialx_sum(x, y, 0.1003f, -0.6303f, 9.748f, -2.038f, 29.34f, -8.245f, -26.44f, 19.99f, -5.448f);
    float d = materialx_sum(x, y, 1.0f, -1.765f, 8.263f, 11.53f, 28.96f, -7.507f, -36.11f, 15.86f, 33.37f);
    return clamp(n / d, 0.0f, 1.0f);
}
FN float materialx_b(float x, float y) {
    float n = materialx_sum(x, y, 0.9345f, -2.323f, 2.229f, -3.748f, 1.424f, -0.7684f, 1.436f, 0.2913f, 0.6286f);
    float d = materialx_sum(x, y, 1.0f, 0.2281f, 15.94f, -55.83f, 13.08f, 41.26f, 54.9f, 300.2f, -285.1f);
    return clamp(n / d, 0.0f, 1.0f);
}

FN Rgb materialx_square(Rgb f0, float f90) {
    Rgb d = rgb(f90 - f0.r, f90 - f0.g, f90 - f0.b);
    return rgb_mul(d, d);
}

FN void materialx_stack(Stack *m, const Surface *s) {
    float rho = s->sheen_roughness * s->sheen_roughness;
    Lobe sheen = lobe_default(LOBE_CHARLIE_NEUBELT);
    sheen.params[CHARLIE_NEUBELT_ALPHA] = clamp(rho, 0.005f, 4.0f);
    workflow_sheen(m, sheen, rgb_scale(s->sheen_color, s->sheen), s->sheen_second, LAYER_ALBEDO_VIEW);
    m->albedo = ALBEDO_MATERIALX;
    m->albedo_coord = rho;

    float alpha = clamp(s->roughness * s->roughness, 0.001f, 1.0f), f90 = s->specular;
    Rgb f0 = metallic_f0(s);
    workflow_base(m, s, rgb_scale(s->base_color, 1.0f - s->metallic), f0, max(f90, s->metallic));
    m->specular.lobe = lobe_default(LOBE_GGX);
    m->specular.lobe.params[GGX_ALPHA] = alpha;
    m->specular.f0 = rgb_mix(f0, s->base_color, s->metallic);
    m->specular.f90 = rgb_grey(mix(f90, 1.0f, s->metallic));
    m->base_fresnel = BASE_FRESNEL_HALF;
    m->interface_f0 = f0;
    m->interface_f90 = f90;
    m->view = VIEW_MATERIALX;
    m->gloss = alpha;
    m->extra_f0 = rgb_mix(rgb_mul(f0, f0), rgb_mul(s->base_color, s->base_color), s->metallic);
    m->extra_f90 = rgb_grey(mix(f90 * f90, 1.0f, s->metallic));
    m->extra_f_quadratic = rgb_mix(materialx_square(f0, f90), materialx_square(s->base_color, 1.0f), s->metallic);
}

/* Sets F (1 + k F) of the highlight, and the E of it that dims the diffuse lobe. */
FN void materialx_view(const Stack *m, StackView *w) {
    float a = materialx_a(w->o.z, m->gloss), b = materialx_b(w->o.z, m->gloss), f90 = m->interface_f90;
    float k = 1.0f / max(a + b, 1e-3f) - 1.0f;
    Rgb e = rgb_add(rgb_scale(m->interface_f0, a), rgb_grey(b * f90));
    w->extra = k;
    w->interface_f0 = rgb_grey(rgb_mean(e) + k * rgb_mean(rgb_mul(e, m->interface_f0)));
    w->interface_f90 = rgb_mean(e) * (1.0f + k * f90);
    w->select_p.diffuse = 1.0f - mix(rgb_max3(w->interface_f0), w->interface_f90, schlick_s(w->o.z));
}
