/* chunk.h - vertices of paths that lie on one material, as arrays, from the hit to the ray that continues
 *
 * The stages of a chunk, in the order of calls:
 *   chunk_place          computes positions and normals at the hits, and reads the material's inputs there
 *   chunk_add_emission   adds the light that the surface emits, weighted against sampling it as a light
 *   chunk_make_frames    builds the shading frames and rotates wo into them
 *   chunk_shade          samples each group of lights and the material, and evaluates f cos and pdf for all of them
 *   chunk_add_light      traces the shadow rays of one group and adds the light that arrives
 *   chunk_continue       applies Russian roulette, and writes the rays of the next depth */
#pragma once

#include "trace/path/path_context.h"
#include "trace/path/stages.h"
#include "weave/cloth_base.h"

enum {
    PATHS_SAMPLES_LOG2 = 4, /* an id is the pixel's number in its tile, then that of its sample */
    PATHS_MAX = 256 << PATHS_SAMPLES_LOG2,
    PATHS_CAPACITY = PATHS_MAX + ROW_LANES,
};

/* The rays of one depth. throughput is the product of f cos / pdf over the vertices so far: a path contributes it times
 * the radiance that its ray finds. The camera's paths have no sky_throughput. */
typedef struct Paths {
    uint32_t id[PATHS_CAPACITY];
    uint32_t key[PATHS_CAPACITY];            /* of the ray, see Ray */
    float origin[3][PATHS_CAPACITY];         /* world space */
    float direction[3][PATHS_CAPACITY];      /* unit */
    float throughput[3][PATHS_CAPACITY];     /* 1 at the camera */
    float sky_throughput[3][PATHS_CAPACITY]; /* for the environment, if sky_in_parts */
    float pdf[PATHS_CAPACITY];               /* of the direction, 1/sr; 0 for the camera's and a mirror's */
    float horizon_normal[3][PATHS_CAPACITY]; /* of the vertex at the origin (see Chunk), if pdf > 0 */
    int inside[PATHS_CAPACITY]; /* 1 + the material whose solid glass the ray is in; 0: none; if `solids` */
} Paths;

/* The sums of finished paths, by their ids: radiance times coverage, and coverage. */
typedef struct PathRadiance {
    float rgba[4][PATHS_CAPACITY];
} PathRadiance;

/* The keys of random numbers (sampler.h) of the pixels of a tile, and of the samples of each pixel. */
typedef struct PathKeys {
    uint32_t pixel[256];
    uint32_t sample[1 << PATHS_SAMPLES_LOG2];
} PathKeys;

typedef float Row[ROW_CAPACITY];

/* Textures looked up at a chunk's vertices. Inputs that share a texture and its placement share the texels. */
typedef struct TexelRows {
    const WeftScene *scene;
    const Input *last;          /* the input that was looked up last; NULL: none */
    const SrgbTable *last_srgb; /* how it was decoded; NULL: not */
    int n;                      /* vertices */
    Row uv[2][2];               /* texture coordinates of the mesh, by set */
    Row placed_uv[2];           /* the same after the input's placement */
    Row texel[4];               /* RGBA */
    Row edges[2][2][2];         /* two edges of the pixel on the surface, in texture coordinates, by set */
    Row chance;                 /* by which one of two mip levels is looked up */
    int level[ROW_CAPACITY];    /* of textures that have levels of their own */
} TexelRows;

typedef struct LightBySlot LightBySlot; /* slot_light.h */

/* Directions are unit, and they and positions are in world space but for those of `vertices`, which are in the shading
 * frame. At all times only the members that the stages so far have filled are valid. */
