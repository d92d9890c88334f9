/* light_list.c - the lights of a scene: adding, reading, changing and removing them
 *
 * Lights may be dragged for minutes: lists keep their memory when they shrink, and a polygon's vertices are written in
 * place. */
#include <math.h>
#include <string.h>

#include "base/fail.h"
#include "base/pi.h"
#include "scene/light/polygons.h"

static const float DEGREE = PI_FLOAT / 180.0f;

static bool all_finite(const float *v, int count) {
    bool finite = true;
    for (int k = 0; k < count; k++) finite &= isfinite(v[k]) != 0;
    return finite;
}

static const char *wrong_polygon(const WeftLight *l) {
    if (!(l->size[0] > 0.0f && l->size[1] > 0.0f && fmaxf(l->size[0], l->size[1]) <= SCENE_REACH)) return "size";
    if (l->corners != 0 && (l->corners < 3 || l->corners > LIGHT_CORNERS)) return "corners";
    return isfinite(l->roll) ? NULL : "roll";
}

static const char *wrong_light(const WeftLight *l) {
    bool beams = l->kind != WEFT_LIGHT_POINT;
    if ((unsigned)l->kind > WEFT_LIGHT_POLYGON) return "kind";
    if (!within_reach(vec3_load(l->position), SCENE_REACH)) return "position";
    if (beams && (!all_finite(l->direction, 3) || !(vec3_length(vec3_load(l->direction)) > 0.0f))) return "direction";
    for (int c = 0; c < 3; c++)
        if (!(isfinite(l->color[c]) && l->color[c] >= 0.0f)) return "color";
    if (!(isfinite(l->range) && l->range >= 0.0f)) return "range";
    if (!(l->inner >= 0.0f && l->outer <= 90.0f && (l->inner <= l->outer || !(l->outer > 0.0f)))) return "cone";
    return l->kind == WEFT_LIGHT_POLYGON ? wrong_polygon(l) : NULL;
}

static Light punctual_of(const WeftLight *l, const char *name) {
    const float outer = l->outer > 0.0f ? l->outer : 45.0f;
    Light light = {.name = name,
                   .kind = (LightKind)l->kind,
                   .position = vec3_load(l->position),
                   .direction = vec3_normal_or(vec3_load(l->direction), vec3(0.0f, -1.0f, 0.0f)),
                   .intensity = 1.0f,
                   .range = l->range,
                   .cos_inner = cosf(l->inner * DEGREE),
                   .cos_outer = cosf(outer * DEGREE)};
    memcpy(light.color, l->color, sizeof light.color);
    return light;
}

static WeftLight public_of(const Light *light) {
    const Vec3 p = light->position, d = light->direction;
    WeftLight l = {.kind = (WeftLightKind)light->kind,
                   .position = {p.x, p.y, p.z},
                   .direction = {d.x, d.y, d.z},
                   .range = light->range};
    for (int c = 0; c < 3; c++) l.color[c] = light->color[c] * light->intensity;
    if (light->kind != LIGHT_SPOT) return l;
    l.outer = acosf(fminf(fmaxf(light->cos_outer, 0.0f), 1.0f)) / DEGREE;
    l.inner = fminf(acosf(fminf(fmaxf(light->cos_inner, 0.0f), 1.0f)) / DEGREE, l.outer);
    return l;
}

/* Polygons. */

/* Finds the corners, counter-clockwise as seen from the side that emits. Returns false if one is not finite. */
static bool find_corners(const WeftLight *l, Vec3 corners[LIGHT_CORNERS]) {
    Vec3 n = vec3_normal_or(vec3_load(l->direction), vec3(0.0f, -1.0f, 0.0f));
    Vec3 level = vec3_normal_or(vec3_cross(vec3(0.0f, 1.0f, 0.0f), n), vec3(1.0f, 0.0f, 0.0f));
    Vec3 up = vec3_cross(n, level);
    float c = cosf(l->roll * DEGREE), s = sinf(l->roll * DEGREE), finite = 0.0f;
    Vec3 x = vec3_scale(vec3_madd(vec3_scale(level, c), up, s), 0.5f * l->size[0]);
    Vec3 y = vec3_scale(vec3_madd(vec3_scale(up, c), level, -s), 0.5f * l->size[1]);
    for (int k = 0; k < l->corners; k++) {
        float angle = (90.0f + 360.0f * (float)k / (float)l->corners) * DEGREE;
        float u = cosf(angle), v = sinf(angle);
        if (l->corners == 4) {
            u = k == 0 || k == 3 ? 1.0f : -1.0f;
            v = k < 2 ? 1.0f : -1.0f;
        }
        corners[k] = vec3_madd(vec3_madd(vec3_load(l->position), x, u), y, v);
        finite += corners[k].x * 0.0f + corners[k].y * 0.0f + corners[k].z * 0.0f;
    }
    return isfinite(finite);
}

