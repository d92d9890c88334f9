/* difference.h - two pictures of one size, and the maps of how they differ */
#ifndef WEFT_IMAGE_DIFFERENCE_H
#define WEFT_IMAGE_DIFFERENCE_H

#include <stdbool.h>

#include "weft/diff.h"

/* Returns (a - b)^2 / (b^2 + 1e-2), whose mean over pixels and channels is relMSE. */
static inline double relative_square(float a, float b) {
    const double reference = (double)b, off = (double)a - reference;
    return off * off / (reference * reference + 1e-2);
}

/* Both over black, as planes of linear r, g, b: finite, row after row. */
typedef struct Pair {
    int width, height;
    int threads;         /* at least 1 */
    float *linear[2][3]; /* of the image and the reference */
} Pair;

static inline size_t pair_pixels(const Pair *pair) { return (size_t)pair->width * (size_t)pair->height; }

/* One of count values that are neither negative nor NaN: that with `rank` values before it in ascending
 * order. False where memory is short. */
bool value_ranked(const float *values, size_t count, size_t rank, float *value);

/* The map of FLIP, of pairs in [0, 1]; bright: of any radiance, over exposures that *out then holds. map must
 * contain width * height zeros. False where memory is short. */
bool flip_map(const Pair *pair, float pixels_per_degree, bool bright, WeftDiff *out, float *map);

/* Computes the map of SSIM, for pairs in [0, 1]. */
bool ssim_map(const Pair *pair, float *map);

/* The pixels at each edge of the picture whose windows reach beyond it. */
enum { SSIM_RADIUS = 5 };

#endif
