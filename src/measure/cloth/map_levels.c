#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/thread.h"
#include "image/halve.h"
#include "image/pixel.h"
#include "measure/cloth/map_levels.h"
#include "shading/dialect/tone.h"

enum { LEVEL_AXES = 4 };
static const int level_axes[LEVEL_AXES] = {AXIS_METALLIC, AXIS_ROUGHNESS, AXIS_ANISOTROPY, AXIS_NORMAL};
static const SearchAxis level_ranges[LEVEL_AXES] = {{0.0, 1.0}, {0.5, 2.0}, {0.0, 1.4}, {0.02, 1.5}};
/* Contrast may be off by this factor for nothing; a change of metallic from one level to the next costs so much, since
 * viewers mix both levels. */
static const double contrast_free = 1.2, metallic_price = 0.02;
static const float cover_least = 1e-4f; /* a texel with less has no threads of its own */

static float *plane_at(const MapLevel *level, MapPlane plane, size_t texel) { return level->planes[plane] + 4 * texel; }

typedef struct FirstLevel {
    const MapGrid *grid;
    const MapLook *look;
    MapLevel *level;
    bool holed;
} FirstLevel;

/* Adds the highlight of a texel to a matrix of squares, `part` times. */
static void facets_add(float *to, float roughness, float strength, float angle, float part) {
    const float b = roughness * roughness, a = b + (1.0f - b) * strength * strength;
    const float x = cosf(angle), y = sinf(angle), aa = a * a, bb = b * b;
    to[0] += part * (aa * x * x + bb * y * y);
    to[1] += part * (aa - bb) * x * y;
    to[2] += part * (aa * y * y + bb * x * x);
}

static void row_make(void *user, int row, int thread) {
    const FirstLevel *self = user;
    const MapLook *look = self->look;
    (void)thread;
    for (int column = 0; column < self->grid->width; column++) {
        const MapTexel t = map_texel(self->grid, column, row);
        const size_t at = (size_t)row * (size_t)self->grid->width + (size_t)column;
        const float cover = fmaxf(t.cover, 1e-6f), x = t.slope[0] / cover, y = t.slope[1] / cover;
        const float n = t.cover / sqrtf(1.0f + x * x + y * y);
        float angle, *color = plane_at(self->level, PLANE_COLOR, at), *normal = plane_at(self->level, PLANE_NORMAL, at);
        const float strength = fminf(look->anisotropy * map_texel_stretch(&t, &angle), 1.0f);
        for (int c = 0; c < 3; c++)
            color[c] = map_texel_color(&t, c, look->shade, self->holed) * (self->holed ? t.cover : 1.0f);
        color[3] = t.cover;
        normal[0] = x * n, normal[1] = y * n, normal[2] = n, normal[3] = t.open;
        facets_add(plane_at(self->level, PLANE_FACETS, at), fminf(look->roughness * t.roughness / cover, 1.0f),
                   strength, angle, t.cover);
    }
}

static bool level_alloc(MapLevel *level, int width, int height) {
    bool room = true;
    level->width = width;
    level->height = height;
    for (int p = 0; p < PLANES; p++) {
        level->planes[p] = alloc_array(4 * (size_t)width * (size_t)height, sizeof(float));
        room = room && level->planes[p];
    }
    return room;
}

/* Makes the texels of all levels. Returns false if memory is short. */
static bool texels_make(const MapGrid *grid, const MapLook *look, MapLevels *levels) {
    MapLevel *first = &levels->items[0];
    if (!level_alloc(first, grid->width, grid->height)) return false;
    FirstLevel job = {.grid = grid, .look = look, .level = first, .holed = levels->holed};
    parallel_for(0, grid->height, row_make, &job);
    levels->count = 1;
    for (MapLevel *at = first; (at->width > 1 || at->height > 1) && levels->count < MAP_LEVELS_MOST; at++) {
        levels->count++;
        if (!level_alloc(at + 1, halved(at->width), halved(at->height))) return false;
        for (int p = 0; p < PLANES; p++) halve_f32(at->planes[p], at->width, at->height, at[1].planes[p]);
    }
    return true;
}

/* Reads the axes of the mean highlight: roughness, the strength by which it is longer, and the angle in -45 to 135
 * degrees, where neither system of threads lies at the seam. */
static void facets_read(const float *a, float *roughness, float *strength, float *angle) {
    const float middle = 0.5f * (a[0] + a[2]), half = 0.5f * (a[0] - a[2]), away = sqrtf(half * half + a[1] * a[1]);
    const float along = sqrtf(fminf(middle + away, 1.0f)), across = sqrtf(fmaxf(middle - away, 1e-8f));
    *roughness = sqrtf(across);
    *strength = sqrtf(fmaxf(along - across, 0.0f) / fmaxf(1.0f - across, 1e-6f));
    *angle = 0.5f * atan2f(a[1], half);
    if (*angle < -0.25f * PI) *angle += PI;
}

/* The cover of a texel: sums over its threads, and the cover that these are weighted by. */
typedef struct Covered {
    const float *color, *normal, *facets;
    float cover;
} Covered;

