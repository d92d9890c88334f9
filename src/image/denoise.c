/* Around each pixel p the picture is a linear function of the features f, fitted to the pixels q of a window:
 *
 *   beta = argmin sum_q w_pq (c_q - beta_0 - beta_1 . (f_q - f_p))^2,   and beta_0 is the denoised p
 *
 * The weights compare patches of colours u, at the pixels p + n and q + n, where v is the variance of u:
 *
 *   d_pq = mean_n ((u_p+n - u_q+n)^2 - (v_p+n + min(v_p+n, v_q+n))) / (eps + k^2 (v_p+n + v_q+n))
 *   w_pq = exp(-max(0, d_pq))
 *
 * The colours u are those of one half of the samples and c those of the other, so that weights do not depend on the
 * noise that they average. v is half the mean square of the halves' difference over a patch. exp(-x) is approximated by
 * (1 - x / 8)^8, which is 0 from 8 on. Squares and variances are summed over the channels. */
#include "image/denoise.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/thread.h"
#include "shading/dialect/loop.h"

enum {
    WINDOW = 5, /* radius of the window */
    PATCH = 3,  /* radius of a patch */
    MARGIN = WINDOW + PATCH,
    SIDE = 2 * WINDOW + 1,
    PATCH_SIDE = 2 * PATCH + 1,
    TILE_W = 64,
    TILE_H = 32,
    WIDE = TILE_W + 2 * PATCH,
    TERMS = 1 + DENOISE_FEATURES,
};

/* A value between 0.25 and 1, the two widths among which the paper chooses for each pixel. */
static const float k_squared = 0.6f;
static const float ridge = 1e-4f; /* keeps the slope of a feature that does not vary at 0 */

typedef float Line[TILE_W];

/* The memory of a thread, for a tile and for one row of it. */
typedef struct Scratch {
    float distance[TILE_H + 2 * PATCH][WIDE], column[WIDE];
    Line weight[SIDE * SIDE][TILE_H];
    Line step[TERMS], weighted[TERMS]; /* 1 and f_q - f_p; times w */
    Line moment[TERMS][TERMS], side[DENOISE_COLORS][TERMS];
} Scratch;

/* A part of the picture. */
typedef struct Area {
    int x, y, width, height;
} Area;

typedef struct Denoising {
    const DenoisePlanes *planes;
    Scratch *scratch; /* one a thread */
    int tiles_across;
} Denoising;

bool denoise_planes_create(DenoisePlanes *planes, int width, int height) {
    enum { COUNT = 3 * DENOISE_COLORS + DENOISE_FEATURES + 1 };
    *planes = (DenoisePlanes){.width = width, .height = height, .stride = (size_t)width + 2 * MARGIN};
    size_t size = planes->stride * ((size_t)height + 2 * MARGIN);
    planes->memory = alloc_array(size, COUNT * sizeof(float));
    if (!planes->memory) return false;
    float *next = planes->memory + MARGIN * planes->stride + MARGIN;
    for (int h = 0; h < 2; h++)
        for (int c = 0; c < DENOISE_COLORS; c++, next += size) planes->color[h][c] = next;
    for (int f = 0; f < DENOISE_FEATURES; f++, next += size) planes->feature[f] = next;
    for (int c = 0; c < DENOISE_COLORS; c++, next += size) planes->out[c] = next;
    planes->variance = next;
    return true;
}

void denoise_planes_free(DenoisePlanes *planes) {
    free(planes->memory);
    *planes = (DenoisePlanes){0};
}

static ptrdiff_t place_of(const DenoisePlanes *planes, int x, int y) {
    return (ptrdiff_t)y * (ptrdiff_t)planes->stride + x;
}

/* Repeats the picture's edge over the margin. */
static void extend(const DenoisePlanes *planes, float *plane) {
    for (int y = 0; y < planes->height; y++) {
        float *row = plane + place_of(planes, 0, y);
        for (int x = 1; x <= MARGIN; x++) {
            row[-x] = row[0];
            row[planes->width - 1 + x] = row[planes->width - 1];
        }
    }
    const float *first = plane - MARGIN, *last = plane + place_of(planes, -MARGIN, planes->height - 1);
    for (int y = 1; y <= MARGIN; y++) {
        memcpy(plane + place_of(planes, -MARGIN, -y), first, planes->stride * sizeof(float));
        memcpy(plane + place_of(planes, -MARGIN, planes->height - 1 + y), last, planes->stride * sizeof(float));
    }
}

