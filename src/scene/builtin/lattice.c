#include "scene/builtin/lattice.h"

#include <string.h>

/* Returns the normal of a smooth sheet, by differences. */
static Vec3 normal_at(const Lattice *lattice, float u, float v) {
    const float step = 1e-3f, v0 = fmaxf(v - step, 0.0f), v1 = fminf(v + step, 1.0f);
    Vec3 along = vec3_sub(lattice->point(u + step, v), lattice->point(u - step, v));
    Vec3 down = vec3_sub(lattice->point(u, v1), lattice->point(u, v0));
    return vec3_normal_or(vec3_cross(down, along), (Vec3){0.0f, 1.0f, 0.0f});
}

bool lattice_make(Arena *arena, Mesh *mesh, const Lattice *lattice) {
    const uint32_t row = lattice->across + 1;
    const float width = lattice->span[0] > 0.0f ? lattice->span[0] : 1.0f,
                height = lattice->span[1] > 0.0f ? lattice->span[1] : 1.0f;
    mesh->vertex_count = row * (lattice->down + 1);
    mesh->triangle_count = 2 * lattice->across * lattice->down;
    mesh->position = arena_array(arena, mesh->vertex_count, 3 * sizeof(float));
    mesh->normal = lattice->smooth ? arena_array(arena, mesh->vertex_count, 3 * sizeof(float)) : NULL;
    mesh->texcoord[0] = arena_array(arena, mesh->vertex_count, 2 * sizeof(float));
    mesh->index = arena_array(arena, mesh->triangle_count, 3 * sizeof(uint32_t));
    if (!mesh->position || (lattice->smooth && !mesh->normal) || !mesh->texcoord[0] || !mesh->index) return false;
    for (uint32_t k = 0; k < mesh->vertex_count; k++) {
        uint32_t i = k % row, j = k / row;
        float u = (float)i / (float)lattice->across, v = (float)j / (float)lattice->down;
        Vec3 p = vec3_add(lattice->point(u, v), lattice->at), n = normal_at(lattice, u, v);
        memcpy(mesh->position + 3 * k, &p, sizeof p);
        if (mesh->normal) memcpy(mesh->normal + 3 * k, &n, sizeof n);
        mesh->texcoord[0][2 * k] = width * u, mesh->texcoord[0][2 * k + 1] = height * v;
    }
    uint32_t *index = mesh->index;
    for (uint32_t k = 0; k < lattice->across * lattice->down; k++) {
        uint32_t i = k % lattice->across, j = k / lattice->across, a = j * row + i, b = a + row;
        *index++ = a, *index++ = b, *index++ = a + 1;
        *index++ = a + 1, *index++ = b, *index++ = b + 1;
    }
    return true;
}