/* Returns a black material that emits light from its front. */
static Material light_material(const float color[3]) {
    Material material = material_default();
    for (int c = 0; c < 3; c++) {
        material.inputs[INPUT_base_color].value[c] = 0.0f;
        material.inputs[INPUT_emission].value[c] = color[c];
    }
    material.inputs[INPUT_specular].value[0] = 0.0f;
    return material;
}

/* Fills mesh k of the polygon lights in its own memory. */
static void shape(WeftScene *scene, int k, const WeftLight *l, const Vec3 corners[LIGHT_CORNERS]) {
    int material = scene_light_materials(scene) + k;
    Mesh *mesh = &scene->meshes[scene_light_meshes(scene) + k];
    mesh->vertex_count = (uint32_t)l->corners;
    mesh->triangle_count = (uint32_t)l->corners - 2;
    mesh->material = material;
    memcpy(mesh->position, corners, (size_t)l->corners * sizeof *corners);
    scene->materials[material] = light_material(l->color);
    scene->polygon_lights[k].light = *l;
    scene->shape_version++;
}

/* Makes a mesh with memory for any polygon. Returns false if memory is short. */
static bool make_mesh(Arena *arena, Mesh *mesh) {
    *mesh = (Mesh){.name = "light",
                   .position = arena_array(arena, LIGHT_CORNERS, 3 * sizeof(float)),
                   .index = arena_array(arena, LIGHT_CORNERS - 2, 3 * sizeof(uint32_t))};
    for (uint32_t t = 0; mesh->index && t < LIGHT_CORNERS - 2; t++) {
        mesh->index[3 * t + 1] = t + 1;
        mesh->index[3 * t + 2] = t + 2;
    }
    return mesh->position && mesh->index;
}

/* Grows the lists of meshes, materials and polygon lights if they are full. Returns false if memory is short. */
static bool reserve_polygon(WeftScene *scene) {
    Arena *arena = &scene->arena;
    size_t count = (size_t)scene->polygon_light_count, more = count < 4 ? 4 : count;
    size_t meshes = (size_t)scene->mesh_count, materials = (size_t)scene_shaded_materials(scene);
    if (scene->polygon_light_count < scene->polygon_light_capacity) return true;
    Mesh *all_meshes = arena_array(arena, meshes + more, sizeof *all_meshes);
    Material *all_materials = arena_array(arena, materials + more, sizeof *all_materials);
    PolygonLight *all_lights = arena_array(arena, count + more, sizeof *all_lights);
    bool made = all_meshes && all_materials && all_lights;
    for (size_t k = 0; made && k < more; k++) made = make_mesh(arena, &all_meshes[meshes + k]);
    if (!made) return false;
    if (meshes) memcpy(all_meshes, scene->meshes, meshes * sizeof *all_meshes);
    if (materials) memcpy(all_materials, scene->materials, materials * sizeof *all_materials);
    if (count) memcpy(all_lights, scene->polygon_lights, count * sizeof *all_lights);
    scene->meshes = all_meshes;
    scene->materials = all_materials;
    scene->polygon_lights = all_lights;
    scene->polygon_light_capacity += (int)more;
    return true;
}

/* Moves the backs of materials, which lie behind the lights', by one place. */
static void move_backs(WeftScene *scene, int step) {
    Material *backs = scene->materials + scene->material_count;
    memmove(backs + step, backs, (size_t)scene->back_count * sizeof *backs);
}

static void add_polygon(WeftScene *scene, int place, const WeftLight *l, const Vec3 corners[LIGHT_CORNERS]) {
    int k = scene->polygon_light_count++;
    move_backs(scene, 1);
    scene->mesh_count++;
    scene->material_count++;
    scene->polygon_lights[k].place = place;
    shape(scene, k, l, corners);
}

/* Removes polygon light k. Its mesh moves behind the others, where the next light reuses its memory. */
static void drop_polygon(WeftScene *scene, int k) {
    int last = scene->polygon_light_count - 1, first_material = scene_light_materials(scene);
    Mesh *meshes = scene->meshes + scene_light_meshes(scene), gone = meshes[k];
    Material *materials = scene->materials + first_material;
    size_t behind = (size_t)(last - k);
    memmove(meshes + k, meshes + k + 1, behind * sizeof *meshes);
    memmove(materials + k, materials + k + 1, behind * sizeof *materials);
    memmove(scene->polygon_lights + k, scene->polygon_lights + k + 1, behind * sizeof *scene->polygon_lights);
    meshes[last] = gone;
    for (int j = k; j < last; j++) meshes[j].material = first_material + j;
    move_backs(scene, -1);
    scene->polygon_light_count--;
    scene->mesh_count--;
    scene->material_count--;
    scene->shape_version++;
}

/* Punctual lights. */

