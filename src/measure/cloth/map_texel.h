/* map_texel.h - a texel of the maps of a cloth: the mean of the points of threads that it covers */
#pragma once

#include <stdbool.h>

#include "shading/weave/weave_point.h"

/* The grid of texels of a cloth that repeats. Column 0 is at the left of the cloth, row 0 at its top. */
typedef struct MapGrid {
    Weave weave; /* with a cycle, over which the grid extends */
    bool back;   /* the other face, whose threads are counted the other way along both systems */
    int width, height;
} MapGrid;

/* Sums over points of a cloth, each with the weight 1 over their number. */
typedef struct MapTexel {
    float color[3]; /* linear reflectance of what is covered, times cover */
    float cover;    /* fraction covered by threads */
    float light;    /* part of the light of a mean place that reaches the threads (weave_open), times cover */
    float slope[2];
    float roughness;
    float open; /* visible fraction of the sky, weave_depth */
    float height;
    float along[2]; /* direction of the fibres as a unit vector at twice the angle, so that opposite ones agree */
} MapTexel;

/* Returns the place of column and row, fractions of texels from the top left, in threads. */
static inline float map_x(const MapGrid *grid, float column) {
    const float x = column / (float)grid->width;
    return (grid->back ? 1.0f - x : x) * grid->weave.cycle_x;
}
static inline float map_y(const MapGrid *grid, float row) {
    const float y = row / (float)grid->height;
    return (grid->back ? y : 1.0f - y) * grid->weave.cycle_y;
}

/* Returns the distance of the points of a texel, in threads. */
float map_spacing(const MapGrid *grid);

/* Returns the texel there. */
MapTexel map_texel(const MapGrid *grid, int column, int row);

/* Adds a texel `part` times. */
void map_texel_add(MapTexel *to, const MapTexel *texel, float part);

/* Returns linear base colour, channel c, with the light that reaches the texel to the power of shade. holed: without gaps. */
float map_texel_color(const MapTexel *texel, int c, float shade, bool holed);

/* Returns the strength of alignment of the fibres, 0 to 1, and sets the angle from +x across them, in which highlights are
 * elongated: -45 to 135 degrees. */
float map_texel_stretch(const MapTexel *texel, float *angle);
