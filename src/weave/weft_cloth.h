/* weft_cloth.h - a draft woven of yarns, ready to be looked at point by point */
#ifndef WEFT_WEAVE_WEFT_CLOTH_H
#define WEFT_WEAVE_WEFT_CLOTH_H

#include "shading/weave_point.h"
#include "weft/weave.h"

/* The colours of a repeat, ever coarser: square grids of a power of 2 columns and rows, each level half of the one
 * before. A level is FAR_LAYERS layers of RGBA: what the warp reflects at a place of light that met one fibre, and of
 * all other light, in parts of the cloth; the same of the weft. Alpha is the share that the system covers. */
enum { FAR_WARP_ONCE, FAR_WARP_AGAIN, FAR_WEFT_ONCE, FAR_WEFT_AGAIN, FAR_LAYERS };
typedef struct ClothFar {
    int width, height, levels;
    float *texels;
} ClothFar;

struct WeftCloth {
    Weave weave; /* with the two tables below */
    ClothFar far;
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

/* cloth_far.c: makes weave.warp_far and weft_far, and far; false where memory is short. */
bool cloth_far_make(WeftCloth *cloth);

/* Returns the texels of a level, all layers one after the other. */
const float *cloth_far_level(const ClothFar *far, int level, int *width, int *height);

/* Returns the texel of a layer so many repeats from the left and from the bottom, of the level below `level`. */
const float *cloth_far_color(const ClothFar *far, int layer, float x, float y, float level);

#endif
