/* order-1886 - the cloth of a game of 2013, as far as it is known: velvet's even glow and bright rim
 *
 *   f     = (1 - F) base_color / pi + D V F
 *   D     = ashikhmin,  V = V_neubelt,  alpha = sheen_roughness^2
 *   F     = c (1 - s) + s, at wi . h
 *
 *   David Neubelt, Matt Pettineo, "Crafting a Next-Gen Material Pipeline for The Order: 1886", SIGGRAPH
 * 2013 course. A reconstruction: its section on cloth was not to be had. D and V are credited to it by
 * Romain Guy, Mathias Agopian, "Physically Based Rendering in Filament", and by Krzysztof Narkowicz, "Cloth
 * Shading", 2018.
 *   Inferred: F in both places, f90 = 1, alpha = roughness^2, that there is no highlight beside it, and no
 * wrap of the light.
 *   Inputs: c is sheen_color sheen; black is none, with F = 0. metallic, ior, specular are not looked at.
 *   Departure: alpha is at least 0.005. */
#pragma once

#include "shading/lobes/cook_torrance.h"
#include "shading/stack/workflow.h"

FN void order_1886_stack(Stack *m, const Surface *s) {
    float r = clamp(s->sheen_roughness, 0.0f, 1.0f);
    Lobe sheen = lobe_default(LOBE_COOK_TORRANCE);
    sheen.params[COOK_TORRANCE_ALPHA] = max(r * r, 0.005f);
    sheen.params[COOK_TORRANCE_D] = to_float(D_ASHIKHMIN);
    sheen.params[COOK_TORRANCE_V] = to_float(V_NEUBELT);
    sheen.params[COOK_TORRANCE_F] = to_float(F_SCHLICK);
    Rgb color = rgb_scale(s->sheen_color, s->sheen);
    if (rgb_max3(color) > 0.0f) {
        workflow_sheen(m, sheen, color, rgb_grey(1.0f), LAYER_ADDITIVE);
        m->base_fresnel = BASE_FRESNEL_HALF;
        m->interface_f0 = color;
        m->interface_f90 = 1.0f;
    }
    slot_even(&m->diffuse, lobe_default(LOBE_LAMBERT), s->base_color, s->base_color, 1.0f);
}
