/* Specification: Khronos Group, "glTF 2.0 Specification", 2021, section 3.7 (meshes), and the texts of
 * KHR_materials_variants and KHR_mesh_quantization in its extension registry. */
#include "gltf/read/mesh.h"

#include <stdio.h>
#include <string.h>

#include "gltf/read/coordinates.h"
#include "gltf/read/draco_primitive.h"

void variants_read(Asset *asset) {
    WeftScene *scene = asset->scene;
    Field root = field_root(asset), extension = field_extension(&root, "KHR_materials_variants"),
          list = field_member(&extension, "variants");
    size_t count = field_count(&list);
    scene->variants = asset_array(asset, &scene->arena, count, sizeof *scene->variants);
    for (size_t i = 0; i < count && asset->result == WEFT_OK; i++) {
        Field field = field_element(&list, i), name = field_member(&field, "name");
        scene->variants[i] = asset_text(asset, field_text(&name, ""));
    }
    scene->variant_count = asset->result == WEFT_OK ? (int)count : 0;
}

int attribute_read(const Field *attributes, const char *name, int low, int high, size_t count) {
    Asset *asset = attributes->asset;
    Field field = field_member(attributes, name);
    int index = field_index(&field, asset->accessor_count);
    if (index < 0 || asset->result != WEFT_OK) return -1;
    const Accessor *a = &asset->accessors[index];
    if (a->columns != 1 || a->rows < low || a->rows > high)
        field_fail(&field, WEFT_MESSAGE_GLTF_SCHEMA, "accessor %d is not of type VEC%d", index, low);
    else if (count && a->count != count)
        field_fail(&field, WEFT_MESSAGE_GLTF_SCHEMA, "%zu elements, but %zu positions", a->count, count);
    return index;
}

static bool is_unsigned(const Accessor *a) {
    return a->component == COMPONENT_U8 || a->component == COMPONENT_U16 || a->component == COMPONENT_U32;
}

/* Warns of attributes that are not read, but for those that are an application's own, by their underscore, and for sets
 * of coordinates or colours, which nothing shows unless a texture names them. */
static void attributes_check(const Field *attributes) {
    static const char *const read[] = {"POSITION", "NORMAL",   "TANGENT",   "TEXCOORD_", "COLOR_",
                                       "JOINTS_0", "JOINTS_1", "WEIGHTS_0", "WEIGHTS_1", "_"};
    const char *name;
    json_t *value;
    json_object_foreach(attributes->json, name, value) {
        bool known = false;
        for (size_t k = 0; k < sizeof read / sizeof *read; k++) known |= strncmp(name, read[k], strlen(read[k])) == 0;
        Field field = field_member(attributes, name);
        if (!known) field_warn(&field, WEFT_MESSAGE_GLTF_WARN_IGNORED, "this attribute is not read");
    }
}

static void indices_read(const Field *field, Primitive *p) {
    Asset *asset = field->asset;
    p->index = field_index(field, asset->accessor_count);
    if (p->index < 0 || asset->result != WEFT_OK) return;
    const Accessor *a = &asset->accessors[p->index];
    if (a->columns != 1 || a->rows != 1 || !is_unsigned(a) || a->normalized)
        field_fail(field, WEFT_MESSAGE_GLTF_SCHEMA, "accessor %d is not of unsigned scalars", p->index);
}

static void targets_read(const Field *list, Primitive *p, size_t count) {
    static const char *const names[TARGET_ATTRIBUTES] = {"POSITION", "NORMAL", "TANGENT"};
    Asset *asset = list->asset;
    p->target_count = field_count(list);
    if (!p->target_count) return;
    p->targets = asset_array(asset, &asset->arena, p->target_count, sizeof *p->targets);
    for (size_t t = 0; t < p->target_count && asset->result == WEFT_OK; t++) {
        Field target = field_element(list, t);
        for (int k = 0; k < TARGET_ATTRIBUTES; k++) p->targets[t][k] = attribute_read(&target, names[k], 3, 3, count);
    }
}

static void skin_sets_read(const Field *attributes, Primitive *p, size_t count) {
    for (int set = 0; set < SKIN_SETS; set++) {
        char joints[16], weights[16];
        snprintf(joints, sizeof joints, "JOINTS_%d", set);
        snprintf(weights, sizeof weights, "WEIGHTS_%d", set);
        p->joints[set] = attribute_read(attributes, joints, 4, 4, count);
        p->weights[set] = attribute_read(attributes, weights, 4, 4, count);
        if (p->joints[set] >= 0 && !is_unsigned(&attributes->asset->accessors[p->joints[set]]))
            field_fail(attributes, WEFT_MESSAGE_GLTF_SCHEMA, "JOINTS_%d is not of unsigned integers", set);
    }
}

