/* ray_masks.h - the maps of opacity of a scene in one array texture, for rays in shaders
 *
 * A layer is one channel of a texture, with 8 bits. All layers have the same size, that of the largest map up to
 * RAY_MASK_SIDE; others are scaled.
 *
 * All calls are for the context that is current. */
#pragma once

#include "scene/record/scene.h"

enum { RAY_MASK_SIDE = 1024, RAY_MASKS_MOST = 64, RAY_MASK_FLOATS = 12 };

typedef struct RayMask {
    int texture, channel; /* index into the scene's textures */
} RayMask;

typedef struct RayMasks {
    unsigned texture; /* 0: there are no maps */
    RayMask all[RAY_MASKS_MOST];
    int count;
} RayMasks;

/* Makes the layers anew. Maps beyond RAY_MASKS_MOST have none. Fails with WEFT_MESSAGE_MEMORY or _GL_MEMORY. */
WeftResult ray_masks_make(RayMasks *self, const WeftScene *scene, WeftError *error);
void ray_masks_destroy(RayMasks *self);

/* Returns true if the opacity of a mesh is looked up in a layer, and fills what glsl/rays.glsl needs to do so on a
 * triangle: coordinates of its three corners in the layer, vertex colours' alpha there, factor, the least opacity that is
 * a hit, or -1 if a random number decides, and the layer plus RAY_MASKS_MOST times the wrapping of u and v. */
bool ray_masks_triangle(const RayMasks *self, const WeftScene *scene, const Mesh *mesh, uint32_t triangle,
                        float numbers[RAY_MASK_FLOATS]);

/* Returns the opacity of a mesh without a map of it: the mean, where gaps between threads are open. */
float ray_masks_mean(const WeftScene *scene, const Mesh *mesh, uint32_t triangle);
