/* map_fit.c - the light of texels, and its distance from that of the cloth */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/pi.h"
#include "base/thread.h"
#include "measure/bsdf/halton.h"
#include "measure/bsdf/weave_sum.h"
#include "measure/cloth/map_fit.h"
#include "shading/material/choice.h"

const SearchAxis map_axes[AXES] = {{0.0, 1.0}, {0.3, 2.0}, {0.0, 1.1}, {0.05, 1.2},
                                   {0.5, 5.0}, {0.0, 1.0}, {0.0, 0.6}, {0.3, 1.0}};
/* Contrast that is off by more than it may costs this for each factor of e. */
static const double contrast_price = 0.25;

/* Returns the surface of a texel: its base has a colour in one channel, its sheen in another. */
static Surface texel_surface(const MapFit *fit, const LookTexel *t) {
    const double *x = fit->x;
    const float scale = (float)x[AXIS_NORMAL];
    Surface s = fit->bare;
    s.base_color = rgb(0.0f, fit->typical, 0.0f);
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

/* Returns the solid angle that a direction stands for, one of `count` that are spread by the cosine. */
static double sky_share(Dir i, int count) { return PI_DOUBLE / (count * (double)i.z); }

/* Adds what a texel reflects to the parts of a pair, `part` times. light: what reaches it. */
static void parts_add(const MapFit *fit, const LookTexel *t, double light, double part, Rgb f, int pair,
                      double parts[PARTS][MAP_PAIRS]) {
    parts[PART_REST][pair] += part * (double)(t->cover * f.b);
    parts[PART_SHEEN][pair] += part * (double)(t->cover * (f.r - f.b));
    for (int c = 0; c < 3; c++)
        parts[PART_BASE + c][pair] += part * light * (double)(t->cover * t->color[c] * (f.g - f.b) / fit->typical);
}

/* Adds f cos of a texel to the parts, `part` times. */
static void shade(const MapFit *fit, const LookTexel *t, double part, double parts[PARTS][MAP_PAIRS]) {
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
        const int first = fit->pairs.first[out];
        const bool sky = out >= MAP_NORMALS;
        stack_see(&seen.stack, &o, &seen.view);
        if (sky && fit->own_sky) {
            parts_add(fit, t, light, part, map_sky_light(&fit->sky, &seen, &framed), first, parts);
            continue;
        }
        for (int k = first; k < fit->pairs.first[out + 1]; k++) {
            const Dir i = frame_to(frame, fit->pairs.i[k]);
            if (!(i.z > 0.0f) || !(fit->pairs.i[k].z > 0.0f)) continue;
            const double share = sky ? part * sky_share(fit->pairs.i[k], MAP_SKY_INS) : part;
            parts_add(fit, t, light, share, stack_eval_of(&seen.stack, &seen.view, slots_all(), i).f_cos, k, parts);
        }
    }
}

static void block_shade(void *user, int block, int thread) {
    const MapFit *fit = user;
    LookBlock *b = &fit->blocks[block];
    (void)thread;
    memset(b->fine, 0, sizeof b->fine);
    memset(b->coarse, 0, sizeof b->coarse);
    const int fine = fit->level ? 1 : FINE;
    for (int k = 0; k < fine; k++) shade(fit, &b->texels[k], 1.0 / fine, b->fine);
    if (!fit->level) shade(fit, &b->texels[FINE], 1.0, b->coarse);
}

/* Returns how many rows are compared. */
static int rows_of(const MapFit *fit) { return fit->level ? MAP_ROWS : 2 * MAP_ROWS; }

/* Fills the rows with the sums of the pairs of all blocks. */
static void rows_fill(MapFit *fit) {
    for (int k = 0; k < 2 * MAP_ROWS; k++) memset(fit->rows[k].parts, 0, sizeof fit->rows[k].parts);
    for (int b = 0; b < fit->count; b++)
        for (int p = 0; p < PARTS; p++)
            for (int k = 0; k < MAP_PAIRS; k++) {
                const int row = map_row(k);
                fit->rows[row].parts[p] += fit->blocks[b].fine[p][k] / fit->count;
                fit->rows[MAP_ROWS + row].parts[p] += fit->blocks[b].coarse[p][k] / fit->count;
            }
}

static double row_value(const MapFit *fit, const double parts[PARTS], int c) {
    return parts[PART_REST] + fit->gains[c] * parts[PART_BASE + c] + fit->tints[c] * parts[PART_SHEEN];
}

static bool is_sky(int row) { return map_group(row % MAP_ROWS) == MAP_LIGHTS; }

