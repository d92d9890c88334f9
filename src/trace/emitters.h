/* emitters.h - emissive triangles as one light, chosen by power */
#ifndef WEFT_TRACE_EMITTERS_H
#define WEFT_TRACE_EMITTERS_H

#include "scene/scene.h"
#include "trace/distribution.h"
#include "trace/light_rows.h"

typedef struct Emitters {
    const WeftScene *scene; /* borrowed */
    int count;
    struct Emitter *triangles;
    Distribution choice;
    uint32_t *mesh_first; /* emitter of a mesh's triangle 0, + 1; 0: emits nothing */
} Emitters;

/* Fills emitters; its arrays come from arena. false when memory is short. */
bool emitters_make(Emitters *emitters, const WeftScene *scene, Arena *arena);

/* Samples for n points and (u, v) as arrays: u chooses the triangle, and what it has left after that is u of
 * its point. */
void emitters_sample_rows(const Emitters *emitters, int n, const float *const point[3], const float *u,
                          const float *v, LightRows *samples);

typedef struct EmitterPoint {
    Vec3 direction; /* unit, from the point to the emitter */
    float distance;
    Rgb radiance;
    float pdf; /* 1/sr as seen from the point; 0: no sample */
} EmitterPoint;

/* The point (u, v) of emitter k; its pdf contains the probability of having chosen k by `choice`. */
EmitterPoint emitters_sample(const Emitters *emitters, int k, Vec3 point, float u, float v);

/* Density with which emitters_sample, from a point at distance t, finds that triangle's point seen under
 * `cosine`. */
float emitters_pdf(const Emitters *emitters, uint32_t mesh, uint32_t triangle, float t, float cosine);

#endif
