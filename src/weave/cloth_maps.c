/* cloth_maps.c - a cloth as tileable textures, for renderers without a model of threads */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/thread.h"
#include "image/srgb.h"
#include "shading/dialect/tone.h"
#include "shading/media/yarn_medium.h"
#include "weave/weft_cloth.h"

static const float SLUB_NODES_LEAST = 0.1f; /* per crossing: of a slub that is no longer than a tile */
enum { MAP_COLOR, MAP_NORMAL, MAP_ROUGHNESS, MAP_ANISOTROPY, MAP_HEIGHT, MAP_COUNT };
enum {
    FINE = 2,         /* points along a texel's side */
    CYCLE_LEAST = 16, /* threads along a map's side, at least */
    SIDE_MAX = 8192   /* texels along a map's side, at most */
};

static const struct {
    const char *file;
    int channels;
} kinds[MAP_COUNT] = {
    {"base_color.png", 4}, {"normal.png", 3}, {"occlusion_roughness.png", 3}, {"anisotropy.png", 3}, {"height.png", 1}};

static const char back_name[] = "back-"; /* begins the names of the other face's files */

typedef struct MapBake {
    Weave weave;      /* with a cycle */
    bool back;        /* the other face, whose threads are counted the other way along both systems */
    const char *name; /* that its files begin with */
    int width, height;
    WeftImage maps[MAP_COUNT];
} MapBake;

/* Sums over the points of a texel, each with the weight 1 / FINE^2. */
typedef struct MapTexel {
    float color[3]; /* linear reflectance */
    float cover;    /* fraction covered by threads */
    float slope[2];
    float roughness;
    float open; /* visible fraction of the sky, weave_depth */
    float height;
    float along[2]; /* direction of the fibres as a unit vector at twice the angle, so that opposite ones agree */
} MapTexel;

/* Returns the part of light that leaves white fibres after it met one of them (yarn_medium.h). */
static float single_of(float alpha) { return 0.328f - 0.111f * alpha; }

/* Adds a point of the cloth to a texel. */
static void add_point(const Weave *m, float x, float y, float spacing, MapTexel *t) {
    const WeavePoint p = weave_point(m, x, y, spacing, 0.0f);
    const float part = 1.0f / (FINE * FINE);
    if (p.height <= WEAVE_NONE) {
        t->height += part * m->low;
        return;
    }
    const float alpha = p.weft ? m->weft.alpha : m->warp.alpha, single = single_of(alpha);
    for (int c = 0; c < 3; c++) {
        const float a = weave_albedo(m, p, c);
        t->color[c] += part * p.lit * (a * single + yarn_reflectance(a) * (1.0f - single));
    }
    t->cover += part;
    t->slope[0] += part * p.slope_x;
    t->slope[1] += part * p.slope_y;
    t->roughness += part * sqrtf(alpha);
    t->open += part * weave_depth(m, p);
    t->height += part * p.height;
    const float across = p.fibre.x * p.fibre.x + p.fibre.y * p.fibre.y;
    t->along[0] += part * (p.fibre.x * p.fibre.x - p.fibre.y * p.fibre.y) / fmaxf(across, 1e-6f);
    t->along[1] += part * 2.0f * p.fibre.x * p.fibre.y / fmaxf(across, 1e-6f);
}

static unsigned char byte_of(float x) { return (unsigned char)lrintf(255.0f * fminf(fmaxf(x, 0.0f), 1.0f)); }

static unsigned char *texel_at(MapBake *b, int map, int column, int row) {
    const size_t pixel = (size_t)row * (size_t)b->width + (size_t)column;
    return (unsigned char *)b->maps[map].pixels + pixel * (size_t)kinds[map].channels;
}

/* Writes a texel of all maps. Highlights of fibres are elongated across them. The anisotropy map is that of
 * KHR_materials_anisotropy: this direction as a vector, and the strength with which roughness grows along it. */
