/* vertex.c - the points that paths hit: position, normal, and the frame */
#include "trace/path/chunk.h"

#include "shading/dialect/loop.h"
#include "shading/stack/frame.h"

/* Steps out from a coordinate p along a normal's n, by units in the last place, or by a fixed length near the world's
 * origin. Carsten Waechter, Nikolaus Binder, "A Fast and Robust Method for Avoiding Self-Intersection", Ray Tracing
 * Gems, 2019. */
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
LOOP(gather_paths, (Chunk *restrict chunk, const ChunkSource *source, int n), (chunk, source, n)) {
    const Paths *paths = source->paths;
    const int *order = source->order;
    const PathKeys *keys = source->keys;
    EACH(k, (size_t)n) {
        int j = order[k];
        uint32_t id = paths->id[j];
        chunk->id[k] = id;
        chunk->key[k] = paths->key[j];
        chunk->pixel[k] = keys->pixel[id >> PATHS_SAMPLES_LOG2];
        chunk->sample[k] = keys->sample[id & ((1u << PATHS_SAMPLES_LOG2) - 1u)];
        chunk->mesh[k] = source->mesh[j];
        chunk->triangle[k] = source->triangle[j];
        chunk->t[k] = source->t[j];
        chunk->u[k] = source->u[j];
        chunk->v[k] = source->v[j];
        chunk->pdf[k] = paths->pdf[j];
    }
    for (int a = 0; a < 3; a++) {
        const float *d = paths->direction[a], *throughput = paths->throughput[a];
        float *wo = chunk->wo[a], *to = chunk->throughput[a];
        EACH(k, (size_t)n) {
            wo[k] = -d[order[k]];
            to[k] = throughput[order[k]];
        }
    }
}

