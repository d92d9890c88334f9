/* map_fit.h - the light that a viewer makes of texels of maps, against that of the cloth
 *
 * Blocks of texels stand for the maps. Their light is a sum of parts, so that the gain of the base colour and the tint of
 * the sheen follow from all other numbers by least squares (map_look.h has the error). */
#pragma once

#include "measure/bsdf/reflection.h"
#include "measure/cloth/map_pairs.h"
#include "measure/cloth/map_sky.h"
#include "measure/cloth/map_texel.h"
#include "measure/fit/search.h"
#include "scene/record/material_at.h"

/* The pattern of a look: blocks of 4 by 4 texels, of which every other one in both directions is shaded; and around each the
 * mean of 16 by 16, of which every fourth one is counted. */
enum { BLOCKS = 48, ROUGH_BLOCKS = 16, FINE = 4, COARSE = 16, TEXELS = FINE + 1 };

/* The numbers that are searched for; all others follow. */
enum {
    AXIS_METALLIC,
    AXIS_ROUGHNESS,
    AXIS_ANISOTROPY,
    AXIS_NORMAL,
    AXIS_SHADE,
    AXIS_SPECULAR,
    AXIS_SHEEN,
    AXIS_SHEEN_ROUGHNESS,
    AXES
};
extern const SearchAxis map_axes[AXES];

/* A texel as a shader reads it from the maps. */
typedef struct LookTexel {
    float color[3], normal[3], along[2], light, roughness, stretch, cover; /* color: with a shade of 0 */
} LookTexel;

/* Parts of f cos_i of which light is a sum: of a black base without sheen; what a base adds for
 * each unit of its colour, by channel in the colour of the texel; what a white sheen adds. */
enum { PART_REST, PART_BASE, PART_SHEEN = PART_BASE + 3, PARTS };

typedef struct LookBlock {
    LookTexel texels[TEXELS]; /* those that are shaded, and the coarse one behind them */
    /* of the texels as they are: their mean. Of skies: shares of what is seen of radiance 1 */
    double fine[PARTS][MAP_PAIRS];
    double coarse[PARTS][MAP_PAIRS];
    double near[2][MAP_CONTRASTS]; /* what two halves of the points of threads in it reflect, means of channels */
} LookBlock;

/* A sum of pairs that is compared. */
typedef struct LookRow {
    double goal[3], weight, parts[PARTS];
} LookRow;

typedef struct MapFit {
    const MapGrid *grid;
    const WeftCloth *cloth;
    Surface bare;   /* of the maps without texels */
    Material plain; /* the same with a sheen */
    Choices choices;
    AlbedoTable *table;
    MapSky sky;
    bool own_sky;  /* the viewer lights by a sky in its own way (map_sky.h), and not by all its directions */
    float typical; /* base colour at which parts are taken, since not all of it is linear */
    double dim;    /* the part of such a sky that the occlusion map leaves */
    MapPairs pairs;
    LookBlock *blocks;
    bool holed;              /* gaps are holes */
    int count;               /* blocks in use */
    bool level;              /* of a mip level: one texel of a block is shaded, no coarse one, and tints stay */
    WeftReflection *threads; /* of the cloth; owned */
    const WeftMaterial *material;
    const double *x;            /* numbers at which it is shaded */
    LookRow rows[2 * MAP_ROWS]; /* fine, then coarse */
    float open;                 /* the mean of the occlusion map */
    double color_most[3];
    double contrast;      /* of what is shaded */
    double contrast_goal; /* of the threads */
    double gains[3], tints[3];
    ItemProgress *item_progress; /* of the searches, which it can stop; NULL: none */
} MapFit;

/* Begins a fit, without texels yet. Release with map_fit_free, in any case. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult map_fit_create(const MapGrid *grid, const WeftMaterial *material, const WeftCloth *cloth, int profile,
                          bool holed, MapFit **out, WeftError *error);
void map_fit_free(MapFit *fit);

/* Places of the maps, in texels of level 0, whose threads a block is compared with. */
typedef struct MapPlace {
    float column, row, width, height;
} MapPlace;

/* Sets what the threads of BLOCKS blocks reflect under the lights: of points in so many columns and rows at each place. */
void map_fit_near(MapFit *fit, const MapPlace *places, int side);

/* Returns the deviation of the threads of blocks from each other, over their mean. Of halves: without what comes of the
 * number of points, which two halves of them do not have in common. */
double map_fit_contrast(const MapFit *fit, bool halves);

/* Leaves the numbers that a profile does not read at what a file without them means. */
void map_fit_unread(const MapFit *fit, SearchAxis axis[AXES]);

/* Shades the texels of the first `count` blocks with these numbers, and sets gains, tints, contrast and dim. Returns the
 * error, and the light of an even sky that comes back over that of the cloth. */
double map_fit_error(MapFit *fit, const double *x, double *sky);

/* Returns the same error with the gains and tints that are set. */
double map_fit_error_now(const MapFit *fit, double *sky);

/* Gives texels first, first + 1, .. of `per` in each block the means of the whole: some hundred texels have them by chance
 * alone, and a cloth whose threads lean to one side in the mean would reflect to that side. */
void map_fit_center(MapFit *fit, int first, int per, const LookTexel *whole);

/* The values of an occlusion map: 1 - strength (1 - factor open), open being the visible fraction of the sky. */
typedef struct MapOcclusion {
    float strength, factor;
} MapOcclusion;

/* Returns the occlusion that takes back what a sky gives too much. */
MapOcclusion map_fit_occlusion(const MapFit *fit, double sky);

/* Returns what contrast and sky add to an error. room: the factor by which contrast may be off for nothing. */
double map_fit_price(const MapFit *fit, double sky, double room);
