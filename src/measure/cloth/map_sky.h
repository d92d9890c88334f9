/* map_sky.h - the light of an even sky, as viewers make it
 *
 * Engines light by an environment in another way than by lights: with the split sum of a round highlight, whatever its
 * anisotropy; with the light between facets, which paint below loses; and with a sheen that is a table times the
 * irradiance. For radiance 1 from everywhere this has a closed form. With A and B of ggx (bake_dfg.c), E = A + B, d: F0
 * of dielectrics, c: base colour, m: metallic, s: specular, S: sheen colour, E_s: E of the sheen,
 *
 *   L        = S E_s + (1 - max3(S) E_s) L_base
 *   three    : L_base = mix(G(d), G(c), m) + (1 - m) c (1 - G(d)),  G(f) = g (1 + (1 - E) a / (1 - (1 - E) a)),
 *              g = f A + mix(s, 1, m) B,  a = f + (1 - f) / 21
 *   Filament : L_base = g (1 + f (1 / E - 1)) + (1 - m) c (1 - g),  g = f A + B,  f = mix(d, c, m)
 *   Babylon.js: L_base = H(mix(d, c, m)) + c (1 - min(H(mix(d, 1, m)), 1)),
 *              H(f) = (f A + mix(s, 1, m) B) (1 + f (1 / E - 1))
 *
 *   As read in three.js 0.187 (ShaderChunk/lights_physical_pars_fragment), google/filament (shaders/src/
 * surface_light_indirect.fs) and Babylon.js 9.28 (ShadersInclude/pbrBlockFinalLitComponents, pbrBlockReflectance). G is
 * by Carmelo J. Fdez-Aguera, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting", JCGT 8 (1),
 * 2019. E and E_s are the profile's. Left out: what occlusion maps take.
 */
#pragma once

#include "shading/material/material_stack.h"
#include "weft/weft.h"

typedef struct MapSky {
    WeftImage split; /* B of ggx: cos_o to the right, roughness downwards, edges at 0 and 1 */
} MapSky;

/* Makes the table. Release with map_sky_free. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult map_sky_create(MapSky *out, WeftError *error);
void map_sky_free(MapSky *sky);

/* Returns true if the viewer of a stack lights by a sky as above. */
bool map_sky_is_own(const Stack *stack);

/* Returns the light of the sky from a surface in its view, whose stack has the E of such a viewer. */
Rgb map_sky_light(const MapSky *sky, const SeenStack *seen, const Surface *surface);
