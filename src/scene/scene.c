/* scene.c - creating, freeing and changing a scene as a whole */
#include "scene/record/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/pi.h"
#include "brdf/measured.h"
#include "scene/light/cubemap.h"
#include "scene/light/environment.h"
#include "scene/material/cloth_fit.h"
#include "scene/material/hair.h"
#include "weave/weft_cloth.h"

WeftScene *scene_create(const char *name) {
    WeftScene *scene = alloc_array(1, sizeof *scene);
    if (!scene) return NULL;
    scene->srgb = srgb_table();
    scene->environment.strength = scene->environment.ambient = scene->environment.reflection = 1.0f;
    scene->name = arena_text(&scene->arena, name);
    if (scene->name && environment_studio(&scene->environment.image, NULL) == WEFT_OK) return scene;
    weft_scene_free(scene);
    return NULL;
}

void weft_scene_free(WeftScene *scene) {
    if (!scene) return;
    for (int k = 0; k < scene->image_count; k++) {
        textures_put_levels(scene->textures, scene->texture_count, k, NULL);
        weft_image_free(&scene->images[k]);
    }
    for (int k = 0; k < scene->cloth_count; k++) weft_cloth_free(scene->cloths[k]);
    for (int k = 0; k < scene->measured_count; k++) scene_measured_free(scene->measured[k]);
    weft_image_free(&scene->environment.image);
    hairs_free(scene);
    arena_free(&scene->arena);
    free(scene);
}

/* Returns the list with capacity for one more entry; it grows at each power of two. Returns NULL if memory is short. */
static void *with_capacity(WeftScene *scene, void *list, int count) {
    const size_t had = (size_t)count;
    if ((had & (had - 1)) != 0) return list;
    void **longer = arena_array(&scene->arena, 2 * had + 1, sizeof *longer);
    if (longer && had) memcpy(longer, list, had * sizeof *longer);
    return longer;
}

int scene_adopt_cloth(WeftScene *scene, WeftCloth *cloth) {
    for (int k = 0; k < scene->cloth_count; k++)
        if (cloth_same(scene->cloths[k], cloth)) {
            weft_cloth_free(cloth);
            return k + 1;
        }
    WeftCloth **cloths = with_capacity(scene, scene->cloths, scene->cloth_count);
    if (!cloths) return 0;
    scene->cloths = cloths;
    scene->cloths[scene->cloth_count] = cloth;
    return ++scene->cloth_count;
}

const WeftCloth *scene_cloth_of(const WeftScene *scene, const Material *material) {
    const int number = material->cloth;
    return number > 0 ? scene->cloths[number - 1] : number < 0 ? scene->cloths[-number - 1]->other : NULL;
}

int scene_adopt_measured(WeftScene *scene, Measured *measured) {
    for (int k = 0; measured->path && k < scene->measured_count; k++) {
        const char *path = scene->measured[k]->path;
        if (path && strcmp(path, measured->path) == 0) {
            scene_measured_free(measured);
            return k + 1;
        }
    }
    Measured **list = with_capacity(scene, scene->measured, scene->measured_count);
    if (!list) return 0;
    scene->measured = list;
    scene->measured[scene->measured_count] = measured;
    return ++scene->measured_count;
}

WeftResult scene_measured_read(const char *path, Measured **out, WeftError *error) {
    *out = NULL;
    if (measured_format(path) == MEASURED_NONE)
        return fail(error, WEFT_MESSAGE_MEASURED, path, "its name ends with none of .binary, .bsdf and .bin");
    *out = alloc_array(1, sizeof **out);
    if (!*out) return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    WeftResult result = measured_read(path, *out, error);
    if (result == WEFT_OK) return WEFT_OK;
    scene_measured_free(*out);
    *out = NULL;
    return result;
}

void scene_measured_free(Measured *measured) {
    if (measured) measured_free(measured);
    free(measured);
}

void scene_bounds(WeftScene *scene) {
    scene->low = (Vec3){INFINITY, INFINITY, INFINITY};
    scene->high = (Vec3){-INFINITY, -INFINITY, -INFINITY};
    for (int m = 0; m < scene->mesh_count; m++) {
        const Mesh *mesh = &scene->meshes[m];
        for (uint32_t k = 0; k < mesh->vertex_count; k++) {
            const Vec3 p = vec3_load(mesh->position + 3 * (size_t)k);
            scene->low = vec3_least(scene->low, p);
            scene->high = vec3_most(scene->high, p);
        }
    }
}

WeftSceneInfo weft_scene_info(const WeftScene *scene) {
    WeftSceneInfo info = {.mesh_count = scene_own_meshes(scene),
                          .material_count = scene_own_materials(scene),
                          .light_count = scene->light_count + scene->polygon_light_count,
                          .camera_count = scene->camera_count,
                          .variant_count = scene->variant_count,
                          .image_count = scene->image_count,
                          .low = {scene->low.x, scene->low.y, scene->low.z},
                          .high = {scene->high.x, scene->high.y, scene->high.z}};
    for (int m = 0; m < info.mesh_count; m++) info.triangle_count += scene->meshes[m].triangle_count;
    return info;
}

int weft_scene_material_used(const WeftScene *scene, int index) {
    for (int m = 0; m < scene_own_meshes(scene); m++)
        if (scene->meshes[m].material == index && scene->meshes[m].triangle_count) return 1;
    return 0;
}

const char *weft_scene_material_name(const WeftScene *scene, int index) {
    return index >= 0 && index < scene_own_materials(scene) ? scene->material_names[index] : NULL;
}

