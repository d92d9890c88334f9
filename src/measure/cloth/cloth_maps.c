/* cloth_maps.c - a cloth as tileable textures, for renderers without a model of threads */
#define _XOPEN_SOURCE 700 /* folder.h */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/folder.h"
#include "base/thread.h"
#include "image/pixel.h"
#include "measure/cloth/map_levels.h"
#include "scene/record/material.h"
#include "shading/dialect/tone.h"
#include "shading/material/choice.h"
#include "weave/weft_cloth.h"

static const float SLUB_NODES_LEAST = 0.1f; /* per crossing: of a slub that is no longer than a tile */
enum { MAP_COLOR, MAP_NORMAL, MAP_ROUGHNESS, MAP_ANISOTROPY, MAP_HEIGHT, MAP_COUNT };
enum {
    CYCLE_LEAST = 16,   /* threads along a map's side, at least */
    SIDE_MAX = 8192,    /* texels along a map's side, at most */
    FOLDER_MOST = 4000, /* bytes of a folder's name */
    PATH_SIZE = 4096,
    BLOCK = 4 /* texels of a block of UASTC, which glTF wants to divide a side */
};

static const struct {
    const char *name;
    int channels;
} kinds[MAP_COUNT] = {{"base_color", 4}, {"normal", 3}, {"occlusion_roughness", 3}, {"anisotropy", 3}, {"height", 1}};

static const char back_name[] = "back-"; /* begins the names of the other face's files */

/* A face of the cloth. */
typedef struct MapBake {
    MapGrid grid;
    const char *name; /* prefix of the files */
    bool holed;       /* gaps are holes, not black */
    bool leveled;     /* all maps but the height are KTX 2 files with mip levels of their own */
    MapLook look;
    MapFit *fit;      /* by which it was found; owned */
    MapLevels levels; /* of a face that has them; owned */
    WeftImage maps[MAP_COUNT];
} MapBake;

static unsigned char *texel_at(MapBake *b, int map, int column, int row) {
    const size_t pixel = (size_t)row * (size_t)b->grid.width + (size_t)column;
    return (unsigned char *)b->maps[map].pixels + pixel * (size_t)kinds[map].channels;
}

/* Writes a texel of all maps but the height. Highlights of fibres are elongated across them. The anisotropy map is that of
 * KHR_materials_anisotropy: this direction as a vector, and the strength with which roughness grows along it. */
static void put_texel(MapBake *b, const MapTexel *t, int column, int row) {
    const float cover = fmaxf(t->cover, 1e-6f), x = t->slope[0] / cover, y = t->slope[1] / cover;
    const float n = 1.0f / sqrtf(1.0f + x * x + y * y);
    float angle;
    const float stretch = map_texel_stretch(t, &angle);
    unsigned char *to = texel_at(b, MAP_COLOR, column, row);
    for (int c = 0; c < 3; c++)
        to[c] = pixel_byte(tone_encode(fminf(b->look.color[c] * map_texel_color(t, c, b->look.shade, b->holed), 1.0f)));
    to[3] = pixel_byte(t->cover);
    to = texel_at(b, MAP_NORMAL, column, row);
    to[0] = pixel_byte(0.5f + 0.5f * x * n), to[1] = pixel_byte(0.5f + 0.5f * y * n),
    to[2] = pixel_byte(0.5f + 0.5f * n);
    to = texel_at(b, MAP_ROUGHNESS, column, row);
    to[0] = pixel_byte(b->look.occlusion.factor * t->open / cover),
    to[1] = pixel_byte(b->look.roughness * t->roughness / cover), to[2] = pixel_byte(b->look.metallic);
    to = texel_at(b, MAP_ANISOTROPY, column, row);
    to[0] = pixel_byte(0.5f + 0.5f * cosf(angle)), to[1] = pixel_byte(0.5f + 0.5f * sinf(angle)),
    to[2] = pixel_byte(b->look.anisotropy * stretch);
}

static void put_height(MapBake *b, const MapTexel *t, int column, int row) {
    const float span = fmaxf(b->grid.weave.high - b->grid.weave.low, 1e-6f);
    *texel_at(b, MAP_HEIGHT, column, row) = pixel_byte((t->height - b->grid.weave.low) / span);
}

/* Returns the first map of which there is one picture; those before it have one for each level. */
static int first_of(const MapBake *b) { return b->leveled ? MAP_HEIGHT : 0; }