static void put_texel(MapBake *b, const MapTexel *t, int column, int row) {
    const float cover = fmaxf(t->cover, 1e-6f), x = t->slope[0] / cover, y = t->slope[1] / cover;
    const float n = 1.0f / sqrtf(1.0f + x * x + y * y);
    const float alignment = sqrtf(t->along[0] * t->along[0] + t->along[1] * t->along[1]) / cover;
    const float angle = 0.5f * atan2f(t->along[1], t->along[0]) + PI / 2.0f;
    unsigned char *to = texel_at(b, MAP_COLOR, column, row);
    for (int c = 0; c < 3; c++) to[c] = byte_of(tone_encode(fminf(t->color[c] / cover, 1.0f)));
    to[3] = byte_of(t->cover);
    to = texel_at(b, MAP_NORMAL, column, row);
    to[0] = byte_of(0.5f + 0.5f * x * n), to[1] = byte_of(0.5f + 0.5f * y * n), to[2] = byte_of(0.5f + 0.5f * n);
    to = texel_at(b, MAP_ROUGHNESS, column, row);
    to[0] = byte_of(t->open / cover), to[1] = byte_of(t->roughness / cover), to[2] = 0;
    to = texel_at(b, MAP_ANISOTROPY, column, row);
    to[0] = byte_of(0.5f + 0.5f * cosf(angle)), to[1] = byte_of(0.5f + 0.5f * sinf(angle)),
    to[2] = byte_of(0.9f * alignment);
    const float span = fmaxf(b->weave.high - b->weave.low, 1e-6f);
    *texel_at(b, MAP_HEIGHT, column, row) = byte_of((t->height - b->weave.low) / span);
}

static void bake_row(void *user, int row, int thread) {
    MapBake *b = user;
    const float spacing = fmaxf(b->weave.cycle_x / (float)b->width, b->weave.cycle_y / (float)b->height) / FINE;
    (void)thread;
    for (int column = 0; column < b->width; column++) {
        MapTexel t = {.cover = 0.0f};
        for (int k = 0; k < FINE * FINE; k++) {
            const int right = k % FINE, down = k / FINE;
            const float x = ((float)column + ((float)right + 0.5f) / FINE) / (float)b->width;
            const float y = 1.0f - ((float)row + ((float)down + 0.5f) / FINE) / (float)b->height;
            add_point(&b->weave, (b->back ? 1.0f - x : x) * b->weave.cycle_x,
                      (b->back ? 1.0f - y : y) * b->weave.cycle_y, spacing, &t);
        }
        put_texel(b, &t, column, row);
    }
}

static WeftResult write_maps(MapBake *b, const char *folder, WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int k = 0; k < MAP_COUNT && result == WEFT_OK; k++) {
        char path[4096];
        snprintf(path, sizeof path, "%.4000s/%s%s", folder, b->name, kinds[k].file);
        result = weft_image_write_as(path, &b->maps[k], &(WeftImageWriting){.data = k != MAP_COLOR}, error);
    }
    return result;
}

/* Writes the inputs of a face, each with its map; place: its size in texture coordinates. */
static void write_face(FILE *stream, const MapBake *b, bool gaps, const char *place) {
    const double white = 0.5 * (double)(b->weave.warp.white + b->weave.weft.white);
    fprintf(stream, "    \"base_color\": {\"texture\": \"%s%s\", %s},\n", b->name, kinds[MAP_COLOR].file, place);
    if (gaps && !b->back)
        fprintf(stream,
                "    \"opacity\": {\"texture\": \"%s%s\", \"channel\": \"a\", %s},\n    \"alpha_mode\": "
                "\"blend\",\n",
                b->name, kinds[MAP_COLOR].file, place);
    fprintf(stream, "    \"normal\": {\"texture\": \"%s%s\", %s},\n", b->name, kinds[MAP_NORMAL].file, place);
    fprintf(stream, "    \"occlusion\": {\"texture\": \"%s%s\", \"channel\": \"r\", %s},\n", b->name,
            kinds[MAP_ROUGHNESS].file, place);
    fprintf(stream, "    \"roughness\": {\"texture\": \"%s%s\", \"channel\": \"g\", %s},\n", b->name,
            kinds[MAP_ROUGHNESS].file, place);
    fprintf(stream, "    \"anisotropy\": {\"texture\": \"%s%s\", \"channel\": \"b\", %s},\n", b->name,
            kinds[MAP_ANISOTROPY].file, place);
    fprintf(stream, "    \"anisotropy_direction\": {\"texture\": \"%s%s\", %s},\n", b->name, kinds[MAP_ANISOTROPY].file,
            place);
    fprintf(stream,
            "    \"sheen_color\": %.3g,\n    \"sheen_roughness\": 0.6,\n    \"reflectance\": %.3g,\n"
            "    \"double_sided\": true",
            0.5 * white, fmin((0.02 + 0.5 * white - 0.017) / 0.05, 1.0));
}

/* Writes a material file (docs/materials.md) with the maps of both faces. metres: length of a unit of texture
 * coordinates. */