typedef struct Chunk {
    /* the paths that arrive, as in Paths */
    uint32_t id[ROW_CAPACITY];
    uint32_t key[ROW_CAPACITY];
    uint32_t pixel[ROW_CAPACITY]; /* PathKeys of the id */
    uint32_t sample[ROW_CAPACITY];
    uint32_t mesh[ROW_CAPACITY];
    uint32_t triangle[ROW_CAPACITY];
    Row wo[3]; /* towards the origin of the ray */
    Row throughput[3];
    Row pdf;  /* of the ray's direction, 1/sr; 0 for the camera's and a mirror's */
    Row t;    /* distance along the ray, metres */
    Row u, v; /* barycentric weights of the second and third corner */

    /* the points that they hit */
    Row corner[3][3];         /* position, by vertex of the triangle, by axis */
    Row corner_normal[3][3];  /* 0 if the mesh has none */
    Row tangent[3];           /* as stored, on the viewer's side */
    Row handedness;           /* of the bitangent, 1 or -1 */
    Row position[3];          /* on the triangle */
    Row lifted[3];            /* on the smooth surface that the corner normals describe */
    Row origin[3];            /* of rays that leave on the viewer's side */
    Row origin_behind[3];     /* of rays that leave on the far side, if the material transmits */
    Row geometric[3];         /* normal of the triangle on the viewer's side */
    Row normal[3];            /* interpolated normal on the viewer's side */
    Row visible[3];           /* of the shading frame without a normal map: normal, where the viewer sees its side */
    int inside[ROW_CAPACITY]; /* of the path that arrives, as in Paths, if `solids` */
    Row side;                 /* 1 if the viewer sees the triangle's front, else -1 */
    Row *horizon_normal;      /* geometric or visible: light from below its plane does not count */
    Row uv_edge[2][2];        /* differences of texture coordinates along two edges, for threads and levels */
    ClothLooks cloth_points;  /* where and how finely a woven material is looked up */
    ClothGuide cloth_guide;   /* of camera rays, if first hits are recorded */
    Row frame[3][3];          /* x, y, z of the shading frame */
    KindVertices vertices;    /* inputs, directions, f cos and pdf in the shading frame */

    /* light samples, and the one of the material that continues the path */
    LightRows light_samples[LIGHT_GROUPS];
    Row f_cos_sky[3];    /* f cos of the drawn wi for light of the environment, if sky_in_parts */
    Row contribution[3]; /* radiance that a light sample adds if nothing occludes it */
    Row shadow_distance; /* to the sampled light, metres; below 0 if it contributes nothing */
    Row continues;       /* 1 if the path goes on, else 0 */
    Row next_direction[3];
    Row next_throughput[3];
    Row sample_weight;           /* next_throughput / (throughput f cos): 1 / (pdf times chance of survival) */
    int selected[ROW_CAPACITY];  /* indices of the vertices with a shadow ray, or of those that continue */
    bool occluded[ROW_CAPACITY]; /* by shadow ray */
    struct {
        Row origin[3];
        Row direction[3];
        Row distance; /* to just before the light, metres */
        uint32_t key[ROW_CAPACITY];
    } shadow_rays; /* of the selected vertices, in their order */

    int filled_material; /* 1 + the material whose untextured inputs vertices.surface contains; 0: none */
    int filled_rows;     /* in how many rows */
    TexelRows textures;
    Stack stack; /* of the vertex that is shaded by itself, and its view */
    StackView view;
    SolidGlass glass;          /* of such a vertex, if its material is solid */
    StageClock *clock;         /* NULL: stages are not timed */
    LightBySlot *slots;        /* NULL: light is not divided by slots */
    Rgb through[ROW_CAPACITY]; /* what panes leave of a shadow ray's light, if there are any */
} Chunk;

/* The vertices of a chunk: those of n paths that hit the material, picked by `order`, which is valid up to
 * row_whole(n). */
typedef struct ChunkSource {
    const PathContext *context;
    const Paths *paths;
    const float *t, *u, *v; /* hits of all paths, as in HitRows */
    const uint32_t *mesh, *triangle;
    const PathKeys *keys;
    const int *order; /* indices of paths */
    int n;
    int material;
    int depth; /* vertices before these; 0 at the camera's first hits */
} ChunkSource;

/* Fills the chunk from its paths and hits: positions, normals, inputs, and threads of a woven material (vertex.c). */
void chunk_place(Chunk *chunk, const ChunkSource *source);

/* Fills the shading frames, and wo in them (vertex.c). */
void chunk_make_frames(Chunk *chunk, const ChunkSource *source);

/* Takes from the paths what solid glass absorbs of their light (inside.c). */
void chunk_absorb(Chunk *chunk, const ChunkSource *source);

/* Returns in which solid light of vertex k is that arrives or leaves below its surface, if `below`, or above it, as
 * Paths have it (inside.c). */
int chunk_inside(const Chunk *chunk, const ChunkSource *source, int k, bool below);

/* Finds the threads of a woven material at n vertices; needs texture coordinates (footprint.c). */
void chunk_find_threads(Chunk *chunk, const ChunkSource *source, int n);

/* Finds the edges of pixels on a material with mip levels of its own, in a set of texture coordinates (footprint.c). */
void chunk_find_edges(Chunk *chunk, const ChunkSource *source, int set, int n);

/* Reads the material's inputs at n vertices (vertex_inputs.c). */
void chunk_read_inputs(Chunk *chunk, const ChunkSource *source, int n);

/* Adds the light that the surface emits (lit.c). */
void chunk_add_emission(Chunk *chunk, const ChunkSource *source, PathRadiance *radiance);

/* Adds the light of one group that arrives and is reflected; returns how many shadow rays that took (lit.c). */
int chunk_add_light(Chunk *chunk, const ChunkSource *source, LightGroup group, PathRadiance *radiance);

/* Samples lights and the material, and evaluates the material for all samples (shade.c). */
void chunk_shade(Chunk *chunk, const ChunkSource *source);

/* Appends the rays that continue to paths, of which there are `count`; returns how many there are then (shade.c). */
int chunk_continue(Chunk *chunk, const ChunkSource *source, Paths *paths, int count);

/* Returns the MIS weight of light found along a ray that was drawn with that pdf, 0 for the camera's, where sampling
 * lights has the density light_pdf. Eric Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997,
 * power heuristic, Equation 9.13. */
static inline float lobe_weight(WeftSampling sampling, float pdf, float light_pdf) {
    float safe_pdf = pdf > 0.0f ? pdf : 1.0f; /* never 0 / 0: a loop evaluates both */
    float mis = safe_pdf / (safe_pdf + light_pdf * (light_pdf / safe_pdf));
    float single = sampling == WEFT_SAMPLING_LIGHT && light_pdf > 0.0f ? 0.0f : 1.0f;
    return pdf > 0.0f ? sampling == WEFT_SAMPLING_MIS ? mis : single : 1.0f;
}
