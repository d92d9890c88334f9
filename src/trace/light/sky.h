/* sky.h - the environment as a light: radiance along a direction, and directions by radiance */
#pragma once

#include "base/memory.h"
#include "scene/record/scene.h"
#include "shading/dialect/angles.h"
#include "trace/light/distribution.h"
#include "trace/light/light_rows.h"

typedef struct Sky {
    const Environment *environment;   /* borrowed */
    float cos_rotation, sin_rotation; /* of the environment's rotation about +y */
    double mean;                      /* luminance of the radiance, over the sphere */
    int width, height;                /* of the importance map: the image's, up to a limit */
    Distribution rows;                /* of the map's rows */
    Distribution columns;             /* of row 0; those of row k lie k * stride floats further on */
    size_t stride;
    uint32_t *packed; /* the image as RGBE if that loses nothing, else NULL */
} Sky;

typedef struct SkyPoint {
    Vec3 direction;
    Rgb radiance;
    float pdf; /* with which sky_sample finds the direction, 1/sr */
} SkyPoint;

/* Fills sky; its arrays come from arena. Returns false if memory is short. */
bool sky_make(Sky *sky, const Environment *environment, Arena *arena);

/* Returns the light from a unit direction. */
SkyPoint sky_at(const Sky *sky, Vec3 direction);

/* Samples a direction with (u, v) in [0, 1)^2, in proportion to about its radiance. */
SkyPoint sky_sample(const Sky *sky, float u, float v);

/* Samples n <= ROW_MOST directions with (u, v) as arrays, n a multiple of ROW_LANES. */
void sky_sample_rows(const Sky *sky, int n, const float *u, const float *v, LightRows *samples);

/* Fills radiance and pdf for n directions d; n as above. */
void sky_at_rows(const Sky *sky, int n, const float *const d[3], LightRows *found);
