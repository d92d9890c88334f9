/* assign.c - assigning the material of a file, or a preset, in a scene */
#include "scene/material/assign.h"

#include <string.h>

#include "base/fail.h"
#include "scene/material/backs.h"
#include "scene/material/cloth_fit.h"
#include "scene/material/material_file.h"
#include "scene/material/pictures.h"
#include "scene/material/relief.h"
#include "scene/material/set.h"
#include "scene/u3m/u3m_source.h"

static bool shows(const Material *material, InputId color) {
    const Input *input = &material->inputs[color];
    return input->value[0] > 0.0f || input->value[1] > 0.0f || input->value[2] > 0.0f;
}

static bool is_cloth(const WeftScene *scene, int k) {
    bool any = false;
    for (int m = 0; m < scene_own_materials(scene); m++) any |= shows(&scene->materials[m], INPUT_sheen_color);
    const Material *material = &scene->materials[k];
    return any ? shows(material, INPUT_sheen_color) : !shows(material, INPUT_emission);
}

/* Lengthens the scene's lists by those of the file and gives it the images. */
static bool adopt_textures(WeftScene *scene, MaterialFile *file) {
    int number[INPUT_COUNT], image[INPUT_COUNT];
    for (int k = 0; k < file->image_count; k++) image[k] = -1;
    for (int k = 0; k < file->texture_count; k++) {
        Texture texture = file->textures[k];
        int from = texture.image;
        texture.path = file->paths[from] ? arena_text(&scene->arena, file->paths[from]) : NULL;
        texture.image = image[from];
        if (file->paths[from] && !texture.path) return false;
        number[k] =
            image[from] < 0 ? picture_add(scene, &file->images[from], texture) : texture_number_of(scene, texture);
        if (!number[k]) return false;
        image[from] = scene->textures[number[k] - 1].image;
    }
    for (int k = 0; k < file->image_count; k++) {
        textures_put_levels(scene->textures, scene->texture_count, image[k], file->levels[k]);
        file->levels[k] = NULL;
    }
    for (int k = 0; k < INPUT_COUNT; k++) {
        int *texture = &file->material.inputs[k].texture;
        if (*texture) *texture = number[*texture - 1];
    }
    return true;
}

/* Gives the scene the cloth of the file, whose material then names it. */
static bool adopt_cloth(WeftScene *scene, MaterialFile *file, const bool *selected) {
    if (!file->cloth) return true;
    int first = 0; /* the others have copies by cloths_fit if they differ */
    while (first < scene_own_materials(scene) && !selected[first]) first++;
    cloth_fit(scene, first, file->cloth);
    file->material.cloth = scene_adopt_cloth(scene, file->cloth);
    if (file->material.cloth) file->cloth = NULL;
    return file->material.cloth != 0;
}

static bool adopt_measured(WeftScene *scene, MaterialFile *file) {
    if (!file->measured) return true;
    file->material.measured = scene_adopt_measured(scene, file->measured);
    if (file->material.measured) file->measured = NULL;
    return file->material.measured != 0;
}

