/* inside.c - in which solid glass a path is, and what that absorbs */
#include <math.h>

#include "trace/path/chunk.h"

/* Returns true if the ray first meets the surface of a solid from within, at t. Other things on its way do not count. */
static bool leaves(const PathContext *context, int material, Ray ray, float *t) {
    enum { STEPS = 256 };
    Hit hit;
    for (int k = 0; k < STEPS && geometry_triangle(context->geometry, ray, &hit); k++) {
        *t = hit.t;
        if (context->scene->meshes[hit.mesh].material == material) return vec3_dot(hit.facing, ray.direction) > 0.0f;
        ray.near = geometry_past(hit.t);
    }
    return false;
}

int path_eye_inside(const PathContext *context, int materials, Vec3 eye) {
    const Ray ray = {.origin = eye, .direction = {0.36f, 0.48f, 0.8f}, .far = INFINITY};
    float nearest = INFINITY, t = 0.0f;
    int inside = 0;
    for (int k = 0; k < materials; k++) {
        if (!context->materials[k].solid || !leaves(context, k, ray, &t) || !(t < nearest)) continue;
        nearest = t;
        inside = k + 1;
    }
    return inside;
}

void chunk_absorb(Chunk *chunk, const ChunkSource *source) {
    const PathMaterial *materials = source->context->materials;
    for (int k = 0; k < source->n; k++) {
        const int inside = source->depth > 0 ? source->paths->inside[source->order[k]] : source->context->eye_inside;
        chunk->inside[k] = inside;
        if (!inside) continue;
        const Rgb left = solid_left(materials[inside - 1].absorption, chunk->t[k]);
        chunk->throughput[0][k] *= left.r;
        chunk->throughput[1][k] *= left.g;
        chunk->throughput[2][k] *= left.b;
    }
}

int chunk_inside(const Chunk *chunk, const ChunkSource *source, int k, bool below) {
    const bool solid = source->context->materials[source->material].solid;
    if (!below || !solid) return chunk->inside[k];
    return chunk->side[k] < 0.0f ? 0 : source->material + 1;
}