static WeftResult write_material(const MapBake faces[2], const WeftCloth *cloth, const double size[2], double metres,
                                 const char *folder, WeftError *error) {
    char path[4096], place[96];
    OutputFile file;
    snprintf(path, sizeof path, "%.4000s/material.json", folder);
    WeftResult result = output_open(&file, path, error);
    if (result != WEFT_OK) return result;
    const bool gaps = cloth->weave.warp_far.share + cloth->weave.weft_far.share < 0.999f;
    snprintf(place, sizeof place, "\"scale\": [%.9g, %.9g]", metres / size[0], metres / size[1]);
    fprintf(file.stream, "{\n");
    write_face(file.stream, &faces[0], gaps, place);
    fprintf(file.stream, ",\n    \"back\": {\n");
    write_face(file.stream, &faces[1], gaps, place);
    fprintf(file.stream, "\n    }\n}\n");
    return output_commit(&file, error);
}

/* Gives the sides of maps of about pixels^2 square texels over a cloth of that size, each 16 to SIDE_MAX. A tall repeat
 * gets maps narrower than `pixels`, so that it takes no more memory than a wide one. */
static void sides_of(int pixels, const double size[2], int sides[2]) {
    const double q = (sqrt)(size[0] / size[1]), side = fmin(pixels, SIDE_MAX / fmax(q, 1.0 / q));
    sides[0] = (int)fmax(rint(side * q), 16.0);
    sides[1] = (int)fmax(rint(side / q), 16.0);
}

/* Returns the number of threads of whole repeats, at least CYCLE_LEAST. */
static int cycle_of(int count) { return count * ((CYCLE_LEAST + count - 1) / count); }

/* Removes a folder that was made for maps of which not all could be written. */
static void folder_remove(const char *folder) {
    for (int k = 0; k < 2 * MAP_COUNT; k++) {
        char path[4096];
        snprintf(path, sizeof path, "%.4000s/%s%s", folder, k < MAP_COUNT ? "" : back_name, kinds[k % MAP_COUNT].file);
        unlink(path);
    }
    rmdir(folder);
}

/* Bakes and writes the maps of a face. */
static WeftResult bake_face(MapBake *b, const char *folder, WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int k = 0; k < MAP_COUNT && result == WEFT_OK; k++)
        result = weft_image_create(b->width, b->height, kinds[k].channels, WEFT_PIXEL_U8, &b->maps[k], error);
    if (result == WEFT_OK) {
        parallel_for(0, b->height, bake_row, b);
        result = write_maps(b, folder, error);
    }
    for (int k = 0; k < MAP_COUNT; k++) weft_image_free(&b->maps[k]);
    return result;
}

/* Returns a face of a cloth as it is baked, with so many threads of each system, and slubs that fit a tile. */
static MapBake face_of(const WeftCloth *cloth, bool back, const int threads[2], const int sides[2]) {
    MapBake bake = {
        .weave = cloth->weave, .back = back, .name = back ? back_name : "", .width = sides[0], .height = sides[1]};
    bake.weave.cycle_x = (float)threads[0];
    bake.weave.cycle_y = (float)threads[1];
    bake.weave.warp.slub_nodes = fmaxf(bake.weave.warp.slub_nodes, SLUB_NODES_LEAST);
    bake.weave.weft.slub_nodes = fmaxf(bake.weave.weft.slub_nodes, SLUB_NODES_LEAST);
    return bake;
}

WeftResult weft_cloth_bake(const WeftCloth *cloth, int pixels, double metres, const char *folder, WeftError *error) {
    if (pixels < 16 || pixels > SIDE_MAX)
        return fail(error, WEFT_MESSAGE_DESC, "maps", "%d pixels; 16 to %d are possible", pixels, SIDE_MAX);
    if (!(metres > 1e-6 && metres < 1e6)) return fail(error, WEFT_MESSAGE_DESC, "maps", "%g metres", metres);
    const bool made = mkdir(folder, 0777) == 0;
    if (!made && errno != EEXIST) return fail(error, WEFT_MESSAGE_FILE_WRITE, folder, "%s", strerror(errno));
    const int threads[2] = {cycle_of(cloth->weave.warps), cycle_of(cloth->weave.picks)};
    const double size[2] = {cloth->size[0] * threads[0] / cloth->weave.warps,
                            cloth->size[1] * threads[1] / cloth->weave.picks};
    int sides[2];
    sides_of(pixels, size, sides);
    WeftCloth *other = cloth_other_face(cloth);
    WeftResult result = other ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, folder, NULL);
    if (other) {
        MapBake faces[2] = {face_of(cloth, false, threads, sides), face_of(other, true, threads, sides)};
        for (int k = 0; k < 2 && result == WEFT_OK; k++) result = bake_face(&faces[k], folder, error);
        if (result == WEFT_OK) result = write_material(faces, cloth, size, metres, folder, error);
    }
    weft_cloth_free(other);
    if (result != WEFT_OK && made) folder_remove(folder);
    return result;
}