/* Computes the variance of a half's pixels; a plane of `out` serves as scratch. */
static void find_variance(DenoisePlanes *planes) {
    float *square = planes->out[0];
    for (int y = 0; y < planes->height; y++)
        for (int x = 0; x < planes->width; x++) {
            ptrdiff_t p = place_of(planes, x, y);
            square[p] = 0.0f;
            for (int c = 0; c < 3; c++) {
                float off = planes->color[0][c][p] - planes->color[1][c][p];
                square[p] += 0.5f * off * off;
            }
        }
    extend(planes, square);
    for (int y = 0; y < planes->height; y++)
        for (int x = 0; x < planes->width; x++) {
            float sum = 0.0f;
            for (int j = -PATCH; j <= PATCH; j++)
                for (int i = -PATCH; i <= PATCH; i++) sum += square[place_of(planes, x + i, y + j)];
            planes->variance[place_of(planes, x, y)] = sum * (1.0f / (PATCH_SIDE * PATCH_SIDE));
        }
    extend(planes, planes->variance);
}

/* Computes the terms of which d is the mean, for n pixels from p on and those at the offset q from them. */
LOOP(distance_n, (int n, const float *const u[3], const float *restrict v, ptrdiff_t q, float *restrict to),
     (n, u, v, q, to)) {
    const float *restrict r = u[0], *restrict g = u[1], *restrict b = u[2];
    const float *r_q = r + q, *g_q = g + q, *b_q = b + q, *v_q = v + q;
    EACH(x, (size_t)n) {
        float dr = r[x] - r_q[x], dg = g[x] - g_q[x], db = b[x] - b_q[x];
        float above = dr * dr + dg * dg + db * db - (v[x] + min(v[x], v_q[x]));
        to[x] = above / (1e-8f + k_squared * (v[x] + v_q[x]));
    }
}

/* Computes the weights from means over patches, which are summed first down, then across. */
LOOP(weights_n, (int n, const float (*restrict distance)[WIDE], float *restrict column, float *restrict weight),
     (n, distance, column, weight)) {
    EACH(x, (size_t)n + 2 * PATCH) {
        float sum = 0.0f;
        for (int y = 0; y < PATCH_SIDE; y++) sum += distance[y][x];
        column[x] = sum;
    }
    EACH(x, (size_t)n) {
        float sum = 0.0f;
        for (size_t k = 0; k < PATCH_SIDE; k++) sum += column[x + k];
        float d = max(sum * (1.0f / (PATCH_SIDE * PATCH_SIDE)), 0.0f);
        float near = max(1.0f - 0.125f * d, 0.0f), square = near * near;
        square *= square;
        weight[x] = square * square;
    }
}

/* Computes the weights of the pixels of all windows of an area from the colours of a half. Pixels outside the picture
 * have weight 0. */
static void weigh(const DenoisePlanes *planes, int half, const Area *area, Scratch *s) {
    for (int offset = 0; offset < SIDE * SIDE; offset++) {
        int dx = offset % SIDE - WINDOW, dy = offset / SIDE - WINDOW;
        for (int y = 0; y < area->height + 2 * PATCH; y++) {
            ptrdiff_t p = place_of(planes, area->x - PATCH, area->y - PATCH + y);
            const float *const u[3] = {planes->color[half][0] + p, planes->color[half][1] + p,
                                       planes->color[half][2] + p};
            distance_n(area->width + 2 * PATCH, u, planes->variance + p, place_of(planes, dx, dy), s->distance[y]);
        }
        for (int y = 0; y < area->height; y++) {
            float *weight = s->weight[offset][y];
            weights_n(area->width, (const float(*)[WIDE])s->distance + y, s->column, weight);
            bool there = area->y + y + dy >= 0 && area->y + y + dy < planes->height;
            for (int x = 0; x < area->width; x++)
                if (!there || area->x + x + dx < 0 || area->x + x + dx >= planes->width) weight[x] = 0.0f;
        }
    }
}

/* Computes the differences f_q - f_p of a feature, as they are and weighted. */
LOOP(take_steps,
     (int n, const float *restrict of_p, ptrdiff_t q, const float *restrict weight, float *restrict step,
      float *restrict weighted),
     (n, of_p, q, weight, step, weighted)) {
    const float *of_q = of_p + q;
    EACH(x, (size_t)n) {
        step[x] = of_q[x] - of_p[x];
        weighted[x] = weight[x] * step[x];
    }
}

