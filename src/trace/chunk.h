/* chunk.h - vertices of paths that lie on one material, as arrays, from the hit to the ray that goes on */
#ifndef WEFT_TRACE_CHUNK_H
#define WEFT_TRACE_CHUNK_H

#include "trace/path_context.h"
#include "trace/stages.h"
#include "weave/cloth_base.h"

enum {
    PATHS_SAMPLES_LOG2 = 4, /* an id is the pixel's number in its tile, then that of its sample */
    PATHS_MOST = 256 << PATHS_SAMPLES_LOG2,
    PATHS_ROOM = PATHS_MOST + ROW_LANES,
};

/* Paths on their way: rays, and what light that they bring is worth. */
typedef struct Paths {
    uint32_t id[PATHS_ROOM], key[PATHS_ROOM]; /* key: of the ray, see Ray */
    float o[3][PATHS_ROOM], d[3][PATHS_ROOM];
    float throughput[3][PATHS_ROOM];
    float sky
        [3]
        [PATHS_ROOM]; /* the same for the environment, where that is reflected in parts; not the camera's */
    float pdf[PATHS_ROOM];       /* of the direction; 0: the camera's, or a mirror's */
    float normal[3][PATHS_ROOM]; /* of where it comes from, if pdf > 0 */
} Paths;

/* Radiance and coverage by a path's id. */
typedef struct Light4 {
    float c[4][PATHS_ROOM];
} Light4;

typedef struct PathKeys {
    uint32_t pixel[256], sample[1 << PATHS_SAMPLES_LOG2];
} PathKeys;

typedef float Row[ROW_ROOM];

/* Textures looked up at a chunk's vertices. Inputs that share a texture and its placement share the texels. */
typedef struct TexelRows {
    const WeftScene *scene;
    const Input *last;          /* the input that was looked up last; NULL: none */
    const SrgbTable *last_srgb; /* how it was decoded; NULL: not */
    int n;
    Row uv[2][2];           /* texture coordinates, by set */
    Row place[2], texel[4]; /* after the input's placement; RGBA */
} TexelRows;

/* Directions and positions are the world's but for those of `vertices`, which are the shading frame's. */
typedef struct Chunk {
    uint32_t id[ROW_ROOM], key[ROW_ROOM], pixel[ROW_ROOM], sample[ROW_ROOM];
    uint32_t mesh[ROW_ROOM], triangle[ROW_ROOM];
    Row wo[3], throughput[3], pdf, t, u, v;
    Row corner[3][3], corner_normal[3][3], tangent[3], handedness; /* by vertex of the triangle, by axis */
    Row position[3], lifted[3], origin[3];                         /* origin: where rays start that leave */
    Row behind[3];                     /* the same on the far side, if the material transmits */
    Row geometric[3], normal[3], side; /* on the viewer's side; side: 1 or -1, the triangle's */
    Row *facing;                       /* of both, the normal below whose plane no light counts */
    Row uv_edge[2][2];                 /* texture coordinates along two edges of a woven triangle */
    ClothLooks looks;                  /* at a woven cloth */
    Row frame[3][3];                   /* x, y, z of it */
    KindVertices vertices;
    LightRows light[LIGHT_GROUPS];
    Row f_sky[3];      /* of the drawn wi as it is for the environment, in parts */
    Row added[3], far; /* what a light sample brings if nothing is in its way; below 0: nothing */
    Row goes, next[3], worth[3], gain; /* whether it goes on (1 or 0), where to, what light from there is
                                          worth, and over f cos what it was */
    int list[ROW_ROOM];                /* those with a shadow ray, or with a way on */
    bool hidden[ROW_ROOM];
    struct {
        Row o[3], d[3], far;
        uint32_t key[ROW_ROOM];
    } shadow;
    int filled, filled_rows; /* the material, + 1, whose inputs vertices.surface has, and in how many rows */
    TexelRows textures;
    Stack stack;
    StackView view;
    StageClock *clock; /* NULL: not asked for */
} Chunk;

/* The vertices that a chunk is made of: n of the paths in order, up to row_whole(n) valid ones, that hit the material. */
typedef struct ChunkSource {
    const PathContext *context;
    const Paths *paths;
    const float *t, *u, *v;
    const uint32_t *mesh, *triangle;
    const PathKeys *keys;
    const int *order;
    int n, material, depth;
} ChunkSource;

/* vertex.c: fills the chunk up to its inputs, and up to its frames. */
void chunk_place(Chunk *chunk, const ChunkSource *source);
void chunk_turn(Chunk *chunk, const ChunkSource *source);

/* footprint.c: weaves the bases of n vertices, after their inputs. */
void chunk_weave(Chunk *chunk, const ChunkSource *source, int n);

/* inputs.c: fills n rows of the material's inputs. */
void chunk_take_inputs(Chunk *chunk, const ChunkSource *source, int n);

/* lit.c: adds what the surface itself sends out, and the light of one group; returns how many rays that took.
 */
void chunk_add_emission(Chunk *chunk, const ChunkSource *source, Light4 *light);
int chunk_add_light(Chunk *chunk, const ChunkSource *source, LightGroup group, Light4 *light);

/* shade.c: samples lights and the material, and evaluates the material for all of them. */
void chunk_shade(Chunk *chunk, const ChunkSource *source);

/* Appends the rays that go on to paths, of which there are `at`; returns how many there are then. */
int chunk_go_on(Chunk *chunk, const ChunkSource *source, Paths *paths, int at);

/* Weight of the lobe's sample with that pdf, 0 of the camera, where lights have the density b. Eric Veach,
 * "Robust Monte Carlo Methods for Light Transport Simulation", 1997, power heuristic, Equation 9.13. */
static inline float lobe_weight(WeftSampling sampling, float pdf, float b) {
    float some = pdf > 0.0f ? pdf : 1.0f,
          both = some / (some + b * (b / some)); /* never 0 / 0: a loop evaluates both */
    float one = sampling == WEFT_SAMPLING_LIGHT && b > 0.0f ? 0.0f : 1.0f;
    return pdf > 0.0f ? sampling == WEFT_SAMPLING_MIS ? both : one : 1.0f;
}

#endif
