/* specular - the older workflow: a diffuse colour, a specular colour, roughness
 *
 *   f = as in workflow metallic, with f0 = specular_color specular and diffuse = base_color (1 - max3 f0)
 *
 *   Khronos Group, KHR_materials_pbrSpecularGlossiness, 2017 (Appendix: F0 = specular, diffuse dimmed by the
 * strongest channel of it). It can express more than metallic: any pair of colours. `convert.h` has what is lost
 * on the way to metallic. Older viewers use each map directly, which is workflow free. */
#pragma once

#include "shading/stack/workflow.h"

FN void specular_stack(Stack *m, const Surface *s) {
    workflow_coat(m, s);
    Lobe sheen = lobe_rough(LOBE_CHARLIE_CONTY_KULLA, s->sheen_roughness);
    workflow_sheen(m, sheen, rgb_scale(s->sheen_color, s->sheen), s->sheen_second, LAYER_ALBEDO_VIEW);
    Rgb f0 = rgb_min(rgb_scale(s->specular_color, s->specular), 1.0f);
    m->base_fresnel = BASE_FRESNEL_LEAST;
    m->interface_f0 = f0;
    m->interface_f90 = 1.0f;
    workflow_transmission(m, s, 1.0f - rgb_max3(f0));
    workflow_base(m, s, rgb_scale(s->base_color, 1.0f - rgb_max3(f0)), f0, 1.0f);
    workflow_glass(m, s, 1.0f);
    if (m->has_fuzz) workflow_fuzz(m, s, lobe_default(LOBE_LTC_FIBRE));
    workflow_coming(m, s);
}
