/* node_save.c - meshes, lights and cameras, each under a node of its own; and the variants */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/pi.h"
#include "gltf/save/saving.h"

enum { VERTICES = 34962, INDICES = 34963, FLOAT = 5126, UNSIGNED_INT = 5125 };

/* Saves count values of `width` floats as an accessor and returns its index. bounds: with the minimum and
 * maximum of each component. */
static int floats_save(Saving *saving, const float *values, size_t count, int width, bool bounds) {
    static const char *const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    json_t *list = saving_list(saving, "accessors"), *object = json_object();
    size_t size = count * (size_t)width * sizeof(float);
    saving_put(saving, object, "bufferView", json_integer(saving_view(saving, values, size, VERTICES)));
    saving_put(saving, object, "componentType", json_integer(FLOAT));
    saving_put(saving, object, "count", json_integer((json_int_t)count));
    saving_put(saving, object, "type", json_string(types[width]));
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t k = 0; bounds && k < 3 * count; k++) {
        low[k % 3] = fminf(low[k % 3], values[k]);
        high[k % 3] = fmaxf(high[k % 3], values[k]);
    }
    if (bounds) saving_put(saving, object, "min", saving_floats(low, 3));
    if (bounds) saving_put(saving, object, "max", saving_floats(high, 3));
    saving_append(saving, list, object);
    return (int)json_array_size(list) - 1;
}

static int indices_save(Saving *saving, const Mesh *mesh) {
    json_t *list = saving_list(saving, "accessors"), *object = json_object();
    size_t count = 3 * (size_t)mesh->triangle_count, size = count * sizeof *mesh->index;
    saving_put(saving, object, "bufferView", json_integer(saving_view(saving, mesh->index, size, INDICES)));
    saving_put(saving, object, "componentType", json_integer(UNSIGNED_INT));
    saving_put(saving, object, "count", json_integer((json_int_t)count));
    saving_put(saving, object, "type", json_string("SCALAR"));
    saving_append(saving, list, object);
    return (int)json_array_size(list) - 1;
}

static void attribute_put(Saving *saving, const Mesh *mesh, json_t *attributes, const char *name, const float *values,
                          int width) {
    if (!values) return;
    int index = floats_save(saving, values, mesh->vertex_count, width, strcmp(name, "POSITION") == 0);
    saving_put(saving, attributes, name, json_integer(index));
}

/* Returns true if a map of the material uses that set of texture coordinates. */
static bool looks_up(const Material *material, int set) {
    bool any = false;
    for (int k = 0; k < INPUT_COUNT; k++) any |= material->inputs[k].texture && material->inputs[k].texcoord == set;
    return any;
}

static bool material_needs_set(const WeftScene *scene, int material, int set) {
    return looks_up(&scene->materials[material], set) ||
           (scene_has_back(scene, material) && looks_up(&scene->materials[scene->material_count + material], set));
}

static bool needs_set(const WeftScene *scene, const Mesh *mesh, int set) {
    bool needs = material_needs_set(scene, mesh->material, set);
    for (int v = 0; v < scene->variant_count && mesh->variant_material; v++)
        if (mesh->variant_material[v] >= 0) needs |= material_needs_set(scene, mesh->variant_material[v], set);
    return needs;
}

/* Finds the sets of texture coordinates to save. A missing set is filled with zeros if a map needs it, or if
 * set 1 exists without set 0, since readers need the sets in sequence. */
static void texcoords_find(Saving *saving, const Mesh *mesh, const float *sets[2]) {
    for (int k = 1; k >= 0; k--) {
        sets[k] = mesh->texcoord[k];
        if (sets[k] || !(needs_set(saving->scene, mesh, k) || (k == 0 && sets[1]))) continue;
        sets[k] = arena_array(&saving->arena, mesh->vertex_count, 2 * sizeof(float));
        if (!sets[k]) saving_fail(saving, WEFT_MESSAGE_MEMORY, saving->path, NULL);
    }
}

