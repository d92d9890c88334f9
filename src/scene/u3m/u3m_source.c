#include "scene/u3m/u3m_source.h"

#include <string.h>

#include "base/fail.h"

/* Copies a text into the scene's arena. Returns false if memory is short. */
static bool text_keep(WeftScene *scene, const U3mText *text, U3mText *out) {
    char *bytes = arena_array(&scene->arena, text->size + 1, 1);
    const char *path = arena_text(&scene->arena, text->path);
    if (!bytes || !path) return false;
    memcpy(bytes, text->text, text->size);
    *out = (U3mText){.size = text->size, .path = path, .part = text->part, .text = bytes};
    return true;
}

static bool source_keep(WeftScene *scene, int material, const U3mText *text) {
    U3mSource *source = arena_array(&scene->arena, 1, sizeof *source);
    if (!source) return false;
    *source = (U3mSource){.text = *text, .material = scene->materials[material]};
    source->has_back = scene_has_back(scene, material);
    if (source->has_back) source->back = scene->materials[scene->material_count + material];
    scene->u3m[material] = source;
    return true;
}

WeftResult u3m_keep(WeftScene *scene, const bool *selected, const U3mText *text, WeftError *error) {
    const int own = scene_own_materials(scene);
    U3mText kept = {0};
    if (text && !scene->u3m) scene->u3m = arena_array(&scene->arena, (size_t)own, sizeof(const U3mSource *));
    bool done = !text || (scene->u3m && text_keep(scene, text, &kept));
    for (int k = 0; k < own && scene->u3m && done; k++) {
        if (!selected[k]) continue;
        scene->u3m[k] = NULL;
        if (text) done = source_keep(scene, k, &kept);
    }
    return done ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
}
