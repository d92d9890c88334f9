/* wear.c - putting pictures on the inputs of materials: one by name, or those of a folder by their names */
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/fail.h"
#include "scene/dress.h"
#include "scene/pictures.h"
#include "scene/set.h"
#include "scene/tangents.h"
#include "shading/choice.h"
#include "shading/convert.h"
#include "weft/material.h"

/* A picture that was read, and what it will be in the scene. */
typedef struct Picture {
    char *path; /* owned */
    WeftImage image;
    int texture; /* number, counted from 1, once it is taken over */
} Picture;

/* Where a picture of that path is, or -1: its first texture. */
static int find_path(const WeftScene *scene, const char *path) {
    for (int k = 0; k < scene->texture_count; k++)
        if (scene->textures[k].path && strcmp(scene->textures[k].path, path) == 0) return k;
    return -1;
}

/* The texture of an image that is repeated and not nearest, or -1. */
static int find_plain(const WeftScene *scene, int image) {
    for (int k = 0; k < scene->texture_count; k++) {
        const Texture *t = &scene->textures[k];
        if (t->image == image && t->wrap_u == WRAP_REPEAT && t->wrap_v == WRAP_REPEAT && !t->nearest)
            return k;
    }
    return -1;
}

/* Gives a picture to the scene: in the place of what was read of that path before, if anything was. */
static bool take_over(WeftScene *scene, Picture *picture) {
    int before = find_path(scene, picture->path);
    if (before < 0) {
        const char *path = arena_text(&scene->arena, picture->path);
        picture->texture = path ? picture_add(scene, &picture->image, (Texture){.path = path}) : 0;
        return picture->texture != 0;
    }
    int image = scene->textures[before].image, plain = find_plain(scene, image);
    Texture texture = {
        .image = image, .path = scene->textures[before].path, .turn = scene->textures[before].turn};
    picture->texture = plain < 0 ? picture_share(scene, texture) : plain + 1;
    if (picture->texture) picture_replace(scene, image, &picture->image, texture.path);
    return picture->texture != 0;
}

/* The picture alone counts; an angle's is the greatest. */
static void put_on_input(Material *material, InputId id, int texture, int channel) {
    const InputInfo *info = &input_infos[id];
    Input *input = &material->inputs[id];
    float value = info->kind == INPUT_DIRECTION ? 0.0f
                  : info->kind == INPUT_ANGLE   ? info->high * (3.14159265f / 180.0f)
                                                : 1.0f;
    *input = (Input){.texture = texture, .channel = (uint8_t)channel, .given = true};
    for (int c = 0; c < 3; c++) input->value[c] = value;
    input->transform[0] = input->transform[4] = 1.0f;
    if (id == INPUT_opacity && material->alpha_mode == ALPHA_OPAQUE)
        material->alpha_mode = ALPHA_BLEND; /* else it would say nothing */
}

/* "MATERIAL.INPUT" or "MATERIAL.INPUT.g", cut in three. */
typedef struct Target {
    char material[256];
    InputId input;
    int channel;
} Target;

static WeftResult read_target(const char *text, Target *target, WeftError *error) {
    static const char channels[] = "rgba";
    char copy[320];
    *target = (Target){.channel = -1};
    if (strlen(text) >= sizeof copy) return fail(error, WEFT_MESSAGE_PARAM_NAME, text, "it is too long");
    snprintf(copy, sizeof copy, "%s", text);
    char *point = strrchr(copy, '.');
    if (point && point[1] && !point[2] && strchr(channels, point[1])) {
        target->channel = (int)(strchr(channels, point[1]) - channels);
        *point = '\0';
        point = strrchr(copy, '.');
    }
    if (!point || (size_t)(point - copy) >= sizeof target->material)
        return fail(error, WEFT_MESSAGE_PARAM_NAME, text, "write MATERIAL.INPUT");
    *point = '\0';
    memcpy(target->material, copy, (size_t)(point - copy) + 1);
    int input = material_input(point + 1);
    if (input < 0) return fail(error, WEFT_MESSAGE_PARAM_NAME, point + 1, "`weft models` lists inputs");
    target->input = (InputId)input;
    InputKind kind = input_infos[input].kind;
    if (target->channel >= 0 && kind != INPUT_SCALAR && kind != INPUT_ANGLE)
        return fail(error, WEFT_MESSAGE_PARAM_NAME, text, "%s takes the whole picture", point + 1);
    return WEFT_OK;
}

