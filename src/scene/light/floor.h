/* floor.h - the disc under a scene that catches its shadow and its mirror image, as both engines see it */
#ifndef WEFT_SCENE_FLOOR_H
#define WEFT_SCENE_FLOOR_H

#include "scene/record/scene.h"
#include "weft/render.h"

typedef struct Floor {
    bool there;
    Vec3 middle;
    float radius;
    float reflection, roughness;
} Floor;

/* Fails with WEFT_MESSAGE_DESC where a number is out of range. */
WeftResult floor_check(const WeftFloor *wanted, WeftError *error);

/* The floor of a scene: FLOOR_REACH times as wide as the sphere about the scene's own box, through the lowest
 * point of that. None of a scene without shapes of its own. */
#define FLOOR_REACH 5.0f
Floor floor_of(const WeftScene *scene, const WeftFloor *wanted);

/* The share of what it catches that a point of the floor shows: 1 up to half of the radius, 0 at the rim,
 * between them s^2 (3 - 2 s). */
float floor_coverage(const Floor *floor, Vec3 point);

/* The distance along a ray from above to the floor; below 0 where it meets none. */
float floor_distance(const Floor *floor, Vec3 origin, Vec3 direction);

#endif
