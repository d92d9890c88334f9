/* disney-2012 - the principled BRDF as its authors' viewer has it: workflow disney with two older terms
 *
 *   As workflows/disney.h, but V of the highlight is smith-ggx-aniso-separate, and tint is base_color over
 * 0.3 r + 0.6 g + 0.1 b.
 *
 *   wdas/brdf, src/brdfs/disney.brdf (0202adc). Its V does not widen the roughness to (0.5 + roughness /
 * 2)^2, which the course notes of 2012 do and their later addenda take back. Nothing dims the diffuse lobe;
 * the sheen has neither a roughness nor 1/pi.
 *   Inputs: sheen_color is not looked at: sheen, of which weft's default is 1 and theirs 0, and sheen_tint
 * say all. Colours are linear, not gamma 2.2. The coat may have a normal of its own. */
#ifndef WEFT_PROFILE_DISNEY_2012_H
#define WEFT_PROFILE_DISNEY_2012_H

#include "shading/workflows/disney.h"

FN Rgb disney_2012_tint(Rgb base) {
    float y = 0.3f * base.r + 0.6f * base.g + 0.1f * base.b;
    return y > 0.0f ? rgb_scale(base, 1.0f / y) : rgb_grey(1.0f);
}

FN Stack disney_2012_stack(Surface s, Dir o) {
    Stack m = disney_stack(s, o);
    float below = 1.0f - s.metallic, s_o = schlick_s(o.z);
    Rgb tint = disney_2012_tint(s.base_color);
    Rgb sheen = rgb_scale(rgb_mix(rgb_grey(1.0f), tint, s.sheen_tint), s.sheen * below);
    Rgb f0 = rgb_mix(rgb_scale(rgb_mix(rgb_grey(1.0f), tint, s.specular_tint), 0.08f * s.specular),
                     s.base_color, s.metallic);
    m = workflow_sheen(m, lobe_default(LOBE_BURLEY_SHEEN), sheen, sheen, LAYER_ADDITIVE);
    Lobe specular = m.specular.lobe;
    float aspect = sqrt(1.0f - 0.9f * s.anisotropy), alpha = s.roughness * s.roughness;
    float ax = max(alpha / aspect, 0.001f), ay = max(alpha * aspect, 0.001f);
    specular.params[0] = ay;
    specular.params[COOK_TORRANCE_STRETCH] = ax / ay;
    specular.params[COOK_TORRANCE_V] = to_float(V_SMITH_GGX_ANISO_SEPARATE);
    m.specular = slot_make(specular, f0, rgb_grey(1.0f), 1.0f, mix(rgb_mean(f0), 1.0f, s_o));
    return m;
}

#endif