/* Gathers the triangles' corners, and the normals there: 0 if the mesh has none. */
static void gather_corners(Chunk *chunk, const WeftScene *scene, int n) {
    for (int k = 0; k < n; k++) {
        const Mesh *mesh = &scene->meshes[chunk->mesh[k]];
        const uint32_t *index = mesh->index + 3 * (size_t)chunk->triangle[k];
        for (int corner = 0; corner < 3; corner++) {
            size_t at = 3 * (size_t)index[corner];
            for (int a = 0; a < 3; a++) {
                chunk->corner[corner][a][k] = mesh->position[at + (size_t)a];
                chunk->corner_normal[corner][a][k] = mesh->normal ? mesh->normal[at + (size_t)a] : 0.0f;
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

/* Returns the mean of p's projections onto the tangent planes of the corners, outward only, on the side of the corner
 * normals times `side`. It lies near the smooth surface that these normals describe, so that the triangles' edges cast
 * no shadow on it. share: 1, or 0 to leave p as it is. Johannes Hanika, "Hacking the Shadow Terminator", Ray Tracing
 * Gems II, 2021. */
FN Dir lift(const Chunk *chunk, size_t k, Dir p, float side, float share) {
    float u = chunk->u[k] * share, v = chunk->v[k] * share, w = (1.0f - chunk->u[k] - chunk->v[k]) * share;
    Dir a = raise(p, ROW_DIR(chunk->corner[0], k), dir_scale(ROW_DIR(chunk->corner_normal[0], k), side), w);
    Dir b = raise(p, ROW_DIR(chunk->corner[1], k), dir_scale(ROW_DIR(chunk->corner_normal[1], k), side), u);
    Dir d = raise(p, ROW_DIR(chunk->corner[2], k), dir_scale(ROW_DIR(chunk->corner_normal[2], k), side), v);
    return dir_add(dir_add(p, a), dir_add(b, d));
}

/* Sets the origin of rays: a lifted point, stepped out along the normal on its side. */
FN void put_origin(Row to[3], size_t k, Dir lifted, Dir out) {
    put3(to, k, dir(step_out(lifted.x, out.x), step_out(lifted.y, out.y), step_out(lifted.z, out.z)));
}

/* Sets position, normals, the lifted point, and the origin of rays, all on the viewer's side. share: as for lift. */
LOOP(place_n, (Chunk *restrict chunk, float share, int n), (chunk, share, n)) {
    EACH(k, (size_t)n) {
        Dir a = ROW_DIR(chunk->corner[0], k), b = ROW_DIR(chunk->corner[1], k), d = ROW_DIR(chunk->corner[2], k);
        Dir wo = ROW_DIR(chunk->wo, k), up = dir(0.0f, 1.0f, 0.0f);
        float u = chunk->u[k], v = chunk->v[k];
        Dir winding = dir_cross(dir(b.x - a.x, b.y - a.y, b.z - a.z), dir(d.x - a.x, d.y - a.y, d.z - a.z));
        Dir geometric = dir_normal_or(winding, up);
        float side = dir_dot(geometric, wo) < 0.0f ? -1.0f : 1.0f;
        geometric = dir_scale(geometric, side);
        Dir na = dir_scale(ROW_DIR(chunk->corner_normal[0], k), side);
        Dir nb = dir_scale(ROW_DIR(chunk->corner_normal[1], k), side);
        Dir nd = dir_scale(ROW_DIR(chunk->corner_normal[2], k), side);
        Dir p = blend(a, b, d, u, v);
        Dir lifted = lift(chunk, k, p, side, share);
        chunk->side[k] = side;
        put3(chunk->geometric, k, geometric);
        Dir normal = dir_normal_or(blend(na, nb, nd, u, v), geometric);
        normal = dir_choose(dir_dot(normal, geometric) > 0.0f, normal, geometric); /* else damaged */
        put3(chunk->normal, k, normal);
        put3(chunk->visible, k, frame_visible_normal(normal, wo));
        put3(chunk->position, k, p);
        put3(chunk->lifted, k, lifted);
        put_origin(chunk->origin, k, lifted, geometric);
    }
}

/* Sets the origin of rays that leave on the far side, lifted like the near one. */
LOOP(place_behind_n, (Chunk *restrict chunk, float share, int n), (chunk, share, n)) {
    EACH(k, (size_t)n) {
        Dir lifted = lift(chunk, k, ROW_DIR(chunk->position, k), -chunk->side[k], share);
        put_origin(chunk->origin_behind, k, lifted, dir_scale(ROW_DIR(chunk->geometric, k), -1.0f));
    }
}

void chunk_place(Chunk *chunk, const ChunkSource *source) {
    int n = row_whole(source->n);
    float share = source->context->lift ? 1.0f : 0.0f;
    gather_paths(chunk, source, n);
    gather_corners(chunk, source->context->scene, n);
    /* A triangle that faces away from light which its smooth surface faces, lifted, does not shadow itself. Past a fold
     * the smooth surface faces away from the viewer: the horizon then is that of the normal that is shaded, for else
     * what is drawn between the two would be lost. */
    chunk->horizon_normal = source->context->lift ? chunk->visible : chunk->geometric;
    place_n(chunk, share, n);
    if (source->context->materials[source->material].transmits) place_behind_n(chunk, share, n);
    if (source->context->solids) chunk_absorb(chunk, source);
    stage_end(chunk->clock, STAGE_PLACE);
    chunk_read_inputs(chunk, source, n);
    stage_end(chunk->clock, STAGE_INPUTS);
    if (!source->context->materials[source->material].cloth) return;
    chunk_find_threads(chunk, source, n);
    stage_end(chunk->clock, STAGE_WEAVE);
}

/* Interpolates the meshes' tangents, on the viewer's side; 0 if the mesh has none. */
static void gather_tangents(Chunk *chunk, const WeftScene *scene, int n) {
    for (int k = 0; k < n; k++) {
        const Mesh *mesh = &scene->meshes[chunk->mesh[k]];
        const uint32_t *index = mesh->index + 3 * (size_t)chunk->triangle[k];
        float weight[3] = {1.0f - chunk->u[k] - chunk->v[k], chunk->u[k], chunk->v[k]}, t[3] = {0}, handedness = 1.0f;
        for (int corner = 0; mesh->tangent && corner < 3; corner++) {
            const float *of = mesh->tangent + 4 * (size_t)index[corner];
            for (int a = 0; a < 3; a++) t[a] += of[a] * weight[corner];
            handedness = of[3];
        }
        for (int a = 0; a < 3; a++) chunk->tangent[a][k] = t[a] * chunk->side[k];
        chunk->handedness[k] = handedness * chunk->side[k];
    }
}

/* Sets frame k, rotated with the weave of its cloth, and wo in it. A surface seen from behind is mirrored: bumps of a normal map are dents there. */
FN void put_frame(Chunk *chunk, size_t k, Surface s, Dir tangent, float handedness, float rotation_cos,
                  float rotation_sin) {
    Dir wo = ROW_DIR(chunk->wo, k);
    Facing at;
    at.geometric = ROW_DIR(chunk->geometric, k);
    at.normal = ROW_DIR(chunk->normal, k);
    at.tangent = tangent;
    at.handedness = handedness;
    Frame f = frame_rotate(frame_of(at, s, wo), rotation_cos, rotation_sin);
    put3(chunk->frame[0], k, f.x);
    put3(chunk->frame[1], k, f.y);
    put3(chunk->frame[2], k, f.z);
    put3(chunk->vertices.o, k, frame_to(f, wo));
}

/* Makes frames that may depend on the inputs and the mesh's tangents. rotation: cosine and sine. */
LOOP(frames_with_tangents_n, (Chunk *restrict chunk, const float rotation[2], int n), (chunk, rotation, n)) {
    float c = rotation[0], s = rotation[1];
    EACH(k, (size_t)n) {
        put_frame(chunk, k, surface_of_row(&chunk->vertices.surface, k), ROW_DIR(chunk->tangent, k),
                  chunk->handedness[k], c, s);
    }
}

/* Makes frames that depend on the normal alone. */
LOOP(frames_n, (Chunk *restrict chunk, int n), (chunk, n)) {
    EACH(k, (size_t)n) {
        Surface s = surface_of_row(&chunk->vertices.surface, k);
        s.normal = dir(0.0f, 0.0f, 1.0f);
        s.anisotropy = 0.0f;
        put_frame(chunk, k, s, dir(0.0f, 0.0f, 0.0f), 1.0f, 1.0f, 0.0f);
    }
}

void chunk_make_frames(Chunk *chunk, const ChunkSource *source) {
    static const float straight[2] = {1.0f, 0.0f};
    int n = row_whole(source->n);
    const PathMaterial *material = &source->context->materials[source->material];
    if (material->needs_tangents) {
        gather_tangents(chunk, source->context->scene, n);
        frames_with_tangents_n(chunk, material->cloth ? material->cloth->rotation_parts : straight, n);
    } else
        frames_n(chunk, n);
}
