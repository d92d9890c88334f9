/* weft_cloth.h - a draft woven of yarns, ready to be evaluated point by point */
#ifndef WEFT_WEAVE_WEFT_CLOTH_H
#define WEFT_WEAVE_WEFT_CLOTH_H

#include "shading/lobes/woven.h"
#include "shading/weave/weave_point.h"
#include "weft/weave.h"

/* Layers of a level of ClothFar: reflectance of the warp at a place by single scattering (ONCE) and by multiple
 * scattering (AGAIN), as fractions of the light on the cloth, and the same of the weft. Alpha is the fraction that the
 * system covers. */
enum { FAR_WARP_ONCE, FAR_WARP_AGAIN, FAR_WEFT_ONCE, FAR_WEFT_AGAIN, FAR_LAYERS };
enum { FAR_LEVELS_MOST = 10 };

/* The mip levels of a repeat's colours: grids whose sides are powers of 2, each level half of the one before. */
typedef struct ClothFar {
    int width, height; /* of the first level */
    int levels;
    int starts[FAR_LEVELS_MOST]; /* of each level, index in texels */
    float *texels;               /* RGBA by level and layer */
    WovenPrepared woven[2]; /* the lobes of warp and weft: weave_woven, fitted to their yarns (woven_fit.h) */
} ClothFar;

/* A point of one system that stands for the cloth from afar: slopes and azimuth as in lobe yarn, and factors on the
 * colours, 1 in the mean. The points of a system are evenly spread over a piece of the cloth. Neighbours have similar
 * slopes, since they are the leaves of a k-d tree. */
typedef struct ClothFacet {
    float slope_x, slope_y, azimuth, once, again;
} ClothFacet;
enum { FACETS_MOST = 4096 };

struct WeftCloth {
    Weave weave; /* with the two tables below */
    ClothFar far;
    int facet_count[2]; /* by system, at least 1 */
    ClothFacet facets[2][FACETS_MOST];
    float *runs, *albedos;
    WeftYarn yarns[2];
    char *text;       /* JSON: the weave of the material that it came from; NULL without a material */
    WeftDraft *draft; /* as it was read; owned; NULL if no material has the cloth */
    char *path;       /* of the draft's file, absolute; NULL if the text contains the draft */
    double size[2];   /* of the repeat, metres */
    float per_uv[2];  /* threads of warp and weft in one unit of texture coordinates */
};

/* Sets the length in metres of a unit of texture coordinates. */
void cloth_spread(WeftCloth *cloth, double metres);

/* Returns true if both came from the same text, and from the same draft if that is in a file. */
bool cloth_same(const WeftCloth *a, const WeftCloth *b);

/* Makes weave.warp_far, weave.weft_far, far and facets (cloth_far.c). Returns false if memory is short. */
bool cloth_far_make(WeftCloth *cloth);

/* Returns the side of a level from that of the first. */
static inline int cloth_far_side(int side, int level) { return side >> level > 0 ? side >> level : 1; }

/* Returns the texels of a level, all layers one after the other. */
const float *cloth_far_level(const ClothFar *far, int level, int *width, int *height);

#endif
