/* disney - the principled BRDF: ten parameters and a base colour for anything that is no glass
 *
 *   f        = (1 - metallic) (base_color mix(burley, subsurface) + sheen) + D V F + coat
 *   sheen    = sheen mix(1, tint, sheen_tint) (1 - wi . h)^5
 *   f0       = mix(0.08 specular mix(1, tint, specular_tint), base_color, metallic)
 *   tint     = base_color / luminance,  D = ggx-aniso,  V = smith-ggx-aniso-separate
 *   alpha_x  = roughness^2 / aspect,  alpha_y = roughness^2 aspect,  aspect = sqrt(1 - 0.9 anisotropy)
 *   coat     = 0.25 clearcoat GTR1 V F,  alpha = mix(0.1, 0.001, clearcoat_gloss),  V at alpha 0.25,  F0 =
 * 0.04
 *
 *   Brent Burley, "Physically Based Shading at Disney", SIGGRAPH 2012 course "Practical Physically Based
 * Shading in Film and Game Production", section 5 and the addenda of its later revisions (V without the
 * remapped roughness, diffuse as published). Nothing dims the diffuse lobe but its own Fresnel factor, so
 * energy is not conserved. Light that goes through the diffuse lobe (diffuse_transmission) is glTF's, not his. */
#pragma once

#include "shading/lobes/burley_subsurface.h"
#include "shading/lobes/cook_torrance.h"
#include "shading/stack/workflow.h"

FN Rgb disney_tint(Rgb base) {
    float y = rgb_luminance(base);
    if (y > 0.0f) return rgb_scale(base, 1.0f / y);
    return rgb_grey(1.0f);
}

FN void disney_tinted(Stack *m, const Surface *s, Rgb tint) {
    float below = 1.0f - s->metallic;
    Rgb f0 = rgb_mix(rgb_scale(rgb_mix(rgb_grey(1.0f), tint, s->specular_tint), 0.08f * s->specular), s->base_color,
                     s->metallic);

    Rgb sheen = rgb_scale(rgb_mix(rgb_grey(1.0f), tint, s->sheen_tint), s->sheen * below);
    workflow_sheen(m, lobe_default(LOBE_BURLEY_SHEEN), sheen, sheen, LAYER_ADDITIVE);

    float aspect = sqrt(1.0f - 0.9f * s->anisotropy), alpha = s->roughness * s->roughness;
    Lobe specular = lobe_default(LOBE_COOK_TORRANCE);
    float ax = max(alpha / aspect, 0.001f), ay = max(alpha * aspect, 0.001f);
    specular.params[COOK_TORRANCE_ALPHA] = ay;
    specular.params[COOK_TORRANCE_STRETCH] = ax / ay;
    specular.params[COOK_TORRANCE_D] = to_float(D_GGX_ANISO);
    specular.params[COOK_TORRANCE_V] = to_float(V_SMITH_GGX_ANISO_SEPARATE);
    specular.params[COOK_TORRANCE_F] = to_float(F_SCHLICK);
    slot_make(&m->specular, specular, f0, rgb_grey(1.0f), 1.0f, rgb_mean(f0), 1.0f);

    Lobe diffuse = lobe_rough(LOBE_BURLEY_SUBSURFACE, s->roughness);
    diffuse.params[BURLEY_SUBSURFACE_SUBSURFACE] = s->subsurface;
    slot_even(&m->diffuse, diffuse, s->base_color, s->base_color, below);

    Lobe coat = lobe_default(LOBE_BURLEY_COAT);
    coat.params[BURLEY_COAT_ALPHA] = mix(0.1f, 0.001f, s->clearcoat_gloss);
    stack_coat_frame(m, s->clearcoat_normal);
    float amount = 0.25f * s->clearcoat;
    slot_make(&m->coat, coat, rgb_grey(0.04f), rgb_grey(1.0f), amount, 0.04f * amount, amount);
}

FN void disney_stack(Stack *m, const Surface *s) {
    disney_tinted(m, s, disney_tint(s->base_color));
    workflow_transmission(m, s, 1.0f - s->metallic);
}
