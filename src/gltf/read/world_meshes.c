/* world_meshes.c - bakes the surfaces of shown nodes into world-space meshes of the scene */
#include <math.h>

#include "base/fail.h"
#include "gltf/asset/accessor.h"
#include "gltf/read/draco_primitive.h"
#include "gltf/read/gather.h"
#include "gltf/read/instances.h"
#include "gltf/read/mesh.h"
#include "gltf/read/pose.h"
#include "gltf/read/tangent.h"
#include "scene/record/tangents.h"

enum { TRIANGLES_MAX = 100000000 };

/* The largest error of the length of a unit vector that was computed in floats. */
static const double UNIT_SLACK = 5e-7;

/* One primitive under one node. */
typedef struct MeshBake {
    Asset *asset;
    Arena scratch;
    const Node *node;
    const Primitive *primitive;
    Mesh *mesh;
    Pose pose;
    bool again; /* the mesh was baked for another instance, whose warnings were given */
} MeshBake;

static void bake_fail(const MeshBake *bake, WeftMessage message, const char *what) {
    asset_fail(bake->asset, message, "meshes[%d].primitives[%d]: %s", bake->node->mesh,
               (int)(bake->primitive - bake->asset->meshes[bake->node->mesh].primitives), what);
}

static void bake_warn(const MeshBake *bake, const char *what) {
    if (bake->again) return;
    warn(bake->asset->log, WEFT_MESSAGE_GLTF_WARN_REPAIRED, bake->asset->name, "meshes[%d].primitives[%d]: %s",
         bake->node->mesh, (int)(bake->primitive - bake->asset->meshes[bake->node->mesh].primitives), what);
}

/* Finds the corners of triangle t, as places in the list of indices. */
static void corners(int mode, size_t t, size_t out[3]) {
    enum { STRIP = 5, FAN = 6 };
    size_t odd = t % 2;
    out[0] = mode == STRIP ? t : mode == FAN ? t + 1 : 3 * t;
    out[1] = mode == STRIP ? t + 1 + odd : mode == FAN ? t + 2 : 3 * t + 1;
    out[2] = mode == STRIP ? t + 2 - odd : mode == FAN ? 0 : 3 * t + 2;
}

static bool has_area(const float *position, const uint32_t corner[3]) {
    double a[3], b[3];
    for (size_t c = 0; c < 3; c++) {
        double origin = (double)position[3 * (size_t)corner[0] + c];
        a[c] = (double)position[3 * (size_t)corner[1] + c] - origin;
        b[c] = (double)position[3 * (size_t)corner[2] + c] - origin;
    }
    return a[1] * b[2] != a[2] * b[1] || a[2] * b[0] != a[0] * b[2] || a[0] * b[1] != a[1] * b[0];
}

/* Makes the triangles of the mesh, front faces counter-clockwise, and leaves out those without area. */
static void bake_triangles(MeshBake *bake) {
    Asset *asset = bake->asset;
    Mesh *mesh = bake->mesh;
    const Primitive *p = bake->primitive;
    size_t count = p->index < 0 ? mesh->vertex_count : asset->accessors[p->index].count;
    size_t triangles = p->mode == 4 ? count / 3 : count < 3 ? 0 : count - 2;
    asset->triangles += triangles;
    if (asset->triangles > TRIANGLES_MAX) bake_fail(bake, WEFT_MESSAGE_GLTF_TOO_LARGE, "too many triangles");
    if (p->mode == 4 && count % 3) bake_warn(bake, "indices after the last triangle");
    const uint32_t *index = p->index < 0 ? NULL : accessor_integers(asset, &bake->scratch, p->index);
    for (size_t i = 0; i < count && index; i++)
        if (index[i] >= mesh->vertex_count) {
            bake_fail(bake, WEFT_MESSAGE_GLTF_BOUNDS, "an index is beyond the vertices");
            return;
        }
    mesh->index = asset_array(asset, &asset->scene->arena, triangles, 3 * sizeof *mesh->index);
    for (size_t t = 0; t < triangles && asset->result == WEFT_OK; t++) {
        size_t places[3];
        corners(p->mode, t, places);
        uint32_t *corner = mesh->index + 3 * (size_t)mesh->triangle_count;
        for (int k = 0; k < 3; k++) {
            size_t place = places[bake->pose.mirrored ? (3 - k) % 3 : k];
            corner[k] = index ? index[place] : (uint32_t)place;
        }
        if (has_area(mesh->position, corner)) mesh->triangle_count++;
    }
}

