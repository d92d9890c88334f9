/* pane.h - thin, smooth glass that light goes straight through, to what lies behind */
#pragma once

#include "scene/record/scene.h"
#include "shading/dialect/rgb.h"

/* Returns true if a material of the scene is a pane: of glass without a thickness, as smooth as lobe ggx can be. What has
 * a normal map or a back of its own, emits, is measured, or lies under a sheen, fuzz or dust is none. */
bool scene_is_pane(const WeftScene *scene, int material);

/* Returns the part of light at that cosine to the normal, above 0, that a pane lets through at a point
 * (stack_glass_straight). uv, color: as for material_textures; uv NULL: the inputs without textures. */
Rgb pane_transmittance(const WeftScene *scene, int material, float uv[2][2], const float color[4], float cosine);
