/* map_look.c - the search for the look of the maps of a cloth; map_look.h has its error */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/thread.h"
#include "measure/bsdf/halton.h"
#include "measure/bsdf/reflection.h"
#include "measure/bsdf/weave_sum.h"
#include "measure/cloth/map_look.h"
#include "measure/cloth/map_pairs.h"
#include "measure/fit/search.h"
#include "scene/record/material_at.h"
#include "shading/material/choice.h"

/* Blocks of 4 by 4 texels, of which every other one in both directions is shaded; and around each the mean of 16 by 16,
 * of which every fourth one is counted. */
enum { BLOCKS = 48, ROUGH_BLOCKS = 16, FINE = 4, COARSE = 16, TEXELS = FINE + 1, NEAR_POINTS = 16 };
/* The numbers that are searched for; all others follow. */
enum {
    AXIS_METALLIC,
    AXIS_ROUGHNESS,
    AXIS_ANISOTROPY,
    AXIS_NORMAL,
    AXIS_SHADE,
    AXIS_SPECULAR,
    AXIS_SHEEN,
    AXIS_SHEEN_ROUGHNESS,
    AXES
};
static const SearchAxis axes[AXES] = {{0.0, 1.0}, {0.3, 2.0}, {0.0, 1.1}, {0.05, 1.2},
                                      {0.5, 5.0}, {0.0, 1.0}, {0.0, 0.6}, {0.3, 1.0}};
/* Contrast may be off by this factor for nothing, and by more at this price for each factor of e. */
static const double contrast_free = 1.6, contrast_price = 0.25;

/* A texel as a shader reads it from the maps. */
typedef struct LookTexel {
    float color[3], normal[3], along[2], light, roughness, stretch, cover; /* color: with a shade of 0 */
} LookTexel;

/* Parts of f cos_i of which light is a sum: of a black base without sheen; what a white base adds, by channel in the
 * colour of the texel; what a white sheen adds. */
enum { PART_REST, PART_BASE, PART_SHEEN = PART_BASE + 3, PARTS };

typedef struct LookBlock {
    LookTexel texels[TEXELS];      /* FINE of them, and the coarse one */
    double fine[PARTS][MAP_PAIRS]; /* of the texels as they are: their mean */
    double coarse[PARTS][MAP_PAIRS];
    double near[MAP_CONTRASTS]; /* what the threads reflect, mean of channels */
} LookBlock;

/* A sum of pairs that is compared. */
typedef struct LookRow {
    double goal[3], weight, parts[PARTS];
} LookRow;

