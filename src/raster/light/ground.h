/* ground.h - the floor on the GPU: the fraction of the sky's light that reaches it, and its mirror image
 *
 * All calls are for the context that is current. */
#pragma once

#include "scene/light/floor.h"
#include "scene/record/camera.h"
#include "trace/geometry/geometry.h"

typedef struct Ground {
    Geometry *geometry; /* of the scene's own meshes, NULL until it is needed */
    bool stale;         /* meshes let light pass at other places than when geometry and sky were made */
    bool solved;        /* sky and light are those of the floor and environment below */
    Floor floor;
    unsigned version; /* of the environment */
    float rotation, strength;
    unsigned sky;                       /* texture: fraction of the environment's light, mapped as in glsl/floor.glsl */
    float light;                        /* luminance of the environment's irradiance on a level plane */
    unsigned framebuffer, color, depth; /* of the mirror; 0 until it is needed */
    int width, height;                  /* of the mirror, texels */
} Ground;

/* Finds the fraction of the environment's light that reaches the floor, on `threads` threads (0: all); does nothing if
 * it is solved. Fails with WEFT_MESSAGE_MEMORY, _RENDER_DEVICE or _GL_MEMORY. */
WeftResult ground_look(Ground *ground, const WeftScene *scene, const Floor *floor, int threads, WeftError *error);

/* Returns the view of the scene in the floor's mirror: from below the floor, and mirrored in `across` too. */
View ground_view(const Floor *floor, const View *view);

/* Binds the mirror, of half the picture's size, as the framebuffer, and clears the rows of `box` (x, y, width and
 * height from below) and some more. Fails with WEFT_MESSAGE_GL_MEMORY. */
WeftResult ground_mirror(Ground *ground, int width, int height, const int box[4], WeftError *error);

/* Makes the mipmaps of the mirror, once it is drawn. */
void ground_mirrored(const Ground *ground);

/* Binds sky, mirror and depth of the mirror to units from `unit` on. */
void ground_bind(const Ground *ground, int unit);

void ground_destroy(Ground *ground);
