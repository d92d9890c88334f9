/* dress.c - putting the material of a file, or a preset, on a scene */
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/file.h"
#include "scene/material_file.h"
#include "scene/presets.h"
#include "scene/set.h"
#include "scene/tangents.h"

const char *weft_preset_name(int index) { return preset_at(index) ? preset_at(index)->name : NULL; }
const char *weft_preset_help(int index) { return preset_at(index) ? preset_at(index)->help : NULL; }
const char *weft_preset_text(int index) { return preset_at(index) ? preset_at(index)->text : NULL; }

static bool shows(const Material *material, InputId color) {
    const Input *input = &material->inputs[color];
    return input->value[0] > 0.0f || input->value[1] > 0.0f || input->value[2] > 0.0f;
}

/* What a wish that names no material means: all that have a sheen, or, where none has, all that send out no
 * light. */
static bool is_cloth(const WeftScene *scene, int k) {
    bool any = false;
    for (int m = 0; m < scene_own_materials(scene); m++)
        any |= shows(&scene->materials[m], INPUT_sheen_color);
    const Material *material = &scene->materials[k];
    return any ? shows(material, INPUT_sheen_color) : !shows(material, INPUT_emission);
}

/* Lengthens the scene's lists by those of the file and gives it the images. */
static bool adopt_textures(WeftScene *scene, MaterialFile *file) {
    if (!file->texture_count) return true;
    size_t images = (size_t)scene->image_count, textures = (size_t)scene->texture_count;
    WeftImage *all_images =
        arena_array(&scene->arena, images + (size_t)file->image_count, sizeof *all_images);
    Texture *all_textures =
        arena_array(&scene->arena, textures + (size_t)file->texture_count, sizeof *all_textures);
    if (!all_images || !all_textures) return false;
    if (images) memcpy(all_images, scene->images, images * sizeof *all_images);
    if (textures) memcpy(all_textures, scene->textures, textures * sizeof *all_textures);
    for (int k = 0; k < file->image_count; k++) {
        all_images[images + (size_t)k] = file->images[k];
        file->images[k] = (WeftImage){0};
    }
    for (int k = 0; k < file->texture_count; k++) {
        all_textures[textures + (size_t)k] = file->textures[k];
        all_textures[textures + (size_t)k].image += scene->image_count;
    }
    for (int k = 0; k < INPUT_COUNT; k++)
        if (file->material.inputs[k].texture) file->material.inputs[k].texture += scene->texture_count;
    scene->images = all_images;
    scene->textures = all_textures;
    scene->image_count += file->image_count;
    scene->texture_count += file->texture_count;
    return true;
}

/* What belongs to the shape stays where the file says nothing of it. */
static Material dressed(const Material *old, const MaterialFile *file) {
    static const InputId shape[] = {INPUT_normal, INPUT_occlusion, INPUT_opacity};
    Material fresh = file->material;
    fresh.name = old->name;
    for (size_t k = 0; k < sizeof shape / sizeof *shape; k++)
        if (!file->named[shape[k]]) fresh.inputs[shape[k]] = old->inputs[shape[k]];
    for (int k = 0; k < INPUT_COUNT; k++)
        if (file->keep[k]) fresh.inputs[k] = old->inputs[k];
    if (!file->sided_named) fresh.double_sided = old->double_sided;
    if (!file->alpha_named) {
        fresh.alpha_mode = old->alpha_mode;
        fresh.alpha_cutoff = old->alpha_cutoff;
    }
    return fresh;
}

static WeftResult put_on(WeftScene *scene, const char *material, MaterialFile *file, WeftError *error) {
    int matched = 0;
    for (int k = 0; k < scene_own_materials(scene) && material; k++)
        matched += material_matches(scene, k, material);
    if (material && !matched) {
        char names[NAMES_SIZE];
        return fail(error, WEFT_MESSAGE_MATERIAL_NAME, material, "%s",
                    scene_names(scene, weft_scene_material_name, names));
    }
    bool *wears = arena_array(&scene->arena, (size_t)scene_own_materials(scene), sizeof *wears);
    if (!wears || !adopt_textures(scene, file)) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    for (int k = 0; k < scene_own_materials(scene); k++)
        wears[k] = material ? material_matches(scene, k, material) : is_cloth(scene, k);
    for (int k = 0; k < scene_own_materials(scene); k++)
        if (wears[k]) scene->materials[k] = dressed(&scene->materials[k], file);
    return tangents_complete(scene, error);
}

static WeftResult dress_from(WeftScene *scene, const char *material, const void *data, size_t size,
                             const char *name, const char *folder, const WeftLog *log, WeftError *error) {
    MaterialFile file;
    WeftResult result = material_file_read(data, size, name, folder, &file, log, error);
    if (result == WEFT_OK) result = put_on(scene, material, &file, error);
    material_file_free(&file);
    return result;
}

WeftResult weft_scene_dress_memory(WeftScene *scene, const char *material, const void *data, size_t size,
                                   const char *name, const WeftLog *log, WeftError *error) {
    return dress_from(scene, material, data ? data : "", data ? size : 0, name, NULL, log, error);
}

static WeftResult dress_preset(WeftScene *scene, const char *material, const char *name, WeftError *error) {
    for (int k = 0; preset_at(k); k++) {
        const Preset *preset = preset_at(k);
        if (strcmp(preset->name, name) == 0) /* no word on what we ship */
            return dress_from(scene, material, preset->text, strlen(preset->text), name, NULL, NULL, error);
    }
    return fail(error, WEFT_MESSAGE_PRESET_NAME, name, "`weft models` lists them");
}

WeftResult weft_scene_dress(WeftScene *scene, const char *material, const char *path, const WeftLog *log,
                            WeftError *error) {
    static const char prefix[] = "preset:";
    const size_t limit = (size_t)1 << 20;
    if (strncmp(path, prefix, strlen(prefix)) == 0)
        return dress_preset(scene, material, path + strlen(prefix), error);
    FileBytes bytes;
    WeftResult result = file_read(path, limit, &bytes, error);
    if (result != WEFT_OK) return result;
    char *folder = strdup(path), *slash = folder ? strrchr(folder, '/') : NULL;
    if (folder) *(slash ? slash + 1 : folder) = '\0';
    result = folder ? dress_from(scene, material, bytes.data, bytes.size, path, folder, log, error)
                    : fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    free(folder);
    free(bytes.data);
    return result;
}
