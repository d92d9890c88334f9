/* occlusion.h - how much of the sky each vertex sees, found by rays in the background */
#ifndef WEFT_RASTER_OCCLUSION_H
#define WEFT_RASTER_OCCLUSION_H

#include "scene/scene.h"

typedef struct Occlusion Occlusion;

/* Starts to look from every vertex, `rays` directions a side, on `threads` threads beside the caller (0: one
 * a processor). The scene must outlive it. Fails with WEFT_MESSAGE_MEMORY or _RENDER_DEVICE. */
WeftResult occlusion_start(const WeftScene *scene, int rays, int threads, Occlusion **out, WeftError *error);

/* Two numbers a vertex, all meshes one after the other: the cosine-weighted part of the sky that its front
 * sees, and its back; 1 is all. NULL until it is done, unless it is waited for. Lives until occlusion_free.
 */
const float *occlusion_values(Occlusion *occlusion, bool wait);

/* Stops early where it is not done; occlusion may be NULL. */
void occlusion_free(Occlusion *occlusion);

#endif
