/* occlusion.h - how much of the sky each vertex sees, found by rays in the background */
#ifndef WEFT_RASTER_OCCLUSION_H
#define WEFT_RASTER_OCCLUSION_H

#include "scene/scene.h"

typedef struct Occlusion Occlusion;

/* How to look. */
typedef struct OcclusionHow {
    int rays;      /* directions a side */
    int threads;   /* beside the caller; 0: one a processor */
    bool no_cache; /* neither reads what an earlier run found from the user's cache, nor writes it there */
} OcclusionHow;

/* Starts to look from every vertex. The scene must outlive it; the calls of weft/scene.h may change it
 * meanwhile. Fails with WEFT_MESSAGE_MEMORY or _RENDER_DEVICE; what is wrong with a file of the cache is a
 * warning. */
WeftResult occlusion_start(const WeftScene *scene, const OcclusionHow *how, Occlusion **out,
                           const WeftLog *log, WeftError *error);

/* Two numbers a vertex, all meshes one after the other: the cosine-weighted part of the sky that its front
 * sees, and its back; 1 is all. NULL until it is done, unless it is waited for. Lives until occlusion_free.
 */
const float *occlusion_values(Occlusion *occlusion, bool wait);

/* Stops early where it is not done; occlusion may be NULL. */
void occlusion_free(Occlusion *occlusion);

#endif
