/* ray_albedos.h - the part of light that the scene's surfaces send back, for a bounce in shaders (glsl/bounce.glsl)
 *
 * A material's is the mean over directions of the light of an even sky, by all its lobes and all points of its maps, with
 * a black and with a white base colour: what it sends back is linear in the base colour, or nearly. A triangle has the
 * mean of its base colour.
 *
 * Departures: transmitted light is left out; maps of other inputs than the base colour have their mean over the unit
 * square; dust has its mean over surfaces of all directions. */
#pragma once

#include "scene/light/sheen_tables.h"
#include "scene/record/scene.h"

typedef struct RayAlbedo {
    float black[3], more[3]; /* with a black base colour, and what a white one adds */
} RayAlbedo;

/* Makes those of all materials that a mesh shows. Release with free. Returns NULL if memory is short. */
RayAlbedo *ray_albedos_make(const WeftScene *scene, const SheenTables *sheens);

/* Sets the red, green and blue of a triangle: of its front in 12 bits, and of its back in the 12 bits above, as one whole
 * number each, which a float holds. */
void ray_albedos_triangle(const RayAlbedo *albedos, const WeftScene *scene, const Mesh *mesh, uint32_t triangle,
                          float packed[3]);
