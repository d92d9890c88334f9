#include "image/pair.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/thread.h"
#include "image/srgb.h"
#include "weft/progress.h"

/* Returns x, bounded so that no sum of channels overflows; 0 if it is not finite. */
static float finite(float x) { return isfinite(x) ? fminf(fmaxf(x, -1e37f), 1e37f) : 0.0f; }

/* Returns the linear values that the integers of an image stand for (alpha: unchanged), or NULL if memory
 * is short. */
static float *decoding(WeftPixelType type) {
    const int count = type == WEFT_PIXEL_U8 ? 1 << 8 : 1 << 16;
    float *values = alloc_array((size_t)count, sizeof *values);
    for (int k = 0; values && k < count; k++) values[k] = srgb_decode((float)k / (float)(count - 1));
    return values;
}

/* Returns channel c of a pixel as a linear value. */
static float channel(const WeftImage *image, const float *decoded, size_t pixel, int c) {
    const size_t at = pixel * (size_t)image->channels + (size_t)c;
    const bool alpha = image->channels % 2 == 0 && c == image->channels - 1;
    if (image->type == WEFT_PIXEL_F32) return finite(((const float *)image->pixels)[at]);
    if (image->type == WEFT_PIXEL_U8) {
        const uint8_t byte = ((const uint8_t *)image->pixels)[at];
        return alpha ? (float)byte / 255.0f : decoded[byte];
    }
    const uint16_t word = ((const uint16_t *)image->pixels)[at];
    return alpha ? (float)word / 65535.0f : decoded[word];
}

static bool over_black(const WeftImage *image, float *const linear[3]) {
    float *decoded = image->type == WEFT_PIXEL_F32 ? NULL : decoding(image->type);
    if (!decoded && image->type != WEFT_PIXEL_F32) return false;
    const bool grey = image->channels < 3;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++) {
        const float alpha = image->channels % 2 ? 1.0f : channel(image, decoded, i, image->channels - 1);
        for (int c = 0; c < 3; c++) linear[c][i] = finite(alpha * channel(image, decoded, i, grey ? 0 : c));
    }
    free(decoded);
    return true;
}

/* Displays a linear image by the tone curve. Tone curves take colours, so grey is first converted to one. */
static WeftResult show(const WeftImage *image, const WeftDiffDesc *desc, WeftImage *out, WeftError *error) {
    if (image->channels >= 3) return weft_image_tonemap(image, desc->tonemap, desc->exposure, out, error);
    WeftImage color;
    const int alpha = image->channels == 2;
    WeftResult result = weft_image_create(image->width, image->height, 3 + alpha, WEFT_PIXEL_F32, &color, error);
    if (result != WEFT_OK) return result;
    const float *from = image->pixels;
    float *to = color.pixels;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++, from += image->channels) {
        for (int c = 0; c < 3; c++) *to++ = from[0];
        if (alpha) *to++ = from[1];
    }
    result = weft_image_tonemap(&color, desc->tonemap, desc->exposure, out, error);
    weft_image_free(&color);
    return result;
}

void pair_free(Pair *pair) { free(pair->linear[0][0]); }

WeftResult pair_make(const WeftDiffDesc *desc, bool shown, Pair *pair, WeftError *error) {
    const WeftImage *const images[2] = {desc->image, desc->reference};
    *pair = (Pair){.width = desc->image->width,
                   .height = desc->image->height,
                   .threads = desc->threads ? desc->threads : thread_count()};
    if (pair->threads > WEFT_THREADS_MAX) pair->threads = WEFT_THREADS_MAX;
    float *planes = alloc_array(pair_pixels(pair), 6 * sizeof *planes);
    if (!planes) {
        fail(error, WEFT_MESSAGE_MEMORY, "images to compare", NULL);
        return WEFT_RESOURCES;
    }
    for (int k = 0; k < 6; k++) pair->linear[k / 3][k % 3] = planes + (size_t)k * pair_pixels(pair);
    WeftResult result = WEFT_OK;
    for (int k = 0; k < 2 && result == WEFT_OK; k++) {
        WeftImage display = {0};
        const WeftImage *image = images[k];
        if (shown && image->type == WEFT_PIXEL_F32) {
            result = show(image, desc, &display, error);
            image = &display;
        }
        if (result == WEFT_OK && !over_black(image, pair->linear[k]))
            result = fail(error, WEFT_MESSAGE_MEMORY, "images to compare", NULL);
        weft_image_free(&display);
    }
    if (result != WEFT_OK) pair_free(pair);
    return result;
}

/* Sorts by counting, since non-negative floats have the order of their bits: the upper 16 bits of the value are found
 * by counting all values, the lower 16 by counting those with these upper bits. */
bool value_ranked(const float *values, size_t count, size_t rank, float *value) {
    size_t *counts = alloc_array(1 << 16, sizeof *counts);
    uint32_t found = 0;
    if (!counts) return false;
    for (int shift = 16; shift >= 0; shift -= 16) {
        memset(counts, 0, (1 << 16) * sizeof *counts);
        for (size_t i = 0; i < count; i++) {
            uint32_t bits;
            memcpy(&bits, &values[i], 4);
            if (shift == 16 || bits >> 16 == found >> 16) counts[bits >> shift & 0xffff]++;
        }
        uint32_t half = 0;
        for (; half < 0xffff && rank >= counts[half]; half++) rank -= counts[half];
        found |= half << shift;
    }
    memcpy(value, &found, 4);
    free(counts);
    return true;
}
