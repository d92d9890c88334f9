/* cloth - fibres and nothing else: a diffuse colour under a sheen, without a highlight
 *
 *   f = sheen + keep base_color / pi
 *
 *   keep: what the layer rule leaves. Romain Guy, Mathias Agopian, "Physically Based Rendering in Filament",
 * 2018, section "Cloth model", drops the specular lobe of cloth likewise. Not for: satin, silk and leather,
 * which have a highlight in the mirror direction. */
#pragma once

#include "shading/stack/workflow.h"

FN void cloth_stack(Stack *m, const Surface *s) {
    Lobe sheen = lobe_rough(LOBE_CHARLIE_NEUBELT, s->sheen_roughness);
    workflow_sheen(m, sheen, rgb_scale(s->sheen_color, s->sheen), s->sheen_second, LAYER_ALBEDO_VIEW);
    workflow_transmission(m, s, 1.0f);
    slot_even(&m->diffuse, lobe_default(LOBE_LAMBERT), s->base_color, s->base_color, 1.0f);
}
