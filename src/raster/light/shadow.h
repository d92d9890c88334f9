/* shadow.h - shadow maps: what the lights that cast shadows see, as layers of depth textures
 *
 * A polygon has a map for each of some points on it: the mean over them is its soft shadow. Paul Heckbert and Michael
 * Herf, "Simulating Soft Shadows with Graphics Hardware", Carnegie Mellon University, CMU-CS-97-104, 1997.
 *
 * All calls are for the context that is current. */
#ifndef WEFT_RASTER_SHADOW_H
#define WEFT_RASTER_SHADOW_H

#include "raster/light/depths.h"
#include "scene/light/polygons.h"

enum { SHADOWS_MOST = 4, SHADOW_SIDE = 2048, SHADOW_POINTS = 55, SHADOW_POINT_SIDE = 512 };

/* A light that casts one. */
typedef struct Shadow {
    View view;                 /* the light's: what it sees lies in [-1, 1]^2; of a polygon from its middle */
    float texel;               /* width of a texel, m; of a view with perspective at distance 1 */
    int points;                /* of a polygon: SHADOW_POINTS; else 0 */
    Vec3 point[SHADOW_POINTS]; /* from the eye, m: along across, up and forward */
    float meeting; /* 1 / distance of the plane on which all of them see the same, 1/m; 0 where that is far */
    Depths
        depths; /* Between these a map holds what casts a shadow; a thing beyond is shaded and casts none. */
} Shadow;

typedef struct Shadows {
    Shadow all[SHADOWS_MOST];
    int count;
    int of_light[SHADOWS_MOST];   /* index of the punctual light, or -1 */
    int of_polygon[SHADOWS_MOST]; /* of the polygon, or -1 */
    int polygons;                 /* how many are of polygons: the last ones */
    unsigned hard, soft; /* array textures: a layer a punctual light, and SHADOW_POINTS layers a polygon */
    unsigned framebuffer, compare; /* compare: the sampler */
    bool drawn;                    /* the textures hold what the lights see */
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

/* By how much x and y of what a point of a polygon sees are moved, in parts of where the point is, 1/m: so much that all
 * see the same on the plane where they meet. */
float shadow_slope(const Shadow *shadow, int point);

/* The view from a point of a polygon; of another light, its one view. */
View shadow_view(const Shadow *shadow, int point);

/* Makes the map of light `k` from a point the target, empty. */
void shadows_begin(const Shadows *shadows, int k, int point);

/* Binds the textures to two units, to compare with. */
void shadows_bind(const Shadows *shadows, int hard_unit, int soft_unit);

#endif