/* Transforms the positions to the world; fails if one is not finite or beyond SCENE_REACH. */
static void bake_positions(MeshBake *bake) {
    Mesh *mesh = bake->mesh;
    mesh->position = accessor_floats(bake->asset, &bake->scratch, bake->primitive->position);
    if (!mesh->position) return;
    pose_morph(bake->asset, &bake->scratch, bake->node, bake->primitive, 0, mesh->position, 3);
    Transform blend;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        float *p = mesh->position + 3 * i;
        double v[3] = {(double)p[0], (double)p[1], (double)p[2]};
        transform_apply(pose_at(&bake->pose, i, &blend), v, 1.0);
        for (int c = 0; c < 3; c++) {
            if (!isfinite(v[c]))
                bake_fail(bake, WEFT_MESSAGE_GLTF_SCHEMA, "a position is not finite");
            else if (fabs(v[c]) > (double)SCENE_REACH)
                bake_fail(bake, WEFT_MESSAGE_GLTF_TOO_LARGE, "a position is too far away");
            else
                p[c] = (float)v[c];
        }
    }
}

/* Writes v at unit length to out, or zeros if it has no direction; returns whether it has one. A length of 1
 * within float precision is kept, so that a saved scene is read back exactly. */
static bool store_unit(const double v[3], float out[3]) {
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    bool good = length > 1e-150 && isfinite(length);
    if (fabs(length - 1.0) < UNIT_SLACK) length = 1.0;
    for (int c = 0; c < 3; c++) out[c] = good ? (float)(v[c] / length) : 0.0f;
    return good;
}

/* Replaces normals that are zero by those of the faces around the vertex. */
static void repair_normals(MeshBake *bake) {
    Mesh *mesh = bake->mesh;
    double(*sum)[3] = asset_array(bake->asset, &bake->scratch, mesh->vertex_count, sizeof *sum);
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count && sum; i++) {
        const uint32_t *corner = mesh->index + (i - i % 3);
        double e[2][3];
        for (size_t c = 0; c < 3; c++)
            for (int k = 0; k < 2; k++)
                e[k][c] = (double)mesh->position[3 * (size_t)corner[k + 1] + c] -
                          (double)mesh->position[3 * (size_t)corner[0] + c];
        for (int c = 0; c < 3; c++) {
            int c1 = (c + 1) % 3, c2 = (c + 2) % 3;
            sum[mesh->index[i]][c] += e[0][c1] * e[1][c2] - e[0][c2] * e[1][c1];
        }
    }
    for (size_t i = 0; i < mesh->vertex_count && sum; i++) {
        float *n = mesh->normal + 3 * i;
        if (n[0] == 0.0f && n[1] == 0.0f && n[2] == 0.0f && !store_unit(sum[i], n)) n[2] = 1.0f;
    }
}

static void bake_normals(MeshBake *bake) {
    Mesh *mesh = bake->mesh;
    if (bake->primitive->normal < 0) return;
    mesh->normal = accessor_floats(bake->asset, &bake->scratch, bake->primitive->normal);
    if (!mesh->normal) return;
    pose_morph(bake->asset, &bake->scratch, bake->node, bake->primitive, 1, mesh->normal, 3);
    Transform blend, cofactors = transform_identity;
    const double sign = bake->pose.mirrored ? -1.0 : 1.0;
    bool good = true;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        float *n = mesh->normal + 3 * i;
        if (i == 0 || bake->pose.joints) cofactors = transform_cofactors(pose_at(&bake->pose, i, &blend));
        double v[3] = {sign * (double)n[0], sign * (double)n[1], sign * (double)n[2]};
        transform_apply(&cofactors, v, 0.0);
        good &= store_unit(v, n);
    }
    if (good) return;
    bake_warn(bake, "normals without direction");
    repair_normals(bake);
}