static void variants_map(const Field *field, Primitive *p) {
    Asset *asset = field->asset;
    size_t variant_count = (size_t)asset->scene->variant_count;
    Field mappings = field_member(field, "mappings");
    if (!field->json || !variant_count) return;
    p->variant_material = asset_array(asset, &asset->scene->arena, variant_count, sizeof(int));
    if (!p->variant_material) return;
    for (size_t v = 0; v < variant_count; v++) p->variant_material[v] = -1;
    size_t count = field_count(&mappings);
    for (size_t i = 0; i < count && asset->result == WEFT_OK; i++) {
        Field mapping = field_element(&mappings, i), material = field_member(&mapping, "material"),
              variants = field_member(&mapping, "variants");
        int index = field_needed_index(&material, asset->material_count);
        size_t names = field_count(&variants);
        for (size_t n = 0; n < names && asset->result == WEFT_OK; n++) {
            Field element = field_element(&variants, n);
            int variant = field_needed_index(&element, variant_count);
            if (variant >= 0) p->variant_material[variant] = index;
        }
    }
}

static void primitive_read(const Field *field, Primitive *p) {
    Asset *asset = field->asset;
    Field attributes = field_member(field, "attributes"), indices = field_member(field, "indices"),
          material = field_member(field, "material"), mode = field_member(field, "mode"),
          targets = field_member(field, "targets"), variants = field_extension(field, "KHR_materials_variants");
    if (!attributes.json) field_fail(&attributes, WEFT_MESSAGE_GLTF_SCHEMA, "missing an object");
    p->mode = (int)field_size(&mode, 4, 0, 6);
    p->position = attribute_read(&attributes, "POSITION", 3, 3, 0);
    size_t count = p->position < 0 ? 0 : asset->accessors[p->position].count;
    p->normal = attribute_read(&attributes, "NORMAL", 3, 3, count);
    p->tangent = attribute_read(&attributes, "TANGENT", 4, 4, count);
    p->color = attribute_read(&attributes, "COLOR_0", 3, 4, count);
    skin_sets_read(&attributes, p, count);
    targets_read(&targets, p, count);
    attributes_check(&attributes);
    indices_read(&indices, p);
    p->material = field_index(&material, asset->material_count);
    if (p->material < 0) p->material = (int)asset->material_count;
    variants_map(&variants, p);
    coordinates_read(&attributes, count, p);
    draco_read(field, p);
    if (p->mode < 4)
        field_warn(field, WEFT_MESSAGE_GLTF_WARN_IGNORED, "points and lines are not shown");
    else if (p->position < 0 && asset->result == WEFT_OK)
        field_warn(field, WEFT_MESSAGE_GLTF_WARN_IGNORED, "it has no positions");
}

static void mesh_read(const Field *field, MeshSource *mesh) {
    Asset *asset = field->asset;
    Field name = field_member(field, "name"), primitives = field_member(field, "primitives"),
          weights = field_member(field, "weights");
    mesh->name = field_text(&name, "");
    mesh->weight_count = field_count(&weights);
    if (mesh->weight_count) {
        mesh->weights = asset_array(asset, &asset->arena, mesh->weight_count, sizeof *mesh->weights);
        if (mesh->weights) field_floats(&weights, mesh->weights, mesh->weight_count, -1e6f, 1e6f);
    }
    mesh->primitive_count = field_count(&primitives);
    mesh->primitives = asset_array(asset, &asset->arena, mesh->primitive_count, sizeof *mesh->primitives);
    for (size_t i = 0; i < mesh->primitive_count && asset->result == WEFT_OK; i++) {
        Field primitive = field_element(&primitives, i);
        primitive_read(&primitive, &mesh->primitives[i]);
        mesh->morphs |= mesh->primitives[i].target_count > 0;
    }
}

void meshes_read(Asset *asset) {
    Field root = field_root(asset), list = field_member(&root, "meshes");
    asset->mesh_count = field_count(&list);
    asset->meshes = asset_array(asset, &asset->arena, asset->mesh_count, sizeof *asset->meshes);
    for (size_t i = 0; i < asset->mesh_count && asset->result == WEFT_OK; i++) {
        Field field = field_element(&list, i);
        mesh_read(&field, &asset->meshes[i]);
    }
}