WeftResult weft_scene_set_texture(WeftScene *scene, const char *text, const char *path, const WeftLog *log,
                                  WeftError *error) {
    Target target;
    WeftError said = {0};
    WeftResult result = read_target(text, &target, error);
    if (result != WEFT_OK) return result;
    const bool *wished = materials_wished(scene, target.material, &said);
    if (!wished && error) *error = said;
    if (!wished) return said.result;
    Picture picture = {.path = strdup(path)};
    result = picture.path ? weft_image_read(path, &picture.image, log, error)
                          : fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    if (result == WEFT_OK && !take_over(scene, &picture))
        result = fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    for (int k = 0; k < scene->material_count && result == WEFT_OK; k++)
        if (wished[k])
            put_on_input(&scene->materials[k], target.input, picture.texture,
                         target.channel < 0 ? 0 : target.channel);
    weft_image_free(&picture.image);
    free(picture.path);
    return result == WEFT_OK ? tangents_complete(scene, error) : result;
}

/* What a file is for, by the end of its name without case and suffix. */
static const struct {
    const char *name;
    InputId input;
    int channel;
} maps[] = {
    {"albedo", INPUT_base_color, 0},
    {"basecolor", INPUT_base_color, 0},
    {"base_color", INPUT_base_color, 0},
    {"diffuse", INPUT_base_color, 0},
    {"color", INPUT_base_color, 0},
    {"normal", INPUT_normal, 0},
    {"roughness", INPUT_roughness, 0},
    {"metallic", INPUT_metallic, 0},
    {"metalness", INPUT_metallic, 0},
    {"specular", INPUT_specular_color, 0},
    {"specularcolor", INPUT_specular_color, 0},
    {"specular_color", INPUT_specular_color, 0},
    {"sheen", INPUT_sheen_color, 0},
    {"sheencolor", INPUT_sheen_color, 0},
    {"sheen_color", INPUT_sheen_color, 0},
    {"sheenroughness", INPUT_sheen_roughness, 0},
    {"sheen_roughness", INPUT_sheen_roughness, 0},
    {"ao", INPUT_occlusion, 0},
    {"occlusion", INPUT_occlusion, 0},
    {"emission", INPUT_emission, 0},
    {"emissive", INPUT_emission, 0},
    {"opacity", INPUT_opacity, 0},
    {"alpha", INPUT_opacity, 0},
    {"orm", INPUT_occlusion, 0},
    {"orm", INPUT_roughness, 1},
    {"orm", INPUT_metallic, 2},
    {"metallicroughness", INPUT_roughness, 1},
    {"metallicroughness", INPUT_metallic, 2},
    {"metallic_roughness", INPUT_roughness, 1},
    {"metallic_roughness", INPUT_metallic, 2},
    {"nap", INPUT_nap_direction, 0},
    {"nap", INPUT_nap, 2},
};
enum { MAPS = sizeof maps / sizeof *maps, FILES_MOST = INPUT_COUNT };

/* The name of the table that a file's name, cut at its suffix, is or ends in; NULL: none. */
static const char *map_of(const char *file) {
    static const char *const suffixes[] = {".tga", ".png", ".jpg", ".jpeg", ".exr", ".hdr"};
    const char *dot = strrchr(file, '.'), *found = NULL;
    bool picture = false;
    for (size_t k = 0; dot && k < sizeof suffixes / sizeof *suffixes; k++)
        picture |= strcasecmp(dot, suffixes[k]) == 0;
    for (int k = 0; k < MAPS && picture; k++) {
        size_t length = strlen(maps[k].name), stem = (size_t)(dot - file);
        if (length > stem || strncasecmp(dot - length, maps[k].name, length) != 0) continue;
        bool apart = length == stem || strchr("_-. ", dot[-(ptrdiff_t)length - 1]);
        if (apart && (!found || length > strlen(found))) found = maps[k].name;
    }
    return found;
}

