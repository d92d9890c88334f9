/* halve.h - mipmaps of pictures of four channels */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/* Returns half of a side, rounded down, and at least 1. */
static inline int halved(int side) { return side > 1 ? side / 2 : 1; }

/* Sets each texel of `to`, halved(width) by halved(height), to the mean of the area that it covers in `from`, width by
 * height. With srgb the first three channels are averaged as linear light. Rows follow each other without gaps; `from`
 * and `to` must not overlap. */
void halve_u8(const uint8_t *from, int width, int height, bool srgb, uint8_t *to);
void halve_f32(const float *from, int width, int height, float *to);
