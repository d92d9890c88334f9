/* occlusion.h - how much of the sky and of each lamp a vertex sees, found by rays in the background */
#ifndef WEFT_RASTER_OCCLUSION_H
#define WEFT_RASTER_OCCLUSION_H

#include "scene/ambient.h"

typedef struct Occlusion Occlusion;

/* Numbers of a vertex: of the sky what its front sees and what its back does, then of each lamp. */
enum { OCCLUSION_LAMPS = AMBIENT_LAMPS, OCCLUSION_VALUES = 2 + OCCLUSION_LAMPS };

/* How to look. */
typedef struct OcclusionHow {
    int rays;      /* directions a side; a quarter of them for each lamp */
    int threads;   /* beside the caller; 0: one a processor */
    bool no_cache; /* neither reads what an earlier run found from the user's cache, nor writes it there */
    const AmbientLamp *lamps; /* in the world; copied */
    int lamp_count;           /* those beyond OCCLUSION_LAMPS are not looked for */
} OcclusionHow;

/* Starts to look from every vertex of the scene's own meshes; those of its lights, which move, neither hide
 * anything nor are looked from. The scene must outlive it; the calls of weft/scene.h may change it
 * meanwhile. Fails with WEFT_MESSAGE_MEMORY or _RENDER_DEVICE; what is wrong with a file of the cache is a
 * warning. */
WeftResult occlusion_start(const WeftScene *scene, const OcclusionHow *how, Occlusion **out,
                           const WeftLog *log, WeftError *error);

/* OCCLUSION_VALUES a vertex, its own meshes one after the other: of the sky the cosine-weighted part, 1 is
 * all; of a lamp the part that is above the horizon of whichever side faces it; below 0 where nothing is
 * known. NULL until it is done, unless it is waited for. Lives until occlusion_free. */
const float *occlusion_values(Occlusion *occlusion, bool wait);

/* Stops early where it is not done; occlusion may be NULL. */
void occlusion_free(Occlusion *occlusion);

#endif