/* Returns the material of the file. Inputs that belong to the shape stay unless the file gives them. */
static Material assigned(const Material *old, const MaterialFile *file) {
    static const InputId shape[] = {INPUT_normal, INPUT_occlusion, INPUT_opacity};
    Material fresh = file->material;
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

/* Places the pictures whose size is known in metres on the meshes of material k. */
static void span_pictures(const WeftScene *scene, int k, const MaterialFile *file, Material *material) {
    for (int input = 0; input < INPUT_COUNT; input++) {
        const float *span = file->span[input];
        Input *to = &material->inputs[input];
        if (!(span[0] > 0.0f && span[1] > 0.0f) || !to->texture || file->keep[input]) continue;
        const double metres = cloth_uv_metres(scene, k, to->texcoord, NULL);
        for (int c = 0; c < 6 && metres > 0.0; c++) to->transform[c] *= (float)(metres / (double)span[c / 3]);
    }
}

/* Warns where pictures have a size in metres and the meshes have no texture coordinates to measure it by. */
static void span_check(const WeftScene *scene, int material, const MaterialFile *file, const WeftLog *log) {
    bool sized = false;
    for (int k = 0; k < INPUT_COUNT; k++) sized |= file->span[k][0] > 0.0f;
    if (sized && weft_scene_material_used(scene, material) && !(cloth_uv_metres(scene, material, 0, NULL) > 0.0))
        warn(log, WEFT_MESSAGE_PLAUSIBLE, scene->material_names[material],
             "its mesh has no texture coordinates, by which the material's pictures lie in millimetres");
}

bool *materials_matching(WeftScene *scene, const char *material, WeftError *error) {
    int matched = 0;
    bool *selected = arena_array(&scene->arena, (size_t)scene->material_count, sizeof *selected);
    if (!selected) {
        fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
        return NULL;
    }
    for (int k = 0; k < scene_own_materials(scene); k++) {
        selected[k] = material ? material_matches(scene, k, material) : is_cloth(scene, k);
        matched += selected[k];
    }
    if (!material || matched) return selected;
    char names[NAMES_SIZE];
    fail(error, WEFT_MESSAGE_MATERIAL_NAME, material, "%s", scene_names(scene, weft_scene_material_name, names));
    return NULL;
}

/* Puts the material of the file on material k, with its back. */
static void put_on_one(WeftScene *scene, int k, const MaterialFile *file) {
    const Material old = scene->materials[k];
    scene->materials[k] = assigned(&old, file);
    span_pictures(scene, k, file, &scene->materials[k]);
    Material back = file->back ? assigned(&old, file->back) : old;
    if (file->back) span_pictures(scene, k, file->back, &back);
    back_give(scene, k, file->back ? &back : NULL);
}

static WeftResult put_on_selected(WeftScene *scene, const bool *selected, MaterialFile *file, WeftError *error) {
    bool adopted = adopt_textures(scene, file) && adopt_cloth(scene, file, selected) && adopt_measured(scene, file);
    if (file->back) adopted = adopted && adopt_textures(scene, file->back) && adopt_measured(scene, file->back);
    if (!adopted) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    for (int k = 0; k < scene_own_materials(scene); k++)
        if (selected[k]) put_on_one(scene, k, file);
    WeftResult result = u3m_keep(scene, selected, file->u3m, error);
    if (result == WEFT_OK) result = cloths_fit(scene, false, error);
    return result == WEFT_OK ? materials_complete(scene, error) : result;
}

static WeftResult put_on(WeftScene *scene, const char *material, MaterialFile *file, const WeftLog *log,
                         WeftError *error) {
    WeftError said = {.result = WEFT_RESOURCES};
    const bool *selected = materials_matching(scene, material, &said);
    if (!selected && error) *error = said;
    if (!selected) return said.result;
    const WeftResult result = put_on_selected(scene, selected, file, error);
    for (int k = 0; result == WEFT_OK && file->material.cloth && k < scene_own_materials(scene); k++)
        if (selected[k]) cloth_check(scene, k, log);
    for (int k = 0; result == WEFT_OK && k < scene_own_materials(scene); k++)
        if (selected[k]) span_check(scene, k, file, log);
    return result;
}

/* Puts a file that was read on one material, and releases it. */
static WeftResult put_on_index(WeftScene *scene, int material, MaterialFile *file, WeftResult read, WeftError *error) {
    WeftResult result = read;
    bool *selected = arena_array(&scene->arena, (size_t)scene->material_count, sizeof *selected);
    if (result == WEFT_OK && !selected) result = fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    if (selected) selected[material] = true;
    if (result == WEFT_OK) result = put_on_selected(scene, selected, file, error);
    material_file_free(file);
    return result;
}

WeftResult material_assign_text(WeftScene *scene, int material, const char *text, WeftError *error) {
    MaterialFile file;
    const WeftResult read = material_file_read(text, strlen(text), "--set", NULL, &file, NULL, error);
    return put_on_index(scene, material, &file, read, error);
}

WeftResult material_assign_file(WeftScene *scene, int material, const char *path, WeftError *error) {
    MaterialFile file;
    const WeftResult read = material_file_load(path, &file, NULL, error);
    return put_on_index(scene, material, &file, read, error);
}

static WeftResult assign_from(WeftScene *scene, const char *material, MaterialFile *file, WeftResult read,
                              const WeftLog *log, WeftError *error) {
    WeftResult result = read == WEFT_OK ? put_on(scene, material, file, log, error) : read;
    material_file_free(file);
    return result;
}

WeftResult weft_scene_assign_material_memory(WeftScene *scene, const char *material, const void *data, size_t size,
                                             const char *name, const WeftLog *log, WeftError *error) {
    MaterialFile file;
    WeftResult read = material_file_read(data ? data : "", data ? size : 0, name, NULL, &file, log, error);
    return assign_from(scene, material, &file, read, log, error);
}

WeftResult weft_scene_assign_material(WeftScene *scene, const char *material, const char *path, const WeftLog *log,
                                      WeftError *error) {
    MaterialFile file;
    WeftResult read = material_file_load(path, &file, log, error);
    return assign_from(scene, material, &file, read, log, error);
}