static void bake_row(void *user, int row, int thread) {
    MapBake *b = user;
    (void)thread;
    for (int column = 0; column < b->grid.width; column++) {
        const MapTexel t = map_texel(&b->grid, column, row);
        if (!b->leveled) put_texel(b, &t, column, row);
        put_height(b, &t, column, row);
    }
}

/* Returns the suffix of a map's file. */
static const char *suffix_of(const MapBake *b, int map) { return b->leveled && map != MAP_HEIGHT ? "ktx2" : "png"; }

static void path_of(const MapBake *b, const char *folder, int map, char path[PATH_SIZE]) {
    snprintf(path, PATH_SIZE, "%.4000s/%s%s.%s", folder, b->name, kinds[map].name, suffix_of(b, map));
}

static WeftResult write_maps(MapBake *b, const char *folder, WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int k = first_of(b); k < MAP_COUNT && result == WEFT_OK; k++) {
        char path[PATH_SIZE];
        path_of(b, folder, k, path);
        result = weft_image_write_as(path, &b->maps[k], &(WeftImageWriting){.data = k != MAP_COLOR}, error);
    }
    return result;
}

/* The pictures of a level of all maps but the height. */
typedef struct LevelPictures {
    const MapLevels *levels;
    int level;
    WeftImage *maps; /* MAP_LEVEL_MAPS, each at the level's place among MAP_LEVELS_MOST */
} LevelPictures;

static void picture_row(void *user, int row, int thread) {
    const LevelPictures *self = user;
    const int width = self->levels->items[self->level].width;
    (void)thread;
    for (int column = 0; column < width; column++) {
        unsigned char texel[MAP_LEVEL_MAPS][4];
        map_level_texel(self->levels, self->level, column, row, texel);
        for (int k = 0; k < MAP_LEVEL_MAPS; k++) {
            const size_t channels = (size_t)kinds[k].channels, at = (size_t)row * (size_t)width + (size_t)column;
            unsigned char *pixels = self->maps[k * MAP_LEVELS_MOST + self->level].pixels;
            memcpy(pixels + at * channels, texel[k], channels);
        }
    }
}

/* Writes the levels as KTX 2 files. */
static WeftResult write_levels(const MapBake *b, const MapLevels *levels, const char *folder, WeftError *error) {
    WeftImage images[MAP_LEVEL_MAPS * MAP_LEVELS_MOST] = {{0}};
    LevelPictures pictures = {.levels = levels, .maps = images};
    WeftResult result = WEFT_OK;
    for (int level = 0; level < levels->count && result == WEFT_OK; level++) {
        const MapLevel *at = &levels->items[level];
        for (int k = 0; k < MAP_LEVEL_MAPS && result == WEFT_OK; k++)
            result = weft_image_create(at->width, at->height, kinds[k].channels, WEFT_PIXEL_U8,
                                       &images[k * MAP_LEVELS_MOST + level], error);
        pictures.level = level;
        if (result == WEFT_OK) parallel_for(0, at->height, picture_row, &pictures);
    }
    for (int k = 0; k < MAP_LEVEL_MAPS && result == WEFT_OK; k++) {
        const WeftImage *first = &images[k * MAP_LEVELS_MOST];
        const WeftImageWriting how = {.data = k != MAP_COLOR, .levels = first + 1, .level_count = levels->count - 1};
        char path[PATH_SIZE];
        path_of(b, folder, k, path);
        result = weft_image_write_as(path, first, &how, error);
    }
    for (int k = 0; k < MAP_LEVEL_MAPS * MAP_LEVELS_MOST; k++) weft_image_free(&images[k]);
    return result;
}

/* Names the file of a map in a material. */
static void texture_put(FILE *stream, const MapBake *b, int map) {
    fprintf(stream, "\"texture\": \"%s%s.%s\"", b->name, kinds[map].name, suffix_of(b, map));
}

/* An input of a material that has a map: its channel, NULL: all; and a factor, if it has one. */
typedef struct MapInput {
    const char *name;
    int map;
    const char *channel;
    const float *factor;
} MapInput;

