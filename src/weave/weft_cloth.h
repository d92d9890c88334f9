/* weft_cloth.h - a draft woven of yarns, ready to be looked at point by point */
#ifndef WEFT_WEAVE_WEFT_CLOTH_H
#define WEFT_WEAVE_WEFT_CLOTH_H

#include "shading/lobes/woven.h"
#include "shading/weave/weave_point.h"
#include "weft/weave.h"

/* The colours of a repeat, ever coarser: square grids of a power of 2 columns and rows, each level half of the one
 * before. A level is FAR_LAYERS layers of RGBA: what the warp reflects at a place of light that met one fibre, and of
 * all other light, in parts of the cloth; the same of the weft. Alpha is the share that the system covers. */
enum { FAR_WARP_ONCE, FAR_WARP_AGAIN, FAR_WEFT_ONCE, FAR_WEFT_AGAIN, FAR_LAYERS };
enum { FAR_LEVELS_MOST = 10 };
typedef struct ClothFar {
    int width, height, levels;
    int starts[FAR_LEVELS_MOST]; /* of each level among the numbers of all */
    float *texels;
    /* The lobes of warp and weft: weave_woven, with what is fitted to the parts of their yarns (woven_fit.h). */
    WovenPrepared woven[2];
} ClothFar;

/* Points of one system, evenly spread over a piece of the cloth, any of which may stand for all: slopes and azimuth as
 * lobe yarn has them, and factors on the colours, 1 on the mean. Neighbours have like slopes: they are the leaves of a k-d tree. */
typedef struct ClothFacet {
    float slope_x, slope_y, azimuth, once, again;
} ClothFacet;
enum { FACETS_MOST = 4096 };

struct WeftCloth {
    Weave weave; /* with the two tables below */
    ClothFar far;
    int facet_count[2]; /* of either system, at least 1 */
    ClothFacet facets[2][FACETS_MOST];
    float *runs, *albedos;
    WeftYarn yarns[2];
    char *text;       /* JSON: the weave of the material that it came from; NULL: of none */
    WeftDraft *draft; /* as it was read; owned; NULL where no material has the cloth */
    char *path;       /* of the draft's file, absolute; NULL: it is in none, and all of it in the text */
    double size[2];   /* of the repeat, metres */
    float per_uv[2];  /* threads of warp and weft in one unit of texture coordinates */
};

/* Sets how many metres a unit of texture coordinates spans. */
void cloth_spread(WeftCloth *cloth, double metres);

/* Returns true if both came from the same text, and from the same draft where that is in a file. */
bool cloth_same(const WeftCloth *a, const WeftCloth *b);

/* cloth_far.c: makes weave.warp_far and weft_far, far and facets; false where memory is short. */
bool cloth_far_make(WeftCloth *cloth);

/* The side of a level of that side at the first. */
static inline int cloth_far_side(int side, int level) { return side >> level > 0 ? side >> level : 1; }

/* Returns the texels of a level, all layers one after the other. */
const float *cloth_far_level(const ClothFar *far, int level, int *width, int *height);

#endif