/* Returns the part of a row's light that occlusion leaves. */
static double row_dim(const MapFit *fit, int row) { return is_sky(row) ? fit->dim : 1.0; }

/* Sets the gain of the base and the tint of the sheen in a channel to those of least squares within their ranges, one
 * after the other until they settle. Errors are weighted between absolute and relative ones. */
static void solve(MapFit *fit, int c) {
    enum { ROUNDS = 24 };
    double bb = 1e-30, bs = 0.0, ss = 1e-30, b = 0.0, s = 0.0;
    for (int k = 0; k < rows_of(fit); k++) {
        const LookRow *row = &fit->rows[k];
        const double w = row->weight * row->weight / (row->weight * row->goal[c] + 0.01), dim = row_dim(fit, k);
        const double base = dim * row->parts[PART_BASE + c], sheen = dim * row->parts[PART_SHEEN];
        const double left = row->goal[c] - dim * row->parts[PART_REST];
        bb += w * base * base, bs += w * base * sheen, ss += w * sheen * sheen;
        b += w * base * left, s += w * sheen * left;
    }
    const double most = 1.0 / fmax(fit->color_most[c], 1e-3);
    for (int k = 0; k < ROUNDS; k++) {
        fit->gains[c] = fmin(fmax((b - bs * fit->tints[c]) / bb, 0.0), most);
        if (!fit->level) fit->tints[c] = fmin(fmax((s - bs * fit->gains[c]) / ss, 0.0), 1.0);
    }
}

double map_fit_error_now(const MapFit *fit, double *sky) {
    double sum = 0.0, made = 0.0, goal = 0.0;
    for (int k = 0; k < rows_of(fit); k++)
        for (int c = 0; c < 3; c++) {
            const LookRow *row = &fit->rows[k];
            const double value = row_dim(fit, k) * row_value(fit, row->parts, c);
            sum += row->weight * fabs(value - row->goal[c]);
            if (!is_sky(k)) continue;
            made += value, goal += row->goal[c];
        }
    *sky = made / fmax(goal, 1e-12);
    return sum * MAP_ROWS / ((double)rows_of(fit) * MAP_GROUPS);
}

/* Returns the deviation of blocks from each other over their mean, for what has two values at each block and pair: that
 * of what both have in common. */
static double contrast_of(const MapFit *fit, double (*at)(const MapFit *, const LookBlock *, int half, int pair)) {
    double deviations = 0.0, means = 0.0;
    for (int k = 0; k < MAP_CONTRASTS; k++) {
        double first = 0.0, second = 0.0, product = 0.0;
        for (int b = 0; b < fit->count; b++) {
            const double x = at(fit, &fit->blocks[b], 0, k), y = at(fit, &fit->blocks[b], 1, k);
            first += x / fit->count, second += y / fit->count, product += x * y / fit->count;
        }
        deviations += (sqrt)(fmax(product - first * second, 0.0)), means += 0.5 * (first + second);
    }
    return deviations / fmax(means, 1e-12);
}

static double block_half(const MapFit *fit, const LookBlock *b, int half, int pair) {
    (void)fit;
    return b->near[half][pair];
}

static double block_near(const MapFit *fit, const LookBlock *b, int half, int pair) {
    (void)fit, (void)half;
    return 0.5 * (b->near[0][pair] + b->near[1][pair]);
}

double map_fit_contrast(const MapFit *fit, bool halves) { return contrast_of(fit, halves ? block_half : block_near); }

static double block_made(const MapFit *fit, const LookBlock *b, int half, int pair) {
    double parts[PARTS], sum = 0.0;
    (void)half;
    for (int p = 0; p < PARTS; p++) parts[p] = b->fine[p][pair];
    for (int c = 0; c < 3; c++) sum += row_value(fit, parts, c) / 3.0;
    return sum;
}

/* Sets gains and tints, and how much the occlusion map takes of a viewer's own sky, where that would be too bright. */
static void balance(MapFit *fit) {
    enum { ROUNDS = 3 };
    double sky;
    fit->dim = 1.0;
    for (int k = 0; k < (fit->own_sky ? ROUNDS : 1); k++) {
        for (int c = 0; c < 3; c++) solve(fit, c);
        if (!fit->own_sky) continue;
        (void)map_fit_error_now(fit, &sky);
        fit->dim = fmin(fit->dim / fmax(sky, 1e-3), 1.0);
    }
}

