/* map_look.c - the search for the look of the maps of a cloth; map_look.h has its error */
#include <math.h>
#include <string.h>

#include "measure/cloth/map_look.h"
#include "weave/weft_cloth.h"

enum { NEAR_SIDE = 4 };                  /* points along a side of a block */
static const double contrast_free = 1.6; /* contrast may be off by this factor for nothing */

/* Returns the block's column and row, spread evenly over the maps. */
static void block_place(const MapGrid *grid, int block, int *column, int *row) {
    *column = (int)(fmod(0.7548776662466927 * (block + 1), 1.0) * grid->width);
    *row = (int)(fmod(0.5698402909980532 * (block + 1), 1.0) * grid->height);
}

static MapTexel texel_beside(const MapGrid *grid, int column, int row, int right, int down) {
    return map_texel(grid, (column + right) % grid->width, (row + down) % grid->height);
}

enum { WHOLE = 2048 }; /* texels that stand for all */

/* Returns texel number k of WHOLE, spread over the maps evenly. */
static MapTexel whole_texel(const MapGrid *grid, int k) {
    int column, row;
    block_place(grid, k, &column, &row);
    return map_texel(grid, column, row);
}

/* Returns the means of the maps. */
static MapTexel whole_mean(const MapGrid *grid) {
    MapTexel mean = {.cover = 0.0f};
    for (int k = 0; k < WHOLE; k++) {
        const MapTexel t = whole_texel(grid, k);
        map_texel_add(&mean, &t, 1.0f / WHOLE);
    }
    return mean;
}

/* Adds a texel of the maps, `part` times, as filtered textures are added: its normal, not its slopes. */
static void look_add(LookTexel *to, const MapTexel *t, bool holed, float part) {
    const float cover = fmaxf(t->cover, 1e-6f), x = t->slope[0] / cover, y = t->slope[1] / cover;
    const float n = 1.0f / sqrtf(1.0f + x * x + y * y);
    float angle;
    const float stretch = map_texel_stretch(t, &angle);
    for (int c = 0; c < 3; c++) to->color[c] += part * map_texel_color(t, c, 0.0f, holed);
    to->normal[0] += part * x * n, to->normal[1] += part * y * n, to->normal[2] += part * n;
    to->along[0] += part * cosf(angle), to->along[1] += part * sinf(angle);
    to->roughness += part * t->roughness / cover;
    to->stretch += part * stretch;
    to->light += part * t->light / cover;
    to->cover += part * (holed ? t->cover : 1.0f);
}

/* Reads the texels of a block. */
static void block_read(MapFit *fit, int block) {
    LookTexel *texels = fit->blocks[block].texels;
    int column, row;
    block_place(fit->grid, block, &column, &row);
    memset(texels, 0, TEXELS * sizeof *texels);
    for (int k = 0; k < FINE; k++) {
        const MapTexel t = texel_beside(fit->grid, column, row, 2 * (k % 2), 2 * (k / 2));
        look_add(&texels[k], &t, fit->holed, 1.0f);
    }
    for (int k = 0; k < COARSE; k++) {
        const MapTexel t = texel_beside(fit->grid, column, row, 4 * (k % 4), 4 * (k / 4));
        look_add(&texels[FINE], &t, fit->holed, 1.0f / COARSE);
    }
}

static void texels_read(MapFit *fit) {
    const MapTexel mean = whole_mean(fit->grid);
    LookTexel whole = {.cover = 0.0f};
    look_add(&whole, &mean, fit->holed, 1.0f);
    fit->open = mean.open / fmaxf(mean.cover, 1e-6f);
    for (int k = 0; k < BLOCKS; k++) block_read(fit, k);
    map_fit_center(fit, 0, FINE, &whole);
    map_fit_center(fit, FINE, 1, &whole);
    for (int k = 0; k < BLOCKS; k++)
        for (int c = 0; c < 3; c++)
            fit->color_most[c] = fmax(fit->color_most[c], (double)fit->blocks[k].texels[FINE].color[c]);
}

/* Starts from a copy of the threads' own numbers: the reflectance of fibres as base colour, their specular in white. */
static void copy_start(const WeftCloth *cloth, double x[AXES]) {
    const double white = 0.5 * (double)(cloth->weave.warp.white + cloth->weave.weft.white);
    x[AXIS_METALLIC] = 0.0;
    x[AXIS_ROUGHNESS] = 1.0;
    x[AXIS_ANISOTROPY] = 0.9;
    x[AXIS_NORMAL] = 1.0;
    x[AXIS_SHADE] = 0.0;
    x[AXIS_SPECULAR] = 1.0;
    x[AXIS_SHEEN] = 0.5 * white;
    x[AXIS_SHEEN_ROUGHNESS] = 0.6;
}

