/* triangle_points.h - points by which the mean over a triangle is taken: the middles of steps x steps equal parts */
#pragma once

#include <math.h>

/* Sets the weights of the corners at point k of steps * steps. */
static inline void triangle_point(int k, int steps, float weight[3]) {
    const int row = (int)sqrtf((float)k), in_row = k - row * row, up = in_row % 2, pair = in_row / 2;
    const float n = 3.0f * (float)steps;
    const float b1 = (float)(3 * row + (up ? 1 : 2)) / n, b2 = (float)(3 * pair + (up ? 2 : 1)) / n;
    weight[0] = 1.0f - b1, weight[1] = b1 - b2, weight[2] = b2;
}
