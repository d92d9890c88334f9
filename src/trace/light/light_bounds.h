/* light_bounds.h - the bounds of a group of emissive triangles: box, cone of normals, power */
#pragma once

#include <stdbool.h>

#include "base/vec3.h"

typedef struct LightBounds {
    Vec3 low, high;   /* box */
    Vec3 axis;        /* of the cone, unit */
    float cos_spread; /* cosine of the half angle of the cone */
    float power;      /* 0: the group is empty */
    bool two_sided;
} LightBounds;

/* Returns the bounds of both groups together. */
LightBounds light_bounds_join(LightBounds a, LightBounds b);

/* Returns the cost of a group in a tree: power times the area of its box times the solid angle that it lights. */
float light_bounds_cost(const LightBounds *bounds);
