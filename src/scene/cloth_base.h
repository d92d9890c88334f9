/* cloth_base.h - the base of a material that is woven, at a point */
#ifndef WEFT_SCENE_CLOTH_BASE_H
#define WEFT_SCENE_CLOTH_BASE_H

#include <stdbool.h>

#include "shading/material_stack.h"
#include "shading/weave_base.h"
#include "weave/weft_cloth.h"

/* A look at a cloth: its texture coordinates, the footprint, and two random numbers in [0, 1) that choose between near
 * and far and between warp and weft. */
typedef struct ClothLook {
    float uv[2];
    WeaveFootprint footprint;
    float level, system;
    bool holed; /* gaps between threads are holes, not black */
} ClothLook;

/* Puts into the place of the stack's base what is there: a point of a thread, or from afar the threads of one system,
 * by which system in proportion to what they reflect. The mean over the random numbers is the cloth. */
void cloth_base(const WeftCloth *cloth, const ClothLook *look, Stack *stack);

/* Returns true if there is no thread. */
bool cloth_is_gap(const WeftCloth *cloth, const float uv[2]);

#endif
