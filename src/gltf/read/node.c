/* Specification: Khronos Group, "glTF 2.0 Specification", 2021, section 3.5 (scenes and nodes). */
#include "gltf/read/node.h"

#include <math.h>

#include "gltf/asset/field.h"
#include "gltf/read/instances.h"

/* Returns the rotation of a quaternion x, y, z, w of any length; the identity if it is 0 or not finite. */
static Transform rotation(const double q[4]) {
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 0.0) || !isfinite(length)) return transform_identity;
    double x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
    return (Transform){{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 0},
                        {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), 0},
                        {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), 0}}};
}

Transform node_transform(const double t[3], const double q[4], const double s[3]) {
    Transform local = rotation(q);
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) local.m[r][c] *= s[c];
        local.m[r][3] = t[r];
    }
    return local;
}

static Transform local_read(const Field *field) {
    Field matrix = field_member(field, "matrix"), translation = field_member(field, "translation"),
          rotation_field = field_member(field, "rotation"), scale = field_member(field, "scale");
    double m[16], t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    field_doubles(&translation, t, 3);
    field_doubles(&rotation_field, q, 4);
    field_doubles(&scale, s, 3);
    Transform local = node_transform(t, q, s);
    if (!field_doubles(&matrix, m, 16)) return local;
    if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0)
        field_fail(&matrix, WEFT_MESSAGE_GLTF_SCHEMA, "its last row is not 0 0 0 1");
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) local.m[r][c] = m[c * 4 + r];
    return local;
}

static float *weights_read(const Field *field, size_t *count) {
    Asset *asset = field->asset;
    *count = field_count(field);
    if (!*count) return NULL;
    float *weights = asset_array(asset, &asset->arena, *count, sizeof *weights);
    if (weights) field_floats(field, weights, *count, -1e6f, 1e6f);
    return weights;
}

static void node_read(const Field *field, Node *node) {
    Asset *asset = field->asset;
    Field name = field_member(field, "name"), mesh = field_member(field, "mesh"), skin = field_member(field, "skin"),
          camera = field_member(field, "camera"), weights = field_member(field, "weights"),
          lights = field_extension(field, "KHR_lights_punctual"), light = field_member(&lights, "light"),
          visibility = field_extension(field, "KHR_node_visibility"), visible = field_member(&visibility, "visible");
    node->name = field_text(&name, "");
    node->mesh = field_index(&mesh, asset->mesh_count);
    node->skin = field_index(&skin, asset->skin_count);
    node->camera = field_index(&camera, asset->camera_count);
    node->light = field_index(&light, asset->light_count);
    node->local = local_read(field);
    node->hidden = !field_bool(&visible, true);
    instances_read(field, node);
    node->weights = weights_read(&weights, &node->weight_count);
}

/* Sets the parent of every node, and fails if a node has two. */
static void parents_read(Asset *asset, const Field *list) {
    for (size_t i = 0; i < asset->node_count && asset->result == WEFT_OK; i++) {
        Field field = field_element(list, i), children = field_member(&field, "children");
        size_t count = field_count(&children);
        for (size_t c = 0; c < count && asset->result == WEFT_OK; c++) {
            Field child = field_element(&children, c);
            int index = field_index(&child, asset->node_count);
            if (asset->result != WEFT_OK) return;
            if (asset->nodes[index].parent >= 0) field_fail(&child, WEFT_MESSAGE_GLTF_PARENTS, "nodes[%d]", index);
            asset->nodes[index].parent = (int)i;
        }
    }
}

/* Sorts parents before children. The way up from a node ends at a root, or never in a cycle. Each walk stops
 * at the first node whose depth is already set, so that the whole is linear and needs no stack. */
static void order_nodes(Asset *asset) {
    int count = (int)asset->node_count;
    int *order = asset_array(asset, &asset->arena, asset->node_count, sizeof *order);
    int *depth = asset_array(asset, &asset->arena, asset->node_count, sizeof *depth); /* 0: not set yet */
    int *tally = asset_array(asset, &asset->arena, asset->node_count + 2, sizeof *tally);
    if (asset->result != WEFT_OK) return;
    for (int i = 0; i < count; i++) {
        int steps = 0, top = i;
        while (top >= 0 && !depth[top] && steps <= count) {
            top = asset->nodes[top].parent;
            steps++;
        }
        if (steps > count) {
            asset_fail(asset, WEFT_MESSAGE_GLTF_CYCLE, "nodes[%d]", i);
            return;
        }
        int level = (top >= 0 ? depth[top] : 0) + steps;
        for (int n = i; n >= 0 && !depth[n]; n = asset->nodes[n].parent) depth[n] = level--;
    }
    for (int i = 0; i < count; i++) tally[depth[i] + 1]++;
    for (int d = 1; d < count + 2; d++) tally[d] += tally[d - 1];
    for (int i = 0; i < count; i++) order[tally[depth[i]]++] = i;
    asset->node_order = order;
}

static void mark_shown(Asset *asset) {
    Field root = field_root(asset), scene_field = field_member(&root, "scene"), scenes = field_member(&root, "scenes");
    size_t scene_count = field_count(&scenes);
    int scene = field_index(&scene_field, scene_count);
    for (size_t s = 0; s < scene_count && asset->result == WEFT_OK; s++) {
        Field element = field_element(&scenes, s), list = field_member(&element, "nodes");
        size_t count = field_count(&list);
        for (size_t i = 0; i < count; i++) {
            Field field = field_element(&list, i);
            int node = field_index(&field, asset->node_count);
            if (node >= 0 && (int)s == (scene < 0 ? 0 : scene)) asset->nodes[node].shown = true;
        }
    }
    for (size_t i = 0; i < asset->node_count && scene_count == 0; i++)
        asset->nodes[i].shown = asset->nodes[i].parent < 0;
}

void nodes_read(Asset *asset) {
    Field root = field_root(asset), list = field_member(&root, "nodes");
    asset->node_count = field_count(&list);
    asset->nodes = asset_array(asset, &asset->arena, asset->node_count, sizeof *asset->nodes);
    for (size_t i = 0; i < asset->node_count && asset->result == WEFT_OK; i++) {
        Field field = field_element(&list, i);
        asset->nodes[i].parent = -1;
        node_read(&field, &asset->nodes[i]);
    }
    parents_read(asset, &list);
    if (asset->result == WEFT_OK) order_nodes(asset);
    if (asset->result == WEFT_OK) mark_shown(asset);
    for (size_t i = 0; i < asset->node_count && asset->result == WEFT_OK; i++) {
        Node *node = &asset->nodes[asset->node_order[i]];
        const Node *parent = node->parent < 0 ? NULL : &asset->nodes[node->parent];
        node->world = parent ? transform_product(&parent->world, &node->local) : node->local;
        if (parent && parent->shown) node->shown = true;
        if (parent && parent->hidden) node->hidden = true;
        for (int e = 0; e < 12; e++)
            if (!(fabs(node->world.m[e / 4][e % 4]) <= 1e38))
                asset_fail(asset, WEFT_MESSAGE_GLTF_TOO_LARGE, "nodes[%d]: its transform", asset->node_order[i]);
    }
}
