/* picture_block.h - the uniform block that all shaders of a picture share: camera, lights and their shadows */
#pragma once

#include "raster/glsl/picture_uniforms.h"
#include "raster/light/shadow.h"
#include "scene/light/floor.h"
#include "weft/raster.h"

_Static_assert((int)PICTURE_POLYGONS == (int)WEFT_RASTER_POLYGONS && (int)PICTURE_CORNERS == (int)LIGHT_CORNERS,
               "glsl/picture_uniforms.h has other numbers of polygons or corners");

/* Types of GLSL as std140 lays them out. */
typedef float uniform_vec4[4];
typedef float uniform_mat4[16]; /* column after column */

/* The block that glsl/picture.glsl declares. */
#define PICTURE_ONE(type, name)         uniform_##type name;
#define PICTURE_MANY(type, name, count) uniform_##type name[count];
typedef struct Picture {
    PICTURE_UNIFORMS(PICTURE_ONE, PICTURE_MANY)
} Picture;

/* Fills the block for a view of a scene lit by at most PICTURE_POLYGONS polygons, over a floor. The caller sets
 * floor_light[0] and [2] if there is a floor. */
void picture_make(const WeftScene *scene, const View *view, const LightPolygons *polygons, const Shadows *shadows,
                  const Floor *floor, Picture *out);

/* Fills the block for the view of a light from a point of it. */
void picture_of_shadow(const Shadow *shadow, int point, Picture *out);
