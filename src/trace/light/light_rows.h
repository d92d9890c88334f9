/* light_rows.h - samples of lights, or what comes along directions, as arrays */
#ifndef WEFT_TRACE_LIGHT_ROWS_H
#define WEFT_TRACE_LIGHT_ROWS_H

#include "shading/stack/surface_rows.h"

/* A distance beyond any light of a scene. */
#define LIGHT_FAR 1e30f

/* The members of LightSample in lights.h. */
typedef struct LightRows {
    float wi[3][ROW_ROOM], radiance[3][ROW_ROOM];
    float pdf[ROW_ROOM];
    float distance[ROW_ROOM]; /* LIGHT_FAR for the environment and directional lights */
} LightRows;

#endif
