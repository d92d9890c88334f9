/* core - an engine without extensions: base colour, metalness and roughness, no rim at all
 *
 *   f  = (1 - F) (1 - metallic) base_color / pi + D_ggx V_ggx F_mixed,  F each channel, at wi . h
 *   F0 = 0.04,  alpha = roughness^2
 *
 *   Khronos Group, "glTF 2.0 Specification", 2021, Appendix B, without any extension: what bevy, Godot and viewers of
 * USDZ show of a cloth whose sheen they do not read.
 *   IBL there differs from engine to engine.
 *   Inputs: sheen, fuzz, coat, anisotropy, ior and the specular inputs are not looked at.
 *   Departures: alpha is at least 0.001. */
#pragma once

#include "shading/stack/workflow.h"

FN void core_stack(Stack *m, const Surface *s) {
    m->base_fresnel = BASE_FRESNEL_HALF;
    m->interface_f0 = rgb_grey(0.04f);
    m->interface_f90 = 1.0f;
    workflow_base(m, s, rgb_scale(s->base_color, 1.0f - s->metallic),
                  rgb_mix(rgb_grey(0.04f), s->base_color, s->metallic), 1.0f);
    m->specular.lobe = lobe_rough(LOBE_GGX, s->roughness);
}
