#include "scene/texture.h"

#include <math.h>
#include <stdint.h>

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

static Texel texel_u8(const WeftImage *image, const SrgbTable *srgb, size_t at) {
    const uint8_t *p = (const uint8_t *)image->pixels + at;
    int channels = image->channels, g = channels >= 3 ? 1 : 0, b = channels >= 3 ? 2 : 0;
    float alpha = channels == 2 || channels == 4 ? (float)p[channels - 1] * (1.0f / 255.0f) : 1.0f;
    if (srgb) return (Texel){{srgb->linear[p[0]], srgb->linear[p[g]], srgb->linear[p[b]], alpha}};
    const float s = 1.0f / 255.0f;
    return (Texel){{(float)p[0] * s, (float)p[g] * s, (float)p[b] * s, alpha}};
}

static Texel texel(const WeftImage *image, const SrgbTable *srgb, int x, int y) {
    int channels = image->channels;
    size_t at = ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)channels;
    if (image->type == WEFT_PIXEL_U8) return texel_u8(image, srgb, at);
    Texel t = {{0.0f, 0.0f, 0.0f, 1.0f}};
    for (int k = 0; k < channels; k++) {
        bool alpha = k == channels - 1 && channels % 2 == 0;
        float value = image->type == WEFT_PIXEL_F32
                          ? ((const float *)image->pixels)[at + (size_t)k]
                          : (float)((const uint16_t *)image->pixels)[at + (size_t)k] / 65535.0f;
        if (srgb && !alpha && image->type == WEFT_PIXEL_U16) value = srgb_decode(value);
        t.c[alpha ? 3 : k] = value;
    }
    if (channels < 3) t.c[1] = t.c[2] = t.c[0];
    return t;
}

/* Bounded, so that the conversion to int is defined whatever a file holds. */
static float coordinate(float u, int size) {
    return isfinite(u) ? fminf(fmaxf(u, -1e4f), 1e4f) * (float)size : 0.0f;
}

Texel texture_fetch(const Texture *texture, const WeftImage *images, const SrgbTable *srgb, float u,
                    float v) {
    const WeftImage *image = &images[texture->image];
    float x = coordinate(u, image->width), y = coordinate(v, image->height);
    if (texture->nearest)
        return texel(image, srgb, wrapped((int)floorf(x), image->width, texture->wrap_u),
                     wrapped((int)floorf(y), image->height, texture->wrap_v));
    x -= 0.5f, y -= 0.5f; /* texel centres */
    float fx = floorf(x), fy = floorf(y), s = x - fx, t = y - fy;
    int x0 = wrapped((int)fx, image->width, texture->wrap_u),
        x1 = wrapped((int)fx + 1, image->width, texture->wrap_u);
    int y0 = wrapped((int)fy, image->height, texture->wrap_v);
    int y1 = wrapped((int)fy + 1, image->height, texture->wrap_v);
    Texel a = texel(image, srgb, x0, y0), b = texel(image, srgb, x1, y0);
    Texel c = texel(image, srgb, x0, y1), d = texel(image, srgb, x1, y1), sum;
    for (int k = 0; k < 4; k++)
        sum.c[k] = (a.c[k] * (1.0f - s) + b.c[k] * s) * (1.0f - t) + (c.c[k] * (1.0f - s) + d.c[k] * s) * t;
    return sum;
}
