#include "gltf/read/tangent.h"

#include <math.h>
#include <string.h>

#include "base/random.h"
#include "gltf/read/gather.h"

typedef struct GltfVec2 {
    float u, v;
} GltfVec2;

static Vec3 vec3_at(const float *values, size_t i) { return vec3_load(values + 3 * i); }

/* Returns a at unit length, or zero if it has no direction. The first step keeps the squares in range. */
static Vec3 unit(Vec3 a) {
    float most = fmaxf(fabsf(a.x), fmaxf(fabsf(a.y), fabsf(a.z)));
    if (!(most > 0.0f) || !isfinite(most)) return (Vec3){0.0f, 0.0f, 0.0f};
    a = (Vec3){a.x / most, a.y / most, a.z / most};
    return vec3_scale(a, 1.0f / sqrtf(vec3_dot(a, a)));
}

/* Returns a without its part along the unit vector n, at unit length. */
static Vec3 tangential(Vec3 a, Vec3 n) { return unit(vec3_sub(unit(a), vec3_scale(n, vec3_dot(unit(a), n)))); }

/* Returns a unit vector perpendicular to n. */
static Vec3 any_across(Vec3 n) {
    Vec3 axis = fabsf(n.x) < 0.7f ? (Vec3){1.0f, 0.0f, 0.0f} : (Vec3){0.0f, 1.0f, 0.0f};
    return tangential(axis, n);
}

/* Gives every triangle three vertices of its own, with the normal of the face. */
static void flatten(Asset *asset, Mesh *mesh) {
    size_t count = (size_t)3 * mesh->triangle_count;
    mesh_gather(asset, mesh, mesh->index, count);
    mesh->normal = asset_array(asset, &asset->scene->arena, count, 3 * sizeof *mesh->normal);
    for (size_t i = 0; i < count && asset->result == WEFT_OK; i++) {
        size_t first = i - i % 3;
        Vec3 a = vec3_at(mesh->position, first);
        Vec3 n = unit(vec3_cross(unit(vec3_sub(vec3_at(mesh->position, first + 1), a)),
                                 unit(vec3_sub(vec3_at(mesh->position, first + 2), a))));
        if (vec3_dot(n, n) == 0.0f) n = (Vec3){0.0f, 0.0f, 1.0f};
        memcpy(mesh->normal + 3 * i, (const float[3]){n.x, n.y, n.z}, 3 * sizeof(float));
        mesh->index[i] = (uint32_t)i;
    }
}

static GltfVec2 *coordinates(Asset *asset, Arena *scratch, const Mesh *mesh, const Input *input) {
    const float *from = mesh->texcoord[input->texcoord], *m = input->transform;
    GltfVec2 *out = asset_array(asset, scratch, mesh->vertex_count, sizeof *out);
    for (size_t i = 0; i < mesh->vertex_count && out; i++) {
        float u = from[2 * i], v = from[2 * i + 1];
        out[i] = (GltfVec2){m[0] * u + m[1] * v + m[2], m[3] * u + m[4] * v + m[5]};
    }
    return out;
}

/* Copies the bits that make a vertex the same as another for smoothing: position, normal, coordinates. */
static void vertex_key(const Mesh *mesh, const GltfVec2 *uv, size_t i, uint32_t key[8]) {
    memcpy(key, mesh->position + 3 * i, 12);
    memcpy(key + 3, mesh->normal + 3 * i, 12);
    memcpy(key + 6, &uv[i], 8);
}

/* Returns the leader of each vertex: the first vertex with an equal key, for which all of them are smoothed
 * as one. The table is an open-addressing hash table, at most half full. Its longest run is some 100 slots
 * for as many vertices as there can be (Donald Knuth, "The Art of Computer Programming" 3, section 6.4,
 * 1998); a file made to have more than PROBES_MAX loses smoothing there, not time. */
static uint32_t *weld(Asset *asset, Arena *scratch, const Mesh *mesh, const GltfVec2 *uv) {
    enum { PROBES_MAX = 256 };
    size_t slots = 16;
    while (slots < (size_t)2 * mesh->vertex_count) slots *= 2;
    uint32_t *table = asset_array(asset, scratch, slots, sizeof *table); /* vertex + 1, 0 is free */
    uint32_t *leader = asset_array(asset, scratch, mesh->vertex_count, sizeof *leader);
    if (!table || !leader) return NULL;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        uint32_t key[8], other[8], hash = 0;
        vertex_key(mesh, uv, i, key);
        for (int k = 0; k < 8; k++) hash = hash_combine(hash, key[k]);
        leader[i] = i;
        for (size_t probe = 0; probe < PROBES_MAX; probe++) {
            uint32_t *slot = &table[(hash + probe) & (slots - 1)];
            if (!*slot) *slot = i + 1;
            vertex_key(mesh, uv, *slot - 1, other);
            if (memcmp(key, other, sizeof key) != 0) continue;
            leader[i] = *slot - 1;
            break;
        }
    }
    return leader;
}

/* Returns how the map lies on a triangle: 0 as seen from the front, 1 mirrored, -1 on a line or point. The v
 * of images grows downwards, so that upright means that (u, -v) has the winding of the corners. */
