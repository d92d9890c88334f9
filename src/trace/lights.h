/* lights.h - everything that shines, as one thing to sample: environment, emissive triangles, punctual lights
 *
 * A group is chosen by its power, an element within it by its own; the pdfs returned contain both choices. */
#ifndef WEFT_TRACE_LIGHTS_H
#define WEFT_TRACE_LIGHTS_H

#include "scene/scene.h"
#include "shading/angles.h"

typedef struct Lights Lights;

WeftResult lights_create(const WeftScene *scene, Lights **out, WeftError *error);
void lights_free(Lights *lights);

typedef struct LightSample {
    Vec3 wi;        /* unit, from the point to the light */
    float distance; /* to it; INFINITY for the environment and directional lights */
    Rgb radiance;   /* arriving */
    float pdf;      /* 1/sr; 0: no sample. For punctual lights the probability of the choice alone */
    bool punctual;  /* cannot be hit by chance: takes no part in MIS */
    bool sky;       /* from the environment */
} LightSample;

LightSample lights_sample(const Lights *lights, Vec3 point, float u, float v);

/* What comes from where nothing is hit, and the density with which lights_sample finds that direction. */
LightSample lights_environment(const Lights *lights, Vec3 direction);

/* Density with which lights_sample, from a point at distance t, finds that triangle's point seen under
 * `cosine`. */
float lights_triangle_pdf(const Lights *lights, uint32_t mesh, uint32_t triangle, float t, float cosine);

#endif