/* Returns the threads of a texel. One without any is seen only where a viewer mixes it with others: it has those of the
 * whole, so that it draws nothing of its own into them. */
static Covered covered_of(const MapLevels *levels, const MapLevel *level, size_t at) {
    if (plane_at(level, PLANE_COLOR, at)[3] < cover_least) level = &levels->items[levels->count - 1], at = 0;
    const float *color = plane_at(level, PLANE_COLOR, at);
    return (Covered){color, plane_at(level, PLANE_NORMAL, at), plane_at(level, PLANE_FACETS, at),
                     fmaxf(color[3], cover_least)};
}

static LookTexel look_texel(const MapLevels *levels, const MapLevel *level, size_t at) {
    const Covered covered = covered_of(levels, level, at);
    const float *color = plane_at(level, PLANE_COLOR, at);
    LookTexel t = {.light = 1.0f, .cover = levels->holed ? color[3] : 1.0f};
    float angle, facets[3];
    for (int c = 0; c < 3; c++) {
        t.color[c] = levels->holed ? covered.color[c] / covered.cover : color[c];
        t.normal[c] = covered.normal[c] / covered.cover;
        facets[c] = covered.facets[c] / covered.cover;
    }
    facets_read(facets, &t.roughness, &t.stretch, &angle);
    t.along[0] = cosf(angle), t.along[1] = sinf(angle);
    return t;
}

/* Chooses texels for the blocks, spread evenly, and the places of their threads. */
static void blocks_choose(MapFit *fit, const MapLevels *levels, const MapLevel *level, MapPlace places[BLOCKS]) {
    const int texels = level->width * level->height;
    fit->count = texels < BLOCKS ? texels : BLOCKS;
    for (int b = 0; b < fit->count; b++) {
        int column = b % level->width, row = b / level->width;
        if (texels > BLOCKS) {
            column = (int)(fmod(0.7548776662466927 * (b + 1), 1.0) * level->width);
            row = (int)(fmod(0.5698402909980532 * (b + 1), 1.0) * level->height);
        }
        const float wide = (float)fit->grid->width / (float)level->width,
                    high = (float)fit->grid->height / (float)level->height;
        places[b] = (MapPlace){(float)column * wide, (float)row * high, wide, high};
        fit->blocks[b].texels[0] = look_texel(levels, level, (size_t)row * (size_t)level->width + (size_t)column);
    }
}

/* Gives the blocks the mean colour and normal of the whole, which the last level is. */
static void blocks_center(MapFit *fit, const LookTexel *whole) {
    map_fit_center(fit, 0, 1, whole);
    for (int c = 0; c < 3; c++) {
        fit->color_most[c] = 0.0;
        for (int b = 0; b < fit->count; b++)
            fit->color_most[c] = fmax(fit->color_most[c], (double)fit->blocks[b].texels[0].color[c]);
    }
}

/* A level that is fitted. */
typedef struct LevelFit {
    MapFit *fit;
    double x[AXES], before; /* before: metallic of the level before */
} LevelFit;

static double level_error(void *user, double *x, SearchCare care) {
    LevelFit *self = user;
    double sky;
    (void)care;
    for (int k = 0; k < LEVEL_AXES; k++) self->x[level_axes[k]] = x[k];
    const double error = map_fit_error(self->fit, self->x, &sky);
    return error + map_fit_price(self->fit, sky, contrast_free) +
           metallic_price * fabs(self->x[AXIS_METALLIC] - self->before);
}

/* Sets the ranges of a level's numbers; those that the profile does not read stay as they are. */
static void ranges_set(const MapFit *fit, const double x[LEVEL_AXES], SearchAxis ranges[LEVEL_AXES]) {
    SearchAxis all[AXES];
    memcpy(all, map_axes, sizeof all);
    map_fit_unread(fit, all);
    for (int k = 0; k < LEVEL_AXES; k++) {
        const SearchAxis *axis = &all[level_axes[k]];
        ranges[k] = axis->high > axis->low ? level_ranges[k] : (SearchAxis){x[k], x[k]};
    }
}

/* Finds the numbers of a level. before: those of the level before. */
static void level_find(LevelFit *self, const MapLevel *before, MapLevel *level) {
    double x[LEVEL_AXES] = {(double)before->metallic, (double)before->roughness, (double)before->anisotropy,
                            (double)before->relief},
           sky;
    Search search = {.axes = LEVEL_AXES,
                     .error = level_error,
                     .user = self,
                     .grid = 24,
                     .descents = 2,
                     .most = 60,
                     .item_progress = self->fit->item_progress};
    ranges_set(self->fit, x, search.axis);
    self->before = (double)before->metallic;
    self->fit->contrast_goal = map_fit_contrast(self->fit, true);
    search_run(&search, x, NULL);
    for (int k = 0; k < LEVEL_AXES; k++) self->x[level_axes[k]] = x[k];
    level->error = map_fit_error(self->fit, self->x, &sky);
    level->metallic = (float)x[0], level->roughness = (float)x[1], level->anisotropy = (float)x[2];
    level->relief = (float)x[3];
    for (int c = 0; c < 3; c++) level->color[c] = (float)self->fit->gains[c];
    level->occlusion = map_fit_occlusion(self->fit, sky);
}