static int orientation(const GltfVec2 uv[3]) {
    double area = (double)(uv[1].u - uv[0].u) * (double)(uv[2].v - uv[0].v) -
                  (double)(uv[2].u - uv[0].u) * (double)(uv[1].v - uv[0].v);
    return area < 0.0 ? 0 : area > 0.0 ? 1 : -1;
}

/* Returns the direction of growing u on a triangle. */
static Vec3 direction_of_u(const Vec3 p[3], const GltfVec2 uv[3], int side) {
    Vec3 e1 = vec3_sub(p[1], p[0]), e2 = vec3_sub(p[2], p[0]);
    float v1 = uv[1].v - uv[0].v, v2 = uv[2].v - uv[0].v, sign = side ? 1.0f : -1.0f;
    return unit(vec3_sub(vec3_scale(e1, sign * v2), vec3_scale(e2, sign * v1)));
}

/* Adds the direction of each triangle to the sums of its corners, separate for upright and mirrored triangles. */
static void accumulate(const Mesh *mesh, const GltfVec2 *uv, const uint32_t *leader, Vec3 *sums[2]) {
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corner = mesh->index + 3 * t;
        Vec3 p[3];
        GltfVec2 c[3];
        for (int k = 0; k < 3; k++) {
            p[k] = vec3_at(mesh->position, corner[k]);
            c[k] = uv[corner[k]];
        }
        int side = orientation(c);
        if (side < 0) continue;
        Vec3 along = direction_of_u(p, c, side);
        for (int k = 0; k < 3; k++) {
            Vec3 n = vec3_at(mesh->normal, corner[k]);
            Vec3 a = tangential(vec3_sub(p[(k + 1) % 3], p[k]), n), b = tangential(vec3_sub(p[(k + 2) % 3], p[k]), n);
            float angle = acosf(fmaxf(-1.0f, fminf(1.0f, vec3_dot(a, b))));
            Vec3 weighted = vec3_scale(tangential(along, n), angle), *sum = &sums[side][leader[corner[k]]];
            *sum = vec3_add(*sum, weighted);
        }
    }
}

/* Splits the vertices that belong to both orientations. Appends to source the old vertex of each new one, and
 * sets the orientation of every vertex in side. Returns the new number of vertices. */
static size_t split(Mesh *mesh, const GltfVec2 *uv, uint32_t *source, int8_t *side, uint32_t *twin) {
    size_t count = mesh->vertex_count;
    for (size_t i = 0; i < count; i++) {
        source[i] = (uint32_t)i;
        side[i] = -1;
    }
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        uint32_t *corner = mesh->index + 3 * t;
        const GltfVec2 c[3] = {uv[corner[0]], uv[corner[1]], uv[corner[2]]};
        int facing = orientation(c);
        for (int k = 0; k < 3 && facing >= 0; k++) {
            uint32_t v = corner[k];
            if (side[v] < 0) side[v] = (int8_t)facing;
            if (side[v] == facing) continue;
            if (!twin[v]) {
                side[count] = (int8_t)facing;
                source[count] = v;
                twin[v] = (uint32_t)count++;
            }
            corner[k] = twin[v];
        }
    }
    return count;
}

static void smooth(Asset *asset, Arena *scratch, Mesh *mesh, const Input *input) {
    size_t old = mesh->vertex_count;
    GltfVec2 *uv = coordinates(asset, scratch, mesh, input);
    uint32_t *leader = uv ? weld(asset, scratch, mesh, uv) : NULL;
    Vec3 *sums[2] = {asset_array(asset, scratch, old, sizeof(Vec3)), asset_array(asset, scratch, old, sizeof(Vec3))};
    uint32_t *source = asset_array(asset, scratch, 2 * old, sizeof *source);
    uint32_t *twin = asset_array(asset, scratch, old, sizeof *twin);
    int8_t *side = asset_array(asset, scratch, 2 * old, sizeof *side);
    if (asset->result != WEFT_OK || !uv || !leader) return;
    accumulate(mesh, uv, leader, sums);
    size_t count = split(mesh, uv, source, side, twin);
    if (count > old) mesh_gather(asset, mesh, source, count);
    mesh->tangent = asset_array(asset, &asset->scene->arena, count, 4 * sizeof *mesh->tangent);
    for (size_t i = 0; i < count && asset->result == WEFT_OK; i++) {
        Vec3 n = vec3_at(mesh->normal, i), t = tangential(sums[side[i] == 1][leader[source[i]]], n);
        if (vec3_dot(t, t) == 0.0f) t = any_across(n);
        memcpy(mesh->tangent + 4 * i, (const float[4]){t.x, t.y, t.z, side[i] == 1 ? -1.0f : 1.0f}, 4 * sizeof(float));
    }
}

void tangents_make(Asset *asset, Mesh *mesh, const Input *input) {
    Arena scratch = {0};
    if (!mesh->normal) flatten(asset, mesh);
    if (asset->result == WEFT_OK) smooth(asset, &scratch, mesh, input);
    arena_free(&scratch);
}
