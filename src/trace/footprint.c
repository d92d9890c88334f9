/* footprint.c - the part of a woven cloth that a path covers where it meets it
 *
 *   P' = a - d (n . a) / (n . d)
 *
 * is where the edge a of a pixel, at right angles to the ray along d, lies on the plane of a triangle with normal n.
 * Homan Igehy, "Tracing Ray Differentials", SIGGRAPH 1999, Equation 10, without what turns. A pixel of the camera is
 * as wide as the picture says. A path that was scattered stands for all those around it: of n directions with the
 * density p each has 1 / (n p) of the sphere, and from there on a cone as wide. */
#include "base/pi.h"
#include "shading/frame.h"
#include "trace/chunk.h"
#include "trace/sampler.h"

enum { SCATTERED = 16 }; /* directions that take a share of the sphere */

/* The width of what path k covers, across its ray. */
static float width_of(const Chunk *c, const ChunkSource *from, int k) {
    const PathContext *context = from->context;
    const float *f = context->forward;
    if (from->depth > 0 && c->pdf[k] > 0.0f)
        return c->t[k] * fminf(sqrtf(1.0f / ((float)SCATTERED * c->pdf[k])), 1.0f);
    const float depth = -c->t[k] * (c->wo[0][k] * f[0] + c->wo[1][k] * f[1] + c->wo[2][k] * f[2]);
    return context->pixel[0] + context->pixel[1] * fabsf(from->depth > 0 ? c->t[k] : depth);
}

static Dir minus(Dir a, Dir b) { return dir(a.x - b.x, a.y - b.y, a.z - b.z); }

/* Texture coordinates of a triangle's corners from the first: by two edges, which the plane's vectors are made of. */
typedef struct UvPlane {
    Dir first, second, normal; /* edges, and their product */
    float u[2], v[2];          /* along either */
} UvPlane;

static UvPlane plane_of(const Chunk *c, const ChunkSource *from, int k) {
    const Mesh *mesh = &from->context->scene->meshes[c->mesh[k]];
    const uint32_t *index = mesh->index + 3 * (size_t)c->triangle[k];
    const Dir a = ROW_DIR(c->corner[0], k);
    UvPlane p = {.first = minus(ROW_DIR(c->corner[1], k), a), .second = minus(ROW_DIR(c->corner[2], k), a)};
    p.normal = dir_cross(p.first, p.second);
    for (int corner = 0; mesh->texcoord[0] && corner < 2; corner++) {
        const float *at = mesh->texcoord[0] + 2 * (size_t)index[corner + 1],
                    *zero = mesh->texcoord[0] + 2 * (size_t)index[0];
        p.u[corner] = at[0] - zero[0];
        p.v[corner] = at[1] - zero[1];
    }
    return p;
}

/* The edge of a pixel on the plane, in texture coordinates. */
static void project(const UvPlane *p, Dir d, Dir edge, float uv[2]) {
    const float square = fmaxf(dir_dot(p->normal, p->normal), 1e-30f), facing = dir_dot(p->normal, d);
    const float least = 1e-2f * sqrtf(square), by = fabsf(facing) > least ? facing
                                                    : facing < 0.0f       ? -least
                                                                          : least;
    const Dir on = minus(edge, dir_scale(d, dir_dot(p->normal, edge) / by));
    const float b = dir_dot(dir_cross(on, p->second), p->normal) / square,
                c = dir_dot(dir_cross(p->first, on), p->normal) / square;
    uv[0] = b * p->u[0] + c * p->u[1];
    uv[1] = b * p->v[0] + c * p->v[1];
}

ClothLook chunk_look(const Chunk *c, const ChunkSource *from, int k) {
    const PathMaterial *material = &from->context->materials[from->material];
    const float *per_uv = material->cloth->per_uv;
    const uint32_t place = 64u * (uint32_t)from->depth;
    const UvPlane plane = plane_of(c, from, k);
    const Dir d = dir_scale(ROW_DIR(c->wo, k), -1.0f);
    const Dir side =
        dir_normal_or(dir_cross(d, fabsf(d.y) < 0.9f ? dir(0.0f, 1.0f, 0.0f) : dir(1.0f, 0.0f, 0.0f)), d);
    const float width = width_of(c, from, k);
    float a[2], b[2];
    project(&plane, d, dir_scale(side, width), a);
    project(&plane, d, dir_scale(dir_cross(side, d), width), b);
    ClothLook look = {.uv = {c->textures.uv[0][0][k], c->textures.uv[0][1][k]},
                      .level = sampler_random(c->pixel[k], c->sample[k], 1000003u + place),
                      .system = sampler_random(c->pixel[k], c->sample[k], 1000033u + place),
                      .holed = material->material.alpha_mode != WEFT_ALPHA_OPAQUE};
    look.footprint = weave_footprint(a[0] * per_uv[0], a[1] * per_uv[1], b[0] * per_uv[0], b[1] * per_uv[1]);
    return look;
}
