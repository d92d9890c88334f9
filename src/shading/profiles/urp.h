/* urp - Unity on phones with a fabric that users added: a highlight that gives way to a rim
 *
 *   f     = 0.96 (1 - metallic) base_color mix(1, 0.62 (1 - cos_o^2 / 4), alpha) / pi
 *           + mix(f0 D_ggx V_urp, c D_charlie V_neubelt, amount),  f0 = mix(0.04, base_color, metallic)
 *   alpha = max(roughness^2, 1/128) in all
 *
 *   The Universal Render Pipeline has no cloth. This is AkiKurisu/IllusionRP,
 * Shaders/Fabric/Lighting.hlsl (245c961) and ShaderLibrary/BRDF.hlsl (17f8e86), its isotropic form, over
 * that pipeline's own highlight. It leaves pi out everywhere, as that pipeline does; here everything is
 * divided by it.
 *   IBL there differs: the colour of the rim does not enter at all.
 *   Inputs: c is sheen_color and amount is sheen, 0 where the colour is black. One roughness serves both.
 * ior, specular and sheen_roughness are not looked at.
 *   Departures: nothing is cut off at 100 / pi, which is done for half floats only; there is no light from
 * behind. */
#pragma once

#include "shading/lobes/cook_torrance.h"
#include "shading/stack/workflow.h"

FN void urp_stack(Stack *m, const Surface *s) {
    float r = clamp(s->roughness, 0.0f, 1.0f), alpha = max(r * r, 0.0078125f);
    float amount = rgb_max3(s->sheen_color) > 0.0f ? clamp(s->sheen, 0.0f, 1.0f) : 0.0f;
    Lobe sheen = lobe_default(LOBE_CHARLIE_NEUBELT), specular = lobe_default(LOBE_COOK_TORRANCE);
    sheen.params[CHARLIE_NEUBELT_ALPHA] = alpha;
    workflow_sheen(m, sheen, rgb_scale(s->sheen_color, amount), s->sheen_second, LAYER_ADDITIVE);
    specular.params[COOK_TORRANCE_ALPHA] = alpha;
    specular.params[COOK_TORRANCE_D] = to_float(D_GGX);
    specular.params[COOK_TORRANCE_V] = to_float(V_URP);
    specular.params[COOK_TORRANCE_F] = to_float(F_NONE);
    Rgb f0 = rgb_mix(rgb_grey(0.04f), s->base_color, s->metallic);
    slot_even(&m->specular, specular, f0, f0, 1.0f - amount);
    slot_even(&m->diffuse, lobe_default(LOBE_LAMBERT), s->base_color, s->base_color, 0.96f * (1.0f - s->metallic));
    m->view = VIEW_URP;
    m->gloss = alpha;
}

FN void urp_view(const Stack *m, StackView *w) {
    w->scale.diffuse = mix(1.0f, 0.62f * (1.0f - 0.25f * w->o.z * w->o.z), m->gloss);
    w->select_p.diffuse = w->scale.diffuse;
}
