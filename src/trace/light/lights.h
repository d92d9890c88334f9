/* lights.h - everything that emits, in groups that are sampled separately: environment, emissive triangles, punctual
 * lights
 *
 * One sample of each group estimates all light at a point. A punctual light is chosen in proportion to its power, an
 * emissive triangle to a bound of what may arrive; the pdfs returned contain the probability of that choice. */
#pragma once

#include "scene/record/scene.h"
#include "trace/light/light_rows.h"

typedef struct Lights Lights;

typedef enum LightGroup { LIGHTS_SKY, LIGHTS_EMITTERS, LIGHTS_PUNCTUAL, LIGHT_GROUPS } LightGroup;

WeftResult lights_create(const WeftScene *scene, Lights **out, WeftError *error);
void lights_free(Lights *lights);

/* Returns true if the group has a light. */
bool lights_has_group(const Lights *lights, LightGroup group);

typedef struct LightSample {
    Vec3 wi;        /* unit, from the point to the light */
    float distance; /* to it; INFINITY for the environment and directional lights */
    Rgb radiance;   /* arriving */
    float pdf;      /* 1/sr; 0: no sample. For punctual lights the probability of the choice */
    bool punctual;  /* cannot be hit by chance: takes no part in MIS */
    bool sky;       /* from the environment */
} LightSample;

/* Samples a group that has a light, for a point, with (u, v) in [0, 1)^2. Light from below the normal's plane does not
 * count unless the normal is 0. */
LightSample lights_sample(const Lights *lights, LightGroup group, Vec3 point, Vec3 normal, float u, float v);

/* Samples such a group as arrays, for n <= ROW_MOST points and (u, v), n a multiple of ROW_LANES. */
void lights_sample_rows(const Lights *lights, LightGroup group, int n, const float *const point[3],
                        const float *const normal[3], const float *u, const float *v, LightRows *samples);

/* Returns the light of the environment from a direction, and the density with which lights_sample finds that
 * direction. */
LightSample lights_environment(const Lights *lights, Vec3 direction);

/* Fills radiance and pdf of lights_environment as arrays, for n directions d. */
void lights_environment_rows(const Lights *lights, int n, const float *const d[3], LightRows *found);

/* Returns the density, 1/sr, with which lights_sample, from a point with that normal, finds a point of that triangle at
 * distance t under `cosine`. */
float lights_triangle_pdf(const Lights *lights, uint32_t mesh, uint32_t triangle, Vec3 point, Vec3 normal, float t,
                          float cosine);
