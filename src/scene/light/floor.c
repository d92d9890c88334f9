#include "scene/light/floor.h"

#include <math.h>

#include "base/fail.h"

WeftResult floor_check(const WeftFloor *wanted, WeftError *error) {
    bool good = wanted->reflection >= 0.0f && wanted->reflection <= 1.0f && wanted->roughness >= 0.0f &&
                wanted->roughness <= 1.0f;
    return good ? WEFT_OK
                : fail(error, WEFT_MESSAGE_DESC, "floor", "reflection %g, roughness %g; each is 0 to 1",
                       (double)wanted->reflection, (double)wanted->roughness);
}

Floor floor_of(const WeftScene *scene, const WeftFloor *wanted) {
    Vec3 low = scene->low, high = scene->high, middle = vec3_scale(vec3_add(low, high), 0.5f);
    float across = vec3_length(vec3_sub(high, low));
    if (!wanted->on || !(across >= 0.0f && across < INFINITY)) return (Floor){0};
    /* slightly below the objects that stand on it, so that no two surfaces coincide */
    return (Floor){.there = low.y <= high.y,
                   .middle = {middle.x, low.y - 1e-4f * across, middle.z},
                   .radius = FLOOR_REACH * 0.5f * across,
                   .reflection = wanted->reflection,
                   .roughness = wanted->roughness};
}

float floor_coverage(const Floor *floor, Vec3 point) {
    float x = point.x - floor->middle.x, z = point.z - floor->middle.z;
    float s = fminf(fmaxf(2.0f - 2.0f * sqrtf(x * x + z * z) / floor->radius, 0.0f), 1.0f);
    return s * s * (3.0f - 2.0f * s);
}

float floor_distance(const Floor *floor, Vec3 origin, Vec3 direction) {
    if (!floor->there || !(direction.y < 0.0f) || !(origin.y > floor->middle.y)) return -1.0f;
    float t = (floor->middle.y - origin.y) / direction.y;
    Vec3 point = vec3_madd(origin, direction, t);
    return floor_coverage(floor, point) > 0.0f ? t : -1.0f;
}