double map_fit_error(MapFit *fit, const double *x, double *sky) {
    fit->x = x;
    parallel_for(0, fit->count, block_shade, fit);
    rows_fill(fit);
    balance(fit);
    fit->contrast = contrast_of(fit, block_made);
    return map_fit_error_now(fit, sky);
}

void map_fit_center(MapFit *fit, int first, int per, const LookTexel *whole) {
    LookTexel mean = {.cover = 0.0f};
    const int count = fit->count * per;
    const float part = 1.0f / (float)count;
    for (int k = 0; k < count; k++) {
        const LookTexel *t = &fit->blocks[k / per].texels[first + k % per];
        for (int c = 0; c < 3; c++) mean.color[c] += part * t->color[c], mean.normal[c] += part * t->normal[c];
    }
    for (int k = 0; k < count; k++) {
        LookTexel *t = &fit->blocks[k / per].texels[first + k % per];
        for (int c = 0; c < 3; c++) t->color[c] *= whole->color[c] / fmaxf(mean.color[c], 1e-6f);
        for (int a = 0; a < 2; a++) t->normal[a] += whole->normal[a] - mean.normal[a];
    }
}

MapOcclusion map_fit_occlusion(const MapFit *fit, double sky) {
    const double left = fit->own_sky ? fit->dim : fmin(1.0 / fmax(sky, 1e-3), 1.0), open = (double)fit->open;
    if (left >= open) return (MapOcclusion){(float)((1.0 - left) / fmax(1.0 - open, 1e-3)), 1.0f};
    return (MapOcclusion){1.0f, (float)(fit->own_sky ? left / fmax(open, 1e-3) : 1.0)};
}

double map_fit_price(const MapFit *fit, double sky, double room) {
    const double off = fabs(log(fmax(fit->contrast, 1e-6) / fmax(fit->contrast_goal, 1e-6)));
    return contrast_price * fmax(off - log(room), 0.0) + 0.5 * fmax(fabs(sky - 1.0) - 0.02, 0.0);
}

