/* map_folder.c - binding images on the inputs of materials: one by name, or those of a folder by their names */
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/fail.h"
#include "image/codec.h"
#include "scene/material/assign.h"
#include "scene/material/green.h"
#include "scene/material/map_names.h"
#include "scene/material/pictures.h"
#include "scene/material/relief.h"
#include "scene/material/set.h"
#include "shading/material/choice.h"
#include "shading/material/convert.h"
#include "weft/material.h"

/* A picture that was read, and what it will be in the scene. */
typedef struct MapPicture {
    char *path; /* owned */
    WeftImage image;
    TextureLevels *levels; /* owned */
    unsigned inverted;     /* as in Texture */
    int texture;           /* number, counted from 1, once it is taken over */
} MapPicture;

static WeftResult picture_read(MapPicture *picture, const WeftLog *log, WeftError *error) {
    return levels_read(picture->path, &picture->image, &picture->levels, log, error);
}

static void picture_free(MapPicture *picture) {
    weft_image_free(&picture->image);
    levels_free(picture->levels);
    free(picture->path);
}

/* Returns the first texture of the image at a picture's path, inverted as it is, or -1. */
static int find_path(const WeftScene *scene, const MapPicture *picture) {
    for (int k = 0; k < scene->texture_count; k++) {
        const Texture *t = &scene->textures[k];
        if (t->path && picture->path && t->inverted == picture->inverted && strcmp(t->path, picture->path) == 0)
            return k;
    }
    return -1;
}

/* Returns the texture of an image that is repeated and interpolated, or -1. */
static int find_plain(const WeftScene *scene, int image) {
    for (int k = 0; k < scene->texture_count; k++) {
        const Texture *t = &scene->textures[k];
        if (t->image == image && t->wrap_u == WRAP_REPEAT && t->wrap_v == WRAP_REPEAT && !t->nearest && !t->single)
            return k;
    }
    return -1;
}

/* Gives a picture to the scene: in the place of what was read of that path before, if anything was. */
static bool take_over(WeftScene *scene, MapPicture *picture) {
    const int before = find_path(scene, picture);
    if (before < 0) {
        const char *path = arena_text(&scene->arena, picture->path);
        picture->texture =
            path ? picture_add(scene, &picture->image, (Texture){.path = path, .inverted = picture->inverted}) : 0;
        if (!picture->texture) return false;
        textures_put_levels(scene->textures, scene->texture_count, scene->image_count - 1, picture->levels);
    } else {
        const int image = scene->textures[before].image, plain = find_plain(scene, image);
        const Texture texture = {.image = image,
                                 .path = scene->textures[before].path,
                                 .version = scene->textures[before].version,
                                 .inverted = picture->inverted};
        picture->texture = plain < 0 ? texture_number_of(scene, texture) : plain + 1;
        if (!picture->texture) return false;
        picture_replace(scene, image, &picture->image, picture->levels, texture.path);
    }
    picture->levels = NULL;
    return true;
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
    result = picture.path ? picture_read(&picture, log, error) : fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    if (result == WEFT_OK && !take_over(scene, &picture)) result = fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    for (int k = 0; k < scene->material_count && result == WEFT_OK; k++)
        if (selected[k])
            put_on_input(&scene->materials[k], target.input, picture.texture, target.channel < 0 ? 0 : target.channel);
    picture_free(&picture);
    return result == WEFT_OK ? materials_complete(scene, error) : result;
}

static bool has_suffix(const char *file, const char *const *suffixes) {
    const char *dot = strrchr(file, '.');
    while (dot && *suffixes && strcasecmp(dot, *suffixes) != 0) suffixes++;
    return dot && *suffixes;
}

/* A picture of a folder. */
typedef struct MapFile {
    const char *file;
    MapName name;
    bool unreadable; /* of a format that weft does not read */
    int picture;     /* where it is among those that are read, counted from 1 */
} MapFile;

enum { PICTURES_MOST = INPUT_COUNT, NAMES_CAPACITY = 160 };

/* The maps of a folder. */
typedef struct MapSet {
    MapPicture pictures[PICTURES_MOST];
    int count;
    int of_input[INPUT_COUNT]; /* number of the picture, counted from 1 */
    int channel[INPUT_COUNT];
} MapSet;

static void free_map_set(MapSet *map_set) {
    for (int k = 0; k < map_set->count; k++) picture_free(&map_set->pictures[k]);
}

