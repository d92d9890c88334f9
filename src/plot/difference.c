/* difference.c - the difference of two images, and its colours */
#include <math.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/memory.h"
#include "image/difference.h"
#include "plot/scale.h"
#include "weft/sheet.h"

void scale_color(float t, float rgb[3]) {
    static const float brighter[4][3] = {
        {0.07f, 0.07f, 0.08f}, {0.62f, 0.10f, 0.10f}, {0.96f, 0.52f, 0.12f}, {1.0f, 0.95f, 0.62f}};
    static const float darker[4][3] = {
        {0.07f, 0.07f, 0.08f}, {0.12f, 0.22f, 0.66f}, {0.16f, 0.60f, 0.90f}, {0.75f, 0.97f, 1.0f}};
    const float(*stops)[3] = t < 0.0f ? darker : brighter;
    float at = 3.0f * fminf(fabsf(t), 1.0f);
    int k = at >= 2.0f ? 2 : (int)at;
    for (int c = 0; c < 3; c++) rgb[c] = stops[k][c] + (stops[k + 1][c] - stops[k][c]) * (at - (float)k);
}

static WeftResult check(const WeftImage *a, const WeftImage *b, WeftError *error) {
    if (a->type == WEFT_PIXEL_F32 && b->type == WEFT_PIXEL_F32 && a->pixels && b->pixels && a->width == b->width &&
        a->height == b->height && a->channels == b->channels && a->channels >= 3)
        return WEFT_OK;
    return fail(error, WEFT_MESSAGE_DESC, "images to compare", "both F32, of 3 or 4 channels and one size");
}

static size_t pixel_count(const WeftImage *image) { return (size_t)image->width * (size_t)image->height; }

/* Returns a channel of a pixel times its alpha. */
static float shown(const WeftImage *image, size_t pixel, int c) {
    const float *p = (const float *)image->pixels + pixel * (size_t)image->channels;
    return image->channels == 4 ? p[c] * p[3] : p[c];
}

/* Returns the difference of the channel that differs most, with its sign. */
static float pixel_difference(const WeftImage *a, const WeftImage *b, size_t pixel) {
    float most = 0.0f;
    for (int c = 0; c < 3; c++) {
        float d = shown(a, pixel, c) - shown(b, pixel, c);
        if (fabsf(d) > fabsf(most)) most = d;
    }
    return most;
}

static int compare_floats(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

WeftResult weft_difference(const WeftImage *image, const WeftImage *reference, WeftDifference *out, WeftError *error) {
    *out = (WeftDifference){0};
    WeftResult result = check(image, reference, error);
    if (result != WEFT_OK) return result;
    size_t count = pixel_count(image);
    float *sizes = alloc_array(count, sizeof *sizes);
    if (!sizes) return fail(error, WEFT_MESSAGE_MEMORY, "images to compare", NULL);
    double sum = 0.0, squares = 0.0;
    for (size_t k = 0; k < count; k++) {
        sizes[k] = fabsf(pixel_difference(image, reference, k));
        for (int c = 0; c < 3; c++) {
            float a = shown(image, k, c), b = shown(reference, k, c);
            sum += fabs((double)a - (double)b);
            squares += relative_square(a, b);
        }
    }
    qsort(sizes, count, sizeof *sizes, compare_floats);
    *out = (WeftDifference){.mean = sum / (3.0 * (double)count),
                            .relmse = squares / (3.0 * (double)count),
                            .high = sizes[(count - 1) - (count - 1) / 100]};
    free(sizes);
    return WEFT_OK;
}

WeftResult weft_difference_image(const WeftImage *image, const WeftImage *reference, float scale, WeftImage *out,
                                 WeftError *error) {
    *out = (WeftImage){0};
    WeftResult result = check(image, reference, error);
    if (result == WEFT_OK && !(scale > 0.0f && isfinite(scale)))
        result = fail(error, WEFT_MESSAGE_DESC, "scale of a difference", "%g", (double)scale);
    if (result == WEFT_OK) result = weft_image_create(image->width, image->height, 3, WEFT_PIXEL_U8, out, error);
    if (result != WEFT_OK) return result;
    uint8_t *pixel = out->pixels;
    for (size_t k = 0; k < pixel_count(image); k++) {
        float rgb[3];
        scale_color(pixel_difference(image, reference, k) / scale, rgb);
        for (int c = 0; c < 3; c++) *pixel++ = (uint8_t)(rgb[c] * 255.0f + 0.5f);
    }
    return WEFT_OK;
}

WeftResult weft_heat_image(const WeftImage *map, float none, float most, WeftImage *out, WeftError *error) {
    *out = (WeftImage){0};
    if (map->type != WEFT_PIXEL_F32 || map->channels != 1 || !map->pixels)
        return fail(error, WEFT_MESSAGE_DESC, "map", "F32 of one channel");
    if (!isfinite(none) || !isfinite(most) || !(fabsf(most - none) > 0.0f))
        return fail(error, WEFT_MESSAGE_DESC, "scale of a map", "%g to %g", (double)none, (double)most);
    WeftResult result = weft_image_create(map->width, map->height, 3, WEFT_PIXEL_U8, out, error);
    if (result != WEFT_OK) return result;
    const float *value = map->pixels;
    uint8_t *pixel = out->pixels;
    for (size_t k = 0; k < pixel_count(map); k++) {
        float rgb[3];
        scale_color(fmaxf((value[k] - none) / (most - none), 0.0f), rgb);
        for (int c = 0; c < 3; c++) *pixel++ = (uint8_t)(rgb[c] * 255.0f + 0.5f);
    }
    return WEFT_OK;
}
