/* weft_cloth.h - a draft woven of yarns, ready to be evaluated point by point */
#pragma once

#include "shading/lobes/woven.h"
#include "shading/weave/weave_point.h"
#include "weft/weave.h"

/* The colours of a repeat as mipmaps: grids of a power of 2 columns and rows, each level half as wide and high as the
 * one before. A level has FAR_LAYERS layers of RGBA: the part of light that the warp reflects there, of light that met
 * one fibre and of all other light, and the same of the weft. Alpha is the share that the system covers. */
enum { FAR_WARP_SINGLE, FAR_WARP_MULTIPLE, FAR_WEFT_SINGLE, FAR_WEFT_MULTIPLE, FAR_LAYERS };
enum { FAR_LEVELS_MOST = 10 };

/* The mip levels of a repeat's colours: grids whose sides are powers of 2, each level half of the one before. */
typedef struct ClothFar {
    int width, height, levels;
    int starts[FAR_LEVELS_MOST]; /* index of the first number of each level */
    float *texels;
    WovenPrepared woven[2]; /* lobes of warp and weft, fitted (woven_fit.h) */
} ClothFar;

/* A point of one system that may stand for all of them from afar. Points are evenly spread over a piece of the cloth,
 * and ordered as the leaves of a k-d tree of their slopes, so that neighbours have similar slopes; of many, every so
 * manieth is kept. */
typedef struct ClothFacet {
    float slope_x, slope_y, azimuth; /* as lobe yarn has them */
    float single, multiple;          /* factors on the colours, 1 on the mean */
} ClothFacet;
enum { FACETS_MOST = 4096 };

struct WeftCloth {
    Weave weave; /* with runs and albedos below as tables */
    ClothFar far;
    int facet_count[2]; /* by system, at least 1 */
    ClothFacet facets[2][FACETS_MOST];
    float *runs, *albedos;
    WeftYarn yarns[2];
    char *text;              /* JSON: the weave of the material that it came from; NULL without a material */
    WeftDraft *draft;        /* as it was read; owned; NULL if no material has the cloth */
    char *path;              /* of the draft's file, absolute; NULL if the text contains the draft */
    struct WeftCloth *other; /* cloth_other_face of it; owned; NULL: nobody has asked for it yet */
    bool other_face;         /* true in the cloth that is the other of one */
    double size[2];          /* of the repeat, metres */
    double metres;           /* spanned by a unit of texture coordinates */
    bool automatic;          /* metres follows from the mesh (scene/material/cloth_fit.h) */
    double rotation;         /* of the weave on texture coordinates, degrees */
    float rotation_parts[2]; /* cosine and sine of that */
    float relief;            /* of the asset: smoothed over so many metres (scene/material/relief.h); infinite: flat */
    float per_uv[2];         /* threads of warp and weft in one unit of texture coordinates */
};

/* Sets the length in metres of a unit of texture coordinates. */
void cloth_spread(WeftCloth *cloth, double metres);

/* Rotates the weave on texture coordinates by an angle in degrees, from u towards -v. */
void cloth_rotate(WeftCloth *cloth, double degrees);

/* Returns a copy that shares no memory with the cloth, or NULL if memory is short. */
WeftCloth *cloth_copy(const WeftCloth *cloth);

/* Returns the other face of a cloth as a cloth, for points that are seen from behind, or NULL if memory is short. What is
 * over is under there. From behind a renderer turns the normal, the tangent and the bitangent about
 * (trace/path/vertex.c), so threads are counted the other way along both systems, which is per_uv below 0; and as this
 * frame mirrors, a yarn's twist has the other sign. */
WeftCloth *cloth_other_face(const WeftCloth *cloth);

/* Returns true if both came from the same text, and from the same draft if that is in a file, and have the same
 * metres. */
bool cloth_same(const WeftCloth *a, const WeftCloth *b);

/* Makes weave.warp_far and weft_far, far and facets. Returns false where memory is short. */
bool cloth_far_make(WeftCloth *cloth);

/* Returns the side of a level, in texels. side: that of level 0. */
static inline int cloth_far_side(int side, int level) { return side >> level > 0 ? side >> level : 1; }

/* Returns the texels of a level, all layers one after the other. */
const float *cloth_far_level(const ClothFar *far, int level, int *width, int *height);