/* Writes the inputs of a face, each with its map; place: its size in texture coordinates. */
static void write_face(FILE *stream, const MapBake *b, const char *place) {
    const MapLook *look = &b->look;
    const MapInput inputs[] = {{"base_color", MAP_COLOR, NULL, NULL},
                               {"normal", MAP_NORMAL, NULL, &look->normal},
                               {"occlusion", MAP_ROUGHNESS, "r", &look->occlusion.strength},
                               {"roughness", MAP_ROUGHNESS, "g", NULL},
                               {"metallic", MAP_ROUGHNESS, "b", NULL},
                               {"anisotropy", MAP_ANISOTROPY, "b", NULL},
                               {"anisotropy_direction", MAP_ANISOTROPY, NULL, NULL},
                               {"opacity", MAP_COLOR, "a", NULL}}; /* the last, for it is not always there */
    const bool holes = b->holed && !b->grid.back;
    for (size_t k = 0; k < sizeof inputs / sizeof *inputs - (holes ? 0 : 1); k++) {
        const MapInput *input = &inputs[k];
        fprintf(stream, "    \"%s\": {", input->name);
        texture_put(stream, b, input->map);
        if (input->channel) fprintf(stream, ", \"channel\": \"%s\"", input->channel);
        if (input->factor) fprintf(stream, ", \"factor\": %.4g", (double)*input->factor);
        fprintf(stream, ", %s},\n", place);
    }
    if (holes) fprintf(stream, "    \"alpha_mode\": \"blend\",\n");
    fprintf(stream,
            "    \"ior\": 1.5,\n    \"specular\": %.4g,\n    \"sheen_color\": [%.4g, %.4g, %.4g],\n"
            "    \"sheen_roughness\": %.4g,\n    \"double_sided\": true",
            (double)look->specular, (double)look->sheen[0], (double)look->sheen[1], (double)look->sheen[2],
            (double)look->sheen_roughness);
}

/* Writes a material file (docs/materials.md) with the maps of one face or both. place: their size in texture coordinates. */
static WeftResult write_material(const MapBake faces[2], int count, const char *place, const char *folder,
                                 WeftError *error) {
    char path[4096];
    OutputFile file;
    snprintf(path, sizeof path, "%.4000s/material.json", folder);
    WeftResult result = output_open(&file, path, error);
    if (result != WEFT_OK) return result;
    fprintf(file.stream, "{\n");
    write_face(file.stream, &faces[0], place);
    if (count == 2) {
        fprintf(file.stream, ",\n    \"back\": {\n");
        write_face(file.stream, &faces[1], place);
        fprintf(file.stream, "\n    }");
    }
    fprintf(file.stream, "\n}\n");
    return output_commit(&file, error);
}

/* Gives the sides of maps of about pixels^2 square texels over a cloth of that size, each 16 to SIDE_MAX. A tall repeat
 * gets maps narrower than `pixels`, so that it takes no more memory than a wide one. step: divides both. */
static void sides_of(int pixels, const double size[2], int step, int sides[2]) {
    const double q = (sqrt)(size[0] / size[1]), side = fmin(pixels, SIDE_MAX / fmax(q, 1.0 / q));
    sides[0] = (int)fmax(step * rint(side * q / step), 16.0);
    sides[1] = (int)fmax(step * rint(side / q / step), 16.0);
}

/* Returns the number of threads of whole repeats, at least CYCLE_LEAST. */
static int cycle_of(int count) { return count * ((CYCLE_LEAST + count - 1) / count); }

/* Removes a folder that was made for maps of which not all could be written. */
static void maps_remove(const char *folder) {
    for (int k = 0; k < 4 * MAP_COUNT; k++) {
        const MapBake b = {.name = k / MAP_COUNT % 2 ? back_name : "", .leveled = k / MAP_COUNT / 2 != 0};
        char path[PATH_SIZE];
        path_of(&b, folder, k % MAP_COUNT, path);
        unlink(path);
    }
    rmdir(folder);
}

/* Returns the grid of a face, with so many threads of each system, and slubs that fit a tile. */
static MapGrid grid_of(const WeftCloth *cloth, bool back, const int threads[2], const int sides[2]) {
    MapGrid grid = {.weave = cloth->weave, .back = back, .width = sides[0], .height = sides[1]};
    grid.weave.cycle_x = (float)threads[0];
    grid.weave.cycle_y = (float)threads[1];
    grid.weave.warp.slub_nodes = fmaxf(grid.weave.warp.slub_nodes, SLUB_NODES_LEAST);
    grid.weave.weft.slub_nodes = fmaxf(grid.weave.weft.slub_nodes, SLUB_NODES_LEAST);
    return grid;
}

