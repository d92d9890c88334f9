/* polygons.h - the polygon lights of a scene's emissive triangles: flat convex polygons of few corners
 *
 * For a renderer that integrates polygons (shading/area/area.h). Adjacent triangles of a mesh in one plane become one
 * polygon if that is convex and has at most LIGHT_CORNERS corners, else several; others stay triangles. */
#pragma once

#include "scene/record/scene.h"

enum { LIGHT_CORNERS = 8 };

typedef struct LightPolygon {
    Vec3 corners[LIGHT_CORNERS]; /* world space, counter-clockwise as seen from the side that emits */
    int count;                   /* 3 .. LIGHT_CORNERS */
    Vec3 normal;                 /* unit, towards that side */
    bool two_sided;              /* both sides emit */
    float radiance[3];           /* mean over the polygon of emission times opacity */
    float area;                  /* m^2 */
    float power;                 /* pi area luminance of radiance, doubled for two sides */
} LightPolygon;

typedef struct LightPolygons {
    LightPolygon *items; /* strongest first */
    int count, found;    /* found: number in the scene */
} LightPolygons;

/* Returns true if the material emits light. Unlit materials are shown as they are and do not light the
 * scene. */
bool material_emits(const Material *material);

/* Finds the `most` strongest polygon lights. Release with light_polygons_free. Returns false if memory is short. */
bool light_polygons_find(LightPolygons *lights, const WeftScene *scene, int most);
void light_polygons_free(LightPolygons *lights);
