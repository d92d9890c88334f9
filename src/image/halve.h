/* halve.h - smaller copies of pictures of four channels */
#ifndef WEFT_IMAGE_HALVE_H
#define WEFT_IMAGE_HALVE_H

#include <stdbool.h>
#include <stdint.h>

/* Half of a side, rounded down, and at least 1. */
static inline int halved(int side) { return side > 1 ? side / 2 : 1; }

/* Each texel of `to`, halved(width) by halved(height), becomes the mean of what it covers of `from`, width by
 * height, edges of odd sides counted by their parts. With srgb the first three channels are averaged as the
 * light that they stand for. Rows follow each other without gaps; the two must not overlap. */
void halve_u8(const uint8_t *from, int width, int height, bool srgb, uint8_t *to);
void halve_f32(const float *from, int width, int height, float *to);

#endif
