/* light_rows.h - samples of lights, or what comes along directions, as arrays */
#pragma once

#include "shading/stack/surface_rows.h"

/* A distance beyond any light of a scene. */
#define LIGHT_FAR 1e30f

/* The members of LightSample in lights.h. */
typedef struct LightRows {
    float wi[3][ROW_CAPACITY], radiance[3][ROW_CAPACITY];
    float pdf[ROW_CAPACITY];
    float distance[ROW_CAPACITY]; /* LIGHT_FAR for the environment and directional lights */
} LightRows;
