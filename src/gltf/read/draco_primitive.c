#include "gltf/read/draco_primitive.h"

#include <stddef.h>
#include <stdio.h>

#include "base/fail.h"
#include "gltf/asset/accessor.h"
#include "gltf/asset/buffer_views.h"
#include "gltf/asset/draco.h"

/* The attributes that may be compressed, and where a primitive has their accessors. */
static const struct {
    const char *name;
    size_t offset;
} attributes[DRACO_ATTRIBUTES] = {
    {"POSITION", offsetof(Primitive, position)},
    {"NORMAL", offsetof(Primitive, normal)},
    {"TANGENT", offsetof(Primitive, tangent)},
    {"TEXCOORD_0", offsetof(Primitive, texcoord)},
    {"TEXCOORD_1", offsetof(Primitive, texcoord) + sizeof(int)},
    {"COLOR_0", offsetof(Primitive, color)},
    {"JOINTS_0", offsetof(Primitive, joints)},
    {"JOINTS_1", offsetof(Primitive, joints) + sizeof(int)},
    {"WEIGHTS_0", offsetof(Primitive, weights)},
    {"WEIGHTS_1", offsetof(Primitive, weights) + sizeof(int)},
};

/* Returns the name of an attribute; that of coordinates is written to text. */
static const char *name_of(const Primitive *p, size_t attribute, char text[24]) {
    const size_t first = offsetof(Primitive, texcoord), at = attributes[attribute].offset;
    if (at != first && at != first + sizeof(int)) return attributes[attribute].name;
    snprintf(text, 24, "TEXCOORD_%d", p->set[at != first]);
    return text;
}

static int *slot_of(Primitive *p, size_t attribute) { return (int *)((char *)p + attributes[attribute].offset); }

void draco_read(const Field *field, Primitive *p) {
    Asset *asset = field->asset;
    Field extension = field_extension(field, "KHR_draco_mesh_compression"),
          view = field_member(&extension, "bufferView"), list = field_member(&extension, "attributes");
    if (!extension.json || asset->result != WEFT_OK) return;
    DracoSource *draco = asset_array(asset, &asset->arena, 1, sizeof *draco);
    if (!draco) return;
    draco->view = field_needed_index(&view, asset->view_count);
    if (!list.json) field_fail(&list, WEFT_MESSAGE_GLTF_SCHEMA, "missing an object");
    for (size_t k = 0; k < DRACO_ATTRIBUTES && asset->result == WEFT_OK; k++) {
        char text[24];
        Field id = field_member(&list, name_of(p, k, text));
        draco->id[k] = (int64_t)field_size(&id, 0, 0, UINT32_MAX);
        if (!id.json || *slot_of(p, k) < 0) draco->id[k] = -1;
        if (id.json && *slot_of(p, k) < 0)
            field_fail(&id, WEFT_MESSAGE_GLTF_SCHEMA, "the primitive has no such attribute");
    }
    if (p->mode != 4 && p->mode != 5) field_fail(&extension, WEFT_MESSAGE_GLTF_SCHEMA, "it needs mode 4 or 5");
    if (p->position >= 0) p->draco = draco; /* without positions nothing is shown */
}

static DracoType type_of(Component component) {
    return (DracoType){.is_float = component == COMPONENT_F32,
                       .is_signed = component == COMPONENT_I8 || component == COMPONENT_I16,
                       .size = component == COMPONENT_I8 || component == COMPONENT_U8     ? 1
                               : component == COMPONENT_I16 || component == COMPONENT_U16 ? 2
                                                                                          : 4};
}

/* Copies what was decoded to accessors of its own. Returns why it does not fit the primitive, NULL if it does. */
static const char *accessors_make(Asset *asset, const DracoMesh *mesh, Primitive *p) {
    const size_t points = draco_point_count(mesh), corners = 3 * draco_triangle_count(mesh);
    Primitive made = *p;
    if (!corners) return "it has no triangles";
    if (points != asset->accessors[p->position].count) return "it has not as many points as its accessors";
    for (size_t k = 0; k < DRACO_ATTRIBUTES; k++) {
        if (p->draco->id[k] < 0) continue;
        Accessor a = asset->accessors[*slot_of(p, k)];
        const DracoType type = type_of(a.component);
        const size_t size = (size_t)type.size * a.rows;
        unsigned char *bytes = asset_array(asset, &asset->arena, points, size);
        if (!bytes) return NULL;
        if (!draco_attribute(mesh, (uint32_t)p->draco->id[k], type, a.rows, bytes)) return "it lacks an attribute";
        *slot_of(&made, k) = accessor_add(asset, a, (Span){bytes, points * size});
    }
    unsigned char *bytes = asset_array(asset, &asset->arena, corners, sizeof(uint32_t));
    if (!bytes) return NULL;
    if (!draco_indices(mesh, (uint32_t *)(void *)bytes)) return "an index is beyond its points";
    const Accessor index = {.count = corners, .component = COMPONENT_U32, .columns = 1, .rows = 1};
    made.index = accessor_add(asset, index, (Span){bytes, corners * sizeof(uint32_t)});
    made.mode = 4;
    made.draco = NULL;
    if (asset->result == WEFT_OK) *p = made;
    return NULL;
}

/* Decodes the primitive. Returns why not, or NULL, also after a sticky failure. */
static const char *decode(Asset *asset, Primitive *p) {
    const size_t most = (size_t)4 << 30, left = asset->limit - asset->spent,
                 allowed = left < most / 2 ? 2 * left : most;
    const Span bytes = view_bytes(asset, p->draco->view);
    DracoMesh *mesh = NULL;
    const char *reason = NULL;
    if (!bytes.data) return NULL;
    switch (draco_open(bytes.data, bytes.size, allowed, &mesh)) {
    case DRACO_READ: reason = accessors_make(asset, mesh, p); break;
    case DRACO_VERSION: reason = "it is not Draco 2.2"; break;
    case DRACO_DAMAGED: reason = "damaged data"; break;
    case DRACO_LARGE: reason = "it takes more memory than its size is worth"; break;
    case DRACO_MEMORY: asset_fail(asset, WEFT_MESSAGE_MEMORY, NULL); break;
    }
    draco_close(mesh);
    return reason;
}

static bool has_data(const Asset *asset, int accessor) {
    return asset->accessors[accessor].view >= 0 && asset->views[asset->accessors[accessor].view].span.data;
}

/* Returns true if the accessors have data without the extension. */
static bool has_fallback(const Asset *asset, Primitive *p) {
    bool all = p->index < 0 || has_data(asset, p->index);
    for (size_t k = 0; k < DRACO_ATTRIBUTES; k++) all = all && (p->draco->id[k] < 0 || has_data(asset, *slot_of(p, k)));
    return all;
}

void draco_unpack(Asset *asset, int mesh, Primitive *p) {
    if (!p->draco || asset->result != WEFT_OK) return;
    const int number = (int)(p - asset->meshes[mesh].primitives);
    const char *reason = decode(asset, p);
    if (!reason) return;
    if (has_fallback(asset, p)) {
        warn(asset->log, WEFT_MESSAGE_GLTF_WARN_REPAIRED, asset->name,
             "meshes[%d].primitives[%d]: Draco: %s; its accessors without compression are used", mesh, number, reason);
        p->draco = NULL;
    } else {
        asset_fail(asset, WEFT_MESSAGE_GLTF_DECODE, "meshes[%d].primitives[%d]: Draco: %s", mesh, number, reason);
    }
}