/* Pictures of a folder that have a meaning, each input's by the first in the order of names. */
typedef struct Wardrobe {
    Picture pictures[FILES_MOST];
    const char *meaning[FILES_MOST];
    int count;
    int of_input[INPUT_COUNT]; /* which picture, + 1 */
    int channel[INPUT_COUNT];
} Wardrobe;

static void free_wardrobe(Wardrobe *wardrobe) {
    for (int k = 0; k < wardrobe->count; k++) {
        weft_image_free(&wardrobe->pictures[k].image);
        free(wardrobe->pictures[k].path);
    }
}

/* Takes a file in, unless all that it is for is taken. */
static WeftResult take_file(Wardrobe *wardrobe, const char *folder, const char *file, const WeftLog *log,
                            WeftError *error) {
    const char *meaning = map_of(file);
    bool needed = false;
    for (int k = 0; k < MAPS && meaning; k++)
        if (strcmp(maps[k].name, meaning) == 0 && !wardrobe->of_input[maps[k].input]) {
            wardrobe->of_input[maps[k].input] = wardrobe->count + 1;
            wardrobe->channel[maps[k].input] = maps[k].channel;
            needed = true;
        }
    if (meaning && !needed)
        warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, folder, "%s: there is a %s map before it", file, meaning);
    if (!needed) return WEFT_OK;
    size_t length = strlen(folder), size = length + strlen(file) + 2;
    bool slash = length && folder[length - 1] == '/';
    Picture *picture = &wardrobe->pictures[wardrobe->count++]; /* of at most one an input */
    picture->path = malloc(size);
    if (!picture->path) return fail(error, WEFT_MESSAGE_MEMORY, folder, NULL);
    snprintf(picture->path, size, "%s%s%s", folder, slash ? "" : "/", file);
    return weft_image_read(picture->path, &picture->image, log, error);
}

static WeftResult read_folder(const char *folder, Wardrobe *wardrobe, const WeftLog *log, WeftError *error) {
    struct dirent **entries;
    int count = scandir(folder, &entries, NULL, alphasort);
    WeftResult result = WEFT_OK;
    if (count < 0) return fail(error, WEFT_MESSAGE_FILE_OPEN, folder, "%s", strerror(errno));
    for (int k = 0; k < count; k++) {
        if (result == WEFT_OK) result = take_file(wardrobe, folder, entries[k]->d_name, log, error);
        free(entries[k]);
    }
    free(entries);
    if (result == WEFT_OK && !wardrobe->count)
        result = fail(error, WEFT_MESSAGE_FILE_OPEN, folder, "no picture in it has the name of a map");
    return result;
}

/* A specular colour without a metalness is the older workflow's. */
static void wear(Material *material, const Wardrobe *wardrobe) {
    if (wardrobe->of_input[INPUT_specular_color] && !wardrobe->of_input[INPUT_metallic])
        material_choose(material, CHOICE_workflow, WORKFLOW_SPECULAR);
    for (int k = 0; k < INPUT_COUNT; k++)
        if (wardrobe->of_input[k])
            put_on_input(material, (InputId)k, wardrobe->pictures[wardrobe->of_input[k] - 1].texture,
                         wardrobe->channel[k]);
}

WeftResult weft_scene_wear_folder(WeftScene *scene, const char *material, const char *folder, int *count,
                                  const WeftLog *log, WeftError *error) {
    Wardrobe wardrobe = {0};
    WeftError said = {0};
    if (count) *count = 0;
    const bool *wished = materials_wished(scene, material, &said);
    if (!wished && error) *error = said;
    if (!wished) return said.result;
    WeftResult result = read_folder(folder, &wardrobe, log, error);
    for (int k = 0; k < wardrobe.count && result == WEFT_OK; k++)
        if (!take_over(scene, &wardrobe.pictures[k]))
            result = fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    for (int k = 0; k < scene->material_count && result == WEFT_OK; k++)
        if (wished[k]) wear(&scene->materials[k], &wardrobe);
    if (count && result == WEFT_OK) *count = wardrobe.count;
    free_wardrobe(&wardrobe);
    return result == WEFT_OK ? tangents_complete(scene, error) : result;
}
