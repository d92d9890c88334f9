/* emitters.h - emissive triangles as one light, sampled in proportion to about what each contributes to a point */
#pragma once

#include "scene/record/scene.h"
#include "trace/light/light_rows.h"
#include "trace/light/light_tree.h"

typedef struct Emitters {
    const WeftScene *scene; /* borrowed */
    int count;
    struct Emitter *triangles;
    float *numbers; /* of each triangle, for loops of vectors */
    bool uniform;   /* each triangle emits the same radiance everywhere */
    LightTree tree;
    uint32_t *mesh_first; /* emitter of a mesh's triangle 0, + 1; 0: emits nothing */
} Emitters;

/* Fills emitters; its arrays come from arena. Returns false if memory is short. */
bool emitters_make(Emitters *emitters, const WeftScene *scene, Arena *arena);

/* Samples the emitters for n <= ROW_MOST points with normals and (u, v) as arrays, n a multiple of ROW_LANES. u chooses
 * the triangle; its position in that triangle's interval and v choose the point there. pdf: 1/sr as seen from the
 * point; 0: no sample. */
void emitters_sample_rows(const Emitters *emitters, int n, const float *const point[3], const float *const normal[3],
                          const float *u, const float *v, LightRows *samples);

/* Returns the density, 1/sr, with which emitters_sample_rows, from a point with that normal, finds a point of that
 * triangle at distance t under `cosine`. */
float emitters_pdf(const Emitters *emitters, uint32_t mesh, uint32_t triangle, Vec3 point, Vec3 normal, float t,
                   float cosine);
