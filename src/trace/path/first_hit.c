#include "trace/path/first_hit.h"

void first_hits_take(FirstHits *hits, const Chunk *chunk, int n, Row normal[3], const float forward[3]) {
    for (int k = 0; k < n; k++) {
        uint32_t id = chunk->id[k];
        float seen = hits->number[FIRST_SEEN][id], cosine = 0.0f;
        for (int a = 0; a < 3; a++) {
            cosine -= chunk->wo[a][k] * forward[a];
            hits->number[FIRST_ALBEDO + a][id] = seen * chunk->vertices.surface.base_color[a][k];
            hits->number[FIRST_NORMAL + a][id] = seen * normal[a][k];
        }
        hits->number[FIRST_DEPTH][id] = seen * chunk->t[k] * cosine;
    }
}