/* Bakes and writes the maps of a face that have no levels of their own. */
static WeftResult bake_face(MapBake *b, const char *folder, WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int k = first_of(b); k < MAP_COUNT && result == WEFT_OK; k++)
        result = weft_image_create(b->grid.width, b->grid.height, kinds[k].channels, WEFT_PIXEL_U8, &b->maps[k], error);
    if (result == WEFT_OK) {
        parallel_for(0, b->grid.height, bake_row, b);
        result = write_maps(b, folder, error);
    }
    for (int k = 0; k < MAP_COUNT; k++) weft_image_free(&b->maps[k]);
    return result;
}

/* Returns the profile of the viewer; -1 with *error where it is none, or shades no material of glTF's. */
static int profile_of(const WeftBaking *baking, WeftError *error) {
    const char *name = baking->profile ? baking->profile : "khronos";
    const int profile = choice_find(CHOICE_profile, name);
    Material material = material_default();
    if (profile < 0) {
        (void)fail(error, WEFT_MESSAGE_DESC, "maps", "there is no profile %s", name);
        return -1;
    }
    material_choose(&material, CHOICE_profile, profile);
    if (weft_material_reads(&material, INPUT_metallic)) return profile;
    (void)fail(error, WEFT_MESSAGE_DESC, "maps", "profile %s does not read the metallic of glTF", name);
    return -1;
}

static bool is_holed(const WeftMaterial *material, const WeftCloth *cloth) {
    const bool gaps = cloth->weave.warp_far.share + cloth->weave.weft_far.share < 0.999f;
    return gaps && material->alpha_mode != WEFT_ALPHA_OPAQUE;
}

static const double LEVEL_SEARCHES = 2.0;

/* The viewer that maps are made for. */
typedef struct MapViewer {
    int profile, pixels;
    double metres;
    bool leveled;
    ItemProgress item_progress; /* of the searches: those of a face's levels take twice as long as that of its look */
    double searched, searches;  /* how many, counted so, are over, of how many */
} MapViewer;

/* Goes on to the next searches, which count as so many. */
static void search_begin(MapViewer *viewer, double searches) {
    const double low = viewer->searched / viewer->searches;
    viewer->searched += searches;
    progress_part(&viewer->item_progress, low, viewer->searched / viewer->searches);
}

/* Finds the look of a face, and its levels. */
static WeftResult look_face(MapBake *b, const WeftMaterial *material, const WeftCloth *cloth, MapViewer *viewer,
                            WeftBaked *found, WeftError *error) {
    WeftResult result = map_fit_create(&b->grid, material, cloth, viewer->profile, b->holed, &b->fit, error);
    if (result != WEFT_OK || !b->fit) return result;
    b->fit->item_progress = &viewer->item_progress;
    search_begin(viewer, 1.0);
    map_look_find(b->fit, &b->look, found);
    if (!progress_report(&viewer->item_progress, 1.0)) return WEFT_INTERRUPTED;
    if (!b->leveled) return WEFT_OK;
    search_begin(viewer, LEVEL_SEARCHES);
    result = map_levels_find(b->fit, &b->look, &b->levels, error);
    for (int k = 1; k < b->levels.count; k++) found->levels += b->levels.items[k].error / (b->levels.count - 1);
    return result;
}

/* Writes the maps of a face. */
static WeftResult make_face(MapBake *b, const char *folder, WeftError *error) {
    WeftResult result = bake_face(b, folder, error);
    if (result != WEFT_OK || !b->leveled) return result;
    b->look.normal = b->levels.normal;
    b->look.occlusion.strength = 1.0f; /* the map of each level has the strength */
    return write_levels(b, &b->levels, folder, error);
}

/* Fits and writes the faces of a cloth, for a viewer; the second may be NULL. That one, which glTF has no place for, has no
 * levels. */