const char *weft_scene_camera_name(const WeftScene *scene, int index) {
    return index >= 0 && index < scene->camera_count ? scene->cameras[index].name : NULL;
}

const char *weft_scene_variant_name(const WeftScene *scene, int index) {
    return index >= 0 && index < scene->variant_count ? scene->variants[index] : NULL;
}

const char *scene_names(const WeftScene *scene, const char *(*name)(const WeftScene *scene, int index),
                        char text[NAMES_SIZE]) {
    enum { LISTED = 5 };
    int used = snprintf(text, NAMES_SIZE, name(scene, 0) ? "available: " : "the scene has none");
    for (int k = 0; k <= LISTED && name(scene, k) && used < NAMES_SIZE; k++) {
        char index[16];
        snprintf(index, sizeof index, "%d", k);
        const char *word = k == LISTED ? "..." : name(scene, k)[0] ? name(scene, k) : index;
        used += snprintf(text + used, (size_t)(NAMES_SIZE - used), "%s%.40s", k ? ", " : "", word);
    }
    return text;
}

/* Sets the materials of variant v; -1: none. */
static void use_variant(WeftScene *scene, int v) {
    scene->variant = v + 1;
    for (int m = 0; m < scene->mesh_count; m++) {
        Mesh *mesh = &scene->meshes[m];
        if (!mesh->variant_material) continue;
        int other = v >= 0 ? mesh->variant_material[v] : -1;
        mesh->material = other >= 0 ? other : mesh->own_material;
    }
}

WeftResult weft_scene_set_variant(WeftScene *scene, const char *name, WeftError *error) {
    char names[NAMES_SIZE];
    int v = name ? 0 : -1;
    while (name && v < scene->variant_count && strcmp(scene->variants[v], name) != 0) v++;
    if (name && v == scene->variant_count)
        return fail(error, WEFT_MESSAGE_VARIANT_NAME, name, "%s", scene_names(scene, weft_scene_variant_name, names));
    use_variant(scene, v);
    return cloths_fit(scene, false, error);
}

int weft_scene_variant(const WeftScene *scene) { return scene->variant - 1; }

/* Raises values below 0, which light cannot be, to 0, and says so. */
static void raise_to_zero(WeftImage *image, const char *path, const WeftLog *log) {
    const size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    float *values = image->pixels;
    size_t below = 0;
    for (size_t k = 0; k < count; k++) {
        below += values[k] < 0.0f;
        values[k] = fmaxf(values[k], 0.0f);
    }
    if (below)
        warn(log, WEFT_MESSAGE_IMAGE_REPAIRED, path, "%zu of %zu values were below 0, which light cannot be; 0 now",
             below, count);
}

WeftResult weft_scene_set_environment_file(WeftScene *scene, const char *path, const WeftLog *log, WeftError *error) {
    WeftImage raw, linear;
    WeftResult result;
    if (cubemap_named(path)) {
        result = cubemap_read(path, &linear, log, error);
    } else {
        result = weft_image_read(path, &raw, log, error);
        if (result != WEFT_OK) return result;
        result = weft_image_convert_f32(&raw, 1, &linear, error);
        weft_image_free(&raw);
    }
    if (result != WEFT_OK) return result;
    raise_to_zero(&linear, path, log);
    weft_image_free(&scene->environment.image);
    scene->environment.image = linear;
    scene->environment.kind = ENVIRONMENT_IMAGE;
    scene->environment.version++;
    return WEFT_OK;
}

WeftResult weft_scene_set_environment_color(WeftScene *scene, const float color[3], WeftError *error) {
    for (int c = 0; c < 3; c++)
        if (!(isfinite(color[c]) && color[c] >= 0.0f))
            return fail(error, WEFT_MESSAGE_DESC, "environment color", "%g", (double)color[c]);
    weft_image_free(&scene->environment.image);
    scene->environment.kind = ENVIRONMENT_CONSTANT;
    scene->environment.version++;
    memcpy(scene->environment.color, color, sizeof scene->environment.color);
    return WEFT_OK;
}

WeftResult weft_scene_set_environment_studio(WeftScene *scene, WeftError *error) {
    WeftImage image;
    WeftResult result = environment_studio(&image, error);
    if (result != WEFT_OK) return result;
    weft_image_free(&scene->environment.image);
    scene->environment.kind = ENVIRONMENT_STUDIO;
    scene->environment.image = image;
    scene->environment.version++;
    environment_give_way(scene);
    return WEFT_OK;
}

WeftResult weft_scene_set_environment_placement(WeftScene *scene, float rotation, float strength, WeftError *error) {
    if (!isfinite(rotation)) return fail(error, WEFT_MESSAGE_DESC, "environment rotation", NULL);
    if (!(isfinite(strength) && strength >= 0.0f)) return fail(error, WEFT_MESSAGE_DESC, "environment strength", NULL);
    scene->environment.rotation = fmodf(rotation, 360.0f) * (PI_FLOAT / 180.0f);
    scene->environment.strength = strength;
    return WEFT_OK;
}

WeftResult weft_scene_set_environment_parts(WeftScene *scene, float ambient, float reflection, WeftError *error) {
    if (!(isfinite(ambient) && ambient >= 0.0f)) return fail(error, WEFT_MESSAGE_DESC, "environment ambient", NULL);
    if (!(isfinite(reflection) && reflection >= 0.0f))
        return fail(error, WEFT_MESSAGE_DESC, "environment reflection", NULL);
    scene->environment.ambient = ambient;
    scene->environment.reflection = reflection;
    return WEFT_OK;
}
