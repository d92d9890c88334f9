/* shadow.h - shadow maps: what the lights that cast shadows see, as layers of one depth texture
 *
 * All calls are for the context that is current. */
#ifndef WEFT_RASTER_SHADOW_H
#define WEFT_RASTER_SHADOW_H

#include "scene/camera.h"
#include "scene/polygons.h"

enum { SHADOWS_MOST = 4, SHADOW_SIDE = 2048 };

/* A light that casts one. */
typedef struct Shadow {
    View view;    /* the light's: what it sees lies in [-1, 1]^2 */
    float texel;  /* width of a texel, m; of a view with perspective at distance 1 */
    float radius; /* of the light, m */
} Shadow;

typedef struct Shadows {
    Shadow all[SHADOWS_MOST];
    int count;
    int of_light[SHADOWS_MOST];   /* index of the punctual light, or -1 */
    int of_polygon[SHADOWS_MOST]; /* of the polygon, or -1 */
    unsigned texture, framebuffer;
    unsigned compare, plain; /* sampler objects: compared, and as numbers */
    Vec3 low, high;          /* box of what shadows are looked at on */
    bool drawn;              /* the texture holds what the lights see */
} Shadows;

/* Chooses the lights: the strongest directional and spot lights, and the strongest polygons, which get at
 * least half of the maps. The driver's objects are made when there is one. Fails with WEFT_MESSAGE_GL_MEMORY
 * or _GL_CONTEXT. */
WeftResult shadows_create(const WeftScene *scene, const LightPolygons *polygons, Shadows *out,
                          WeftError *error);
void shadows_destroy(Shadows *shadows);

/* Chooses again, for other lights; maps that see something else are to be drawn anew.
 * Fails as shadows_create does, and there are then none. */
WeftResult shadows_update(Shadows *shadows, const WeftScene *scene, const LightPolygons *polygons,
                          WeftError *error);

/* Makes layer `layer` the target, empty. */
void shadows_begin(const Shadows *shadows, int layer);

/* Binds the texture to two units: to compare with, and to read. */
void shadows_bind(const Shadows *shadows, int compare_unit, int plain_unit);

#endif