/* Adds one pixel of each window to the normal equations. */
LOOP(add_products, (int n, Scratch *s, const float *const color[DENOISE_COLORS]), (n, s, color)) {
    for (int i = 0; i < TERMS; i++) {
        const float *restrict a = s->weighted[i];
        for (int j = i; j < TERMS; j++) {
            const float *restrict b = s->step[j];
            float *restrict sum = s->moment[i][j];
            EACH(x, (size_t)n) sum[x] += a[x] * b[x];
        }
        for (int c = 0; c < DENOISE_COLORS; c++) {
            const float *restrict b = color[c];
            float *restrict sum = s->side[c][i];
            EACH(x, (size_t)n) sum[x] += a[x] * b[x];
        }
    }
}

/* Solves the equations by elimination from the last term on, so that beta_0 is found first and alone. */
LOOP(solve_n, (int n, Scratch *s), (n, s)) {
    Line(*moment)[TERMS] = s->moment, (*side)[TERMS] = s->side;
    for (int i = 1; i < TERMS; i++) EACH(x, (size_t)n) moment[i][i][x] += ridge * moment[0][0][x];
    for (int k = TERMS - 1; k > 0; k--)
        for (int i = 0; i < k; i++) EACH(x, (size_t)n) {
                float ratio = moment[i][k][x] / max(moment[k][k][x], 1e-20f);
                for (int j = i; j < k; j++) moment[i][j][x] -= ratio * moment[j][k][x];
                for (int c = 0; c < DENOISE_COLORS; c++) side[c][i][x] -= ratio * side[c][k][x];
            }
    for (int c = 0; c < DENOISE_COLORS; c++) EACH(x, (size_t)n) side[c][0][x] /= max(moment[0][0][x], 1e-20f);
}

/* Adds the half of the picture that the fits to a half of the samples give. */
static void fit(const DenoisePlanes *planes, int half, const Area *area, Scratch *s) {
    for (int x = 0; x < TILE_W; x++) s->step[0][x] = 1.0f;
    for (int y = 0; y < area->height; y++) {
        ptrdiff_t p = place_of(planes, area->x, area->y + y);
        memset(s->moment, 0, sizeof s->moment);
        memset(s->side, 0, sizeof s->side);
        for (int offset = 0; offset < SIDE * SIDE; offset++) {
            ptrdiff_t q = place_of(planes, offset % SIDE - WINDOW, offset / SIDE - WINDOW);
            const float *color[DENOISE_COLORS], *weight = s->weight[offset][y];
            memcpy(s->weighted[0], weight, sizeof s->weighted[0]);
            for (int f = 0; f < DENOISE_FEATURES; f++)
                take_steps(area->width, planes->feature[f] + p, q, weight, s->step[1 + f], s->weighted[1 + f]);
            for (int c = 0; c < DENOISE_COLORS; c++) color[c] = planes->color[half][c] + p + q;
            add_products(area->width, s, color);
        }
        solve_n(area->width, s);
        for (int c = 0; c < DENOISE_COLORS; c++)
            for (int x = 0; x < area->width; x++) planes->out[c][p + x] += 0.5f * s->side[c][0][x];
    }
}

static void denoise_tile(void *user, int item, int thread) {
    const Denoising *d = user;
    const DenoisePlanes *planes = d->planes;
    Area area = {item % d->tiles_across * TILE_W, item / d->tiles_across * TILE_H, TILE_W, TILE_H};
    if (area.width > planes->width - area.x) area.width = planes->width - area.x;
    if (area.height > planes->height - area.y) area.height = planes->height - area.y;
    for (int half = 0; half < 2; half++) {
        weigh(planes, 1 - half, &area, &d->scratch[thread]);
        fit(planes, half, &area, &d->scratch[thread]);
    }
}

bool denoise(DenoisePlanes *planes, int threads) {
    Denoising d = {.planes = planes, .tiles_across = (planes->width + TILE_W - 1) / TILE_W};
    d.scratch = alloc_array((size_t)threads, sizeof *d.scratch);
    if (!d.scratch) return false;
    find_variance(planes);
    for (int c = 0; c < DENOISE_COLORS; c++) {
        extend(planes, planes->color[0][c]);
        extend(planes, planes->color[1][c]);
        for (int y = 0; y < planes->height; y++)
            memset(planes->out[c] + place_of(planes, 0, y), 0, (size_t)planes->width * sizeof(float));
    }
    for (int f = 0; f < DENOISE_FEATURES; f++) extend(planes, planes->feature[f]);
    parallel_for(threads, d.tiles_across * ((planes->height + TILE_H - 1) / TILE_H), denoise_tile, &d);
    free(d.scratch);
    return true;
}
