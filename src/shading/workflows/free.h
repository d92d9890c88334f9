/* free - terms side by side: whatever D, V and F are chosen, with nothing that couples them to the diffuse
 * lobe
 *
 *   f = base_color diffuse + D V F + sheen,   f0 = specular_color specular, f90 = 1
 *
 *   For looking at terms, and the specular workflow of viewers that use each map directly: a coloured reflection beside a
 * coloured diffuse lobe. It may gain energy, for nothing is taken from anything; workflow specular dims the diffuse lobe
 * by 1 - max3 f0 in place of that. The layer rule is additive unless another is chosen. */
#pragma once

#include "shading/stack/workflow.h"

FN void free_stack(Stack *m, const Surface *s) {
    Lobe sheen = lobe_rough(LOBE_CHARLIE_NEUBELT, s->sheen_roughness);
    workflow_sheen(m, sheen, rgb_scale(s->sheen_color, s->sheen), s->sheen_second, LAYER_ADDITIVE);
    workflow_transmission(m, s, 1.0f);
    workflow_base(m, s, s->base_color, rgb_scale(s->specular_color, s->specular), 1.0f);
}
