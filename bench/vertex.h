/* vertex.h - what bench_vertex asks of a build: a module that shades vertices, each a stack, its value for a
 * light, a sample, and the value of that */
#ifndef WEFT_BENCH_VERTEX_H
#define WEFT_BENCH_VERTEX_H

enum { VERTEX_COUNT = 256, VERTEX_MATERIALS = 2 };

/* Colours and roughnesses of a cloth, directions and random numbers, a vertex each; what comes of them. */
typedef struct VertexArrays {
    float o[3][VERTEX_COUNT], light[3][VERTEX_COUNT], u[VERTEX_COUNT], v[VERTEX_COUNT];
    float base[3][VERTEX_COUNT], roughness[VERTEX_COUNT], sheen[3][VERTEX_COUNT], sheen_roughness[VERTEX_COUNT];
    float out[11][VERTEX_COUNT]; /* f cos and pdf for the light, the sample, f cos and pdf for that */
} VertexArrays;

/* material: 0 is a cloth, 1 a floor without a sheen. once: all vertices are of the first one's surface, and
 * what does not depend on directions may be made before. */
typedef void VertexRun(VertexArrays *a, int material, int once);
VertexRun vertex_run;
VertexRun vertex_run_kind; /* the same by the kind of the material (shading/kinds/kind.h) */

#endif
