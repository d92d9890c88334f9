/* filament-cloth - Filament's cloth: a matt colour and a soft rim laid over it, no highlight
 *
 *   f     = base_color / pi + c D V
 *   D     = charlie with sin_h^2 >= 1/128,  V = V_neubelt,  alpha = max(roughness, 0.045)^2
 *
 *   google/filament, shaders/src/surface_shading_model_cloth.fs (4c8b73e), surface_brdf.fs (04d50d4).
 * Nothing is taken from the diffuse lobe, which the design document has times 1 - F.
 *   IBL there differs: the diffuse lobe keeps 1 - c E each channel, and the rim is blurred as if it were
 * ggx.
 *   Inputs: c, its sheenColor, is sheen_color sheen, and its roughness, which only D reads, is sheen_roughness.
 * Where no colour is given it takes the root of the base colour; here black is none.
 * Subsurface colour is not made.
 *   Departure: alpha is at least 0.005. */
#pragma once

#include "shading/profiles/filament_sheen.h"

FN void filament_cloth_stack(Stack *m, const Surface *s) {
    float r = filament_roughness(s->sheen_roughness);
    filament_fuzz(m, r, rgb_scale(s->sheen_color, s->sheen), LAYER_ADDITIVE);
    slot_even(&m->diffuse, lobe_default(LOBE_LAMBERT), s->base_color, s->base_color, 1.0f);
}
