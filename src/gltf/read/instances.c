#include "gltf/read/instances.h"

#include <string.h>

#include "gltf/asset/accessor.h"
#include "gltf/read/node.h"

static const struct {
    const char *name;
    int rows;
} attributes[INSTANCE_ATTRIBUTES] = {{"TRANSLATION", 3}, {"ROTATION", 4}, {"SCALE", 3}};

void instances_read(const Field *field, Node *node) {
    Asset *asset = field->asset;
    Field extension = field_extension(field, "EXT_mesh_gpu_instancing"), list = field_member(&extension, "attributes");
    for (int k = 0; k < INSTANCE_ATTRIBUTES; k++) node->instance[k] = -1;
    const char *name;
    json_t *value;
    json_object_foreach(list.json, name, value) {
        Field member = field_member(&list, name);
        int k = 0;
        while (k < INSTANCE_ATTRIBUTES && strcmp(name, attributes[k].name) != 0) k++;
        if (k == INSTANCE_ATTRIBUTES) {
            if (name[0] != '_') field_warn(&member, WEFT_MESSAGE_GLTF_WARN_IGNORED, "this attribute is not read");
            continue;
        }
        const int index = field_needed_index(&member, asset->accessor_count);
        if (asset->result != WEFT_OK) return;
        const Accessor *a = &asset->accessors[index];
        if (a->columns != 1 || a->rows != attributes[k].rows)
            field_fail(&member, WEFT_MESSAGE_GLTF_SCHEMA, "accessor %d is not of type VEC%d", index,
                       attributes[k].rows);
        else if (node->instance_count && a->count != node->instance_count)
            field_fail(&member, WEFT_MESSAGE_GLTF_SCHEMA, "%zu instances, but %zu of another attribute", a->count,
                       node->instance_count);
        node->instance_count = a->count;
        node->instance[k] = index;
    }
    if (extension.json && !node->instance_count && asset->result == WEFT_OK)
        field_fail(&list, WEFT_MESSAGE_GLTF_SCHEMA, "expected an object of TRANSLATION, ROTATION or SCALE");
}

size_t instances_count(const Node *node) { return node->instance_count ? node->instance_count : 1; }

Instances instances_decode(Asset *asset, Arena *scratch, const Node *node) {
    Instances instances = {{NULL}};
    for (int k = 0; node->instance_count && k < INSTANCE_ATTRIBUTES; k++)
        if (node->instance[k] >= 0) instances.values[k] = accessor_floats(asset, scratch, node->instance[k]);
    return instances;
}

Transform instances_world(const Instances *instances, const Node *node, size_t k) {
    double placed[INSTANCE_ATTRIBUTES][4] = {{0, 0, 0}, {0, 0, 0, 1}, {1, 1, 1}};
    for (int a = 0; a < INSTANCE_ATTRIBUTES; a++)
        for (int c = 0; c < attributes[a].rows && instances->values[a]; c++)
            placed[a][c] = (double)instances->values[a][k * (size_t)attributes[a].rows + (size_t)c];
    if (!node->instance_count) return node->world;
    const Transform local = node_transform(placed[0], placed[1], placed[2]);
    return transform_product(&node->world, &local);
}
