/* footprint.c - the part of a woven cloth that a path covers where it meets it
 *
 *   P' = a - d (n . a) / (n . d)
 *
 * is the projection of the edge a of a pixel, at right angles to the ray along d, onto the plane of a triangle with
 * normal n. Homan Igehy, "Tracing Ray Differentials", SIGGRAPH 1999, Equation 10, without its changes of direction. A
 * camera ray is as wide as its pixel. A scattered ray is a cone: each of SCATTERED directions drawn with the density p
 * covers 1 / (SCATTERED p) of the sphere. */
#include "shading/dialect/loop.h"
#include "shading/stack/frame.h"
#include "trace/geometry/sampler.h"
#include "trace/path/chunk.h"

enum { SCATTERED = 16 };

/* Returns the width of path k across its ray, metres. */
FN float width_of(const Chunk *chunk, const float forward[3], const float pixel[2], bool scattered, size_t k) {
    float p = chunk->pdf[k], t = chunk->t[k];
    float depth = -t * (chunk->wo[0][k] * forward[0] + chunk->wo[1][k] * forward[1] + chunk->wo[2][k] * forward[2]);
    float seen = pixel[0] + pixel[1] * abs(scattered ? t : depth);
    float spread = t * min(sqrt(1.0f / ((float)SCATTERED * max(p, 1e-20f))), 1.0f);
    float least = scattered ? 0.0f : 3e38f; /* a bool that is the same for all would keep the loop from vectors */
    return p > least ? spread : seen;
}

FN Dir minus(Dir a, Dir b) { return dir(a.x - b.x, a.y - b.y, a.z - b.z); }

/* The plane of a triangle: two edges from the first corner, and the texture coordinates along each. */
typedef struct UvPlane {
    Dir first, second, normal; /* the edges and their cross product */
    float u[2], v[2];          /* by edge */
} UvPlane;

FN UvPlane plane_of(const Chunk *chunk, size_t k) {
    Dir a = ROW_DIR(chunk->corner[0], k);
    UvPlane p;
    p.first = minus(ROW_DIR(chunk->corner[1], k), a);
    p.second = minus(ROW_DIR(chunk->corner[2], k), a);
    p.normal = dir_cross(p.first, p.second);
    p.u[0] = chunk->uv_edge[0][0][k];
    p.v[0] = chunk->uv_edge[0][1][k];
    p.u[1] = chunk->uv_edge[1][0][k];
    p.v[1] = chunk->uv_edge[1][1][k];
    return p;
}

/* The edge of a pixel on the plane, in texture coordinates. */
typedef struct UvEdge {
    float u, v;
} UvEdge;

/* Projects the edge of a pixel along d onto the plane. At grazing angles d counts as 0.01 from the plane. */
FN UvEdge project(UvPlane p, Dir d, Dir edge) {
    float square = max(dir_dot(p.normal, p.normal), 1e-30f), facing = dir_dot(p.normal, d);
    float least = 1e-2f * sqrt(square), by = abs(facing) > least ? facing : facing < 0.0f ? -least : least;
    Dir on = minus(edge, dir_scale(d, dir_dot(p.normal, edge) / by));
    float b = dir_dot(dir_cross(on, p.second), p.normal) / square,
          c = dir_dot(dir_cross(p.first, on), p.normal) / square;
    UvEdge e = {b * p.u[0] + c * p.u[1], b * p.v[0] + c * p.v[1]};
    return e;
}

/* Gathers the differences of texture coordinates along two edges of the triangles. */
static void gather_uv_edges(Chunk *chunk, const WeftScene *scene, int set, int n) {
    for (int k = 0; k < n; k++) {
        const Mesh *mesh = &scene->meshes[chunk->mesh[k]];
        const uint32_t *index = mesh->index + 3 * (size_t)chunk->triangle[k];
        for (int edge = 0; edge < 2; edge++)
            for (int a = 0; a < 2; a++)
                chunk->uv_edge[edge][a][k] = mesh->texcoord[set]
                                                 ? mesh->texcoord[set][2 * index[edge + 1] + (uint32_t)a] -
                                                       mesh->texcoord[set][2 * index[0] + (uint32_t)a]
                                                 : 0.0f;
    }
}

/* The two edges of a pixel on the plane. */
typedef struct UvEdges {
    UvEdge a, b;
} UvEdges;