/* Grows the list of punctual lights if it is full. Returns false if memory is short. */
static bool reserve_punctual(WeftScene *scene) {
    size_t count = (size_t)scene->light_count, more = count < 4 ? 4 : count;
    if (scene->light_count < scene->light_capacity) return true;
    Light *lights = arena_array(&scene->arena, count + more, sizeof *lights);
    if (!lights) return false;
    if (count) memcpy(lights, scene->lights, count * sizeof *lights);
    scene->lights = lights;
    scene->light_capacity = (int)(count + more);
    return true;
}

static void add_punctual(WeftScene *scene, int k, const WeftLight *l) {
    Light *at = &scene->lights[k];
    memmove(at + 1, at, (size_t)(scene->light_count - k) * sizeof *at);
    *at = punctual_of(l, "");
    scene->light_count++;
}

static void drop_punctual(WeftScene *scene, int k) {
    Light *at = &scene->lights[k];
    scene->light_count--;
    memmove(at, at + 1, (size_t)(scene->light_count - k) * sizeof *at);
}

/* Both. */

/* The light at an index: one of the two indices is -1. */
typedef struct FoundLight {
    int polygon, punctual;
} FoundLight;

static FoundLight find(const WeftScene *scene, int place) {
    FoundLight found = {-1, place};
    for (int k = 0; k < scene->polygon_light_count; k++) {
        if (scene->polygon_lights[k].place == place) return (FoundLight){k, -1};
        found.punctual -= scene->polygon_lights[k].place < place;
    }
    return found;
}

static WeftResult check_place(const WeftScene *scene, int index, WeftError *error) {
    bool there = index >= 0 && index < scene->light_count + scene->polygon_light_count;
    return there ? WEFT_OK : fail(error, WEFT_MESSAGE_DESC, "light", "there is no light %d", index);
}

/* Checks a light, sets its defaults and corners, and reserves memory for it. */
static WeftResult ready(WeftScene *scene, WeftLight *l, Vec3 corners[LIGHT_CORNERS], WeftError *error) {
    const char *wrong = wrong_light(l);
    bool polygon = l->kind == WEFT_LIGHT_POLYGON;
    if (!wrong && polygon) {
        if (!l->corners) l->corners = 4;
        if (!find_corners(l, corners)) wrong = "size";
    }
    if (wrong) return fail(error, WEFT_MESSAGE_DESC, "light", "%s", wrong);
    bool reserved = polygon ? reserve_polygon(scene) : reserve_punctual(scene);
    return reserved ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
}

static void insert(WeftScene *scene, int place, const WeftLight *l, const Vec3 corners[LIGHT_CORNERS]) {
    if (l->kind == WEFT_LIGHT_POLYGON)
        add_polygon(scene, place, l, corners);
    else
        add_punctual(scene, find(scene, place).punctual, l);
}

WeftResult weft_scene_add_light(WeftScene *scene, const WeftLight *light, WeftError *error) {
    WeftLight l = *light;
    Vec3 corners[LIGHT_CORNERS];
    WeftResult result = ready(scene, &l, corners, error);
    if (result == WEFT_OK) insert(scene, scene->light_count + scene->polygon_light_count, &l, corners);
    return result;
}

WeftResult weft_scene_light(const WeftScene *scene, int index, WeftLight *out, WeftError *error) {
    *out = (WeftLight){0};
    WeftResult result = check_place(scene, index, error);
    if (result != WEFT_OK) return result;
    FoundLight found = find(scene, index);
    *out = found.polygon >= 0 ? scene->polygon_lights[found.polygon].light : public_of(&scene->lights[found.punctual]);
    return WEFT_OK;
}

WeftResult weft_scene_put_light(WeftScene *scene, int index, const WeftLight *light, WeftError *error) {
    WeftLight l = *light;
    Vec3 corners[LIGHT_CORNERS];
    WeftResult result = check_place(scene, index, error);
    if (result == WEFT_OK) result = ready(scene, &l, corners, error);
    if (result != WEFT_OK) return result;
    FoundLight found = find(scene, index);
    bool polygon = l.kind == WEFT_LIGHT_POLYGON;
    if (polygon && found.polygon >= 0) {
        shape(scene, found.polygon, &l, corners);
    } else if (!polygon && found.punctual >= 0) {
        scene->lights[found.punctual] = punctual_of(&l, scene->lights[found.punctual].name);
    } else {
        if (polygon)
            drop_punctual(scene, found.punctual);
        else
            drop_polygon(scene, found.polygon);
        insert(scene, index, &l, corners);
    }
    return WEFT_OK;
}

WeftResult weft_scene_remove_light(WeftScene *scene, int index, WeftError *error) {
    WeftResult result = check_place(scene, index, error);
    if (result != WEFT_OK) return result;
    FoundLight found = find(scene, index);
    if (found.polygon >= 0)
        drop_polygon(scene, found.polygon);
    else
        drop_punctual(scene, found.punctual);
    for (int k = 0; k < scene->polygon_light_count; k++)
        scene->polygon_lights[k].place -= scene->polygon_lights[k].place > index;
    return WEFT_OK;
}
