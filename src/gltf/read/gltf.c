#include "gltf/read/gltf.h"

#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/file.h"
#include "gltf/asset/accessor.h"
#include "gltf/asset/buffer_views.h"
#include "gltf/asset/container.h"
#include "gltf/asset/field.h"
#include "gltf/asset/material_fields.h"
#include "gltf/read/animation.h"
#include "gltf/read/gltf_camera.h"
#include "gltf/read/gltf_material.h"
#include "gltf/read/gltf_texture.h"
#include "gltf/read/light.h"
#include "gltf/read/mesh.h"
#include "gltf/read/node.h"
#include "gltf/read/pose.h"

static void version_check(Asset *asset) {
    Field root = field_root(asset), info = field_member(&root, "asset"), version_field = field_member(&info, "version"),
          least_field = field_member(&info, "minVersion");
    if (!version_field.json) {
        field_fail(&version_field, WEFT_MESSAGE_GLTF_VERSION, "missing a string");
        return;
    }
    const char *version = field_text(&version_field, "2.0");
    const char *least = field_text(&least_field, "2.0");
    if (strncmp(version, "2.", 2) != 0)
        field_fail(&version_field, WEFT_MESSAGE_GLTF_VERSION, "it is version %.20s", version);
    else if (strcmp(least, "2.0") != 0)
        field_fail(&least_field, WEFT_MESSAGE_GLTF_VERSION, "it needs version %.20s", least);
}

bool gltf_supports(const char *extension) {
    /* beside those of material_fields.h */
    static const char *const names[] = {
        "EXT_mesh_gpu_instancing", "EXT_meshopt_compression",    "KHR_animation_pointer", "KHR_meshopt_compression",
        "KHR_node_visibility",     "KHR_draco_mesh_compression", "KHR_lights_punctual",   "KHR_materials_unlit",
        "KHR_materials_variants",  "KHR_mesh_quantization",      "KHR_texture_transform",
    };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(extension, names[i]) == 0) return true;
    if (texture_extension_read(extension)) return true;
    for (const MaterialField *row = material_fields; row->factor; row++)
        if (row->input != NO_INPUT && material_field_extends(row) && strcmp(extension, row->object) == 0) return true;
    return false;
}

/* Warns of an extension that is ignored, with what that leaves out where it is known. */
static void ignored(const Asset *asset, const char *name) {
    const char *lost = material_extension_lost(name);
    warn(asset->log, WEFT_MESSAGE_GLTF_WARN_EXTENSION, asset->name, "%.80s%s%s", name, lost ? ": " : "",
         lost ? lost : "");
}

/* Warns of each extension below a value that neither weft knows nor `named` has, and adds it there. The reader limits
 * the depth of JSON. */
static void unnamed_check(Asset *asset, json_t *value, json_t *named) {
    const char *key, *name;
    json_t *part, *extension;
    size_t k;
    json_array_foreach(value, k, part) { unnamed_check(asset, part, named); }
    json_object_foreach(value, key, part) {
        if (strcmp(key, "extras") == 0) continue; /* extras belong to any application */
        if (strcmp(key, "extensions") == 0) json_object_foreach(part, name, extension) {
                if (gltf_supports(name) || json_object_get(named, name)) continue;
                ignored(asset, name);
                json_object_set_new(named, name, json_true());
            }
        unnamed_check(asset, part, named);
    }
}

static void extensions_check(Asset *asset) {
    Field root = field_root(asset), required = field_member(&root, "extensionsRequired"),
          used = field_member(&root, "extensionsUsed");
    size_t count = field_count(&required);
    for (size_t i = 0; i < count; i++) {
        Field field = field_element(&required, i);
        const char *name = field_text(&field, "");
        if (!gltf_supports(name) && !material_extension_lost(name) && !asset->examined)
            asset_fail(asset, WEFT_MESSAGE_GLTF_EXTENSION, "%.80s", name);
    }
    json_t *named = json_object();
    count = field_count(&used);
    for (size_t i = 0; i < count && asset->result == WEFT_OK; i++) {
        Field field = field_element(&used, i);
        const char *name = field_text(&field, "");
        if (!gltf_supports(name)) ignored(asset, name);
        json_object_set_new(named, name, json_true());
    }
    if (asset->result == WEFT_OK) unnamed_check(asset, asset->root, named);
    json_decref(named);
}

static void skins_and_nodes_read(Asset *asset) {
    Field root = field_root(asset), nodes = field_member(&root, "nodes");
    skins_read(asset, field_count(&nodes));
    if (asset->result == WEFT_OK) nodes_read(asset);
}

/* In the order in which they refer to one another. */
static void (*const stages[])(Asset *) = {
    version_check,        extensions_check, buffers_read,  views_read,  accessors_read,   animation_apply,
    textures_read,        materials_read,   variants_read, meshes_read, cameras_count,    lights_count,
    skins_and_nodes_read, cameras_read,     lights_read,   meshes_bake, textures_resolve, backs_take,
};

static const size_t FILE_MAX = (size_t)4 << 30, LIMIT_FIRST = (size_t)256 << 20;

void gltf_open(Asset *asset, const char *path, const void *data, size_t size) {
    asset->name = path;
    asset->in_memory = data != NULL;
    asset->limit = LIMIT_FIRST;
    Span bytes = {data, size};
    if (!data && asset_progress(asset, 0.0, 0.0, 0, 1)) {
        asset->result = file_read(path, FILE_MAX, &asset->file, asset->error);
        bytes = (Span){asset->file.data, asset->file.size};
    }
    asset->input_bytes = bytes.size;
    if (asset->result == WEFT_OK) container_read(asset, bytes);
}

void gltf_read_parts(Asset *asset) {
    for (size_t i = 0; i < sizeof stages / sizeof *stages && asset->result == WEFT_OK; i++) stages[i](asset);
    if (asset->result == WEFT_OK) asset_progress(asset, 1.0, 1.0, 1, 1);
}

void gltf_close(Asset *asset) {
    buffers_free(asset);
    json_decref(asset->root);
    arena_free(&asset->arena);
    free(asset->file.data);
    *asset = (Asset){0};
}

WeftResult gltf_read(const char *path, const void *data, size_t size, WeftScene *scene, const WeftLog *log,
                     WeftError *error) {
    return gltf_read_watched(path, data, size, NULL, scene, NULL, NULL, log, error);
}

WeftResult gltf_read_watched(const char *path, const void *data, size_t size, const WeftMoment *moment,
                             WeftScene *scene, WeftProgress progress, void *user, const WeftLog *log,
                             WeftError *error) {
    Asset asset = {.moment = moment, .log = log, .error = error, .progress = progress, .user = user, .scene = scene};
    gltf_open(&asset, path, data, size);
    gltf_read_parts(&asset);
    WeftResult result = asset.result;
    gltf_close(&asset);
    return result;
}
