/* emitters.h - emissive triangles as one light, chosen by about what each sends to a point */
#ifndef WEFT_TRACE_EMITTERS_H
#define WEFT_TRACE_EMITTERS_H

#include "scene/record/scene.h"
#include "trace/light_rows.h"
#include "trace/light_tree.h"

typedef struct Emitters {
    const WeftScene *scene; /* borrowed */
    int count;
    struct Emitter *triangles;
    float *numbers; /* of each triangle, for loops of vectors */
    bool even;      /* each triangle sends out the same everywhere */
    LightTree tree;
    uint32_t *mesh_first; /* emitter of a mesh's triangle 0, + 1; 0: emits nothing */
} Emitters;

/* Fills emitters; its arrays come from arena. false when memory is short. */
bool emitters_make(Emitters *emitters, const WeftScene *scene, Arena *arena);

/* Samples for n <= ROW_MOST points with normals and (u, v) as arrays, n a multiple of ROW_LANES: u chooses the
 * triangle, and what it has left after that is u of its point. pdf: 1/sr as seen from the point; 0: no sample. */
void emitters_sample_rows(const Emitters *emitters, int n, const float *const point[3],
                          const float *const normal[3], const float *u, const float *v, LightRows *samples);

/* Density with which that, from a point with that normal and at distance t, finds that triangle's point seen
 * under `cosine`. */
float emitters_pdf(const Emitters *emitters, uint32_t mesh, uint32_t triangle, Vec3 point, Vec3 normal,
                   float t, float cosine);

#endif
