/* map_folder.c - binding images on the inputs of materials: one by name, or those of a folder by their names */
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/fail.h"
#include "scene/material/assign.h"
#include "scene/material/pictures.h"
#include "scene/material/set.h"
#include "scene/record/tangents.h"
#include "shading/material/choice.h"
#include "shading/material/convert.h"
#include "weft/material.h"

/* A picture that was read, and what it will be in the scene. */
typedef struct MapPicture {
    char *path; /* owned */
    WeftImage image;
    int texture; /* number, counted from 1, once it is taken over */
} MapPicture;

/* Returns the first texture of the image at that path, or -1. */
static int find_path(const WeftScene *scene, const char *path) {
    for (int k = 0; k < scene->texture_count; k++)
        if (path && scene->textures[k].path && strcmp(scene->textures[k].path, path) == 0) return k;
    return -1;
}

/* Returns the texture of an image that is repeated and interpolated, or -1. */
static int find_plain(const WeftScene *scene, int image) {
    for (int k = 0; k < scene->texture_count; k++) {
        const Texture *t = &scene->textures[k];
        if (t->image == image && t->wrap_u == WRAP_REPEAT && t->wrap_v == WRAP_REPEAT && !t->nearest) return k;
    }
    return -1;
}

/* Gives a picture to the scene: in the place of what was read of that path before, if anything was. */
static bool take_over(WeftScene *scene, MapPicture *picture) {
    int before = find_path(scene, picture->path);
    if (before < 0) {
        const char *path = arena_text(&scene->arena, picture->path);
        picture->texture = path ? picture_add(scene, &picture->image, (Texture){.path = path}) : 0;
        return picture->texture != 0;
    }
    int image = scene->textures[before].image, plain = find_plain(scene, image);
    Texture texture = {
        .image = image, .path = scene->textures[before].path, .version = scene->textures[before].version};
    picture->texture = plain < 0 ? texture_number_of(scene, texture) : plain + 1;
    if (picture->texture) picture_replace(scene, image, &picture->image, texture.path);
    return picture->texture != 0;
}

static void put_on_input(Material *material, InputId id, int texture, int channel) {
    Input *input = &material->inputs[id];
    *input = (Input){.texture = texture, .channel = (uint8_t)channel, .given = true};
    input_set_map_factor(input, id);
    input->transform[0] = input->transform[4] = 1.0f;
    if (id == INPUT_opacity && material->alpha_mode == WEFT_ALPHA_OPAQUE)
        material->alpha_mode = WEFT_ALPHA_BLEND; /* else it would say nothing */
}

/* "MATERIAL.INPUT" or "MATERIAL.INPUT.g", cut in three. */
typedef struct MapTarget {
    char material[256];
    InputId input;
    int channel;
} MapTarget;

static WeftResult read_target(const char *text, MapTarget *target, WeftError *error) {
    static const char channels[] = "rgba";
    char copy[320];
    *target = (MapTarget){.channel = -1};
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
    int input = weft_material_input_find(point + 1);
    if (input < 0) return fail(error, WEFT_MESSAGE_PARAM_NAME, point + 1, "`weft models` lists inputs");
    target->input = (InputId)input;
    WeftInputKind kind = input_infos[input].kind;
    if (target->channel >= 0 && kind != WEFT_INPUT_SCALAR && kind != WEFT_INPUT_ANGLE)
        return fail(error, WEFT_MESSAGE_PARAM_NAME, text, "%s takes the whole picture", point + 1);
    return WEFT_OK;
}

WeftResult weft_scene_set_texture(WeftScene *scene, const char *text, const char *path, const WeftLog *log,
                                  WeftError *error) {
    MapTarget target;
    WeftError said = {0};
    WeftResult result = read_target(text, &target, error);
    if (result != WEFT_OK) return result;
    const bool *selected = materials_matching(scene, target.material, &said);
    if (!selected && error) *error = said;
    if (!selected) return said.result;
    MapPicture picture = {.path = strdup(path)};
    result = picture.path ? weft_image_read(path, &picture.image, log, error)
                          : fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    if (result == WEFT_OK && !take_over(scene, &picture)) result = fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    for (int k = 0; k < scene->material_count && result == WEFT_OK; k++)
        if (selected[k])
            put_on_input(&scene->materials[k], target.input, picture.texture, target.channel < 0 ? 0 : target.channel);
    weft_image_free(&picture.image);
    free(picture.path);
    return result == WEFT_OK ? tangents_complete(scene, error) : result;
}

/* The use of a file by the end of its name, without case, suffix, and '_', '-' and blanks between words. Each input is
 * also found by its own name. */
