#include "scene/record/tangents.h"

#include "base/equal.h"
#include "base/fail.h"

const Input *tangents_input(const Material *material) {
    static const InputId maps[] = {INPUT_normal, INPUT_clearcoat_normal, INPUT_anisotropy_direction,
                                   INPUT_nap_direction, INPUT_coat_anisotropy_direction};
    const Input *inputs = material->inputs;
    for (size_t k = 0; k < sizeof maps / sizeof *maps; k++)
        if (inputs[maps[k]].texture) return &inputs[maps[k]];
    if (material->cloth || material->measured) return &inputs[INPUT_normal];
    if (inputs[INPUT_anisotropy].value[0] > 0.0f) return &inputs[INPUT_anisotropy];
    if (inputs[INPUT_coat_anisotropy].value[0] > 0.0f) return &inputs[INPUT_coat_anisotropy];
    return inputs[INPUT_nap].value[0] > 0.0f ? &inputs[INPUT_nap] : NULL;
}

bool tangents_possible(const Mesh *mesh, const Input *input) {
    const float *uv = mesh->texcoord[input->texcoord];
    bool same = true;
    for (size_t k = 2; uv && same && k < 2 * (size_t)mesh->vertex_count; k++) same = is_equal(uv[k], uv[k % 2]);
    return uv && !same;
}

typedef struct Vec2 {
    float u, v;
} Vec2;

static Vec2 placed(const Mesh *mesh, const Input *input, uint32_t vertex) {
    const float *uv = mesh->texcoord[input->texcoord] + 2 * (size_t)vertex, *m = input->transform;
    return (Vec2){m[0] * uv[0] + m[1] * uv[1] + m[2], m[3] * uv[0] + m[4] * uv[1] + m[5]};
}

/* Adds a triangle's direction of growing u, as long as its extent in v, to its corners; w counts which way
 * the map lies, positive where it is upright: v runs down. */
static void add_triangle(const Mesh *mesh, const Input *input, const uint32_t *corner, float *tangent) {
    Vec2 uv[3];
    Vec3 p[3];
    for (int k = 0; k < 3; k++) {
        uv[k] = placed(mesh, input, corner[k]);
        p[k] = vec3_load(mesh->position + 3 * (size_t)corner[k]);
    }
    float u1 = uv[1].u - uv[0].u, v1 = uv[1].v - uv[0].v, u2 = uv[2].u - uv[0].u, v2 = uv[2].v - uv[0].v;
    float area = u1 * v2 - u2 * v1, upright = area < 0.0f ? 1.0f : -1.0f;
    Vec3 along =
        vec3_sub(vec3_scale(vec3_sub(p[2], p[0]), upright * v1), vec3_scale(vec3_sub(p[1], p[0]), upright * v2));
    float size = vec3_length(along);
    if (!isfinite(size) || !(area < 0.0f || area > 0.0f)) return;
    for (int k = 0; k < 3; k++) {
        float *t = tangent + 4 * (size_t)corner[k];
        t[0] += along.x, t[1] += along.y, t[2] += along.z, t[3] += upright * size;
    }
}

static bool mesh_tangents(WeftScene *scene, Mesh *mesh, const Input *input) {
    float *tangent = arena_array(&scene->arena, mesh->vertex_count, 4 * sizeof *tangent);
    if (!tangent) return false;
    for (size_t k = 0; k < mesh->triangle_count; k++) add_triangle(mesh, input, mesh->index + 3 * k, tangent);
    for (size_t k = 0; k < mesh->vertex_count; k++) {
        float *t = tangent + 4 * k;
        Vec3 n = mesh->normal ? vec3_load(mesh->normal + 3 * k) : vec3(0.0f, 0.0f, 0.0f), sum = vec3_load(t);
        Vec3 along = vec3_normal_or(vec3_madd(sum, n, -vec3_dot(sum, n)), vec3(1.0f, 0.0f, 0.0f));
        t[0] = along.x, t[1] = along.y, t[2] = along.z, t[3] = t[3] < 0.0f ? -1.0f : 1.0f;
    }
    mesh->tangent = tangent;
    return true;
}

WeftResult tangents_complete(WeftScene *scene, WeftError *error) {
    for (int m = 0; m < scene->mesh_count; m++) {
        Mesh *mesh = &scene->meshes[m];
        const int back = scene_back(scene, mesh->material);
        const Input *input = tangents_input(&scene->materials[mesh->material]);
        if (!input && back >= 0) input = tangents_input(&scene->materials[back]);
        if (!input || mesh->tangent || !tangents_possible(mesh, input)) continue;
        if (!mesh_tangents(scene, mesh, input)) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    }
    return WEFT_OK;
}