/* Lists the pictures of a folder in the order of their names. Returns their number. */
static int list_pictures(struct dirent **entries, int count, MapFile *files) {
    static const char *const unread[] = {".tif", ".tiff", ".bmp", ".psd", ".dds", ".jp2", NULL};
    int found = 0;
    for (int k = 0; k < count; k++) {
        const char *file = entries[k]->d_name;
        const bool readable = image_suffix_read(file);
        if (!readable && !has_suffix(file, unread)) continue;
        files[found++] = (MapFile){.file = file, .name = map_name(file), .unreadable = !readable};
    }
    return found;
}

/* Returns the use of an input in a picture, or NULL. */
static const MapUse *use_of(const MapFile *file, InputId input) {
    for (int k = 0; k < file->name.count; k++)
        if (file->name.uses[k].input == input) return &file->name.uses[k];
    return NULL;
}

/* Returns how much there is to change in a picture before it is the map of an input: the less the better. */
static int penalty(const MapFile *file, const MapUse *use) {
    return 4 * (file->name.green == GREEN_DOWN) + 2 * use->inverted + (file->name.green == GREEN_UNSAID);
}

/* Returns the picture for an input, the first of those that are as good; NULL if there is none. */
static MapFile *best_file(MapFile *files, int count, InputId input) {
    MapFile *best = NULL;
    int least = 0;
    for (int k = 0; k < count; k++) {
        const MapUse *use = use_of(&files[k], input);
        if (!use || files[k].unreadable || (best && penalty(&files[k], use) >= least)) continue;
        best = &files[k];
        least = penalty(best, use);
    }
    return best;
}

/* Collects names, comma between; "..." stands for those that the text has no room for. */
static void note(char *names, const char *file) {
    size_t used = strlen(names);
    const char *comma = used ? ", " : "";
    if (used + strlen(comma) + strlen(file) + sizeof ", ..." <= NAMES_CAPACITY)
        snprintf(names + used, NAMES_CAPACITY - used, "%s%s", comma, file);
    else if (!strstr(names, "..."))
        snprintf(names + used, NAMES_CAPACITY - used, "%s...", comma);
}

/* Says of each picture that is not read why it is not. */
static void say_unused(MapFile *files, int count, const char *folder, const WeftLog *log) {
    char unknown[NAMES_CAPACITY] = "", unread[NAMES_CAPACITY] = "";
    for (int k = 0; k < count; k++) {
        const MapFile *file = &files[k];
        if (file->picture) continue;
        const MapFile *taken = file->name.count ? best_file(files, count, file->name.uses[0].input) : NULL;
        if (taken)
            warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, folder, "%s: the map of %s is %s", file->file,
                 input_infos[file->name.uses[0].input].name, taken->file);
        else
            note(file->name.count ? unread : unknown, file->file);
    }
    if (unread[0])
        warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, folder, "maps of a format that is not read; convert to .png: %s",
             unread);
    if (unknown[0]) warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, folder, "no input has a map of this name: %s", unknown);
}

/* Reads the picture of a file into the next place, with its path. */
static WeftResult read_picture(const char *folder, const char *file, MapSet *map_set, const WeftLog *log,
                               WeftError *error) {
    size_t length = strlen(folder), size = length + strlen(file) + 2;
    bool slash = length && folder[length - 1] == '/';
    MapPicture *picture = &map_set->pictures[map_set->count++]; /* of at most one an input */
    picture->path = malloc(size);
    if (!picture->path) return fail(error, WEFT_MESSAGE_MEMORY, folder, NULL);
    snprintf(picture->path, size, "%s%s%s", folder, slash ? "" : "/", file);
    return picture_read(picture, log, error);
}

/* Inverts what a picture holds so that inputs take it: gloss, and green that points down. */
static void invert_picture(const MapFile *file, MapPicture *picture, const WeftLog *log) {
    const MapName *name = &file->name;
    for (int k = 0; k < name->count; k++) {
        const int channel = name->uses[k].channel;
        if (name->uses[k].inverted) picture->inverted |= name->count == 1 && channel == 0 ? 7u : 1u << channel;
    }
    const bool normals = name->count == 1 && input_infos[name->uses[0].input].kind == WEFT_INPUT_NORMAL;
    const bool seen = normals && name->green == GREEN_UNSAID && normals_green_down(&picture->image);
    if (name->green == GREEN_DOWN || seen) picture->inverted |= 2u;
    if (name->green == GREEN_DOWN)
        warn(log, WEFT_MESSAGE_GLTF_WARN_REPAIRED, picture->path, "its green points down, as in DirectX: turned up");
    if (seen)
        warn(log, WEFT_MESSAGE_GLTF_WARN_REPAIRED, picture->path,
             "its normals are those of a surface only if green points down, as in DirectX: turned up; with \"gl\" at "
             "the end of its name it stays");
    picture_invert(&picture->image, &picture->levels, picture->inverted);
}

