#include "raster/material/slopes.h"

#include <math.h>
#include <stddef.h>

#include "image/halve.h"
#include "scene/record/texture.h"

/* The longest slope, of a normal 83 degrees from the surface's: damaged maps have longer ones. */
static const float SLOPE_MOST = 8.0f;

void slopes_size(int *width, int *height) {
    do {
        *width = halved(*width);
        *height = halved(*height);
    } while (*width > SLOPES_SIDE || *height > SLOPES_SIDE);
}

static Texel texel_of(const WeftImage *map, int x, int y) {
    const Texture direct = {.wrap_u = WRAP_CLAMP, .wrap_v = WRAP_CLAMP, .nearest = true};
    const size_t channels = (size_t)map->channels;
    if (map->type != WEFT_PIXEL_U8 || channels < 3)
        return texture_fetch(&direct, map, NULL, ((float)x + 0.5f) / (float)map->width,
                             ((float)y + 0.5f) / (float)map->height);
    const unsigned char *p = map->pixels;
    p += channels * ((size_t)y * (size_t)map->width + (size_t)x);
    return (Texel){{(float)p[0] / 255.0f, (float)p[1] / 255.0f, (float)p[2] / 255.0f, 1.0f}};
}

static void add_texel(Texel t, float part, float to[4]) {
    float z = fmaxf(2.0f * t.c[2] - 1.0f, 1e-3f), x = (2.0f * t.c[0] - 1.0f) / z, y = (2.0f * t.c[1] - 1.0f) / z;
    float length = hypotf(x, y), scale = length > SLOPE_MOST ? SLOPE_MOST / length : 1.0f;
    x *= scale;
    y *= scale;
    float square = x * x + y * y;
    const float moments[4] = {x * x, x * y, y * y, square * square};
    for (int c = 0; c < 4; c++) to[c] += part * moments[c];
}

/* Returns the first texel of a map's side that part k of n covers. */
static int cover(int k, int side, int n) { return (int)((long long)k * side / n); }

/* Adds up the part of the map that one texel covers, at least one texel of it. */
static void put_moments(const WeftImage *map, int x, int y, int width, int height, float to[4]) {
    int left = cover(x, map->width, width), right = cover(x + 1, map->width, width);
    int top = cover(y, map->height, height), bottom = cover(y + 1, map->height, height);
    if (right <= left) right = left + 1;
    if (bottom <= top) bottom = top + 1;
    float part = 1.0f / ((float)(right - left) * (float)(bottom - top));
    for (int c = 0; c < 4; c++) to[c] = 0.0f;
    for (int v = top; v < bottom; v++)
        for (int u = left; u < right; u++) add_texel(texel_of(map, u, v), part, to);
}

void slopes_make(const WeftImage *map, int width, int height, float *levels) {
    float *to = levels;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, to += 4) put_moments(map, x, y, width, height, to);
    for (int w = width, h = height; w > 1 || h > 1; w = halved(w), h = halved(h)) {
        halve_f32(levels, w, h, to);
        levels = to;
        to += 4 * (size_t)halved(w) * (size_t)halved(h);
    }
}
