/* shadow.h - shadow maps: the depths that lights see, as layers of depth textures
 *
 * A polygon has a map for each of some points on it: the mean over them is its soft shadow. Paul Heckbert and Michael
 * Herf, "Simulating Soft Shadows with Graphics Hardware", Carnegie Mellon University, CMU-CS-97-104, 1997.
 *
 * All calls are for the context that is current. */
#pragma once

#include "raster/glsl/picture_uniforms.h"
#include "raster/light/depths.h"
#include "scene/light/polygons.h"

/* Texels along the side of a map, and of each of a polygon's if it is the only one. Several share the memory of one. */
enum { SHADOW_SIDE = 2048, SHADOW_POINT_SIDE = 512 };

/* A point light amid the scene has a cube of maps, as tiles of its one map: three in a row, of so many texels a side. */
enum { SHADOW_FACES = 6, SHADOW_TILE = SHADOW_SIDE / 3 };

/* The shadow map of a light. */
typedef struct Shadow {
    View view;                 /* of the light, with the map in [-1, 1]^2; of a polygon from its middle */
    float texel;               /* width of a texel, m; of a view with perspective at distance 1 */
    int faces;                 /* SHADOW_FACES for a light amid the scene, of which view is that along z, else 0 */
    int points;                /* SHADOW_POINTS for a polygon, else 0 */
    Vec3 point[SHADOW_POINTS]; /* from the eye, m: along across, up and forward */
    float meeting;             /* 1 / distance of the plane that all maps have at the same place, 1/m; 0: far */
    Depths depths;             /* range of the map's depths: an object beyond it receives shadows and casts none */
} Shadow;

typedef struct Shadows {
    Shadow all[SHADOWS_MOST];
    int count;
    int of_light[SHADOWS_MOST];    /* index of the punctual light, or -1 */
    int of_polygon[SHADOWS_MOST];  /* index of the polygon, or -1 */
    int polygons;                  /* number of maps of polygons, which are the last */
    int point_side;                /* texels along the side of each of their layers */
    unsigned hard, soft;           /* array textures: a layer a punctual light, and SHADOW_POINTS layers a polygon */
    unsigned framebuffer, compare; /* compare: the sampler */
    bool drawn;                    /* the textures are up to date */
} Shadows;

/* Chooses the lights: the strongest punctual lights of each kind, and the strongest polygons, for which at least half of
 * the maps are reserved. OpenGL objects are made only if there is a light. Fails with WEFT_MESSAGE_GL_MEMORY or
 * _GL_CONTEXT. */
WeftResult shadows_create(const WeftScene *scene, const LightPolygons *polygons, Shadows *out, WeftError *error);
void shadows_destroy(Shadows *shadows);

/* Chooses the lights again, and clears `drawn` if a map has changed. Fails as shadows_create does; there are then no
 * maps. */
WeftResult shadows_update(Shadows *shadows, const WeftScene *scene, const LightPolygons *polygons, WeftError *error);

/* Returns a point of a polygon for two numbers in [0, 1), which run along the sides of a parallelogram; even numbers give
 * even points. */
Vec3 shadow_point_on(const LightPolygon *polygon, float u, float v);

/* Returns the shift of x and y in the map of a point of a polygon, over x and y of the point itself, 1/m. With it all
 * maps have the plane `meeting` at the same place. */
float shadow_slope(const Shadow *shadow, int point);

/* Returns how many views the map of a light has: of points of a polygon, of faces of a cube, or one. */
int shadow_view_count(const Shadow *shadow);

/* Returns a view of a map. Those of points of a polygon have the axis of the middle's view and are sheared by
 * shadow_slope; face k of a cube looks along axis k / 2, of odd k backwards, as glsl/shadow.glsl finds it. */
View shadow_view(const Shadow *shadow, int point);

/* Binds the map of shadow `k` from a point as the framebuffer and clears it; of a cube, a face's tile, and with the first
 * face all are cleared. */
void shadows_begin(const Shadows *shadows, int k, int point);

/* Binds the textures to two units, for comparing look-ups. */
void shadows_bind(const Shadows *shadows, int hard_unit, int soft_unit);
