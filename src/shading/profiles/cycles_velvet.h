/* cycles-velvet - Blender's velvet before 4.0: black towards the viewer, a bright line at the silhouette
 *
 *   f     = base_color / pi + c D V
 *   D     = velvet at sigma = max(sheen_roughness, 0.01), not squared;  V = V_cook_torrance
 *
 *   blender/blender, intern/cycles/kernel/closure/bsdf_ashikhmin_velvet.h (1460c1c), after Michael
 * Ashikhmin et al., 2000. There it is a closure by itself, which a graph of nodes adds to or mixes with
 * others: the Lambert lobe beside it is that graph here, black where base_color is. Nothing is taken from
 * anything.
 *   Inputs: its weight c is sheen_color sheen, its sigma sheen_roughness (the node's default is 1).
 *   Departures: sampled by D and not uniformly; wi . h has no cut-off. */
#pragma once

#include "shading/lobes/cook_torrance.h"
#include "shading/stack/workflow.h"

FN void cycles_velvet_stack(Stack *m, const Surface *s) {
    Lobe sheen = lobe_default(LOBE_COOK_TORRANCE);
    sheen.params[COOK_TORRANCE_ALPHA] = clamp(s->sheen_roughness, 0.01f, 1.0f);
    sheen.params[COOK_TORRANCE_D] = to_float(D_VELVET);
    sheen.params[COOK_TORRANCE_V] = to_float(V_COOK_TORRANCE);
    sheen.params[COOK_TORRANCE_F] = to_float(F_NONE);
    workflow_sheen(m, sheen, rgb_scale(s->sheen_color, s->sheen), s->sheen_second, LAYER_ADDITIVE);
    slot_even(&m->diffuse, lobe_default(LOBE_LAMBERT), s->base_color, s->base_color, 1.0f);
}