/* Returns the error of that look, without any gain. */
static double copied_error(MapFit *fit, const double *x) {
    double sky;
    fit->count = BLOCKS;
    (void)map_fit_error(fit, x, &sky);
    for (int c = 0; c < 3; c++) fit->gains[c] = fit->tints[c] = 1.0;
    fit->dim = 1.0; /* a copy has no occlusion that was fitted */
    return map_fit_error_now(fit, &sky);
}

/* Returns the factor on the colours of texels, none of which exceeds 1, by which the mean of the maps is that of the blocks,
 * which the search saw, times a gain. */
static float color_factor(const MapFit *fit, int c, float shade, double gain) {
    enum { STEPS = 8 };
    static const double most = 16.0;
    float colors[WHOLE], parts[WHOLE];
    double blocks = 0.0, factor = gain;
    for (int k = 0; k < BLOCKS * FINE; k++) {
        const LookTexel *t = &fit->blocks[k / FINE].texels[k % FINE];
        blocks += (double)(t->cover * t->color[c] * powf(fmaxf(t->light, 0.0f), shade)) / (BLOCKS * FINE);
    }
    for (int k = 0; k < WHOLE; k++) {
        const MapTexel t = whole_texel(fit->grid, k);
        colors[k] = map_texel_color(&t, c, shade, fit->holed);
        parts[k] = (fit->holed ? t.cover : 1.0f) / WHOLE;
    }
    for (int step = 0; step < STEPS; step++) { /* the first one is exact where no texel is cut */
        double mean = 0.0;
        for (int k = 0; k < WHOLE; k++) mean += (double)parts[k] * fmin(factor * (double)colors[k], 1.0);
        factor = fmin(factor * gain * blocks / fmax(mean, 1e-9), most * gain);
    }
    return (float)factor;
}

static double error_at(void *user, double *x, SearchCare care) {
    MapFit *fit = user;
    double sky;
    fit->count = care == SEARCH_FULL ? BLOCKS : ROUGH_BLOCKS;
    fit->contrast_goal = map_fit_contrast(fit, false);
    const double error = map_fit_error(fit, x, &sky);
    /* a sheen whose strongest channel is below 1 would dim the base less than it was reckoned with */
    const double dim = 1.0 - fmax(fit->tints[0], fmax(fit->tints[1], fit->tints[2]));
    return error + map_fit_price(fit, sky, contrast_free) + 0.1 * x[AXIS_SHEEN] * dim;
}

static void look_search(MapFit *fit, MapLook *look, WeftBaked *found) {
    double x[AXES], sky;
    Search search = {.axes = AXES,
                     .error = error_at,
                     .user = fit,
                     .grid = 64,
                     .descents = 3,
                     .most = 120,
                     .item_progress = fit->item_progress};
    memcpy(search.axis, map_axes, sizeof map_axes);
    map_fit_unread(fit, search.axis);
    copy_start(fit->cloth, x);
    found->copied = copied_error(fit, x);
    x[AXIS_NORMAL] = 0.4;
    x[AXIS_SHADE] = 1.0;
    search_run(&search, x, NULL);
    fit->count = BLOCKS;
    fit->contrast_goal = map_fit_contrast(fit, false);
    found->fitted = map_fit_error(fit, x, &sky);
    found->sky = sky - 1.0;
    found->contrast = fit->contrast / fmax(fit->contrast_goal, 1e-6);
    *look = (MapLook){.roughness = (float)x[AXIS_ROUGHNESS],
                      .anisotropy = (float)x[AXIS_ANISOTROPY],
                      .normal = (float)x[AXIS_NORMAL],
                      .shade = (float)x[AXIS_SHADE],
                      .metallic = (float)x[AXIS_METALLIC],
                      .specular = (float)x[AXIS_SPECULAR],
                      .sheen_roughness = (float)x[AXIS_SHEEN_ROUGHNESS]};
    for (int c = 0; c < 3; c++) {
        look->color[c] = color_factor(fit, c, look->shade, fit->gains[c]);
        look->sheen[c] = (float)(fit->tints[c] * x[AXIS_SHEEN]);
    }
    look->occlusion = map_fit_occlusion(fit, sky);
}

void map_look_find(MapFit *fit, MapLook *look, WeftBaked *found) {
    MapPlace places[BLOCKS];
    texels_read(fit);
    for (int k = 0; k < BLOCKS; k++) {
        int column, row;
        block_place(fit->grid, k, &column, &row);
        places[k] = (MapPlace){(float)column, (float)row, NEAR_SIDE, NEAR_SIDE};
    }
    map_fit_near(fit, places, NEAR_SIDE);
    look_search(fit, look, found);
}
