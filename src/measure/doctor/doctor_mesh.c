/* doctor_mesh.c - meshes: attributes that their materials need, and open edges */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/asset/accessor.h"
#include "measure/doctor/doctor.h"
#include "scene/material/cloth_fit.h"

enum { TRIANGLES = 4, STRIP = 5, FAN = 6 };

static bool is_surface(const Primitive *p) { return p->mode >= TRIANGLES && p->mode <= FAN; }

static json_t *material_of(const WeftDoctor *doctor, const Primitive *p) {
    return doctor_item(doctor, "materials", p->material);
}

/* Returns the UV set of a textureInfo, which its transform may replace; -1 if it is invalid. */
static int set_of(json_t *info) {
    double set = 0.0;
    doctor_numbers(info, "texCoord", &set, 1);
    doctor_numbers(info, "extensions/KHR_texture_transform/texCoord", &set, 1);
    return set >= 0.0 && set < 1e6 ? (int)set : -1;
}

/* Returns true if a set that textures are read by is invalid, or the primitive lacks it. */
static bool is_missing(const Primitive *p, int set) {
    bool missing = set < 0;
    for (int k = 0; k < 2; k++) missing = missing || (p->set[k] == set && p->texcoord[k] < 0);
    return missing;
}

/* Returns true if a texture of the material needs a set of texture coordinates that the primitive lacks,
 * and then sets its key and set. */
static bool lacks_set(json_t *part, const Primitive *p, const char **key, int *set) {
    const char *name;
    json_t *value;
    json_object_foreach(part, name, value) {
        if (strcmp(name, "extras") == 0 || !json_is_object(value)) continue;
        size_t length = strlen(name);
        if (length > 7 && strcmp(name + length - 7, "Texture") == 0 && json_object_get(value, "index")) {
            *set = set_of(value);
            *key = name;
            if (is_missing(p, *set)) return true;
        } else if (lacks_set(value, p, key, set)) {
            return true;
        }
    }
    return false;
}

static void check_attributes(WeftDoctor *doctor, int mesh, int number, const Primitive *p) {
    char path[48];
    json_t *material = material_of(doctor, p);
    const char *key = NULL;
    int set = 0;
    snprintf(path, sizeof path, "primitives/%d/attributes", number);
    const Place place = {WEFT_OF_MESH, mesh, path};
    if (lacks_set(material, p, &key, &set)) {
        doctor_found(doctor, WEFT_FINDING_TEXCOORD_MISSING, place, 0, (double)set, NULL,
                     "primitive %d has no TEXCOORD_%d, which %.40s of materials[%d] is read by: it is one "
                     "colour all over, or "
                     "whatever an engine makes of that",
                     number, set, key, p->material);
        doctor_advise(doctor, "unwrap the mesh, or name the set that it has in texCoord");
    }
    if (p->normal < 0) {
        doctor_found(doctor, WEFT_FINDING_NORMALS_MISSING, place, 0, (double)NAN, NULL,
                     "primitive %d has no NORMAL: it is shown with flat facets, and a sheen shows each of them",
                     number);
        doctor_advise(doctor, "export smooth normals");
    }
}

/* Returns which input of a material needs tangents; NULL if none does. */
static const char *needs_tangents(json_t *material) {
    double strength = 0.0;
    if (doctor_part(material, "normalTexture")) return "normalTexture";
    if (doctor_part(material, "extensions/KHR_materials_clearcoat/clearcoatNormalTexture"))
        return "clearcoatNormalTexture";
    doctor_numbers(material, "extensions/KHR_materials_anisotropy/anisotropyStrength", &strength, 1);
    return strength > 0.0 ? "anisotropy" : NULL;
}