static json_t *attributes_save(Saving *saving, const Mesh *mesh) {
    json_t *attributes = json_object();
    const float *sets[2];
    texcoords_find(saving, mesh, sets);
    attribute_put(saving, mesh, attributes, "POSITION", mesh->position, 3);
    attribute_put(saving, mesh, attributes, "NORMAL", mesh->normal, 3);
    attribute_put(saving, mesh, attributes, "TANGENT", mesh->normal ? mesh->tangent : NULL, 4);
    attribute_put(saving, mesh, attributes, "TEXCOORD_0", sets[0], 2);
    attribute_put(saving, mesh, attributes, "TEXCOORD_1", sets[1], 2);
    attribute_put(saving, mesh, attributes, "COLOR_0", mesh->color, 4);
    return attributes;
}

/* Saves the material of each variant on a mesh, one mapping a material. */
static void mappings_put(Saving *saving, const Mesh *mesh, json_t *primitive) {
    const WeftScene *scene = saving->scene;
    json_t *mappings = json_array();
    for (int m = 0; m < scene->material_count && mesh->variant_material; m++) {
        json_t *variants = json_array();
        for (int v = 0; v < scene->variant_count; v++)
            if (mesh->variant_material[v] == m) saving_append(saving, variants, json_integer(v));
        if (json_array_size(variants)) {
            json_t *mapping = json_object();
            saving_put(saving, mapping, "material", json_integer(m));
            saving_put(saving, mapping, "variants", json_incref(variants));
            saving_append(saving, mappings, mapping);
        }
        json_decref(variants);
    }
    if (!json_array_size(mappings)) {
        json_decref(mappings);
        return;
    }
    json_t *extension = json_object();
    saving_put(saving, extension, "mappings", mappings);
    saving_extend(saving, primitive, "KHR_materials_variants", extension);
}

/* Appends a node, and its number to the list of the scene that is shown. */
static void node_append(Saving *saving, json_t *node) {
    json_t *nodes = saving_list(saving, "nodes"), *shown = json_array_get(saving_list(saving, "scenes"), 0);
    saving_append(saving, nodes, node);
    if (!json_object_get(shown, "nodes")) saving_put(saving, shown, "nodes", json_array());
    saving_append(saving, json_object_get(shown, "nodes"), json_integer((json_int_t)json_array_size(nodes) - 1));
}

static void mesh_save(Saving *saving, const Mesh *mesh) {
    if (!mesh->triangle_count || !mesh->vertex_count) return; /* glTF cannot express an empty mesh */
    json_t *list = saving_list(saving, "meshes"), *object = json_object(), *primitives = json_array(),
           *primitive = json_object(), *node = json_object();
    saving_put(saving, primitive, "attributes", attributes_save(saving, mesh));
    saving_put(saving, primitive, "indices", json_integer(indices_save(saving, mesh)));
    saving_put(saving, primitive, "material", json_integer(mesh->material));
    mappings_put(saving, mesh, primitive);
    saving_append(saving, primitives, primitive);
    saving_name(saving, object, mesh->name);
    saving_put(saving, object, "primitives", primitives);
    saving_put(saving, node, "mesh", json_integer((json_int_t)json_array_size(list)));
    saving_append(saving, list, object);
    node_append(saving, node);
}

/* Returns the matrix of a node from its columns. */
static json_t *matrix(Vec3 x, Vec3 y, Vec3 z, Vec3 at) {
    const float m[16] = {x.x, x.y, x.z, 0.0f, y.x, y.y, y.z, 0.0f, z.x, z.y, z.z, 0.0f, at.x, at.y, at.z, 1.0f};
    return saving_floats(m, 16);
}

/* Returns the matrix of a node at `at` whose -z is direction, with any up. */
static json_t *aimed(Vec3 at, Vec3 direction) {
    Vec3 back = vec3_scale(direction, -1.0f);
    Vec3 up = fabsf(back.y) < 0.9f ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f);
    Vec3 right = vec3_normal_or(vec3_cross(up, back), vec3(1.0f, 0.0f, 0.0f));
    return matrix(right, vec3_cross(back, right), back, at);
}

/* Returns the half angle of a cone, whose cosine in float is that number. */
static double cone(float cosine) { return fmin(acos((double)cosine), 0.5 * PI_DOUBLE); }