/* Reads the tangents of the file and makes them perpendicular to the normals. */
static void bake_tangents(MeshBake *bake) {
    Mesh *mesh = bake->mesh;
    if (bake->primitive->tangent < 0 || !mesh->normal) return;
    mesh->tangent = accessor_floats(bake->asset, &bake->scratch, bake->primitive->tangent);
    if (!mesh->tangent) return;
    pose_morph(bake->asset, &bake->scratch, bake->node, bake->primitive, 2, mesh->tangent, 4);
    Transform blend;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        float *t = mesh->tangent + 4 * i;
        const float *n = mesh->normal + 3 * i;
        double v[3] = {(double)t[0], (double)t[1], (double)t[2]};
        transform_apply(pose_at(&bake->pose, i, &blend), v, 0.0);
        double along = 0.0;
        if (!store_unit(v, t)) t[0] = 1.0f;
        for (int c = 0; c < 3; c++) along += (double)t[c] * (double)n[c];
        if (fabs(along) < UNIT_SLACK) along = 0.0;
        for (int c = 0; c < 3; c++) v[c] = (double)t[c] - along * (double)n[c];
        if (fabs(along) > 0.9999999) { /* any axis that is not the normal's */
            int axis = fabsf(n[0]) < 0.7f ? 0 : 1;
            for (int c = 0; c < 3; c++) v[c] = (c == axis) - (double)n[axis] * (double)n[c];
        }
        store_unit(v, t);
        t[3] = (t[3] < 0.0f) != bake->pose.mirrored ? -1.0f : 1.0f;
    }
}

static void bake_texcoords(MeshBake *bake) {
    Mesh *mesh = bake->mesh;
    for (int set = 0; set < 2; set++) {
        if (bake->primitive->texcoord[set] < 0) continue;
        float *values = accessor_floats(bake->asset, &bake->scratch, bake->primitive->texcoord[set]);
        mesh->texcoord[set] = values;
        bool good = true;
        for (size_t i = 0; i < 2 * (size_t)mesh->vertex_count && values; i++)
            if (!(fabsf(values[i]) <= 1e9f)) {
                values[i] = 0.0f;
                good = false;
            }
        if (!good) bake_warn(bake, "texture coordinates that are not finite");
    }
}

static void bake_colors(MeshBake *bake) {
    Asset *asset = bake->asset;
    Mesh *mesh = bake->mesh;
    if (bake->primitive->color < 0) return;
    size_t width = asset->accessors[bake->primitive->color].rows;
    const float *values = accessor_floats(asset, &bake->scratch, bake->primitive->color);
    mesh->color = asset_array(asset, &bake->scratch, mesh->vertex_count, 4 * sizeof *mesh->color);
    for (size_t i = 0; i < 4 * (size_t)mesh->vertex_count && asset->result == WEFT_OK; i++) {
        size_t c = i % 4;
        float value = c < width ? values[i / 4 * width + c] : 1.0f;
        mesh->color[i] = value > 0.0f ? fminf(value, 1.0f) : 0.0f;
    }
}

static void complete_tangents(MeshBake *bake) {
    const WeftScene *scene = bake->asset->scene;
    Mesh *mesh = bake->mesh;
    const Input *input = tangents_input(&scene->materials[mesh->material]);
    for (int v = 0; v < scene->variant_count && mesh->variant_material && !input; v++)
        if (mesh->variant_material[v] >= 0) input = tangents_input(&scene->materials[mesh->variant_material[v]]);
    if (input && !mesh->tangent && tangents_possible(mesh, input)) tangents_make(bake->asset, mesh, input);
}

static void mark_materials(Asset *asset, const Mesh *mesh) {
    asset->material_shown[mesh->material] = true;
    if (mesh->material == (int)asset->material_count) asset->scene->material_count = (int)asset->material_count + 1;
    for (int v = 0; v < asset->scene->variant_count && mesh->variant_material; v++)
        if (mesh->variant_material[v] >= 0) asset->material_shown[mesh->variant_material[v]] = true;
}

/* Moves the vertices that triangles use, in their order, from scratch to the scene. Primitives of a file
 * often share one large array of which each uses a part. */
static void compact(MeshBake *bake) {
    Asset *asset = bake->asset;
    Mesh *mesh = bake->mesh;
    size_t corner_count = (size_t)3 * mesh->triangle_count;
    uint32_t *place = asset_array(asset, &bake->scratch, mesh->vertex_count, sizeof *place);
    uint32_t *source = asset_array(asset, &bake->scratch, mesh->vertex_count, sizeof *source);
    if (!place || !source) return;
    for (size_t i = 0; i < corner_count; i++) place[mesh->index[i]] = 1;
    uint32_t used = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        if (place[v]) {
            place[v] = used;
            source[used++] = v;
        }
    for (size_t i = 0; i < corner_count; i++) mesh->index[i] = place[mesh->index[i]];
    mesh_gather(asset, mesh, source, used);
}