/* Sets what all levels share: sheen and specular of the look. */
static void look_hold(LevelFit *self, const MapLook *look) {
    MapFit *fit = self->fit;
    const float most = fmaxf(look->sheen[0], fmaxf(look->sheen[1], look->sheen[2]));
    fit->level = true;
    for (int c = 0; c < 3; c++) fit->tints[c] = most > 0.0f ? (double)(look->sheen[c] / most) : 0.0;
    self->x[AXIS_SHADE] = 0.0;
    self->x[AXIS_SPECULAR] = (double)look->specular;
    self->x[AXIS_SHEEN] = (double)most;
    self->x[AXIS_SHEEN_ROUGHNESS] = (double)look->sheen_roughness;
}

/* Sets the numbers of the first level, which are in its texels already. */
static void first_set(MapLevel *first, const MapLook *look) {
    first->metallic = look->metallic;
    first->roughness = first->anisotropy = 1.0f;
    first->relief = look->normal;
    first->occlusion = look->occlusion;
    for (int c = 0; c < 3; c++) first->color[c] = look->color[c];
}

/* Goes on to one of so many levels, which share a part of the search evenly. Returns false if the search should end. */
static bool level_begin(ItemProgress *item_progress, const ItemProgress *part, int level, int count) {
    const double step = (part->high - part->low) / count;
    progress_part(item_progress, part->low + step * level, part->low + step * (level + 1));
    return progress_report(item_progress, 0.0);
}

WeftResult map_levels_find(MapFit *fit, const MapLook *look, MapLevels *out, WeftError *error) {
    enum { FEW = 4, MANY = 8 }; /* points along a side of a place */
    LevelFit self = {.fit = fit};
    MapPlace places[BLOCKS];
    const ItemProgress part = fit->item_progress ? *fit->item_progress : (ItemProgress){.watch = NULL};
    *out = (MapLevels){.holed = fit->holed, .normal = look->normal};
    if (!texels_make(fit->grid, look, out)) return fail(error, WEFT_MESSAGE_MEMORY, "maps", NULL);
    first_set(&out->items[0], look);
    const MapLevel *last = &out->items[out->count - 1];
    const LookTexel whole = look_texel(out, last, 0);
    const Covered covered = covered_of(out, last, 0);
    fit->open = covered.normal[3] / covered.cover;
    look_hold(&self, look);
    for (int k = 1; k < out->count; k++) {
        if (!level_begin(fit->item_progress, &part, k - 1, out->count - 1)) return WEFT_INTERRUPTED;
        MapLevel *level = &out->items[k];
        blocks_choose(fit, out, level, places);
        blocks_center(fit, &whole);
        map_fit_near(fit, places, k < 3 ? FEW : MANY);
        level_find(&self, level - 1, level);
        out->normal = fmaxf(out->normal, level->relief);
    }
    return progress_report(fit->item_progress, 0.0) ? WEFT_OK : WEFT_INTERRUPTED;
}

void map_levels_free(MapLevels *levels) {
    for (int k = 0; k < levels->count; k++)
        for (int p = 0; p < PLANES; p++) free(levels->items[k].planes[p]);
    levels->count = 0;
}

void map_level_texel(const MapLevels *levels, int level, int column, int row, unsigned char maps[MAP_LEVEL_MAPS][4]) {
    const MapLevel *from = &levels->items[level];
    const size_t at = (size_t)row * (size_t)from->width + (size_t)column;
    const LookTexel t = look_texel(levels, from, at);
    const Covered covered = covered_of(levels, from, at);
    const float open = covered.normal[3] / covered.cover, scale = from->relief / fmaxf(levels->normal, 1e-6f);
    const float x = scale * t.normal[0], y = scale * t.normal[1],
                n = 1.0f / sqrtf(x * x + y * y + t.normal[2] * t.normal[2]);
    for (int c = 0; c < 3; c++) maps[0][c] = pixel_byte(tone_encode(fminf(from->color[c] * t.color[c], 1.0f)));
    maps[0][3] = pixel_byte(plane_at(from, PLANE_COLOR, at)[3]);
    maps[1][0] = pixel_byte(0.5f + 0.5f * x * n), maps[1][1] = pixel_byte(0.5f + 0.5f * y * n);
    maps[1][2] = pixel_byte(0.5f + 0.5f * t.normal[2] * n);
    maps[2][0] = pixel_byte(1.0f - from->occlusion.strength * (1.0f - from->occlusion.factor * open));
    maps[2][1] = pixel_byte(from->roughness * t.roughness);
    maps[2][2] = pixel_byte(from->metallic);
    maps[3][0] = pixel_byte(0.5f + 0.5f * t.along[0]), maps[3][1] = pixel_byte(0.5f + 0.5f * t.along[1]);
    maps[3][2] = pixel_byte(from->anisotropy * t.stretch);
    maps[1][3] = maps[2][3] = maps[3][3] = 255;
}
