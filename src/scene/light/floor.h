/* floor.h - the disc under a scene that catches its shadow and its mirror image, as both engines see it */
#pragma once

#include "scene/record/scene.h"
#include "weft/render.h"

typedef struct Floor {
    bool there;
    Vec3 middle;
    float radius;     /* m */
    float reflection; /* fraction of the mirror image, 0 to 1 */
    float roughness;  /* of the mirror, 0 to 1 */
} Floor;

/* Fails with WEFT_MESSAGE_DESC if a number is out of range. */
WeftResult floor_check(const WeftFloor *wanted, WeftError *error);

#define FLOOR_REACH 5.0f

/* Returns the floor of a scene: FLOOR_REACH times as wide as the sphere about the scene's own box, through the lowest
 * point of the box. A scene without meshes of its own has none. */
Floor floor_of(const WeftScene *scene, const WeftFloor *wanted);

/* Returns the weight of shadow and mirror image at a point of the floor: 1 up to half of the radius, 0 at the rim,
 * between them s^2 (3 - 2 s). */
float floor_coverage(const Floor *floor, Vec3 point);

/* Returns the distance along a ray from above to the floor, below 0 if it misses. */
float floor_distance(const Floor *floor, Vec3 origin, Vec3 direction);
