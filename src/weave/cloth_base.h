/* cloth_base.h - the base of a material that is woven, at points of its cloth */
#pragma once

#include <stdbool.h>

#include "shading/kinds/kind.h"
#include "shading/weave/weave_base.h"
#include "shading/weave/weave_place.h"
#include "weave/weft_cloth.h"

/* Points of a cloth, each seen by a pixel. */
typedef struct ClothLooks {
    float uv[2][ROW_CAPACITY];                                                         /* texture coordinates */
    float footprint_x[ROW_CAPACITY], footprint_y[ROW_CAPACITY], longest[ROW_CAPACITY]; /* WeaveFootprint of the pixel */
    float level[ROW_CAPACITY]; /* random, in [0, 1): chooses between near and far */
    float facet[ROW_CAPACITY]; /* random, in [0, 1): near, the place across a fibre; far, the facet */
    float wear[ROW_CAPACITY];  /* the material's input, 0 to 1 */
    bool holed;                /* gaps between threads are holes, not black */
} ClothLooks;

/* Returns where the weave of a cloth lies. */
FN WeavePlacing cloth_placing(const WeftCloth *cloth) {
    return (WeavePlacing){cloth->per_uv[WEFT_WARP], cloth->per_uv[WEFT_WEFT], cloth->rotation_parts[0],
                          cloth->rotation_parts[1]};
}

/* The features of cloth at its points that guide a denoiser: the part of light from all around that comes back, and
 * the slopes of lobe yarn. From afar both are those of the cloth, whatever facet stands for it. */
typedef struct ClothGuide {
    float albedo[3][ROW_CAPACITY], slope[2][ROW_CAPACITY];
} ClothGuide;

/* Sets the bases at the first n points. Near, a base is the point of a thread. From afar it is a random facet of one
 * system in the colours of all its threads; a system is chosen in proportion to what it reflects. The mean over the
 * random numbers is the cloth. guide may be NULL. */
void cloth_bases(const WeftCloth *cloth, const ClothLooks *looks, int n, YarnRows *out, ClothGuide *guide);

/* Returns lobe woven of one system and its mean colours over the whole repeat. The lobes of both systems add up to the
 * cloth. */
WeaveBase cloth_base_far(const WeftCloth *cloth, bool weft);

/* Returns the albedo of the fibres of the thread on top. Alone they reflect more than packed in the thread. */
Rgb cloth_fibre_albedo(const WeftCloth *cloth, const float uv[2]);

/* Returns true if there is no thread. */
bool cloth_is_gap(const WeftCloth *cloth, const float uv[2]);
