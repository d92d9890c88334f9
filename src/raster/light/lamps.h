/* lamps.h - the emissive triangles of a scene, chosen in proportion to their power */
#pragma once

#include "scene/record/scene.h"

typedef struct Lamp {
    uint32_t mesh, triangle;
    Vec3 a, ab, ac; /* a corner and two edges */
    float area;     /* m^2 */
    bool two_sided;
    float radiance[3];        /* mean of emission times opacity */
    float probability, until; /* of the choice; sum of all up to this one */
} Lamp;

typedef struct Lamps {
    Lamp *all;
    int count;
} Lamps;

/* Finds the lamps of a scene. Release with lamps_free. Returns false if memory is short; *lamps is then zero. */
bool lamps_find(Lamps *lamps, const WeftScene *scene);
void lamps_free(Lamps *lamps);
