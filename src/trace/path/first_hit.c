#include "trace/path/first_hit.h"

#include "shading/stack/frame.h"

/* Returns the normal of a thread at vertex k, turned towards the viewer where it faces away. */
static Dir thread_normal(const Chunk *chunk, size_t k) {
    Frame f = {ROW_DIR(chunk->frame[0], k), ROW_DIR(chunk->frame[1], k), ROW_DIR(chunk->frame[2], k)};
    Dir local = {chunk->cloth_guide.slope[0][k], chunk->cloth_guide.slope[1][k], 1.0f};
    return frame_visible_normal(dir_normal_or(frame_from(f, local), f.z), ROW_DIR(chunk->wo, k));
}

void first_hits_take(FirstHits *hits, const Chunk *chunk, int n, FirstLook look, const float forward[3]) {
    bool woven = look == FIRST_LOOK_WOVEN;
    const Row *albedo = woven ? chunk->cloth_guide.albedo : chunk->vertices.surface.base_color;
    const Row *level = look == FIRST_LOOK_UNSHADED ? chunk->normal : chunk->frame[2];
    for (int k = 0; k < n; k++) {
        uint32_t id = chunk->id[k];
        Dir normal = woven ? thread_normal(chunk, (size_t)k) : ROW_DIR(level, k);
        float seen = hits->number[FIRST_SEEN][id], cosine = 0.0f;
        for (int a = 0; a < 3; a++) {
            cosine -= chunk->wo[a][k] * forward[a];
            hits->number[FIRST_ALBEDO + a][id] = seen * albedo[a][k];
        }
        hits->number[FIRST_NORMAL][id] = seen * normal.x;
        hits->number[FIRST_NORMAL + 1][id] = seen * normal.y;
        hits->number[FIRST_NORMAL + 2][id] = seen * normal.z;
        hits->number[FIRST_DEPTH][id] = seen * chunk->t[k] * cosine;
    }
}

void first_hits_place(FirstHits *hits, const Chunk *chunk, int n, const WeftScene *scene) {
    for (int k = 0; k < n; k++) {
        uint32_t id = chunk->id[k];
        if (!(hits->number[FIRST_SEEN][id] > 0.0f)) continue;
        const Hit hit = {.t = chunk->t[k],
                         .mesh = chunk->mesh[k],
                         .triangle = chunk->triangle[k],
                         .u = chunk->u[k],
                         .v = chunk->v[k]};
        const Attributes at = geometry_attributes(&scene->meshes[hit.mesh], &hit);
        hits->mesh[id] = hit.mesh;
        for (int a = 0; a < 3; a++) hits->place[PLACE_POSITION + a][id] = chunk->position[a][k];
        for (int a = 0; a < 2; a++) hits->place[PLACE_UV + a][id] = at.uv[0][a];
    }
}
