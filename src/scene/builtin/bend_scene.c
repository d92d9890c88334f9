#include "scene/builtin/bend_scene.h"

#include <math.h>

#include "base/fail.h"
#include "scene/builtin/lattice.h"

static const float radius = 0.1f, height = 0.2f, half_angle = 1.3089969f; /* m, m, 75 degrees */
enum { AROUND = 150 };

static Vec3 bend_point(float u, float v) {
    const float angle = half_angle * (2.0f * u - 1.0f);
    return (Vec3){radius * sinf(angle), height * (0.5f - v), radius * cosf(angle)};
}

WeftResult bend_make(WeftScene *scene, WeftError *error) {
    const Lattice lattice = {
        .across = AROUND, .down = 1, .point = bend_point, .smooth = true, .span = {2.0f * half_angle * radius, height}};
    Arena *arena = &scene->arena;
    scene->meshes = arena_array(arena, 1, sizeof(Mesh));
    scene->materials = arena_array(arena, 1, sizeof(Material));
    scene->material_names = arena_array(arena, 1, sizeof(char *));
    if (!scene->meshes || !scene->materials || !scene->material_names)
        return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    scene->meshes[0] = (Mesh){.name = "cloth", .material = 0};
    scene->material_names[0] = "cloth";
    scene->materials[0] = material_default();
    scene->materials[0].double_sided = true;
    if (!lattice_make(arena, &scene->meshes[0], &lattice)) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    scene->mesh_count = scene->material_count = 1;
    scene_bounds(scene);
    return WEFT_OK;
}