typedef struct MapUse {
    const char *name;
    InputId input;
    int channel;
} MapUse;

static const MapUse others[] = {
    {"albedo", INPUT_base_color, 0},
    {"diffuse", INPUT_base_color, 0},
    {"color", INPUT_base_color, 0},
    {"metalness", INPUT_metallic, 0},
    {"specular", INPUT_specular_color, 0},
    {"anisotropic", INPUT_anisotropy, 0},
    {"sheen", INPUT_sheen_color, 0},
    {"ao", INPUT_occlusion, 0},
    {"ambientocclusion", INPUT_occlusion, 0},
    {"emissive", INPUT_emission, 0},
    {"alpha", INPUT_opacity, 0},
    {"orm", INPUT_occlusion, 0},
    {"orm", INPUT_roughness, 1},
    {"orm", INPUT_metallic, 2},
    {"metallicroughness", INPUT_roughness, 1},
    {"metallicroughness", INPUT_metallic, 2},
    {"nap", INPUT_nap_direction, 0},
    {"nap", INPUT_nap, 2},
};
enum {
    OTHERS = sizeof others / sizeof *others,
    USES = OTHERS + INPUT_COUNT,
    FILES_MOST = INPUT_COUNT,
    NAMES_CAPACITY = 160
};

static MapUse use_at(int k) {
    return k < OTHERS ? others[k] : (MapUse){input_infos[k - OTHERS].name, (InputId)(k - OTHERS), 0};
}

static bool is_separator(char c) { return c && strchr("_-. ", c); }

/* Returns true if the name ends so, between its start and its suffix at dot, after a separator or nothing. */
static bool ends_in(const char *file, const char *dot, const char *name) {
    const char *at = dot, *letter = name + strlen(name);
    while (letter > name && at > file) {
        if (is_separator(letter[-1])) {
            letter--;
            continue;
        }
        at--;
        if (is_separator(*at)) continue;
        if (tolower((unsigned char)*at) != *--letter) return false;
    }
    return letter == name && (at == file || is_separator(at[-1]));
}

static bool is_picture(const char *file) {
    static const char *const suffixes[] = {".tga", ".png", ".jpg", ".jpeg", ".exr", ".hdr"};
    const char *dot = strrchr(file, '.');
    bool picture = false;
    for (size_t k = 0; dot && k < sizeof suffixes / sizeof *suffixes; k++) picture |= strcasecmp(dot, suffixes[k]) == 0;
    return picture;
}

/* Returns the use of the longest name that a file's name, cut at its suffix, is or ends in; -1 if there is none. */
static int use_of(const char *file) {
    int found = -1;
    for (int k = 0; k < USES && is_picture(file); k++)
        if (ends_in(file, strrchr(file, '.'), use_at(k).name) &&
            (found < 0 || strlen(use_at(k).name) > strlen(use_at(found).name)))
            found = k;
    return found;
}

/* Pictures of a folder that have a meaning, each input's by the first in the order of names. */
typedef struct MapSet {
    MapPicture pictures[FILES_MOST];
    int count;
    int of_input[INPUT_COUNT]; /* number of the picture, counted from 1 */
    int channel[INPUT_COUNT];
    char unknown[NAMES_CAPACITY]; /* pictures without a meaning, comma between */
} MapSet;

static void free_map_set(MapSet *map_set) {
    for (int k = 0; k < map_set->count; k++) {
        weft_image_free(&map_set->pictures[k].image);
        free(map_set->pictures[k].path);
    }
}

/* Notes a picture whose name says nothing. */
static void note_unknown(MapSet *map_set, const char *file) {
    char *names = map_set->unknown;
    size_t used = strlen(names);
    const char *comma = used ? ", " : "";
    if (used + strlen(comma) + strlen(file) + sizeof ", ..." <= NAMES_CAPACITY)
        snprintf(names + used, NAMES_CAPACITY - used, "%s%s", comma, file);
    else if (!strstr(names, "..."))
        snprintf(names + used, NAMES_CAPACITY - used, "%s...", comma);
}

