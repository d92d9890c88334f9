/* picture_block.h - the uniform block that all shaders of a picture share: camera, punctual lights and
 * their shadows */
#ifndef WEFT_RASTER_PICTURE_BLOCK_H
#define WEFT_RASTER_PICTURE_BLOCK_H

#include "raster/light/shadow.h"
#include "scene/light/floor.h"
#include "weft/raster.h"

enum { PICTURE_LIGHTS_MOST = 64, PICTURE_POLYGONS_MOST = WEFT_RASTER_POLYGONS };

/* The block that glsl/picture.glsl declares, in std140. */
typedef struct Picture {
    float to_clip[16]; /* column after column */
    float eye[4], forward[4];
    float shadow_clip[SHADOWS_MOST][16], shadow_eye[SHADOWS_MOST][4];
    float shadow_soft[SHADOWS_MOST][4], shadow_points[SHADOWS_MOST][SHADOW_POINTS][4];
    float lights[PICTURE_LIGHTS_MOST][4][4];
    float polygon_corners[PICTURE_POLYGONS_MOST][LIGHT_CORNERS][4];
    float polygon_normals[PICTURE_POLYGONS_MOST][4], polygon_radiance[PICTURE_POLYGONS_MOST][4];
    float floor_place[4], floor_light[4], floor_lens[4];
} Picture;

/* Fills the block for a view of a scene lit by at most PICTURE_POLYGONS_MOST polygons, over a floor. Where there is a
 * floor, floor_light[0] and [2] are left to the caller. */
void picture_make(const WeftScene *scene, const View *view, const LightPolygons *polygons,
                  const Shadows *shadows, const Floor *floor, Picture *out);

/* Fills it for the view of a light from a point of it. */
void picture_of_shadow(const Shadow *shadow, int point, Picture *out);

#endif
