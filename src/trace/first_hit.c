#include "trace/first_hit.h"

void first_hits_take(FirstHits *hits, const Chunk *c, int n, Row normal[3], const float forward[3]) {
    for (int k = 0; k < n; k++) {
        uint32_t id = c->id[k];
        float seen = hits->number[FIRST_SEEN][id], cosine = 0.0f;
        for (int a = 0; a < 3; a++) {
            cosine -= c->wo[a][k] * forward[a];
            hits->number[FIRST_ALBEDO + a][id] = seen * c->vertices.surface.base_color[a][k];
            hits->number[FIRST_NORMAL + a][id] = seen * normal[a][k];
        }
        hits->number[FIRST_DEPTH][id] = seen * c->t[k] * cosine;
    }
}