typedef struct LookFit {
    const MapGrid *grid;
    const WeftCloth *cloth;
    Surface bare;   /* of the maps without texels */
    Material plain; /* the same with a sheen */
    Choices choices;
    AlbedoTable *table;
    MapPairs pairs;
    LookBlock *blocks;
    bool holed; /* gaps are holes */
    int count;  /* blocks in use */
    const double *x;
    LookRow rows[2 * MAP_ROWS]; /* fine, then coarse */
    float open;                 /* the mean of the occlusion map */
    double color_most[3];
    double contrast_goal, contrast;
    MapLook look;
    double gains[3], tints[3];
} LookFit;

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
static void block_read(LookFit *fit, int block) {
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

/* Gives texels first, first + 1, .. of `per` in each block the means of the whole: some hundred texels have them by chance
 * alone, and a cloth whose threads lean to one side in the mean would reflect to that side. */
static void center(LookFit *fit, int first, int per, const LookTexel *whole) {
    LookTexel mean = {.cover = 0.0f};
    const float part = 1.0f / (float)(BLOCKS * per);
    for (int k = 0; k < BLOCKS * per; k++) {
        const LookTexel *t = &fit->blocks[k / per].texels[first + k % per];
        for (int c = 0; c < 3; c++) mean.color[c] += part * t->color[c], mean.normal[c] += part * t->normal[c];
    }
    for (int k = 0; k < BLOCKS * per; k++) {
        LookTexel *t = &fit->blocks[k / per].texels[first + k % per];
        for (int c = 0; c < 3; c++) t->color[c] *= whole->color[c] / fmaxf(mean.color[c], 1e-6f);
        for (int a = 0; a < 2; a++) t->normal[a] += whole->normal[a] - mean.normal[a];
    }
}

static void texels_read(LookFit *fit) {
    const MapTexel mean = whole_mean(fit->grid);
    LookTexel whole = {.cover = 0.0f};
    look_add(&whole, &mean, fit->holed, 1.0f);
    fit->open = mean.open / fmaxf(mean.cover, 1e-6f);
    for (int k = 0; k < BLOCKS; k++) block_read(fit, k);
    center(fit, 0, FINE, &whole);
    center(fit, FINE, 1, &whole);
    for (int k = 0; k < BLOCKS; k++)
        for (int c = 0; c < 3; c++)
            fit->color_most[c] = fmax(fit->color_most[c], (double)fit->blocks[k].texels[FINE].color[c]);
}

/* Returns the surface of a texel: its base is white in one channel, its sheen in another. */
static Surface texel_surface(const LookFit *fit, const LookTexel *t) {
    const double *x = fit->x;
    const float scale = (float)x[AXIS_NORMAL];
    Surface s = fit->bare;
    s.base_color = rgb(0.0f, 1.0f, 0.0f);
    s.sheen_color = rgb((float)x[AXIS_SHEEN], 0.0f, 0.0f);
    s.sheen_roughness = (float)x[AXIS_SHEEN_ROUGHNESS];
    s.metallic = (float)x[AXIS_METALLIC];
    s.specular = (float)x[AXIS_SPECULAR];
    s.roughness = fminf(t->roughness * (float)x[AXIS_ROUGHNESS], 1.0f);
    s.anisotropy = fminf(t->stretch * (float)x[AXIS_ANISOTROPY], 1.0f);
    s.anisotropy_direction = dir_normal_or(dir(t->along[0], t->along[1], 0.0f), dir(1.0f, 0.0f, 0.0f));
    s.normal = dir_normal_or(dir(scale * t->normal[0], scale * t->normal[1], t->normal[2]), dir(0.0f, 0.0f, 1.0f));
    return s;
}

/* Adds f cos of a texel to the parts, `part` times. */
static void shade(const LookFit *fit, const LookTexel *t, double part, double parts[PARTS][MAP_PAIRS]) {
    const Dir up = dir(0.0f, 0.0f, 1.0f);
    const Facing facing = {.geometric = up, .normal = up, .tangent = dir(1.0f, 0.0f, 0.0f), .handedness = 1.0f};
    const double light = (double)powf(fmaxf(t->light, 0.0f), (float)fit->x[AXIS_SHADE]);
    const Surface surface = texel_surface(fit, t), framed = frame_surface(surface);
    const TableRef e = fit->table ? albedo_table_ref(fit->table) : (TableRef){.kind = TABLE_NONE};
    SeenStack seen;
    stack_make(&seen.stack, &framed, &fit->choices, e);
    for (int out = 0; out < MAP_OUTS; out++) {
        const Frame frame = frame_of(facing, surface, fit->pairs.o[out]);
        const Dir o = frame_to(frame, fit->pairs.o[out]);
        stack_see(&seen.stack, &o, &seen.view);
        for (int k = fit->pairs.first[out]; k < fit->pairs.first[out + 1]; k++) {
            const Dir i = frame_to(frame, fit->pairs.i[k]);
            if (!(i.z > 0.0f) || !(fit->pairs.i[k].z > 0.0f)) continue;
            const Rgb f = stack_eval_of(&seen.stack, &seen.view, slots_all(), i).f_cos;
            parts[PART_REST][k] += part * (double)(t->cover * f.b);
            parts[PART_SHEEN][k] += part * (double)(t->cover * (f.r - f.b));
            for (int c = 0; c < 3; c++)
                parts[PART_BASE + c][k] += part * light * (double)(t->cover * t->color[c] * (f.g - f.b));
        }
    }
}

static void block_shade(void *user, int block, int thread) {
    const LookFit *fit = user;
    LookBlock *b = &fit->blocks[block];
    (void)thread;
    memset(b->fine, 0, sizeof b->fine);
    memset(b->coarse, 0, sizeof b->coarse);
    for (int k = 0; k < FINE; k++) shade(fit, &b->texels[k], 1.0 / FINE, b->fine);
    shade(fit, &b->texels[FINE], 1.0, b->coarse);
}

/* Fills the rows with the sums of the pairs of all blocks. */
static void rows_fill(LookFit *fit) {
    for (int k = 0; k < 2 * MAP_ROWS; k++) memset(fit->rows[k].parts, 0, sizeof fit->rows[k].parts);
    for (int b = 0; b < fit->count; b++)
        for (int p = 0; p < PARTS; p++)
            for (int k = 0; k < MAP_PAIRS; k++) {
                const int row = map_row(k);
                fit->rows[row].parts[p] += fit->blocks[b].fine[p][k] / fit->count;
                fit->rows[MAP_ROWS + row].parts[p] += fit->blocks[b].coarse[p][k] / fit->count;
            }
}

static double row_value(const LookFit *fit, const double parts[PARTS], int c) {
    return parts[PART_REST] + fit->gains[c] * parts[PART_BASE + c] + fit->tints[c] * parts[PART_SHEEN];
}

/* Sets the gain of the base and the tint of the sheen in a channel to those of least squares within their ranges, one
 * after the other until they settle. Errors are weighted between absolute and relative ones. */
static void solve(LookFit *fit, int c) {
    enum { ROUNDS = 24 };
    double bb = 1e-30, bs = 0.0, ss = 1e-30, b = 0.0, s = 0.0;
    for (int k = 0; k < 2 * MAP_ROWS; k++) {
        const LookRow *row = &fit->rows[k];
        const double w = row->weight * row->weight / (row->weight * row->goal[c] + 0.01);
        const double base = row->parts[PART_BASE + c], sheen = row->parts[PART_SHEEN];
        const double left = row->goal[c] - row->parts[PART_REST];
        bb += w * base * base, bs += w * base * sheen, ss += w * sheen * sheen;
        b += w * base * left, s += w * sheen * left;
    }
    const double most = 1.0 / fmax(fit->color_most[c], 1e-3);
    for (int k = 0; k < ROUNDS; k++) {
        fit->gains[c] = fmin(fmax((b - bs * fit->tints[c]) / bb, 0.0), most);
        fit->tints[c] = fmin(fmax((s - bs * fit->gains[c]) / ss, 0.0), 1.0);
    }
}

/* Returns the error of the rows, and the ratio of the light of the sky that comes back to that of the cloth. */
static double rows_error(const LookFit *fit, double *sky) {
    double sum = 0.0, made = 0.0, goal = 0.0;
    for (int k = 0; k < 2 * MAP_ROWS; k++)
        for (int c = 0; c < 3; c++) {
            const LookRow *row = &fit->rows[k];
            const double value = row_value(fit, row->parts, c);
            sum += row->weight * fabs(value - row->goal[c]);
            if (map_group(k % MAP_ROWS) < MAP_LIGHTS) continue;
            made += value, goal += row->goal[c];
        }
    *sky = made / fmax(goal, 1e-12);
    return sum / (2.0 * MAP_GROUPS);
}

/* Returns the deviation of blocks from each other over their mean: of one value a block and pair, in `at`. */
static double contrast_of(const LookFit *fit, double (*at)(const LookFit *, const LookBlock *, int)) {
    double deviations = 0.0, means = 0.0;
    for (int k = 0; k < MAP_CONTRASTS; k++) {
        double sum = 0.0, square = 0.0;
        for (int b = 0; b < fit->count; b++) {
            const double value = at(fit, &fit->blocks[b], k);
            sum += value / fit->count, square += value * value / fit->count;
        }
        deviations += (sqrt)(fmax(square - sum * sum, 0.0)), means += sum;
    }
    return deviations / fmax(means, 1e-12);
}

static double block_near(const LookFit *fit, const LookBlock *b, int pair) {
    (void)fit;
    return b->near[pair];
}

static double block_made(const LookFit *fit, const LookBlock *b, int pair) {
    double parts[PARTS], sum = 0.0;
    for (int p = 0; p < PARTS; p++) parts[p] = b->fine[p][pair];
    for (int c = 0; c < 3; c++) sum += row_value(fit, parts, c) / 3.0;
    return sum;
}

/* Shades the texels with these numbers and sets what follows from them. Returns the error. */
static double look_error(LookFit *fit, const double *x, double *sky) {
    fit->x = x;
    parallel_for(0, fit->count, block_shade, fit);
    rows_fill(fit);
    for (int c = 0; c < 3; c++) solve(fit, c);
    fit->contrast = contrast_of(fit, block_made);
    return rows_error(fit, sky);
}

static double error_at(void *user, double *x, SearchCare care) {
    LookFit *fit = user;
    double sky;
    fit->count = care == SEARCH_FULL ? BLOCKS : ROUGH_BLOCKS;
    const double error = look_error(fit, x, &sky);
    const double goal = contrast_of(fit, block_near);
    const double off = fabs(log(fmax(fit->contrast, 1e-6) / fmax(goal, 1e-6)));
    /* a sheen whose strongest channel is below 1 would dim the base less than it was reckoned with */
    const double dim = 1.0 - fmax(fit->tints[0], fmax(fit->tints[1], fit->tints[2]));
    return error + contrast_price * fmax(off - log(contrast_free), 0.0) + 0.1 * x[AXIS_SHEEN] * dim +
           0.5 * fmax(fabs(sky - 1.0) - 0.02, 0.0);
}

/* Makes the table of E of the sheen that the profile has, where it reads one. */
static bool table_make(LookFit *fit) {
    float coords[2];
    Stack stack;
    for (int end = 0; end < 2; end++) {
        Surface s = fit->bare;
        s.sheen_color = rgb_grey(1.0f);
        s.sheen_roughness = (float)(end ? axes[AXIS_SHEEN_ROUGHNESS].high : axes[AXIS_SHEEN_ROUGHNESS].low);
        stack_make(&stack, &s, &fit->choices, (TableRef){.kind = TABLE_NONE});
        coords[end] = stack.albedo_coord;
    }
    if (!HAS_SHEEN(&stack)) return true;
    if (!albedo_is_own(stack.albedo)) {
        stack_albedo(&stack, dir(0.0f, 0.0f, 1.0f)); /* tables of engines are made where they are first read */
        return true;
    }
    fit->table = alloc_array(1, sizeof *fit->table);
    if (!fit->table) return false;
    albedo_table_fill(fit->table, &stack.sheen.lobe, fminf(coords[0], coords[1]), fmaxf(coords[0], coords[1]), 0);
    return true;
}

/* Sets the light of the cloth in all rows, and their weights, 1 over the light of the group. */
static void goals_set(LookFit *fit, const WeftReflection *cloth) {
    double light[MAP_GROUPS] = {0.0};
    for (int out = 0; out < MAP_OUTS; out++) {
        const Dir w = fit->pairs.o[out];
        const float o[3] = {w.x, w.y, w.z};
        for (int k = fit->pairs.first[out]; k < fit->pairs.first[out + 1]; k++) {
            const Dir v = fit->pairs.i[k];
            const float i[1][3] = {{v.x, v.y, v.z}};
            float f[1][3];
            weft_reflection_eval(cloth, WEFT_PART_ALL, o, 1, i, f);
            for (int c = 0; c < 3; c++) fit->rows[map_row(k)].goal[c] += (double)(f[0][c] * fmaxf(v.z, 0.0f));
        }
    }
    for (int k = 0; k < MAP_ROWS; k++)
        for (int c = 0; c < 3; c++) light[map_group(k)] += fit->rows[k].goal[c];
    for (int k = 0; k < MAP_ROWS; k++) {
        fit->rows[k].weight = 1.0 / fmax(light[map_group(k)], 1e-12);
        fit->rows[MAP_ROWS + k] = fit->rows[k];
    }
}

typedef struct NearPoints {
    LookFit *fit;
    const Surface *surface; /* of the material, whose base is the threads */
    const Choices *choices;
    TableRef e;
} NearPoints;

/* Sets what the threads of a block reflect under the lights. */
static void block_look(void *user, int block, int thread) {
    const NearPoints *self = user;
    const LookFit *fit = self->fit;
    LookBlock *b = &fit->blocks[block];
    int column, row;
    (void)thread;
    block_place(fit->grid, block, &column, &row);
    for (int n = 0; n < NEAR_POINTS; n++) {
        const int right = n % 4, down = n / 4;
        const float x = map_x(fit->grid, (float)column + (float)right + 0.5f),
                    y = map_y(fit->grid, (float)row + (float)down + 0.5f);
        const WeavePoint point =
            weave_point(&fit->grid->weave, x, y, map_spacing(fit->grid), 2.0f * (float)halton(n + 1, 3) - 1.0f);
        if (point.height <= WEAVE_NONE) continue;
        const WeaveBase threads = weave_near(&fit->grid->weave, point, 0.0f);
        SeenStack seen;
        stack_make(&seen.stack, self->surface, self->choices, self->e);
        stack_put_base(&seen.stack, &threads.lobe, threads.single, threads.multiple);
        for (int out = 0; out < MAP_NORMALS; out++) {
            stack_see(&seen.stack, &fit->pairs.o[out], &seen.view);
            for (int k = fit->pairs.first[out]; k < fit->pairs.first[out + 1]; k++) {
                const Dir i = fit->pairs.i[k];
                if (!(i.z > 0.0f)) continue;
                const Rgb f = stack_eval_of(&seen.stack, &seen.view, slots_all(), i).f_cos;
                b->near[k] += (double)rgb_mean(f) / NEAR_POINTS;
            }
        }
    }
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
static double copied_error(LookFit *fit, const double *x) {
    double sky;
    fit->count = BLOCKS;
    (void)look_error(fit, x, &sky);
    for (int c = 0; c < 3; c++) fit->gains[c] = fit->tints[c] = 1.0;
    return rows_error(fit, &sky);
}

/* Returns by how much the texels of the blocks are brighter in a channel than those of the whole maps, by chance. */
static double chance(const LookFit *fit, int c, float shade) {
    double blocks = 0.0, whole = 0.0;
    for (int k = 0; k < BLOCKS * FINE; k++) {
        const LookTexel *t = &fit->blocks[k / FINE].texels[k % FINE];
        blocks += (double)(t->cover * t->color[c] * powf(fmaxf(t->light, 0.0f), shade)) / (BLOCKS * FINE);
    }
    for (int k = 0; k < WHOLE; k++) {
        const MapTexel t = whole_texel(fit->grid, k);
        whole += (double)((fit->holed ? t.cover : 1.0f) * map_texel_color(&t, c, shade, fit->holed)) / WHOLE;
    }
    return blocks / fmax(whole, 1e-9);
}

/* Leaves the numbers that a profile does not read at what a file without them means. */
static void unread_fix(const LookFit *fit, SearchAxis axis[AXES]) {
    static const struct {
        int axis, input;
        double usual;
    } rows[] = {{AXIS_ANISOTROPY, INPUT_anisotropy, 0.9}, /* viewers without it do not have its map either */
                {AXIS_SPECULAR, INPUT_specular, 1.0},
                {AXIS_SHEEN, INPUT_sheen_color, 0.0},
                {AXIS_SHEEN_ROUGHNESS, INPUT_sheen_roughness, 0.6}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        if (!weft_material_reads(&fit->plain, rows[k].input))
            axis[rows[k].axis] = (SearchAxis){rows[k].usual, rows[k].usual};
}

static void look_search(LookFit *fit, WeftBaked *found) {
    double x[AXES], sky;
    Search search = {.axes = AXES, .error = error_at, .user = fit, .grid = 64, .descents = 3, .most = 120};
    memcpy(search.axis, axes, sizeof axes);
    unread_fix(fit, search.axis);
    copy_start(fit->cloth, x);
    found->copied = copied_error(fit, x);
    x[AXIS_NORMAL] = 0.4;
    x[AXIS_SHADE] = 1.0;
    search_run(&search, x, NULL);
    fit->count = BLOCKS;
    found->fitted = look_error(fit, x, &sky);
    found->sky = sky - 1.0;
    found->contrast = fit->contrast / fmax(contrast_of(fit, block_near), 1e-6);
    MapLook *look = &fit->look;
    *look = (MapLook){.roughness = (float)x[AXIS_ROUGHNESS],
                      .anisotropy = (float)x[AXIS_ANISOTROPY],
                      .normal = (float)x[AXIS_NORMAL],
                      .shade = (float)x[AXIS_SHADE],
                      .metallic = (float)x[AXIS_METALLIC],
                      .specular = (float)x[AXIS_SPECULAR],
                      .sheen_roughness = (float)x[AXIS_SHEEN_ROUGHNESS]};
    for (int c = 0; c < 3; c++) {
        look->color[c] = (float)(fit->gains[c] * chance(fit, c, look->shade));
        look->sheen[c] = (float)(fit->tints[c] * x[AXIS_SHEEN]);
    }
    /* occlusion takes back what the sky gives too much */
    look->occlusion = (float)fmin(fmax((1.0 - 1.0 / fmax(sky, 1e-3)) / fmax(1.0 - (double)fit->open, 1e-3), 0.0), 1.0);
}

WeftResult map_look_find(const MapGrid *grid, const WeftMaterial *material, const WeftCloth *cloth, int profile,
                         bool holed, MapLook *look, WeftBaked *found, WeftError *error) {
    LookFit *fit = alloc_array(1, sizeof *fit);
    LookBlock *blocks = alloc_array(BLOCKS, sizeof *blocks);
    WeftReflection *threads = NULL;
    if (!fit || !blocks) {
        free(fit);
        free(blocks);
        return fail(error, WEFT_MESSAGE_MEMORY, "maps", NULL);
    }
    WeftResult result = weft_reflection_create_woven(material, cloth, &threads, error);
    if (result == WEFT_OK) {
        Material bare = material_default();
        material_choose(&bare, CHOICE_profile, profile);
        bare.inputs[INPUT_ior].value[0] = 1.5f;
        *fit = (LookFit){.grid = grid, .cloth = cloth, .blocks = blocks, .bare = material_plain(&bare), .holed = holed};
        fit->choices = material_choices(&bare);
        fit->pairs = map_pairs();
        fit->plain = bare;
        for (int c = 0; c < 3; c++) fit->plain.inputs[INPUT_sheen_color].value[c] = 1.0f;
        if (!table_make(fit)) result = fail(error, WEFT_MESSAGE_MEMORY, "maps", NULL);
    }
    if (result == WEFT_OK) {
        const Surface surface = reflection_surface(threads);
        const Choices choices = material_choices(material);
        NearPoints near = {.fit = fit, .surface = &surface, .choices = &choices, .e = reflection_table(threads)};
        goals_set(fit, threads);
        texels_read(fit);
        parallel_for(0, BLOCKS, block_look, &near);
        look_search(fit, found);
        *look = fit->look;
    }
    weft_reflection_free(threads);
    free(fit->table);
    free(fit);
    free(blocks);
    return result;
}
