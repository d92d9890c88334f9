/* material_at.h - a material evaluated at a point of a mesh */
#ifndef WEFT_SCENE_MATERIAL_AT_H
#define WEFT_SCENE_MATERIAL_AT_H

#include "scene/record/scene.h"
#include "shading/material/material_stack.h"

/* The material's inputs without its textures: the same everywhere, so it need be made only once. */
Surface material_plain(const Material *material);

/* Returns the choices of a material. */
Choices material_choices(const Material *material);

/* Puts in what its textures say at a point: uv holds the two UV sets, color the linear vertex colour. */
void material_textures(const WeftScene *scene, const Material *material, float uv[2][2], const float color[4],
                       Surface *surface);

/* Only the opacity there, after the alpha mode's rule (MASK gives 0 or 1); 1 for OPAQUE. */
float material_opacity(const WeftScene *scene, const Material *material, float uv[2][2], float vertex_alpha);

#endif
