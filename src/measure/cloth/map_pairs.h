/* map_pairs.h - the pairs of directions for which maps of a cloth are fitted */
#pragma once

#include "shading/dialect/lang.h"
#include "shading/stack/frame.h"

enum {
    MAP_LIGHTS = 5,
    MAP_NORMALS = 30, /* of the ball: points that the viewer sees */
    MAP_SKIES = 8,    /* wo under the sky */
    MAP_SKY_INS = 20,
    MAP_OUTS = MAP_NORMALS + MAP_SKIES,
    MAP_PAIRS = MAP_NORMALS * MAP_LIGHTS + MAP_SKIES * MAP_SKY_INS,
    MAP_ROWS = MAP_NORMALS * MAP_LIGHTS + MAP_SKIES, /* sums that are compared: pairs under lights, skies */
    MAP_GROUPS = MAP_LIGHTS + 1,                     /* lights and the sky */
    MAP_CONTRASTS = MAP_NORMALS * MAP_LIGHTS         /* the pairs under lights, which come first */
};

/* Pairs by their wo, on the cloth; wi below its horizon are as they fall. */
typedef struct MapPairs {
    Dir o[MAP_OUTS], i[MAP_PAIRS];
    int first[MAP_OUTS + 1]; /* of each wo: its pairs, side by side */
} MapPairs;

MapPairs map_pairs(void);

/* Returns direction n of `count` under the sky, spread by the cosine, for wo number `sky`. */
Dir map_sky_in(int n, int count, int sky);

/* Returns the row of a pair, and the group of a row. */
static inline int map_row(int pair) {
    return pair < MAP_CONTRASTS ? pair : MAP_CONTRASTS + (pair - MAP_CONTRASTS) / MAP_SKY_INS;
}
static inline int map_group(int row) { return row < MAP_CONTRASTS ? row % MAP_LIGHTS : MAP_LIGHTS; }
