/* Specification: Khronos Group, "glTF 2.0 Specification", 2021, sections 3.7.2.2 (morph targets) and 3.7.3 (skins). */
#include "gltf/read/pose.h"

#include "gltf/asset/accessor.h"
#include "gltf/asset/field.h"

static void skin_read(const Field *field, Skin *skin, size_t node_count) {
    Asset *asset = field->asset;
    Field joints = field_member(field, "joints"), inverse = field_member(field, "inverseBindMatrices");
    skin->joint_count = field_count(&joints);
    if (!skin->joint_count) field_fail(&joints, WEFT_MESSAGE_GLTF_SCHEMA, "a skin needs joints");
    skin->joints = asset_array(asset, &asset->arena, skin->joint_count, sizeof *skin->joints);
    for (size_t i = 0; i < skin->joint_count && asset->result == WEFT_OK; i++) {
        Field joint = field_element(&joints, i);
        skin->joints[i] = field_index(&joint, node_count);
    }
    skin->inverse_bind = field_index(&inverse, asset->accessor_count);
    if (skin->inverse_bind < 0 || asset->result != WEFT_OK) return;
    const Accessor *a = &asset->accessors[skin->inverse_bind];
    if (a->columns != 4 || a->count < skin->joint_count)
        field_fail(&inverse, WEFT_MESSAGE_GLTF_SCHEMA, "expected a MAT4 for each of %zu joints", skin->joint_count);
}

void skins_read(Asset *asset, size_t node_count) {
    Field root = field_root(asset), list = field_member(&root, "skins");
    asset->skin_count = field_count(&list);
    asset->skins = asset_array(asset, &asset->arena, asset->skin_count, sizeof *asset->skins);
    for (size_t i = 0; i < asset->skin_count && asset->result == WEFT_OK; i++) {
        Field field = field_element(&list, i);
        skin_read(&field, &asset->skins[i], node_count);
    }
}

/* Returns the world transform of each joint times its inverse bind matrix. */
static Transform *joints_bind(Asset *asset, Arena *scratch, const Skin *skin) {
    Transform *bound = asset_array(asset, scratch, skin->joint_count, sizeof *bound);
    const float *inverse = skin->inverse_bind < 0 ? NULL : accessor_floats(asset, scratch, skin->inverse_bind);
    for (size_t j = 0; j < skin->joint_count && asset->result == WEFT_OK; j++) {
        Transform bind = transform_identity;
        for (int e = 0; inverse && e < 12; e++)
            bind.m[e % 3][e / 3] = (double)inverse[16 * j + (size_t)(e / 3 * 4 + e % 3)];
        bound[j] = transform_product(&asset->nodes[skin->joints[j]].world, &bind);
    }
    return bound;
}

Pose pose_prepare(Asset *asset, Arena *scratch, const Node *node, const Primitive *p) {
    Pose pose = {.world = node->world};
    if (node->skin >= 0 && p->joints[0] >= 0 && p->weights[0] >= 0) {
        const Skin *skin = &asset->skins[node->skin];
        pose.joints = joints_bind(asset, scratch, skin);
        for (int set = 0; set < SKIN_SETS && p->joints[set] >= 0 && p->weights[set] >= 0; set++) {
            pose.index[set] = accessor_integers(asset, scratch, p->joints[set]);
            pose.weight[set] = accessor_floats(asset, scratch, p->weights[set]);
            size_t count = 4 * asset->accessors[p->joints[set]].count;
            for (size_t i = 0; i < count && asset->result == WEFT_OK; i++)
                if (pose.index[set][i] >= skin->joint_count)
                    asset_fail(asset, WEFT_MESSAGE_GLTF_BOUNDS, "meshes[%d]: joint %u of %zu", node->mesh,
                               (unsigned)pose.index[set][i], skin->joint_count);
        }
        if (asset->result == WEFT_OK) pose.world = pose.joints[0];
    }
    pose.mirrored = transform_determinant(&pose.world) < 0.0;
    return pose;
}

const Transform *pose_at(const Pose *pose, size_t vertex, Transform *blend) {
    if (!pose->joints) return &pose->world;
    double total = 0.0;
    *blend = (Transform){{{0}}};
    for (int set = 0; set < SKIN_SETS && pose->index[set]; set++)
        for (size_t k = 4 * vertex; k < 4 * vertex + 4; k++) {
            double weight = (double)pose->weight[set][k];
            if (!(weight > 0.0)) continue;
            const Transform *joint = &pose->joints[pose->index[set][k]];
            total += weight;
            for (int e = 0; e < 12; e++) blend->m[e / 4][e % 4] += weight * joint->m[e / 4][e % 4];
        }
    if (!(total > 0.0)) return &pose->world;
    for (int e = 0; e < 12; e++) blend->m[e / 4][e % 4] /= total;
    return blend;
}

void pose_morph(Asset *asset, Arena *scratch, const Node *node, const Primitive *p, int attribute, float *values,
                size_t stride) {
    const MeshSource *mesh = &asset->meshes[node->mesh];
    const float *weights = node->weights ? node->weights : mesh->weights;
    size_t weight_count = node->weights ? node->weight_count : mesh->weight_count;
    for (size_t t = 0; t < p->target_count && t < weight_count && asset->result == WEFT_OK; t++) {
        int accessor = p->targets[t][attribute];
        if (accessor < 0 || weights[t] == 0.0f) continue;
        const float *offset = accessor_floats(asset, scratch, accessor);
        size_t count = asset->accessors[accessor].count;
        for (size_t i = 0; i < count && offset; i++)
            for (size_t c = 0; c < 3; c++) values[i * stride + c] += weights[t] * offset[3 * i + c];
    }
}
