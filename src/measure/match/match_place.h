/* match_place.h - the inputs of a material at a place of its textures */
#pragma once

#include "measure/match/match_curves.h"
#include "scene/record/scene.h"

/* Returns true if textures of both inputs lie at the same place of a surface. */
bool place_same(const Input *a, const Input *b);

/* Returns the texture of an input at a place of it, linear; 1 without a texture. */
Texel place_texel(const WeftScene *scene, const WeftMaterial *material, InputId input, float u, float v);

/* Returns a number times its texture there; the brightest channel of the sheen's colour there. */
double place_number(const WeftScene *scene, const WeftMaterial *material, InputId input, float u, float v);
double place_brightness(const WeftScene *scene, const WeftMaterial *material, float u, float v);

/* Returns the input whose texture makes the sheen vary, and says where its nodes' texels lie. */
InputId place_driver(const MatchCurves *curves);

/* Computes the means of the texels around the nodes of a sheen that varies, of the textures that lie where its texture
 * does; other inputs are those of `average`. */
void place_means(const WeftScene *scene, const WeftMaterial *material, const WeftMaterial *average,
                 MatchCurves *curves);
