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
 * (1 - x / 8)^8, which is 0 from 8 on. Squares and variances are summed over the channels.
 *
 * Features with noise of their own, such as the albedo of threads that are a pixel wide, are averaged first, with such
 * weights from their own patches.
 *
 * Given the weights the fit F is linear in the picture Y, with the factor h of the pixel itself. So with the variance
 * s^2 of Y, Charles Stein's unbiased estimate ("Estimation of the Mean of a Multivariate Normal Distribution", Annals of
 * Statistics 9(6), 1981) of the error of F + t (Y - F) is least where
 *
 *   t = 1 - (1 - h) s^2 / E[(Y - F)^2]
 *
 * with means over the pixels around, and that is the picture which is returned. t is 0 where F and Y differ by noise
 * alone, and near 1 where F has lost what the features do not tell. */
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
    BLEND = 7, /* radius of the means for t */
};
_Static_assert((int)BLEND <= (int)MARGIN, "");

/* A value between 0.25 and 1, the two widths among which the paper chooses for each pixel. */
static const float k_squared = 0.6f;
static const float ridge = 1e-5f; /* keeps the slope of a feature that does not vary at 0 */

typedef float Line[TILE_W];

/* The memory of a thread, for a tile and for one row of it. */
typedef struct Scratch {
    float distance[TILE_H + 2 * PATCH][WIDE], column[WIDE];
    Line weight[SIDE * SIDE][TILE_H];
    Line step[TERMS], weighted[TERMS]; /* 1 and f_q - f_p; times w */
    Line moment[TERMS][TERMS], side[DENOISE_COLORS][TERMS];
} Scratch;

/* Pictures of three channels whose patches are compared, and the variance of them all. */
typedef struct Compared {
    const float *u[3];
    const float *variance;
} Compared;

/* A part of the picture. */
typedef struct Area {
    int x, y, width, height;
} Area;

typedef struct Denoising {
    const DenoisePlanes *planes;
    Scratch *scratch; /* one a thread */
    int tiles_across;
    int group; /* of noisy features, three each */
} Denoising;