static WeftResult bake_faces(const WeftMaterial *material, const WeftCloth *const cloths[2], MapViewer *viewer,
                             const char *folder, WeftBaked *found, WeftError *error) {
    const WeftCloth *front = cloths[0];
    const int threads[2] = {cycle_of(front->weave.warps), cycle_of(front->weave.picks)};
    const double size[2] = {front->size[0] * threads[0] / front->weave.warps,
                            front->size[1] * threads[1] / front->weave.picks};
    const bool holed = is_holed(material, front);
    char place[96];
    int sides[2];
    MapBake faces[2] = {{.name = ""}, {.name = ""}};
    WeftBaked baked[2] = {{.levels = 0.0}, {.levels = 0.0}};
    WeftResult result = WEFT_OK;
    const int count = cloths[1] ? 2 : 1;
    viewer->searches = count + (viewer->leveled ? LEVEL_SEARCHES : 0.0);
    sides_of(viewer->pixels, size, viewer->leveled ? BLOCK : 1, sides);
    snprintf(place, sizeof place, "\"scale\": [%.9g, %.9g]", viewer->metres / size[0], viewer->metres / size[1]);
    for (int k = 0; k < count && result == WEFT_OK; k++) {
        MapBake *b = &faces[k];
        *b = (MapBake){.grid = grid_of(cloths[k], k == 1, threads, sides),
                       .name = k ? back_name : "",
                       .holed = holed,
                       .leveled = viewer->leveled && k == 0};
        result = look_face(b, material, cloths[k], viewer, &baked[k], error);
    }
    for (int k = 0; k < count && result == WEFT_OK; k++) result = make_face(&faces[k], folder, error);
    for (int k = 0; k < count; k++) {
        map_fit_free(faces[k].fit);
        map_levels_free(&faces[k].levels);
    }
    if (result != WEFT_OK) return result;
    if (found) *found = baked[0];
    return write_material(faces, count, place, folder, error);
}

/* A cloth to bake, in a thread that is watched. */
typedef struct ClothBake {
    const WeftMaterial *material;
    const WeftCloth *cloths[2];
    MapViewer viewer;
    const char *folder;
    WeftBaked *found;
    WeftResult result;
    WeftError error;
} ClothBake;

static void bake_run(void *user, int item, int thread) {
    (void)item, (void)thread;
    ClothBake *self = user;
    self->result = bake_faces(self->material, self->cloths, &self->viewer, self->folder, self->found, &self->error);
}

/* Bakes a cloth, and tells the caller how far the search is. */
static WeftResult bake_watched(ClothBake *self, const WeftBaking *baking, WeftError *error) {
    LoopWatch watch;
    self->viewer.item_progress = (ItemProgress){.watch = &watch};
    (void)watch_loop(&watch, 1, 1, bake_run, self, baking->progress, baking->user);
    if (self->result != WEFT_OK && self->result != WEFT_INTERRUPTED && error) *error = self->error;
    return self->result;
}

WeftResult weft_material_bake(const WeftMaterial *material, const WeftCloth *cloth, const WeftBaking *baking,
                              const char *folder, WeftBaked *found, WeftError *error) {
    const MapViewer viewer = {.profile = profile_of(baking, error),
                              .pixels = baking->pixels ? baking->pixels : 1024,
                              .metres = fabs(baking->metres) <= 0.0 ? 1.0 : baking->metres,
                              .leveled = baking->levels != 0};
    const int pixels = viewer.pixels;
    const double metres = viewer.metres;
    if (viewer.profile < 0) return WEFT_USAGE;
    if (!cloth) return fail(error, WEFT_MESSAGE_DESC, "maps", "the material is not woven");
    if (pixels < 16 || pixels > SIDE_MAX)
        return fail(error, WEFT_MESSAGE_DESC, "maps", "%d pixels; 16 to %d are possible", pixels, SIDE_MAX);
    if (!(metres > 1e-6 && metres < 1e6)) return fail(error, WEFT_MESSAGE_DESC, "maps", "%g metres", metres);
    if (strlen(folder) > FOLDER_MOST) return fail(error, WEFT_MESSAGE_FILE_WRITE, "maps", "the name is too long");
    const int made = folder_create(folder);
    if (made < 0) return fail(error, WEFT_MESSAGE_FILE_WRITE, folder, "%s", strerror(errno));
    WeftCloth *other = baking->one_face ? NULL : cloth_other_face(cloth);
    ClothBake bake = {
        .material = material, .cloths = {cloth, other}, .viewer = viewer, .folder = folder, .found = found};
    const WeftResult result =
        other || baking->one_face ? bake_watched(&bake, baking, error) : fail(error, WEFT_MESSAGE_MEMORY, folder, NULL);
    weft_cloth_free(other);
    if (result != WEFT_OK && made == 1) maps_remove(folder);
    return result;
}

WeftResult weft_cloth_bake(const WeftCloth *cloth, int pixels, double metres, const char *folder, WeftError *error) {
    Material material = material_default();
    if (pixels < 1 || !(metres > 0.0)) /* 0 is no default here */
        return fail(error, WEFT_MESSAGE_DESC, "maps", "%d pixels, %g metres", pixels, metres);
    material.alpha_mode = WEFT_ALPHA_BLEND;
    return weft_material_bake(&material, cloth, &(WeftBaking){.pixels = pixels, .metres = metres}, folder, NULL, error);
}
