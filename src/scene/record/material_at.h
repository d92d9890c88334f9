/* material_at.h - a material evaluated at a point of a mesh */
#pragma once

#include "scene/record/scene.h"
#include "shading/material/material_stack.h"

/* Returns the material's inputs without its textures: the same at every point, so one call a material is enough. What is
 * woven has no transmission. */
Surface material_plain(const Material *material);

/* Returns the surface of a material of defaults. */
Surface surface_default(void);

/* Returns the choices of a material. Auto for the rim becomes fuzz if the material has some, even where a texture of it
 * is black: the sheen is then what engines without fuzz show. */
Choices material_choices(const Material *material);

/* Returns true if light goes through the material as through glass anywhere: by its workflow and profile, and where a
 * texture of metalness is 0. */
bool material_has_glass(const Material *material);

/* Returns true if the material is of solid glass, whose surface has two sides whether it is double-sided or not. What is
 * woven or measured is none. */
bool material_is_solid(const Material *material);

/* Sets the textured inputs of a surface at a point, and multiplies base_color and opacity by the linear vertex colour.
 * uv: the two UV sets. */
void material_textures(const WeftScene *scene, const Material *material, float uv[2][2], const float color[4],
                       Surface *surface);

/* Returns the opacity at a point, after the alpha mode's rule (MASK gives 0 or 1); 1 for OPAQUE. */
float material_opacity(const WeftScene *scene, const Material *material, float uv[2][2], float vertex_alpha);
