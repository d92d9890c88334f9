/* load.c - weft_scene_load: reads a scene from a file, from memory or by the name of a built-in one */
#include <string.h>

#include "base/fail.h"
#include "base/path.h"
#include "gltf/read/gltf.h"
#include "scene/builtin/builtin.h"
#include "scene/light/environment.h"
#include "scene/material/backs.h"
#include "scene/material/cloth_fit.h"
#include "weft/scene.h"

/* The receiver of progress, and what is shown. */
typedef struct Watcher {
    WeftProgress progress; /* may be NULL */
    void *user;
    const WeftMoment *moment; /* may be NULL */
} Watcher;

static WeftResult load_builtin(const char *path, Watcher watcher, WeftScene *scene, WeftError *error) {
    const char *name = path_builtin(path);
    for (int k = 0; builtin_at(k); k++) {
        const Builtin *builtin = builtin_at(k);
        if (strcmp(builtin->name, name) != 0) continue;
        if (watcher.moment) return fail(error, WEFT_MESSAGE_GLTF_REFERENCE, path, "it has no animation");
        if (builtin->make) return builtin->make(scene, error);
        return gltf_read_watched(path, builtin->glb, (size_t)(builtin->glb_end - builtin->glb), NULL, scene,
                                 watcher.progress, watcher.user, NULL, error);
    }
    return fail(error, WEFT_MESSAGE_SCENE_NAME, path, "available: builtin:%s", builtin_at(0)->name);
}

/* Fits cloths and hair to the meshes. Hair that is too much for a scene is left out with a warning. */
static WeftResult fit(WeftScene *scene, const WeftLog *log, WeftError *error) {
    WeftError said = {.result = WEFT_OK};
    WeftResult result = cloths_fit(scene, true, &said);
    if (result == WEFT_USAGE) {
        warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, scene->name, "its hair: %.160s", said.text);
        for (int k = 0; k < scene_own_materials(scene); k++) scene->materials[k].hair[WEFT_HAIR_LENGTH] = 0.0f;
        result = cloths_fit(scene, true, &said);
    }
    if (result != WEFT_OK && error) *error = said;
    return result;
}

static WeftResult load(const char *path, const void *data, size_t size, Watcher watcher, WeftScene **out,
                       const WeftLog *log, WeftError *error) {
    *out = NULL;
    WeftScene *scene = scene_create(path);
    if (!scene) return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    WeftResult result;
    const bool alone = !data && path_is_cloth(path); /* a material, which the built-in cloth is of */
    if (alone || (!data && path_builtin(path)))
        result = load_builtin(alone ? "builtin:cloth" : path, watcher, scene, error);
    else
        result = gltf_read_watched(path, data, size, watcher.moment, scene, watcher.progress, watcher.user, log, error);
    if (result == WEFT_OK) {
        scene_bounds(scene);
        environment_give_way(scene);
        result = backs_make(scene, error);
        if (result == WEFT_OK) result = fit(scene, log, error);
    }
    if (result == WEFT_OK && alone) result = weft_scene_assign_material(scene, NULL, path, log, error);
    if (result == WEFT_OK)
        *out = scene;
    else
        weft_scene_free(scene);
    return result;
}

WeftResult weft_scene_load(const char *path, WeftScene **out, const WeftLog *log, WeftError *error) {
    return load(path, NULL, 0, (Watcher){0}, out, log, error);
}

WeftResult weft_scene_load_watched(const char *path, WeftProgress progress, void *user, WeftScene **out,
                                   const WeftLog *log, WeftError *error) {
    return load(path, NULL, 0, (Watcher){progress, user, NULL}, out, log, error);
}

WeftResult weft_scene_load_moment(const char *path, const WeftMoment *moment, WeftProgress progress, void *user,
                                  WeftScene **out, const WeftLog *log, WeftError *error) {
    return load(path, NULL, 0, (Watcher){progress, user, moment}, out, log, error);
}

WeftResult weft_scene_load_memory(const void *data, size_t size, const char *name, WeftScene **out, const WeftLog *log,
                                  WeftError *error) {
    /* NULL is an empty file, never the file of that name. */
    return load(name, data ? data : "", data ? size : 0, (Watcher){0}, out, log, error);
}