/* Bakes one primitive. Returns false if it has nothing to show. */
static bool bake_primitive(MeshBake *bake) {
    Asset *asset = bake->asset;
    const Primitive *p = bake->primitive;
    const MeshSource *source = &asset->meshes[bake->node->mesh];
    Mesh *mesh = bake->mesh;
    *mesh = (Mesh){.name = asset_text(asset, *source->name ? source->name : bake->node->name),
                   .vertex_count = (uint32_t)asset->accessors[p->position].count,
                   .material = p->material,
                   .own_material = p->material,
                   .variant_material = p->variant_material};
    bake->pose = pose_prepare(asset, &bake->scratch, bake->node, p);
    static void (*const steps[])(MeshBake *) = {bake_positions, bake_triangles, bake_normals,
                                                bake_tangents,  bake_texcoords, bake_colors};
    for (size_t i = 0; i < sizeof steps / sizeof *steps && asset->result == WEFT_OK; i++) steps[i](bake);
    if (asset->result != WEFT_OK || !mesh->triangle_count) return false;
    compact(bake);
    complete_tangents(bake);
    mark_materials(asset, mesh);
    return true;
}

/* Returns true if the meshes of a node are shown. */
static bool shows_mesh(const Node *node) { return node->shown && !node->hidden && node->mesh >= 0; }

/* Returns an upper bound of the number of surfaces of all shown nodes, SIZE_MAX where it is more; warns of skins and
 * morph targets, which do not move. */
static size_t count_surfaces(Asset *asset) {
    bool skins = false, morphs = false;
    size_t count = 0;
    for (size_t i = 0; i < asset->node_count; i++) {
        const Node *node = &asset->nodes[i];
        if (!shows_mesh(node)) continue;
        const size_t primitives = asset->meshes[node->mesh].primitive_count;
        if (primitives && instances_count(node) > (SIZE_MAX - count) / primitives) return SIZE_MAX;
        count += primitives * instances_count(node);
        skins |= node->skin >= 0;
        morphs |= asset->meshes[node->mesh].morphs;
    }
    if (asset->moment) return count;
    if (skins) warn(asset->log, WEFT_MESSAGE_GLTF_WARN_REST_POSE, asset->name, "its skins");
    if (morphs) warn(asset->log, WEFT_MESSAGE_GLTF_WARN_REST_POSE, asset->name, "its morph targets");
    return count;
}

/* Bakes every primitive of a node's mesh once, for an instance. */
static void bake_mesh(Asset *asset, const Node *node, size_t instance, size_t surfaces) {
    WeftScene *scene = asset->scene;
    MeshSource *source = &asset->meshes[node->mesh];
    for (size_t p = 0; p < source->primitive_count && asset->result == WEFT_OK; p++) {
        draco_unpack(asset, node->mesh, &source->primitives[p]);
        MeshBake bake = {.asset = asset,
                         .node = node,
                         .primitive = &source->primitives[p],
                         .mesh = &scene->meshes[scene->mesh_count],
                         .again = instance > 0};
        if (asset->result != WEFT_OK || bake.primitive->mode < 4 || bake.primitive->position < 0) continue;
        if (bake_primitive(&bake)) scene->mesh_count++;
        arena_free(&bake.scratch);
        asset_progress(asset, 0.25, 0.5, (size_t)scene->mesh_count, surfaces);
    }
}

void meshes_bake(Asset *asset) {
    WeftScene *scene = asset->scene;
    const size_t surfaces = count_surfaces(asset);
    scene->meshes = asset_array(asset, &scene->arena, surfaces, sizeof *scene->meshes);
    for (size_t i = 0; i < asset->node_count && asset->result == WEFT_OK; i++) {
        if (!shows_mesh(&asset->nodes[i])) continue;
        Arena scratch = {0};
        Node placed = asset->nodes[i];
        const Instances instances = instances_decode(asset, &scratch, &placed);
        for (size_t k = 0; k < instances_count(&placed) && asset->result == WEFT_OK; k++) {
            placed.world = instances_world(&instances, &asset->nodes[i], k);
            bake_mesh(asset, &placed, k, surfaces);
        }
        arena_free(&scratch);
    }
}
