/* ground.h - the floor in the driver's memory: how much of the sky's light reaches it, and a mirror
 *
 * All calls are for the context that is current. */
#ifndef WEFT_RASTER_GROUND_H
#define WEFT_RASTER_GROUND_H

#include "scene/light/floor.h"
#include "scene/record/camera.h"
#include "trace/geometry/geometry.h"

typedef struct Ground {
    Geometry *geometry; /* of the scene's own meshes, NULL until it is needed */
    bool stale;         /* light may pass elsewhere than when that was made or looked through */
    bool known;         /* sky and light are of the floor and the environment below */
    Floor floor;
    unsigned turn;
    float rotation, strength;
    unsigned
        sky; /* texture: part of the environment's light that reaches a point, by raster/glsl/floor.glsl */
    float light; /* luminance of all of the environment's light that falls on a level plane */
    unsigned framebuffer, color, depth; /* of the mirror, so wide and high; 0 until it is needed */
    int width, height;
} Ground;

/* Finds out how much of the environment's light reaches the floor, on `threads` threads; does nothing where
 * that is known. Fails with WEFT_MESSAGE_MEMORY, _RENDER_DEVICE or _GL_MEMORY. */
WeftResult ground_look(Ground *ground, const WeftScene *scene, const Floor *floor, int threads,
                       WeftError *error);

/* The scene as the floor shows it: what a view shows of it from below, mirrored in `across` too. */
View ground_view(const Floor *floor, const View *view);

/* Makes the mirror the target, with the same rows of half the picture as `box`, x, y, width and height from
 * below, has, and some more, empty. Fails with WEFT_MESSAGE_GL_MEMORY. */
WeftResult ground_mirror(Ground *ground, int width, int height, const int box[4], WeftError *error);

/* Makes the smaller copies of what was drawn into it. */
void ground_mirrored(const Ground *ground);

/* Binds sky, mirror and depth of the mirror to units from `unit` on. */
void ground_bind(const Ground *ground, int unit);

void ground_destroy(Ground *ground);

#endif
