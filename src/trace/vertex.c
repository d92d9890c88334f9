/* vertex.c - the points that paths hit: position, normal, and the frame */
#include "trace/chunk.h"

#include "shading/dialect/loop.h"
#include "shading/stack/frame.h"

/* Carsten Waechter, Nikolaus Binder, "A Fast and Robust Method for Avoiding Self-Intersection", Ray Tracing
 * Gems, 2019: a step of so many units in the last place, or of a fixed length near the origin of the world.
 */
FN float step_out(float p, float n) {
    const float near_origin = 1.0f / 32.0f, length = 1.0f / 65536.0f, units = 256.0f;
    int32_t bits, step = (int32_t)(units * n);
    memcpy(&bits, &p, 4);
    bits += p < 0.0f ? -step : step;
    float stepped;
    memcpy(&stepped, &bits, 4);
    return abs(p) < near_origin ? p + length * n : stepped;
}

FN void put3(Row rows[3], size_t k, Dir d) {
    rows[0][k] = d.x;
    rows[1][k] = d.y;
    rows[2][k] = d.z;
}

/* Gathers the paths and their hits. */
LOOP(take_paths, (Chunk *restrict c, const ChunkSource *from, int n), (c, from, n)) {
    const Paths *p = from->paths;
    const int *order = from->order;
    const PathKeys *keys = from->keys;
    EACH(k, (size_t)n) {
        int j = order[k];
        uint32_t id = p->id[j];
        c->id[k] = id;
        c->key[k] = p->key[j];
        c->pixel[k] = keys->pixel[id >> PATHS_SAMPLES_LOG2];
        c->sample[k] = keys->sample[id & ((1u << PATHS_SAMPLES_LOG2) - 1u)];
        c->mesh[k] = from->mesh[j];
        c->triangle[k] = from->triangle[j];
        c->t[k] = from->t[j];
        c->u[k] = from->u[j];
        c->v[k] = from->v[j];
        c->pdf[k] = p->pdf[j];
    }
    for (int a = 0; a < 3; a++) {
        const float *d = p->d[a], *throughput = p->throughput[a];
        float *wo = c->wo[a], *to = c->throughput[a];
        EACH(k, (size_t)n) {
            wo[k] = -d[order[k]];
            to[k] = throughput[order[k]];
        }
    }
}

/* The triangles' corners, and the normals there: 0 where the mesh has none. */
static void take_corners(Chunk *c, const WeftScene *scene, int n) {
    for (int k = 0; k < n; k++) {
        const Mesh *mesh = &scene->meshes[c->mesh[k]];
        const uint32_t *index = mesh->index + 3 * (size_t)c->triangle[k];
        for (int corner = 0; corner < 3; corner++) {
            size_t at = 3 * (size_t)index[corner];
            for (int a = 0; a < 3; a++) {
                c->corner[corner][a][k] = mesh->position[at + (size_t)a];
                c->corner_normal[corner][a][k] = mesh->normal ? mesh->normal[at + (size_t)a] : 0.0f;
            }
        }
    }
}

FN Dir blend(Dir a, Dir b, Dir c, float u, float v) {
    float w = 1.0f - u - v;
    return dir(a.x * w + b.x * u + c.x * v, a.y * w + b.y * u + c.y * v, a.z * w + b.z * u + c.z * v);
}

/* Returns the step along n, times weight, that raises p to the tangent plane at a corner with normal n. */
FN Dir raise(Dir p, Dir corner, Dir n, float weight) {
    float below = min(dir_dot(dir(p.x - corner.x, p.y - corner.y, p.z - corner.z), n), 0.0f);
    return dir_scale(n, -below * weight);
}

/* Returns the mean of p's projections onto the tangent planes of the corners, outward only, on the side of the triangle
 * that `side` times its normals are on: near the smooth surface that these describe. Rays that leave from there meet no
 * shadow of the triangles' own edges. share: 1, or 0 to leave p as it is. Johannes Hanika, "Hacking the Shadow
 * Terminator", Ray Tracing Gems II, 2021. */
FN Dir lift(const Chunk *c, size_t k, Dir p, float side, float share) {
    float u = c->u[k] * share, v = c->v[k] * share, w = (1.0f - c->u[k] - c->v[k]) * share;
    Dir a = raise(p, ROW_DIR(c->corner[0], k), dir_scale(ROW_DIR(c->corner_normal[0], k), side), w);
    Dir b = raise(p, ROW_DIR(c->corner[1], k), dir_scale(ROW_DIR(c->corner_normal[1], k), side), u);
    Dir d = raise(p, ROW_DIR(c->corner[2], k), dir_scale(ROW_DIR(c->corner_normal[2], k), side), v);
    return dir_add(dir_add(p, a), dir_add(b, d));
}

/* Sets where rays start: at a lifted point, stepped out along the normal on that side. */
FN void put_start(Row to[3], size_t k, Dir lifted, Dir out) {
    put3(to, k, dir(step_out(lifted.x, out.x), step_out(lifted.y, out.y), step_out(lifted.z, out.z)));
}

/* Sets position, normals on the viewer's side, the lifted point, and where rays start on that side. What faces light is
 * the smooth surface as well: a triangle that turns away from light which its smooth surface faces lies, lifted, in no
 * shadow of its own. share: as lift has it. */
