/* sky.h - the environment as a light: radiance along a direction, and directions by radiance */
#ifndef WEFT_TRACE_SKY_H
#define WEFT_TRACE_SKY_H

#include "base/memory.h"
#include "scene/record/scene.h"
#include "shading/dialect/angles.h"
#include "trace/distribution.h"
#include "trace/light_rows.h"

typedef struct Sky {
    const Environment *environment; /* borrowed */
    float cos_turn, sin_turn;       /* of the environment's rotation */
    double mean;                    /* radiance's luminance, over the sphere */
    int width, height;              /* of the importance map: the image's, up to a limit */
    Distribution rows, columns;     /* columns: of row 0; those of row k are k * stride floats further on */
    size_t stride;
    uint32_t *packed; /* the image as RGBE, where that loses nothing; else NULL */
} Sky;

typedef struct SkyPoint {
    Vec3 direction;
    Rgb radiance;
    float pdf; /* of sky_sample, 1/sr */
} SkyPoint;

/* Fills sky; its arrays come from arena. false when memory is short. */
bool sky_make(Sky *sky, const Environment *environment, Arena *arena);

/* Returns the light from a unit direction. */
SkyPoint sky_at(const Sky *sky, Vec3 direction);

/* A direction for (u, v) in [0, 1)^2, by about its radiance. */
SkyPoint sky_sample(const Sky *sky, float u, float v);

/* Works on arrays of n <= ROW_MOST, n a multiple of ROW_LANES: samples for (u, v); and radiance and pdf
 * along the directions d. */
void sky_sample_rows(const Sky *sky, int n, const float *u, const float *v, LightRows *samples);
void sky_at_rows(const Sky *sky, int n, const float *const d[3], LightRows *found);

#endif
