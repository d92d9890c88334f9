/* cloth_base.h - the base of a material that is woven, at points */
#ifndef WEFT_SCENE_CLOTH_BASE_H
#define WEFT_SCENE_CLOTH_BASE_H

#include <stdbool.h>

#include "shading/kind.h"
#include "shading/weave_base.h"
#include "weave/weft_cloth.h"

/* A look at a cloth: its texture coordinates, the footprint, and two random numbers in [0, 1): one chooses between near
 * and far, the other what stands for the cloth from afar. */
typedef struct ClothLook {
    float uv[2];
    WeaveFootprint footprint;
    float level, facet;
    bool holed; /* gaps between threads are holes, not black */
} ClothLook;

/* Looks as arrays. */
typedef struct ClothLooks {
    float uv[2][ROW_ROOM], footprint_x[ROW_ROOM], footprint_y[ROW_ROOM], longest[ROW_ROOM];
    float level[ROW_ROOM], facet[ROW_ROOM];
    bool holed;
} ClothLooks;

/* Gives what is at the first n places: a point of a thread, or from afar any point of one system's threads in the colours
 * of all, by which system in proportion to what they reflect. The mean over the random numbers is the cloth. */
void cloth_bases(const WeftCloth *cloth, const ClothLooks *looks, int n, YarnRows *out);

/* Puts into the place of the stack's base what is at one place. */
void cloth_base(const WeftCloth *cloth, const ClothLook *look, Stack *stack);

/* Returns true if there is no thread. */
bool cloth_is_gap(const WeftCloth *cloth, const float uv[2]);

#endif
