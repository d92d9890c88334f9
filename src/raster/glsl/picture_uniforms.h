/* picture_uniforms.h - the uniform block Picture, which all shaders of a picture share: a uniform is one row
 *
 * frame/picture_block.h makes a record of C from the rows, picture.glsl the block of GLSL. ONE(type, name) is a
 * uniform, MANY(type, name, count) an array. The types are vec4 and mat4, which std140 lays out as C does float[4] and
 * float[16]. */
#pragma once

#define PICTURE_LIGHTS   64 /* most punctual lights of a picture */
#define PICTURE_POLYGONS 8  /* WEFT_RASTER_POLYGONS */
#define PICTURE_CORNERS  8  /* LIGHT_CORNERS of scene/light/polygons.h */
#define POLYGON_POINTS   4  /* on a polygon, which stand for it in a moving picture */
#define SHADOWS_MOST     4  /* shadow maps, of punctual lights and polygons together */
#define SHADOW_POINTS    55 /* points on a polygon from which its shadow map looks */

/* The rows of the block, in their order in memory.
 *
 * half is half the width of a shadow map at distance 1. A light in `lights` has four vectors: position and kind (0
 * directional, 1 point, 2 spot); direction of travel and range; colour times intensity, and shadow map or -1; cosines
 * of the cones, and for reference.glsl the sum of the probabilities of the lights up to it, and its own. A point of shadow_points is an offset from shadow_eye: x and y over half, z along w in m; w is the
 * shift of what it sees, over its x and y, 1/m. The floor's mirror has, with floor_lens.xy, depth x + y / w, or x w + y
 * without perspective. */
/* clang-format off */
#define PICTURE_UNIFORMS(ONE, MANY)                                                                          \
    ONE(mat4, to_clip)                    /* from world space less eye.xyz */                                \
    ONE(vec4, eye)                        /* w: 0 without perspective, else 1 */                             \
    ONE(vec4, forward)                    /* unit vector along the camera; w: number of punctual lights */   \
    MANY(mat4, shadow_clip, SHADOWS_MOST) /* from world space less shadow_eye.xyz */                         \
    MANY(vec4, shadow_eye, SHADOWS_MOST)  /* w: width of a texel, m; below 0: of one at distance 1 */        \
    MANY(vec4, shadow_soft, SHADOWS_MOST) /* half; the map's first layer in soft_map; faces of a cube or 0; side of a tile */ \
    MANY(vec4, shadow_points, SHADOWS_MOST * SHADOW_POINTS)                                                   \
    MANY(vec4, lights, 4 * PICTURE_LIGHTS)                                                                   \
    MANY(vec4, polygon_corners, PICTURE_CORNERS * PICTURE_POLYGONS)                                           \
    MANY(vec4, polygon_points, POLYGON_POINTS * PICTURE_POLYGONS) /* w: area that each stands for, m2 */        \
    MANY(vec4, polygon_normals, PICTURE_POLYGONS)                                                            \
    MANY(vec4, polygon_radiance, PICTURE_POLYGONS)                                                           \
    ONE(vec4, floor_place) /* middle and radius */                                                           \
    ONE(vec4, floor_light) /* luminance of the sky on it, share mirrored, 1 if the scene shades it */        \
    ONE(vec4, floor_lens)  /* z: half width of the mirror's cone, w: width over height, both of the picture */ \
    ONE(vec4, sky_place)   /* cosine and sine of its rotation, factor; 0 none, 1 one colour, 2 a map */       \
    ONE(vec4, sky_color)   /* radiance of one colour */                                                      \
    ONE(vec4, sky_parts)   /* factor on diffuse lobe and dust, on the other lobes */                         \
    ONE(vec4, ray_first)   /* number of nodes; first texel of triangles, normals, emitters */                   \
    ONE(vec4, ray_count)   /* number of emitters, of the frame; first texel of masks; 1: not all fibres of hair */  \
    ONE(vec4, coarse)         /* x: side of the square of pixels that share the points of a soft shadow; y: pixels along
                                 the side of one that light is found for (coarse_guide.glsl); z: width of a pixel
                                 where w is 1, m; w: one of so many points of a soft shadow is used */         \
    ONE(vec4, texture_levels) /* x: 1 if textures have smaller copies, 0 if the middle of a pixel is meant */
/* clang-format on */
