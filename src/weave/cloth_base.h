/* cloth_base.h - the base of a material that is woven, at points */
#ifndef WEFT_SCENE_CLOTH_BASE_H
#define WEFT_SCENE_CLOTH_BASE_H

#include <stdbool.h>

#include "shading/kinds/kind.h"
#include "shading/weave/weave_base.h"
#include "weave/weft_cloth.h"

/* Looks at a cloth: texture coordinates, footprints (WeaveFootprint), and two random numbers in [0, 1) each: `level`
 * chooses between near and far, `facet` is near by the place across a fibre, and from afar what stands for the cloth. */
typedef struct ClothLooks {
    float uv[2][ROW_ROOM], footprint_x[ROW_ROOM], footprint_y[ROW_ROOM], longest[ROW_ROOM];
    float level[ROW_ROOM], facet[ROW_ROOM];
    bool holed; /* gaps between threads are holes, not black */
} ClothLooks;

/* Gives what is at the first n places: a point of a thread, or from afar any point of one system's threads in the colours
 * of all, by which system in proportion to what they reflect. The mean over the random numbers is the cloth. */
void cloth_bases(const WeftCloth *cloth, const ClothLooks *looks, int n, YarnRows *out);

/* Returns what the threads of one system reflect on the mean over the whole repeat: lobe woven and its colours, of the
 * light that falls on the cloth, so that the cloth is the sum of both systems. */
WeaveBase cloth_base_far(const WeftCloth *cloth, bool weft);

/* Returns true if there is no thread. */
bool cloth_is_gap(const WeftCloth *cloth, const float uv[2]);

#endif
