/* metallic - the workflow of most assets: base colour, metalness, roughness
 *
 *   f      = coat + (1 - coat_F) (sheen + keep base)
 *   base   = (1 - max3 F_min) (1 - metallic) base_color / pi + D V F
 *   F      = f0 (1 - s) + f90 s,  s = (1 - wi . h)^5
 *   f0     = mix(min(F0 specular_color, 1) specular, base_color, metallic)
 *   coat_F = clearcoat (0.04 + 0.96 (1 - cos_o)^5)
 *   keep   = what the layer rule leaves for the base under the sheen
 *   A material that has fuzz has lobe ltc-fibre in place of the sheen, over the coat. A coat may have an ior, a colour,
 * darkening and a stretch of its own, a diffuse lobe a roughness (eon), and the base may turn light back or be of glass
 * (stack.h).
 *
 *   Khronos Group, "glTF 2.0 Specification", 2021, Appendix B; KHR_materials_specular, _ior, _clearcoat,
 * _sheen, _anisotropy, _transmission, _volume; the drafts _fuzz, _coat, _diffuse_roughness, _retroreflection, 2025 and 2026. Without an ior F0 is the artist's reflectance, by default 0.03. Departure: F_min,
 * which dims the diffuse lobe, is that of a dielectric at the least of wi . h, cos_o and cos_i. With wi . h
 * alone, as glTF has it, a smooth white dielectric reflects up to 2 - f0 times what it receives at grazing, 1.85 times at
 * roughness 0.05 (weft plot albedo khronos:base_color=1,sheen=0,roughness=0.05 --csv); so it never passes 1
 * (tests/shading/test_furnace). Profile khronos follows the text. */
#pragma once

#include "shading/stack/workflow.h"

FN Rgb metallic_f0(const Surface *s) {
    return rgb_scale(rgb_min(rgb_scale(s->specular_color, dielectric_f0(s)), 1.0f), s->specular);
}

/* Makes the stack of the workflow with another sheen lobe, layer rule and interface rule: base_fresnel is one of the
 * BASE_FRESNEL_... of stack.h. */
FN void metallic_with(Stack *m, const Surface *s, Lobe sheen, int layer, int base_fresnel) {
    workflow_coat(m, s);
    workflow_sheen(m, sheen, rgb_scale(s->sheen_color, s->sheen), s->sheen_second, layer);
    Rgb f0 = metallic_f0(s);
    m->base_fresnel = base_fresnel;
    m->interface_f0 = f0;
    m->interface_f90 = s->specular;
    workflow_transmission(m, s, 1.0f - s->metallic);
    workflow_base(m, s, rgb_scale(s->base_color, 1.0f - s->metallic), rgb_mix(f0, s->base_color, s->metallic),
                  mix(s->specular, 1.0f, s->metallic));
    workflow_glass(m, s, 1.0f - s->metallic);
}

FN void metallic_stack(Stack *m, const Surface *s) {
    metallic_with(m, s, lobe_rough(LOBE_CHARLIE_CONTY_KULLA, s->sheen_roughness), LAYER_ALBEDO_VIEW,
                  BASE_FRESNEL_LEAST);
    if (m->has_fuzz) workflow_fuzz(m, s, lobe_default(LOBE_LTC_FIBRE));
    workflow_coming(m, s);
}
