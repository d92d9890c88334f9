/* inside.c - in which solid glass a path is, and what that absorbs */
#include "trace/path/chunk.h"

void chunk_absorb(Chunk *chunk, const ChunkSource *source) {
    const PathMaterial *materials = source->context->materials;
    for (int k = 0; k < source->n; k++) {
        const bool behind = materials[source->material].solid && chunk->side[k] < 0.0f;
        int inside = source->depth > 0 ? source->paths->inside[source->order[k]] : 0;
        if (!inside && behind) inside = source->material + 1; /* the camera is inside */
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
