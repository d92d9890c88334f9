#include "image/difference.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/memory.h"
#include "image/flip.h"
#include "image/ssim.h"

static void relmse_map(const Pair *pair, float *map) {
    float *const *a = pair->linear[0], *const *b = pair->linear[1];
    for (size_t i = 0; i < pair_pixels(pair); i++) {
        double sum = 0.0;
        for (int c = 0; c < 3; c++) sum += relative_square(a[c][i], b[c][i]);
        map[i] = (float)fmin(sum / 3.0, (double)FLT_MAX);
    }
}

static const char *const names[WEFT_METRIC_COUNT] = {"relmse", "flip", "ssim"};

const char *weft_metric_name(WeftMetric metric) { return (unsigned)metric < WEFT_METRIC_COUNT ? names[metric] : ""; }

static WeftResult check(const WeftDiffDesc *desc, WeftError *error) {
    const WeftImage *a = desc->image, *b = desc->reference;
    const float sight = desc->pixels_per_degree;
    if (!a || !b || !a->pixels || !b->pixels)
        return fail(error, WEFT_MESSAGE_DESC, "images to compare", "two are needed");
    if (a->width != b->width || a->height != b->height)
        return fail(error, WEFT_MESSAGE_DESC, "images to compare", "one is %d x %d pixels, the other %d x %d", a->width,
                    a->height, b->width, b->height);
    if ((unsigned)desc->metric >= WEFT_METRIC_COUNT || desc->threads < 0 || !isfinite(desc->exposure) ||
        (unsigned)desc->tonemap >= WEFT_TONEMAP_COUNT)
        return fail(error, WEFT_MESSAGE_DESC, "comparison", "metric %d, %d threads, curve %d, exposure %g",
                    (int)desc->metric, desc->threads, (int)desc->tonemap, (double)desc->exposure);
    if (!(sight >= 1.0f && sight <= 500.0f) && (sight < 0.0f || sight > 0.0f || isnan(sight)))
        return fail(error, WEFT_MESSAGE_DESC, "pixels per degree", "%g is not in 1 .. 500", (double)sight);
    return WEFT_OK;
}

/* Returns the difference that a value of a map stands for; 0 means equal. */
static float badness(WeftMetric metric, float value) {
    const float off = metric == WEFT_METRIC_SSIM ? 1.0f - value : value;
    return off > 0.0f ? off : 0.0f;
}

/* Returns the mean of a map; for ssim without the edge, unless the picture is all edge. */
static double map_mean(const Pair *pair, const float *map, WeftMetric metric) {
    const bool inner = metric == WEFT_METRIC_SSIM && pair->width > 2 * SSIM_RADIUS && pair->height > 2 * SSIM_RADIUS;
    const int edge = inner ? SSIM_RADIUS : 0;
    double sum = 0.0;
    for (int y = edge; y < pair->height - edge; y++)
        for (int x = edge; x < pair->width - edge; x++) sum += (double)map[(size_t)y * (size_t)pair->width + (size_t)x];
    return sum / ((double)(pair->width - 2 * edge) * (double)(pair->height - 2 * edge));
}

/* Fills the statistics of a map in out. Returns false if memory is short. */
static bool summarise(const Pair *pair, WeftMetric metric, const float *map, WeftDiff *out) {
    const size_t count = pair_pixels(pair);
    float *bad = alloc_array(count, sizeof *bad);
    size_t worst = 0;
    if (!bad) return false;
    for (size_t i = 0; i < count; i++) {
        bad[i] = badness(metric, map[i]);
        if (bad[i] > bad[worst]) worst = i;
    }
    const bool ranked = value_ranked(bad, count, (count - 1) - (count - 1) / 100, &out->high);
    free(bad);
    if (metric == WEFT_METRIC_SSIM) out->high = 1.0f - out->high;
    out->value = map_mean(pair, map, metric);
    out->worst = map[worst];
    out->worst_x = (int)(worst % (size_t)pair->width);
    out->worst_y = (int)(worst / (size_t)pair->width);
    return ranked;
}

static bool make_map(const WeftDiffDesc *desc, const Pair *pair, bool bright, WeftDiff *out, float *map) {
    const float sight = desc->pixels_per_degree > 0.0f ? desc->pixels_per_degree : 67.0f;
    switch (desc->metric) {
    case WEFT_METRIC_FLIP: return flip_map(pair, sight, bright, out, map);
    case WEFT_METRIC_SSIM: return ssim_map(pair, map);
    default: relmse_map(pair, map); return true;
    }
}

WeftResult weft_diff(const WeftDiffDesc *desc, WeftDiff *out, WeftImage *map, WeftError *error) {
    *out = (WeftDiff){0};
    if (map) *map = (WeftImage){0};
    WeftResult result = check(desc, error);
    if (result != WEFT_OK) return result;
    const bool linear = desc->image->type == WEFT_PIXEL_F32 && desc->reference->type == WEFT_PIXEL_F32;
    const bool shown =
        !linear || desc->metric == WEFT_METRIC_SSIM || (desc->metric == WEFT_METRIC_FLIP && desc->exposed);
    Pair pair;
    WeftImage own = {0};
    result = pair_make(desc, shown, &pair, error);
    if (result != WEFT_OK) return result;
    result = weft_image_create(pair.width, pair.height, 1, WEFT_PIXEL_F32, &own, error);
    if (result == WEFT_OK &&
        !(make_map(desc, &pair, !shown, out, own.pixels) && summarise(&pair, desc->metric, own.pixels, out)))
        result = fail(error, WEFT_MESSAGE_MEMORY, "images to compare", NULL);
    pair_free(&pair);
    if (result == WEFT_OK && map)
        *map = own;
    else
        weft_image_free(&own);
    return result;
}

double weft_diff_beyond(const WeftImage *map, WeftMetric metric, double limit) {
    const size_t count = (size_t)map->width * (size_t)map->height;
    const float *values = map->pixels;
    size_t beyond = 0;
    for (size_t i = 0; i < count; i++)
        beyond += metric == WEFT_METRIC_SSIM ? (double)values[i] < limit : (double)values[i] > limit;
    return (double)beyond / (double)count;
}