LOOP(place_n, (Chunk *restrict c, float share, int n), (c, share, n)) {
    EACH(k, (size_t)n) {
        Dir a = ROW_DIR(c->corner[0], k), b = ROW_DIR(c->corner[1], k), d = ROW_DIR(c->corner[2], k);
        Dir wo = ROW_DIR(c->wo, k), up = dir(0.0f, 1.0f, 0.0f);
        float u = c->u[k], v = c->v[k];
        Dir facing = dir_cross(dir(b.x - a.x, b.y - a.y, b.z - a.z), dir(d.x - a.x, d.y - a.y, d.z - a.z));
        Dir geometric = dir_normal_or(facing, up);
        float side = dir_dot(geometric, wo) < 0.0f ? -1.0f : 1.0f;
        geometric = dir_scale(geometric, side);
        Dir na = dir_scale(ROW_DIR(c->corner_normal[0], k), side);
        Dir nb = dir_scale(ROW_DIR(c->corner_normal[1], k), side);
        Dir nd = dir_scale(ROW_DIR(c->corner_normal[2], k), side);
        Dir p = blend(a, b, d, u, v);
        Dir lifted = lift(c, k, p, side, share);
        c->side[k] = side;
        put3(c->geometric, k, geometric);
        Dir normal = dir_normal_or(blend(na, nb, nd, u, v), geometric);
        normal = dir_choose(dir_dot(normal, geometric) > 0.0f, normal, geometric); /* else damaged */
        put3(c->normal, k, normal);
        put3(c->position, k, p);
        put3(c->lifted, k, lifted);
        put_start(c->origin, k, lifted, geometric);
    }
}

/* Sets where rays start that leave on the far side, lifted as the near one is. */
LOOP(place_behind_n, (Chunk *restrict c, float share, int n), (c, share, n)) {
    EACH(k, (size_t)n) {
        Dir lifted = lift(c, k, ROW_DIR(c->position, k), -c->side[k], share);
        put_start(c->behind, k, lifted, dir_scale(ROW_DIR(c->geometric, k), -1.0f));
    }
}

void chunk_place(Chunk *c, const ChunkSource *from) {
    int n = row_whole(from->n);
    float share = from->context->lift ? 1.0f : 0.0f;
    take_paths(c, from, n);
    take_corners(c, from->context->scene, n);
    c->facing = from->context->lift ? c->normal : c->geometric;
    place_n(c, share, n);
    if (from->context->materials[from->material].transmits) place_behind_n(c, share, n);
    stage_end(c->clock, STAGE_PLACE);
    chunk_take_inputs(c, from, n);
    stage_end(c->clock, STAGE_INPUTS);
    if (!from->context->materials[from->material].cloth) return;
    chunk_weave(c, from, n);
    stage_end(c->clock, STAGE_WEAVE);
}

static void take_tangents(Chunk *c, const WeftScene *scene, int n) {
    for (int k = 0; k < n; k++) {
        const Mesh *mesh = &scene->meshes[c->mesh[k]];
        const uint32_t *index = mesh->index + 3 * (size_t)c->triangle[k];
        float weight[3] = {1.0f - c->u[k] - c->v[k], c->u[k], c->v[k]}, t[3] = {0}, handedness = 1.0f;
        for (int corner = 0; mesh->tangent && corner < 3; corner++) {
            const float *of = mesh->tangent + 4 * (size_t)index[corner];
            for (int a = 0; a < 3; a++) t[a] += of[a] * weight[corner];
            handedness = of[3];
        }
        for (int a = 0; a < 3; a++) c->tangent[a][k] = t[a] * c->side[k];
        c->handedness[k] = handedness * c->side[k];
    }
}

/* From behind everything is mirrored: the bumps of a normal map are dents there. */
FN void put_frame(Chunk *c, size_t k, Surface s, Dir tangent, float handedness) {
    Dir wo = ROW_DIR(c->wo, k);
    Facing at;
    at.geometric = ROW_DIR(c->geometric, k);
    at.normal = ROW_DIR(c->normal, k);
    at.tangent = tangent;
    at.handedness = handedness;
    Frame f = frame_of(at, s, wo);
    put3(c->frame[0], k, f.x);
    put3(c->frame[1], k, f.y);
    put3(c->frame[2], k, f.z);
    put3(c->vertices.o, k, frame_to(f, wo));
}

LOOP(turn_bent_n, (Chunk *restrict c, int n), (c, n)) {
    EACH(k, (size_t)n) {
        put_frame(c, k, surface_of_row(&c->vertices.surface, k), ROW_DIR(c->tangent, k), c->handedness[k]);
    }
}

/* Makes frames that depend on no input and no tangent. */
LOOP(turn_plain_n, (Chunk *restrict c, int n), (c, n)) {
    EACH(k, (size_t)n) {
        Surface s = surface_of_row(&c->vertices.surface, k);
        s.normal = dir(0.0f, 0.0f, 1.0f);
        s.anisotropy = 0.0f;
        put_frame(c, k, s, dir(0.0f, 0.0f, 0.0f), 1.0f);
    }
}

void chunk_turn(Chunk *c, const ChunkSource *from) {
    int n = row_whole(from->n);
    if (from->context->materials[from->material].bent) {
        take_tangents(c, from->context->scene, n);
        turn_bent_n(c, n);
    } else
        turn_plain_n(c, n);
}