static void check_tangents(WeftDoctor *doctor, int mesh, int number, const Primitive *p) {
    char path[48];
    const char *what = needs_tangents(material_of(doctor, p));
    if (!what || p->tangent >= 0 || p->normal < 0) return;
    snprintf(path, sizeof path, "primitives/%d/attributes", number);
    doctor_found(doctor, WEFT_FINDING_TANGENTS_MISSING, (Place){WEFT_OF_MESH, mesh, path},
                 doctor_engine("three") | doctor_engine("babylon") | doctor_engine("khronos"), (double)NAN, NULL,
                 "primitive %d has no TANGENT, but %s of materials[%d] needs them: these engines guess from "
                 "the picture's "
                 "derivatives and not as MikkTSpace does, so that seams and mirrored parts show",
                 number, what, p->material);
    doctor_advise(doctor, "export tangents, those that the map was baked with");
}

/* ---- edges ---- */

static int compare_words(const void *a, const void *b) {
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* A corner and where it is, for sorting by place. */
typedef struct Corner {
    float at[3];
    uint32_t number;
} Corner;

static int compare_corners(const void *a, const void *b) {
    const Corner *x = a, *y = b;
    for (int k = 0; k < 3; k++)
        if (x->at[k] < y->at[k] || x->at[k] > y->at[k]) return x->at[k] < y->at[k] ? -1 : 1;
    return 0;
}

/* Gives numbers to the corners of all triangles of a mesh, equal where the places are equal. */
static uint32_t *weld(Corner *corners, size_t count, Arena *arena) {
    uint32_t *place = arena_array(arena, count, sizeof *place), next = 0;
    if (!place) return NULL;
    qsort(corners, count, sizeof *corners, compare_corners);
    for (size_t k = 0; k < count; k++) {
        if (k && compare_corners(&corners[k - 1], &corners[k]) != 0) next++;
        place[corners[k].number] = next;
    }
    return place;
}

/* Returns the fraction of edges that only one triangle has. */
static double open_share(const uint32_t *place, size_t corners, Arena *arena) {
    uint64_t *edges = arena_array(arena, corners, sizeof *edges);
    size_t count = 0, open = 0, all = 0;
    for (size_t k = 0; edges && k < corners; k++) {
        uint64_t a = place[k], b = place[k % 3 == 2 ? k - 2 : k + 1];
        if (a != b) edges[count++] = a < b ? a << 32 | b : b << 32 | a;
    }
    if (!count) return 0.0;
    qsort(edges, count, sizeof *edges, compare_words);
    for (size_t k = 0, run; k < count; k += run, all++) {
        for (run = 1; k + run < count && edges[k + run] == edges[k];) run++;
        open += run == 1;
    }
    return (double)open / (double)all;
}

/* Appends the corners of a primitive's triangles; returns false if they cannot be read. */
static bool gather(WeftDoctor *doctor, const Primitive *p, Corner *corners, size_t *count, size_t most, Arena *arena) {
    size_t vertices = doctor->asset.accessors[p->position].count;
    size_t wanted = p->index < 0 ? vertices : doctor->asset.accessors[p->index].count;
    const float *position = accessor_floats(&doctor->asset, arena, p->position);
    const uint32_t *index = p->index < 0 ? NULL : accessor_integers(&doctor->asset, arena, p->index);
    if (!position || (p->index >= 0 && !index)) return false;
    for (size_t k = 0; k < wanted / 3 * 3 && *count < most; k++) {
        size_t vertex = index ? index[k] : k;
        if (vertex >= vertices) return false;
        Corner *corner = &corners[*count];
        memcpy(corner->at, position + 3 * vertex, sizeof corner->at);
        corner->number = (uint32_t)(*count)++;
    }
    return true;
}

static double mesh_open(WeftDoctor *doctor, const MeshSource *mesh) {
    enum { CORNERS_MAX = 6000000 };
    size_t capacity = 0, count = 0;
    Arena arena = {0};
    bool whole = true;
    for (size_t k = 0; k < mesh->primitive_count; k++) {
        const Primitive *p = &mesh->primitives[k];
        if (p->mode != TRIANGLES || p->position < 0) return 0.0;
        capacity += doctor->asset.accessors[p->index < 0 ? p->position : p->index].count;
    }
    if (!capacity || capacity > CORNERS_MAX) return 0.0;
    Corner *corners = arena_array(&arena, capacity, sizeof *corners);
    for (size_t k = 0; corners && k < mesh->primitive_count && whole; k++)
        whole = gather(doctor, &mesh->primitives[k], corners, &count, capacity, &arena);
    uint32_t *place = corners && whole ? weld(corners, count, &arena) : NULL;
    double share = place ? open_share(place, count, &arena) : 0.0;
    arena_free(&arena);
    return share;
}

/* Reports cloth of a single layer that is not double-sided, since it is seen from behind. */
static void check_back(WeftDoctor *doctor, int mesh) {
    const MeshSource *source = &doctor->asset.meshes[mesh];
    int cloth = -1;
    for (size_t k = 0; k < source->primitive_count && cloth < 0; k++) {
        json_t *material = material_of(doctor, &source->primitives[k]);
        Cloth used = material ? doctor_cloth(doctor, source->primitives[k].material) : (Cloth){0};
        if (cloth_shows(&used) && !json_is_true(json_object_get(material, "doubleSided")))
            cloth = source->primitives[k].material;
    }
    double share = cloth < 0 ? 0.0 : mesh_open(doctor, source);
    if (!(share > 0.0)) return;
    doctor_found(doctor, WEFT_FINDING_BACK_MISSING, (Place){WEFT_OF_MESH, mesh, NULL}, 0, share, NULL,
                 "%.2g %% of its edges are open, and its cloth, materials[%d], is not doubleSided: where it "
                 "is seen from "
                 "behind there is nothing",
                 100.0 * share, cloth);
    doctor_advise(doctor, "write doubleSided true, unless no back can be seen");
}

void check_empty(WeftDoctor *doctor) {
    const size_t meshes = doctor->asset.mesh_count;
    if (scene_own_meshes(doctor->scene) || (!meshes && doctor->asset.material_count))
        return; /* or a set of materials */
    doctor_found(doctor, WEFT_FINDING_SCENE_EMPTY, (Place){WEFT_OF_ASSET, 0, NULL}, 0, (double)meshes, NULL,
                 meshes ? "none of its %zu meshes is in the scene as a surface: there is nothing to see"
                        : "the file has %zu meshes: there is nothing to see",
                 meshes);
    doctor_advise(doctor, "put a node with a mesh of triangles into the scene");
}

/* Returns true for what is woven here, or shows a sheen and is likely to be. */
static bool may_be_woven(const WeftDoctor *doctor, const Cloth *cloth) {
    return cloth_shows(cloth) ||
           (cloth->index < doctor->scene->material_count && doctor->scene->materials[cloth->index].cloth);
}

void check_scale(WeftDoctor *doctor, const Cloth *cloth) {
    double uneven;
    if (!may_be_woven(doctor, cloth)) return;
    const double metres = cloth_uv_metres(doctor->scene, cloth->index, 0, &uneven);
    if (!(uneven > CLOTH_UNEVEN)) return;
    doctor_found(
        doctor, WEFT_FINDING_UV_UNEVEN, (Place){WEFT_OF_MATERIAL, cloth->index, NULL}, 0, uneven, NULL,
        "a unit of its texture coordinates spans %.2g to %.2g m on most of its surface: threads of a weave, and "
        "whatever else a texture repeats, differ as much in size",
        metres * (exp)(-uneven), metres * (exp)(uneven));
    doctor_advise(doctor, "unwrap it with one density of texels, or give parts materials of their own");
}

void check_mesh(WeftDoctor *doctor, int mesh) {
    const MeshSource *source = &doctor->asset.meshes[mesh];
    for (size_t k = 0; k < source->primitive_count; k++) {
        const Primitive *p = &source->primitives[k];
        if (!is_surface(p)) continue;
        check_attributes(doctor, mesh, (int)k, p);
        check_tangents(doctor, mesh, (int)k, p);
    }
    check_back(doctor, mesh);
}
