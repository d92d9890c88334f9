/* ray_emitters.h - the emissive triangles of a scene, chosen in proportion to their power */
#pragma once

#include "scene/record/scene.h"

typedef struct RayEmitter {
    uint32_t mesh, triangle;
    Vec3 a, ab, ac; /* a corner and two edges */
    float area;     /* m^2 */
    bool two_sided;
    float radiance[3];        /* mean of emission times opacity */
    float probability, until; /* of the choice; sum of all up to this one */
} RayEmitter;

typedef struct RayEmitters {
    RayEmitter *all;
    int count;
} RayEmitters;

/* Finds the emitters of a scene. Release with ray_emitters_free. Returns false if memory is short; *emitters is then zero. */
bool ray_emitters_find(RayEmitters *emitters, const WeftScene *scene);
void ray_emitters_free(RayEmitters *emitters);
