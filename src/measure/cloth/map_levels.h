/* map_levels.h - mip levels of the maps of a cloth, whose light is that of the threads at every level
 *
 * Means of texels shade otherwise than the texels do in the mean: their normals are flatter, and two crossed highlights
 * become one round one. So each level after the first has numbers of its own. Its texels are means of those before,
 * weighted by cover: of colours, of normals, of what is seen of the sky, and of the squares of roughness along and across
 * fibres as a matrix
 *
 *   A = sum (a^2 t t^T + b^2 s s^T),  b = roughness^2,  a = b + (1 - b) anisotropy^2,  t: the longer axis, s: across it
 *
 * whose axes are those of the mean highlight. Factors on the colour, on both axes and on the normals, and a metallic, are
 * found as those of a look (map_look.h), for the contrast of texels that the threads have at that size. The first level
 * stays as the look has it, so that it is right by itself where a viewer has means of its own. */
#pragma once

#include "measure/cloth/map_look.h"

enum { MAP_LEVELS_MOST = 14, MAP_LEVEL_MAPS = 4 };

/* Four numbers a texel, times cover: colour and 1; normal, and the visible fraction of the sky; A as xx, xy, yy. The
 * colour of opaque cloth is black in gaps. */
typedef enum MapPlane { PLANE_COLOR, PLANE_NORMAL, PLANE_FACETS, PLANES } MapPlane;

typedef struct MapLevel {
    int width, height;
    float *planes[PLANES];
    float color[3], roughness, anisotropy, metallic; /* factors, and the number itself */
    float relief;                                    /* factor on the slopes of normals */
    MapOcclusion occlusion;
    double error; /* as WeftBaked.fitted */
} MapLevel;

typedef struct MapLevels {
    MapLevel items[MAP_LEVELS_MOST];
    int count;
    float normal; /* the greatest relief, which the scale of the normal map is */
    bool holed;
} MapLevels;

/* Makes the levels of maps with that look, which was found by the fit. Release with map_levels_free, in any case. Fails with
 * WEFT_MESSAGE_MEMORY; WEFT_INTERRUPTED where the progress of the fit was stopped. */
WeftResult map_levels_find(MapFit *fit, const MapLook *look, MapLevels *out, WeftError *error);
void map_levels_free(MapLevels *levels);

/* Writes a texel of base colour and cover, normal, occlusion with roughness and metallic, and anisotropy. */
void map_level_texel(const MapLevels *levels, int level, int column, int row, unsigned char maps[MAP_LEVEL_MAPS][4]);
