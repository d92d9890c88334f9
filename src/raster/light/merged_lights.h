/* merged_lights.h - the lights of an environment for a moving picture, which are fewer
 *
 * Two lights are merged, again and again, until MERGED_LIGHTS are left: those whose light spreads least together, by
 * Joe H. Ward, "Hierarchical Grouping to Optimize an Objective Function", Journal of the American Statistical
 * Association 58(301), 1963.
 * The light of both comes from their mean direction, and none is lost. */
#pragma once

#include "scene/light/env_split.h"

enum { MERGED_LIGHTS = 4, MERGED_OF = 8 };

typedef struct MergedLight {
    EnvLight light;
    float of[MERGED_OF]; /* the parts of its luminance that the first lights have */
} MergedLight;

/* Returns the number of merged lights. */
int merged_lights(const AmbientParts *parts, MergedLight out[MERGED_LIGHTS]);