static json_t *light_object(Saving *saving, const Light *light) {
    static const char *const types[] = {"directional", "point", "spot"}; /* indexed by LightKind */
    float color[3];
    double intensity = (double)light->intensity;
    json_t *object = json_object();
    memcpy(color, light->color, sizeof color);
    /* a colour is in [0, 1]; halving is exact */
    while (fmaxf(color[0], fmaxf(color[1], color[2])) > 1.0f) {
        for (int c = 0; c < 3; c++) color[c] *= 0.5f;
        intensity *= 2.0;
    }
    saving_name(saving, object, light->name);
    saving_put(saving, object, "type", json_string(types[light->kind]));
    saving_put(saving, object, "color", saving_floats(color, 3));
    saving_put(saving, object, "intensity", json_real(intensity));
    if (light->range > 0.0f && light->kind != LIGHT_DIRECTIONAL)
        saving_put(saving, object, "range", json_real((double)light->range));
    if (light->kind != LIGHT_SPOT) return object;
    json_t *spot = json_object();
    double outer = cone(light->cos_outer);
    saving_put(saving, spot, "outerConeAngle", json_real(outer));
    /* it must be less, by an amount that does not change the cosine in float */
    saving_put(saving, spot, "innerConeAngle", json_real(fmax(fmin(cone(light->cos_inner), outer - 1e-9), 0.0)));
    saving_put(saving, object, "spot", spot);
    return object;
}

static void light_save(Saving *saving, const Light *light, json_t *list) {
    if ((int)light->kind > (int)LIGHT_SPOT) return; /* a polygon light is saved as an emissive mesh */
    json_t *node = json_object(), *extension = json_object();
    saving_put(saving, extension, "light", json_integer((json_int_t)json_array_size(list)));
    saving_append(saving, list, light_object(saving, light));
    if (light->kind == LIGHT_POINT)
        saving_put(saving, node, "translation", saving_floats(&light->position.x, 3));
    else
        saving_put(saving, node, "matrix", aimed(light->position, light->direction));
    saving_extend(saving, node, "KHR_lights_punctual", extension);
    node_append(saving, node);
}

static void lights_save(Saving *saving) {
    json_t *list = json_array();
    for (int k = 0; k < saving->scene->light_count; k++) light_save(saving, &saving->scene->lights[k], list);
    if (!json_array_size(list)) {
        json_decref(list);
        return;
    }
    json_t *extension = json_object();
    saving_put(saving, extension, "lights", list);
    saving_extend(saving, saving->root, "KHR_lights_punctual", extension);
}

/* Saves a camera. glTF requires a near plane, which nothing here needs. */
static void camera_save(Saving *saving, const Camera *camera) {
    json_t *list = saving_list(saving, "cameras"), *object = json_object(), *lens = json_object(),
           *node = json_object();
    const char *type = camera->orthographic ? "orthographic" : "perspective";
    saving_name(saving, object, camera->name);
    saving_put(saving, object, "type", json_string(type));
    saving_put(saving, lens, "znear", json_real(0.01));
    if (camera->orthographic) {
        saving_put(saving, lens, "zfar", json_real(1e6));
        saving_put(saving, lens, "xmag", json_real((double)camera->ymag));
        saving_put(saving, lens, "ymag", json_real((double)camera->ymag));
    } else {
        saving_put(saving, lens, "yfov", json_real((double)camera->yfov));
    }
    saving_put(saving, object, type, lens);
    saving_put(saving, node, "camera", json_integer((json_int_t)json_array_size(list)));
    saving_put(saving, node, "matrix",
               matrix(camera->right, camera->up, vec3_scale(camera->forward, -1.0f), camera->eye));
    saving_append(saving, list, object);
    node_append(saving, node);
}

static void variants_save(Saving *saving) {
    json_t *list = json_array(), *extension = json_object();
    for (int k = 0; k < saving->scene->variant_count; k++) {
        json_t *variant = json_object();
        saving_put(saving, variant, "name", json_string(saving->scene->variants[k]));
        saving_append(saving, list, variant);
    }
    saving_put(saving, extension, "variants", list);
    if (saving->scene->variant_count)
        saving_extend(saving, saving->root, "KHR_materials_variants", extension);
    else
        json_decref(extension);
}

void nodes_save(Saving *saving) {
    const WeftScene *scene = saving->scene;
    saving_append(saving, saving_list(saving, "scenes"), json_object());
    saving_put(saving, saving->root, "scene", json_integer(0));
    for (int k = 0; k < scene->mesh_count && saving->result == WEFT_OK; k++) mesh_save(saving, &scene->meshes[k]);
    lights_save(saving);
    for (int k = 0; k < scene->camera_count; k++) camera_save(saving, &scene->cameras[k]);
    variants_save(saving);
}