/* Returns the edges of the pixel of path k: the first level, the second upright in the picture of an upright camera. */
FN UvEdges edges_of(const Chunk *chunk, const float forward[3], const float pixel[2], bool scattered, size_t k) {
    UvPlane plane = plane_of(chunk, k);
    Dir d = dir_scale(ROW_DIR(chunk->wo, k), -1.0f);
    bool level = abs(d.y) < 0.9f;
    Dir side = dir_normal_or(dir_cross(d, dir(level ? 0.0f : 1.0f, level ? 1.0f : 0.0f, 0.0f)), d);
    float width = width_of(chunk, forward, pixel, scattered, k);
    UvEdges edges = {project(plane, d, dir_scale(side, width)),
                     project(plane, d, dir_scale(dir_cross(side, d), width))};
    return edges;
}

/* Returns the footprint of a pixel with edges a and b on the cloth. */
FN WeaveFootprint footprint_of(WeavePlacing cloth, UvEdge a, UvEdge b) {
    Dir first = weave_threads(cloth, a.u, a.v), second = weave_threads(cloth, b.u, b.v);
    return weave_footprint(first.x, first.y, second.x, second.y);
}

/* Fills where and how finely the cloth is looked up. */
LOOP(footprints_n, (Chunk *restrict chunk, const PathContext *context, const WeftCloth *cloth, int depth, int n),
     (chunk, context, cloth, depth, n)) {
    ClothLooks *to = &chunk->cloth_points;
    const float forward[3] = {context->forward[0], context->forward[1], context->forward[2]};
    const float pixel[2] = {context->pixel_width[0], context->pixel_width[1]};
    WeavePlacing placing = cloth_placing(cloth);
    uint32_t pair = SAMPLER_CLOTH + (uint32_t)depth;
    EACH(k, (size_t)n) {
        UvEdges edges = edges_of(chunk, forward, pixel, depth > 0, k);
        WeaveFootprint f = footprint_of(placing, edges.a, edges.b);
        to->uv[0][k] = chunk->textures.uv[0][0][k];
        to->uv[1][k] = chunk->textures.uv[0][1][k];
        to->footprint_x[k] = f.x;
        to->footprint_y[k] = f.y;
        to->longest[k] = f.longest;
        Point p = sampler_point(chunk->pixel[k], chunk->sample[k], pair);
        to->level[k] = p.u;
        to->facet[k] = p.v;
        to->wear[k] = chunk->vertices.surface.wear[k];
    }
}

void chunk_find_threads(Chunk *chunk, const ChunkSource *source, int n) {
    const PathMaterial *material = &source->context->materials[source->material];
    gather_uv_edges(chunk, source->context->scene, 0, n);
    footprints_n(chunk, source->context, material->cloth, source->depth, n);
    chunk->cloth_points.holed = material->material.alpha_mode != WEFT_ALPHA_OPAQUE;
    bool seen = source->context->first_hits && source->depth == 0;
    cloth_bases(material->cloth, &chunk->cloth_points, n, &chunk->vertices.yarn, seen ? &chunk->cloth_guide : NULL);
}

/* Fills the edges of pixels, and the numbers by which one of two levels is looked up. */
LOOP(edges_n, (Chunk *restrict chunk, const PathContext *context, int set, int depth, int n),
     (chunk, context, set, depth, n)) {
    const float forward[3] = {context->forward[0], context->forward[1], context->forward[2]};
    const float pixel[2] = {context->pixel_width[0], context->pixel_width[1]};
    uint32_t pair = SAMPLER_CLOTH + (uint32_t)depth;
    TexelRows *to = &chunk->textures;
    EACH(k, (size_t)n) {
        UvEdges edges = edges_of(chunk, forward, pixel, depth > 0, k);
        to->edges[set][0][0][k] = edges.a.u;
        to->edges[set][0][1][k] = edges.a.v;
        to->edges[set][1][0][k] = edges.b.u;
        to->edges[set][1][1][k] = edges.b.v;
        to->chance[k] = sampler_point(chunk->pixel[k], chunk->sample[k], pair).u;
    }
}

void chunk_find_edges(Chunk *chunk, const ChunkSource *source, int set, int n) {
    gather_uv_edges(chunk, source->context->scene, set, n);
    edges_n(chunk, source->context, set, source->depth, n);
}
