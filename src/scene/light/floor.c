#include "scene/light/floor.h"

#include <math.h>
#include <string.h>

#include "base/fail.h"
#include "base/path.h"

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

/* Returns true if a material of the scene's own meshes emits. */
static bool emits(const WeftScene *scene) {
    for (int m = 0; m < scene_own_meshes(scene); m++) {
        const Material *material = &scene->materials[scene->meshes[m].material];
        const float *color = material->inputs[INPUT_emission].value;
        if (material->inputs[INPUT_emission_strength].value[0] * (color[0] + color[1] + color[2]) > 0.0f) return true;
    }
    return false;
}

/* Returns the area of a triangle seen from above; 0 if it is not level, looks down or reaches higher than `top`. */
static float level_area(const Mesh *mesh, const uint32_t *corner, float top) {
    Vec3 p[3];
    for (int k = 0; k < 3; k++) {
        p[k] = vec3_load(mesh->position + 3 * (size_t)corner[k]);
        if (p[k].y > top) return 0.0f;
    }
    const Vec3 n = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
    return n.y > 0.99f * vec3_length(n) ? 0.5f * n.y : 0.0f;
}

/* Returns true if the scene stands on a floor of its own. */
static bool has_floor(const WeftScene *scene) {
    const Vec3 size = vec3_sub(scene->high, scene->low);
    const float top = scene->low.y + 0.01f * vec3_length(size);
    double area = 0.0;
    for (int m = 0; m < scene_own_meshes(scene); m++)
        for (uint32_t k = 0; k < scene->meshes[m].triangle_count; k++)
            area += (double)level_area(&scene->meshes[m], scene->meshes[m].index + 3 * (size_t)k, top);
    return area >= 0.5 * (double)size.x * (double)size.z;
}

WeftFloor weft_scene_stage(const WeftScene *scene) {
    const bool stands = path_builtin(scene->name) || scene->light_count > 0 || scene->polygon_light_count > 0 ||
                        scene->environment.kind != ENVIRONMENT_STUDIO || emits(scene) || has_floor(scene);
    return stands ? (WeftFloor){0} : (WeftFloor){.on = 1, .reflection = 0.0f, .roughness = 0.3f};
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
