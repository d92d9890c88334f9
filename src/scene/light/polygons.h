/* polygons.h - the lights that a scene's emissive triangles make up: flat convex polygons of few corners
 *
 * For a renderer that integrates polygons (shading/area/area.h). Triangles of a mesh that lie in one plane and
 * side by side become one polygon where that is convex and of at most LIGHT_CORNERS corners, else several;
 * what fits nothing stays a triangle. */
#ifndef WEFT_SCENE_POLYGONS_H
#define WEFT_SCENE_POLYGONS_H

#include "scene/record/scene.h"

enum { LIGHT_CORNERS = 8 };

typedef struct LightPolygon {
    Vec3 corners[LIGHT_CORNERS]; /* world space, counter-clockwise as seen from the side that shines */
    int count;                   /* 3 .. LIGHT_CORNERS */
    Vec3 normal;                 /* unit, towards that side */
    bool two_sided;              /* both sides shine */
    float radiance[3];           /* of a textured one the mean; what is transparent does not shine */
    float area, power;           /* m^2; luminance in W: pi area luminance, twice that of two sides */
} LightPolygon;

typedef struct LightPolygons {
    LightPolygon *items; /* strongest first */
    int count, found;    /* found: how many the scene has */
} LightPolygons;

/* Returns true if the material emits light. Unlit materials are shown as they are and do not light the
 * scene. */
bool material_emits(const Material *material);

/* Finds the `most` strongest. Release with light_polygons_free. False when memory is short. */
bool light_polygons_find(LightPolygons *lights, const WeftScene *scene, int most);
void light_polygons_free(LightPolygons *lights);

#endif
