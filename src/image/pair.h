/* pair.h - two images of one size as planes of linear colour, for the metrics that compare them */
#pragma once

#include <stdbool.h>

#include "weft/diff.h"

/* Two images over black, as planes of linear r, g, b: finite, row after row. */
typedef struct Pair {
    int width, height;
    int threads;         /* at least 1 */
    float *linear[2][3]; /* of the image and the reference */
} Pair;

static inline size_t pair_pixels(const Pair *pair) { return (size_t)pair->width * (size_t)pair->height; }

/* Makes the pair of two images of one size. With `shown` linear images are tone-mapped first. Fails with
 * WEFT_MESSAGE_MEMORY or as weft_image_tonemap does. Release with pair_free. */
WeftResult pair_make(const WeftDiffDesc *desc, bool shown, Pair *pair, WeftError *error);
void pair_free(Pair *pair);

/* Finds the value with `rank` values before it in ascending order, among count values that are neither negative nor
 * NaN. Returns false if memory is short. */
bool value_ranked(const float *values, size_t count, size_t rank, float *value);
