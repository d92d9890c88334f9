#include "scene/texture.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "image/srgb.h"

SrgbTable srgb_table(void) {
    SrgbTable table;
    for (int k = 0; k < 256; k++) table.linear[k] = srgb_decode((float)k / 255.0f);
    return table;
}

/* Texel index after wrapping; x may be any int. */
static int wrapped(int x, int size, Wrap wrap) {
    switch (wrap) {
    case WRAP_CLAMP: return x < 0 ? 0 : x >= size ? size - 1 : x;
    case WRAP_MIRROR: {
        int period = 2 * size, k = x % period;
        if (k < 0) k += period;
        return k < size ? k : period - 1 - k;
    }
    case WRAP_REPEAT: break;
    }
    if ((unsigned)x < (unsigned)size) return x;
    int k = x % size;
    return k < 0 ? k + size : k;
}

/* One texel's channels as they are stored, scaled to [0, 1] where they are integers. */
static inline void load(const WeftImage *image, const SrgbTable *srgb, size_t at, int channels, float *c) {
    int colors = channels - !(channels & 1); /* without alpha */
    switch (image->type) {
    case WEFT_PIXEL_U8: {
        const uint8_t *p = (const uint8_t *)image->pixels + at;
        for (int k = 0; k < channels; k++)
            c[k] = srgb && k < colors ? srgb->linear[p[k]] : (float)p[k] * (1.0f / 255.0f);
        return;
    }
    case WEFT_PIXEL_U16: {
        const uint16_t *p = (const uint16_t *)image->pixels + at;
        for (int k = 0; k < channels; k++) {
            float value = (float)p[k] * (1.0f / 65535.0f);
            c[k] = srgb && k < colors ? srgb_decode(value) : value;
        }
        return;
    }
    case WEFT_PIXEL_F32: memcpy(c, (const float *)image->pixels + at, (size_t)channels * sizeof *c); return;
    }
}

/* The mean of four texels with weights, channels known to the compiler so that its loops unroll. */
static inline Texel blend(const WeftImage *image, const SrgbTable *srgb, const size_t at[4],
                          const float weight[4], int channels) {
    float sum[4] = {0}, c[4] = {0};
    for (int corner = 0; corner < 4; corner++) {
        load(image, srgb, at[corner] * (size_t)channels, channels, c);
        for (int k = 0; k < channels; k++) sum[k] += c[k] * weight[corner];
    }
    bool grey = channels < 3;
    return (Texel){{sum[0], sum[grey ? 0 : 1], sum[grey ? 0 : 2],
                    channels == 2   ? sum[1]
                    : channels == 4 ? sum[3]
                                    : 1.0f}};
}

/* Bounded, so that the conversion to int is defined whatever a file holds. */
static float coordinate(float u, int size) {
    return isfinite(u) ? fminf(fmaxf(u, -1e4f), 1e4f) * (float)size : 0.0f;
}

Texel texture_fetch(const Texture *texture, const WeftImage *images, const SrgbTable *srgb, float u,
                    float v) {
    const WeftImage *image = &images[texture->image];
    float x = coordinate(u, image->width), y = coordinate(v, image->height);
    if (!texture->nearest) x -= 0.5f, y -= 0.5f; /* texel centres */
    float fx = floorf(x), fy = floorf(y), s = texture->nearest ? 0.0f : x - fx,
          t = texture->nearest ? 0.0f : y - fy;
    size_t x0 = (size_t)wrapped((int)fx, image->width, texture->wrap_u);
    size_t x1 = (size_t)wrapped((int)fx + 1, image->width, texture->wrap_u);
    size_t y0 = (size_t)wrapped((int)fy, image->height, texture->wrap_v) * (size_t)image->width;
    size_t y1 = (size_t)wrapped((int)fy + 1, image->height, texture->wrap_v) * (size_t)image->width;
    const size_t at[4] = {y0 + x0, y0 + x1, y1 + x0, y1 + x1};
    const float weight[4] = {(1.0f - s) * (1.0f - t), s * (1.0f - t), (1.0f - s) * t, s * t};
    switch (image->channels) {
    case 1: return blend(image, srgb, at, weight, 1);
    case 2: return blend(image, srgb, at, weight, 2);
    case 3: return blend(image, srgb, at, weight, 3);
    default: return blend(image, srgb, at, weight, 4);
    }
}