/* Takes the map of an input from a file, which is read at its first one. A picture without alpha has no map there. */
static WeftResult take_map(MapFile *file, InputId input, const char *folder, MapSet *map_set, const WeftLog *log,
                           WeftError *error) {
    const MapUse *use = use_of(file, input);
    if (!file->picture) {
        WeftResult result = read_picture(folder, file->file, map_set, log, error);
        if (result != WEFT_OK) return result;
        file->picture = map_set->count;
        invert_picture(file, &map_set->pictures[map_set->count - 1], log);
    }
    if (use->channel == 3 && map_set->pictures[file->picture - 1].image.channels % 2) {
        warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, folder, "%s: it has no alpha, where by its name the map of %s is",
             file->file, input_infos[input].name);
        return WEFT_OK;
    }
    map_set->of_input[input] = file->picture;
    map_set->channel[input] = use->channel;
    return WEFT_OK;
}

/* Returns true if neither stem begins with the other: pictures of one set may say more of themselves than others do. */
static bool is_other_set(const char *a, const char *b) {
    const size_t x = strlen(a), y = strlen(b);
    return strncmp(a, b, x < y ? x : y) != 0;
}

/* Warns of pictures of several sets that would make one material. */
static void say_mixed(const MapFile *files, int count, const char *folder, const WeftLog *log) {
    const MapFile *first = NULL;
    for (int k = 0; k < count; k++) {
        if (!files[k].picture) continue;
        if (!first) first = &files[k];
        if (!is_other_set(first->name.stem, files[k].name.stem)) continue;
        warn(log, WEFT_MESSAGE_PLAUSIBLE, folder,
             "%.80s and %.80s seem to be of two sets, of which one material is made: put each into a folder",
             first->file, files[k].file);
        return;
    }
}

static WeftResult read_folder(const char *folder, MapSet *map_set, const WeftLog *log, WeftError *error) {
    struct dirent **entries;
    int count = scandir(folder, &entries, NULL, alphasort);
    if (count < 0) return fail(error, WEFT_MESSAGE_FILE_OPEN, folder, "%s", strerror(errno));
    MapFile *files = calloc((size_t)count + 1, sizeof *files);
    WeftResult result = files ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, folder, NULL);
    int pictures = files ? list_pictures(entries, count, files) : 0;
    for (int k = 0; k < INPUT_COUNT && result == WEFT_OK; k++) {
        MapFile *file = best_file(files, pictures, (InputId)k);
        if (file) result = take_map(file, (InputId)k, folder, map_set, log, error);
    }
    if (result == WEFT_OK) say_unused(files, pictures, folder, log);
    if (result == WEFT_OK) say_mixed(files, pictures, folder, log);
    if (result == WEFT_OK && !map_set->count)
        result = fail(error, WEFT_MESSAGE_FILE_OPEN, folder, "no picture in it has the name of a map");
    for (int k = 0; k < count; k++) free(entries[k]);
    free(entries);
    free(files);
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

/* Binds the maps to the inputs of a material. An input that has its map already keeps its factor; a folder without a
 * new map leaves the workflow as it is. */
static void bind_map_set(const WeftScene *scene, Material *material, const MapSet *map_set, int workflow) {
    bool any = false;
    for (int k = 0; k < INPUT_COUNT; k++) {
        if (!map_set->of_input[k]) continue;
        int texture = map_set->pictures[map_set->of_input[k] - 1].texture, channel = map_set->channel[k];
        const Input *input = &material->inputs[k];
        if (relief_source(scene, input->texture) == texture && input->channel == channel) continue;
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
        if (selected[k]) bind_map_set(scene, &scene->materials[k], &map_set, workflow);
    if (count && result == WEFT_OK) *count = map_set.count;
    free_map_set(&map_set);
    return result == WEFT_OK ? materials_complete(scene, error) : result;
}