/* Takes a file in, unless all that it is for is taken. */
static WeftResult take_file(MapSet *map_set, const char *folder, const char *file, const WeftLog *log,
                            WeftError *error) {
    const int use = use_of(file);
    bool needed = false;
    for (int k = use; use >= 0 && k < USES && strcmp(use_at(k).name, use_at(use).name) == 0; k++)
        if (!map_set->of_input[use_at(k).input]) {
            map_set->of_input[use_at(k).input] = map_set->count + 1;
            map_set->channel[use_at(k).input] = use_at(k).channel;
            needed = true;
        }
    if (use < 0 && is_picture(file)) note_unknown(map_set, file);
    if (use >= 0 && !needed)
        warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, folder, "%s: there is a %s map before it", file, use_at(use).name);
    if (!needed) return WEFT_OK;
    size_t length = strlen(folder), size = length + strlen(file) + 2;
    bool slash = length && folder[length - 1] == '/';
    MapPicture *picture = &map_set->pictures[map_set->count++]; /* of at most one an input */
    picture->path = malloc(size);
    if (!picture->path) return fail(error, WEFT_MESSAGE_MEMORY, folder, NULL);
    snprintf(picture->path, size, "%s%s%s", folder, slash ? "" : "/", file);
    return weft_image_read(picture->path, &picture->image, log, error);
}

static WeftResult read_folder(const char *folder, MapSet *map_set, const WeftLog *log, WeftError *error) {
    struct dirent **entries;
    int count = scandir(folder, &entries, NULL, alphasort);
    WeftResult result = WEFT_OK;
    if (count < 0) return fail(error, WEFT_MESSAGE_FILE_OPEN, folder, "%s", strerror(errno));
    for (int k = 0; k < count; k++) {
        if (result == WEFT_OK) result = take_file(map_set, folder, entries[k]->d_name, log, error);
        free(entries[k]);
    }
    free(entries);
    if (result == WEFT_OK && map_set->unknown[0])
        warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, folder, "no input has a map of this name: %s", map_set->unknown);
    if (result == WEFT_OK && !map_set->count)
        result = fail(error, WEFT_MESSAGE_FILE_OPEN, folder, "no picture in it has the name of a map");
    return result;
}

static void move_map(MapSet *map_set, InputId from, InputId to) {
    if (map_set->of_input[to]) return;
    map_set->of_input[to] = map_set->of_input[from];
    map_set->of_input[from] = 0;
}

/* Returns true if a map is of an input that workflow disney alone reads. Then specular and sheen are amounts. */
static bool is_disney(MapSet *map_set) {
    static const InputId own[] = {INPUT_subsurface, INPUT_specular_tint, INPUT_sheen_tint, INPUT_clearcoat_gloss};
    bool any = false;
    for (size_t k = 0; k < sizeof own / sizeof *own; k++) any |= map_set->of_input[own[k]] != 0;
    if (!any) return false;
    move_map(map_set, INPUT_specular_color, INPUT_specular);
    move_map(map_set, INPUT_sheen_color, INPUT_sheen);
    return true;
}

/* Returns the workflow of the maps, -1: any. A specular colour without a metalness belongs to workflow specular. */
static int workflow_of(MapSet *map_set) {
    if (is_disney(map_set)) return choice_find(CHOICE_workflow, "disney");
    return map_set->of_input[INPUT_specular_color] && !map_set->of_input[INPUT_metallic] ? WORKFLOW_SPECULAR : -1;
}

/* Binds the maps to the inputs of a material. An input that has its map already keeps its factor; a folder without a new
 * map leaves the workflow as it is. */
static void bind_map_set(Material *material, const MapSet *map_set, int workflow) {
    bool any = false;
    for (int k = 0; k < INPUT_COUNT; k++) {
        if (!map_set->of_input[k]) continue;
        int texture = map_set->pictures[map_set->of_input[k] - 1].texture, channel = map_set->channel[k];
        const Input *input = &material->inputs[k];
        if (input->texture == texture && input->channel == channel) continue;
        put_on_input(material, (InputId)k, texture, channel);
        any = true;
    }
    if (any && workflow >= 0) material_choose(material, CHOICE_workflow, workflow);
}

WeftResult weft_scene_bind_maps(WeftScene *scene, const char *material, const char *folder, int *count,
                                const WeftLog *log, WeftError *error) {
    MapSet map_set = {0};
    WeftError said = {0};
    if (count) *count = 0;
    const bool *selected = materials_matching(scene, material, &said);
    if (!selected && error) *error = said;
    if (!selected) return said.result;
    WeftResult result = read_folder(folder, &map_set, log, error);
    for (int k = 0; k < map_set.count && result == WEFT_OK; k++)
        if (!take_over(scene, &map_set.pictures[k])) result = fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    int workflow = workflow_of(&map_set);
    for (int k = 0; k < scene->material_count && result == WEFT_OK; k++)
        if (selected[k]) bind_map_set(&scene->materials[k], &map_set, workflow);
    if (count && result == WEFT_OK) *count = map_set.count;
    free_map_set(&map_set);
    return result == WEFT_OK ? tangents_complete(scene, error) : result;
}