/* Makes the table of E of the sheen that the profile has, where it reads one. */
static bool table_make(MapFit *fit) {
    float coords[2];
    Stack stack;
    for (int end = 0; end < 2; end++) {
        Surface s = fit->bare;
        s.sheen_color = rgb_grey(1.0f);
        s.sheen_roughness = (float)(end ? map_axes[AXIS_SHEEN_ROUGHNESS].high : map_axes[AXIS_SHEEN_ROUGHNESS].low);
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

/* Adds f of the cloth, `part` times, to the goal of a row. */
static void goal_add(LookRow *row, const WeftReflection *cloth, Dir w, Dir v, double part) {
    const float o[3] = {w.x, w.y, w.z}, i[1][3] = {{v.x, v.y, v.z}};
    float f[1][3];
    weft_reflection_eval(cloth, WEFT_PART_ALL, o, 1, i, f);
    for (int c = 0; c < 3; c++) row->goal[c] += part * (double)f[0][c];
}

/* Sets the light of the cloth in all rows, and their weights, 1 over the light of the group. A sky that the viewer has by
 * directions is compared direction by direction. */
static void goals_set(MapFit *fit, const WeftReflection *cloth) {
    enum { MANY = 1024 };
    const int ins = fit->own_sky ? MANY : MAP_SKY_INS;
    double light[MAP_GROUPS] = {0.0};
    for (int k = 0; k < MAP_CONTRASTS; k++) {
        const Dir v = fit->pairs.i[k];
        goal_add(&fit->rows[k], cloth, fit->pairs.o[k / MAP_LIGHTS], v, (double)fmaxf(v.z, 0.0f));
    }
    for (int k = 0; k < MAP_SKIES * ins; k++)
        goal_add(&fit->rows[MAP_CONTRASTS + k / ins], cloth, fit->pairs.o[MAP_NORMALS + k / ins],
                 map_sky_in(k % ins, ins, k / ins), PI_DOUBLE / ins);
    for (int k = 0; k < MAP_ROWS; k++)
        for (int c = 0; c < 3; c++) light[map_group(k)] += fit->rows[k].goal[c];
    for (int k = 0; k < MAP_ROWS; k++) {
        fit->rows[k].weight = 1.0 / fmax(light[map_group(k)], 1e-12);
        fit->rows[MAP_ROWS + k] = fit->rows[k];
    }
    fit->typical = (float)fmin(fmax(light[MAP_LIGHTS] / (3.0 * MAP_SKIES), 0.05), 1.0);
}

void map_fit_unread(const MapFit *fit, SearchAxis axis[AXES]) {
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

typedef struct NearPoints {
    MapFit *fit;
    const MapPlace *places;
    Surface surface; /* of the material, whose base is the threads */
    Choices choices;
    TableRef e;
    int side; /* points along a side of a place */
} NearPoints;

/* Adds what the threads at a point reflect under the lights, `part` times. */
static void point_look(const NearPoints *self, float column, float row, float facet, double part, double *near) {
    const MapFit *fit = self->fit;
    const Weave *weave = &fit->grid->weave;
    const WeavePoint point =
        weave_point(weave, map_x(fit->grid, column), map_y(fit->grid, row), map_spacing(fit->grid), facet);
    if (point.height <= WEAVE_NONE) return;
    const WeaveBase threads = weave_near(weave, point, 0.0f);
    SeenStack seen;
    stack_make(&seen.stack, &self->surface, &self->choices, self->e);
    stack_put_base(&seen.stack, &threads.lobe, threads.single, threads.multiple);
    for (int out = 0; out < MAP_NORMALS; out++) {
        stack_see(&seen.stack, &fit->pairs.o[out], &seen.view);
        for (int k = fit->pairs.first[out]; k < fit->pairs.first[out + 1]; k++) {
            const Dir i = fit->pairs.i[k];
            if (!(i.z > 0.0f)) continue;
            near[k] += part * (double)rgb_mean(stack_eval_of(&seen.stack, &seen.view, slots_all(), i).f_cos);
        }
    }
}

static void block_look(void *user, int block, int thread) {
    const NearPoints *self = user;
    const MapPlace *place = &self->places[block];
    const int side = self->side;
    (void)thread;
    for (int n = 0; n < side * side; n++) {
        const int right = n % side, down = n / side;
        const float x = ((float)right + 0.5f) / (float)side, y = ((float)down + 0.5f) / (float)side;
        point_look(self, place->column + x * place->width, place->row + y * place->height,
                   2.0f * (float)halton(n + 1, 3) - 1.0f, 2.0 / (side * side),
                   self->fit->blocks[block].near[(right + down) % 2]);
    }
}

void map_fit_near(MapFit *fit, const MapPlace *places, int side) {
    NearPoints near = {.fit = fit,
                       .places = places,
                       .surface = reflection_surface(fit->threads),
                       .choices = material_choices(fit->material),
                       .e = reflection_table(fit->threads),
                       .side = side};
    for (int b = 0; b < BLOCKS; b++) memset(fit->blocks[b].near, 0, sizeof fit->blocks[b].near);
    parallel_for(0, fit->count, block_look, &near);
}

/* Sets the surface of the maps without texels, as a viewer of that profile has it. */
static void viewer_set(MapFit *fit, int profile) {
    Material bare = material_default();
    material_choose(&bare, CHOICE_profile, profile);
    bare.inputs[INPUT_ior].value[0] = 1.5f;
    fit->bare = material_plain(&bare);
    fit->choices = material_choices(&bare);
    fit->plain = bare;
    for (int c = 0; c < 3; c++) fit->plain.inputs[INPUT_sheen_color].value[c] = 1.0f;
    Stack stack;
    stack_make(&stack, &fit->bare, &fit->choices, (TableRef){.kind = TABLE_NONE});
    fit->own_sky = map_sky_is_own(&stack);
}

WeftResult map_fit_create(const MapGrid *grid, const WeftMaterial *material, const WeftCloth *cloth, int profile,
                          bool holed, MapFit **out, WeftError *error) {
    MapFit *fit = *out = alloc_array(1, sizeof *fit);
    LookBlock *blocks = alloc_array(BLOCKS, sizeof *blocks);
    if (!fit || !blocks) {
        free(blocks);
        return fail(error, WEFT_MESSAGE_MEMORY, "maps", NULL);
    }
    *fit =
        (MapFit){.grid = grid, .cloth = cloth, .material = material, .blocks = blocks, .holed = holed, .count = BLOCKS};
    viewer_set(fit, profile);
    fit->pairs = map_pairs();
    WeftResult result = weft_reflection_create_woven(material, cloth, &fit->threads, error);
    if (result == WEFT_OK && fit->own_sky) result = map_sky_create(&fit->sky, error);
    if (result != WEFT_OK) return result;
    if (!table_make(fit)) return fail(error, WEFT_MESSAGE_MEMORY, "maps", NULL);
    goals_set(fit, fit->threads);
    return WEFT_OK;
}

void map_fit_free(MapFit *fit) {
    if (!fit) return;
    weft_reflection_free(fit->threads);
    map_sky_free(&fit->sky);
    free(fit->table);
    free(fit->blocks);
    free(fit);
}