bool denoise_planes_create(DenoisePlanes *planes, int width, int height) {
    enum { COUNT = 3 * DENOISE_COLORS + 2 * DENOISE_NOISY + DENOISE_FEATURES + 2 };
    *planes = (DenoisePlanes){.width = width, .height = height, .stride = (size_t)width + 2 * MARGIN};
    size_t size = planes->stride * ((size_t)height + 2 * MARGIN);
    planes->memory = alloc_array(size, COUNT * sizeof(float));
    if (!planes->memory) return false;
    float *next = planes->memory + MARGIN * planes->stride + MARGIN;
    for (int h = 0; h < 2; h++)
        for (int c = 0; c < DENOISE_COLORS; c++, next += size) planes->color[h][c] = next;
    for (int h = 0; h < 2; h++)
        for (int f = 0; f < DENOISE_NOISY; f++, next += size) planes->noisy[h][f] = next;
    for (int f = 0; f < DENOISE_FEATURES; f++, next += size) planes->feature[f] = next;
    for (int c = 0; c < DENOISE_COLORS; c++, next += size) planes->out[c] = next;
    planes->variance = next;
    planes->own = next + size;
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

/* Computes the variance of a half's pixels from two halves of three channels; a plane of `out` serves as scratch. */
static void find_variance(DenoisePlanes *planes, float *const a[3], float *const b[3]) {
    float *square = planes->out[0];
    for (int y = 0; y < planes->height; y++)
        for (int x = 0; x < planes->width; x++) {
            ptrdiff_t p = place_of(planes, x, y);
            square[p] = 0.0f;
            for (int c = 0; c < 3; c++) {
                float off = a[c][p] - b[c][p];
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

/* Computes the weights of the pixels of all windows of an area. Pixels outside the picture have weight 0. */
static void weigh(const DenoisePlanes *planes, Compared by, const Area *area, Scratch *s) {
    for (int offset = 0; offset < SIDE * SIDE; offset++) {
        int dx = offset % SIDE - WINDOW, dy = offset / SIDE - WINDOW;
        for (int y = 0; y < area->height + 2 * PATCH; y++) {
            ptrdiff_t p = place_of(planes, area->x - PATCH, area->y - PATCH + y);
            const float *const u[3] = {by.u[0] + p, by.u[1] + p, by.u[2] + p};
            distance_n(area->width + 2 * PATCH, u, by.variance + p, place_of(planes, dx, dy), s->distance[y]);
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
        const float *centre = s->weight[SIDE * SIDE / 2][y];
        for (int x = 0; x < area->width; x++)
            planes->own[p + x] += 0.5f * min(centre[x] / max(s->moment[0][0][x], 1e-20f), 1.0f);
    }
}

/* Adds the weighted means of three noisy features of a half. */
static void average(const DenoisePlanes *planes, int half, int group, const Area *area, Scratch *s) {
    for (int y = 0; y < area->height; y++) {
        ptrdiff_t p = place_of(planes, area->x, area->y + y);
        memset(s->side, 0, sizeof s->side);
        for (int offset = 0; offset < SIDE * SIDE; offset++) {
            ptrdiff_t q = place_of(planes, offset % SIDE - WINDOW, offset / SIDE - WINDOW);
            const float *weight = s->weight[offset][y];
            for (int x = 0; x < area->width; x++) s->side[3][0][x] += weight[x];
            for (int c = 0; c < 3; c++) {
                const float *of_q = planes->noisy[half][3 * group + c] + p + q;
                for (int x = 0; x < area->width; x++) s->side[c][0][x] += weight[x] * of_q[x];
            }
        }
        for (int c = 0; c < 3; c++)
            for (int x = 0; x < area->width; x++)
                planes->feature[3 * group + c][p + x] += 0.5f * s->side[c][0][x] / s->side[3][0][x];
    }
}

static Area area_of(const Denoising *d, int item) {
    const DenoisePlanes *planes = d->planes;
    Area area = {item % d->tiles_across * TILE_W, item / d->tiles_across * TILE_H, TILE_W, TILE_H};
    if (area.width > planes->width - area.x) area.width = planes->width - area.x;
    if (area.height > planes->height - area.y) area.height = planes->height - area.y;
    return area;
}

static Compared compared(float *const u[3], const float *variance) { return (Compared){{u[0], u[1], u[2]}, variance}; }

static void denoise_tile(void *user, int item, int thread) {
    const Denoising *d = user;
    const Area area = area_of(d, item);
    for (int half = 0; half < 2; half++) {
        weigh(d->planes, compared(d->planes->color[1 - half], d->planes->variance), &area, &d->scratch[thread]);
        fit(d->planes, half, &area, &d->scratch[thread]);
    }
}

static void average_tile(void *user, int item, int thread) {
    const Denoising *d = user;
    const Area area = area_of(d, item);
    for (int half = 0; half < 2; half++) {
        float *const *other = d->planes->noisy[1 - half] + 3 * d->group;
        weigh(d->planes, compared(other, d->planes->variance), &area, &d->scratch[thread]);
        average(d->planes, half, d->group, &area, &d->scratch[thread]);
    }
}

/* Sets a plane to 0, without its margin. */
static void clear(const DenoisePlanes *planes, float *plane) {
    for (int y = 0; y < planes->height; y++)
        memset(plane + place_of(planes, 0, y), 0, (size_t)planes->width * sizeof(float));
}

/* Fills a plane with the sums over the squares of pixels about each pixel; to and plane are different. */
static void sum_around(const DenoisePlanes *planes, float *plane, float *across, float *to) {
    extend(planes, plane);
    for (int y = -BLEND; y < planes->height + BLEND; y++)
        for (int x = 0; x < planes->width; x++) {
            float sum = 0.0f;
            for (int i = -BLEND; i <= BLEND; i++) sum += plane[place_of(planes, x + i, y)];
            across[place_of(planes, x, y)] = sum;
        }
    for (int y = 0; y < planes->height; y++)
        for (int x = 0; x < planes->width; x++) {
            float sum = 0.0f;
            for (int j = -BLEND; j <= BLEND; j++) sum += across[place_of(planes, x, y + j)];
            to[place_of(planes, x, y)] = sum;
        }
}

/* Returns the mean of both halves of a channel. */
static float sampled(const DenoisePlanes *planes, int c, ptrdiff_t p) {
    return 0.5f * (planes->color[0][c][p] + planes->color[1][c][p]);
}

/* Keeps of the picture what the fit has lost. Squares are relative to the brightness, as in relMSE. The planes of the
 * features serve as scratch. */
static void blend(DenoisePlanes *planes) {
    float *noise = planes->feature[0], *off = planes->feature[1], *across = planes->feature[2];
    float *noise_around = planes->feature[3], *off_around = planes->feature[4];
    for (int y = 0; y < planes->height; y++)
        for (int x = 0; x < planes->width; x++) {
            ptrdiff_t p = place_of(planes, x, y);
            float square = 3e-2f, variance = 0.0f, difference = 0.0f;
            for (int c = 0; c < 3; c++) {
                float halves = planes->color[0][c][p] - planes->color[1][c][p];
                float lost = sampled(planes, c, p) - planes->out[c][p];
                square += planes->out[c][p] * planes->out[c][p];
                variance += 0.25f * halves * halves;
                difference += lost * lost;
            }
            noise[p] = (1.0f - planes->own[p]) * variance / square;
            off[p] = difference / square;
        }
    sum_around(planes, noise, across, noise_around);
    sum_around(planes, off, across, off_around);
    for (int y = 0; y < planes->height; y++)
        for (int x = 0; x < planes->width; x++) {
            ptrdiff_t p = place_of(planes, x, y);
            float t = clamp(1.0f - noise_around[p] / max(off_around[p], 1e-20f), 0.0f, 1.0f);
            for (int c = 0; c < DENOISE_COLORS; c++)
                planes->out[c][p] += t * (sampled(planes, c, p) - planes->out[c][p]);
        }
}

/* Averages the features that have noise of their own. */
static void smooth_features(Denoising *d, DenoisePlanes *planes, int threads, int tiles) {
    for (d->group = 0; d->group < DENOISE_NOISY / 3; d->group++) {
        float *const *a = planes->noisy[0] + 3 * d->group, *const *b = planes->noisy[1] + 3 * d->group;
        find_variance(planes, a, b);
        for (int c = 0; c < 3; c++) {
            extend(planes, a[c]);
            extend(planes, b[c]);
            clear(planes, planes->feature[3 * d->group + c]);
        }
        parallel_for(threads, tiles, average_tile, d);
    }
    for (int f = 0; f < DENOISE_FEATURES; f++) extend(planes, planes->feature[f]);
}

bool denoise(DenoisePlanes *planes, int threads) {
    Denoising d = {.planes = planes, .tiles_across = (planes->width + TILE_W - 1) / TILE_W};
    const int tiles = d.tiles_across * ((planes->height + TILE_H - 1) / TILE_H);
    d.scratch = alloc_array((size_t)threads, sizeof *d.scratch);
    if (!d.scratch) return false;
    smooth_features(&d, planes, threads, tiles);
    find_variance(planes, planes->color[0], planes->color[1]);
    clear(planes, planes->own);
    for (int c = 0; c < DENOISE_COLORS; c++) {
        extend(planes, planes->color[0][c]);
        extend(planes, planes->color[1][c]);
        clear(planes, planes->out[c]);
    }
    parallel_for(threads, tiles, denoise_tile, &d);
    blend(planes);
    free(d.scratch);
    return true;
}
