#include "scene/texture.h"

#include <math.h>
#include <stdint.h>

#include "image/srgb.h"

SrgbTable srgb_table(void) {
    SrgbTable table;
    for (int k = 0; k < 256; k++) table.linear[k] = srgb_decode((float)k / 255.0f);
    return table;
}

/* A texel's four channels, in one register. */
typedef float Channels __attribute__((vector_size(16)));

/* The two texels around a coordinate and how far it is from the first. */
typedef struct TexelSpan {
    size_t first, second;
    float t;
} TexelSpan;

/* Returns the texels at u after wrapping, for `size` texels. Non-finite and absurd coordinates read as 0. */
static inline TexelSpan span(float u, int size, TextureWrap wrap, bool nearest) {
    if (!(fabsf(u) < 1e6f)) u = 0.0f;
    float period = wrap == WRAP_MIRROR ? 0.5f * u : u;
    if (wrap != WRAP_CLAMP) u = period - floorf(period); /* in [0, 1]; rounding can reach 1 */
    if (wrap == WRAP_MIRROR) u = 1.0f - fabsf(2.0f * u - 1.0f);
    float x = fminf(fmaxf(u, -1.0f), 2.0f) * (float)size - (nearest ? 0.0f : 0.5f),
          whole = floorf(x); /* texel centres */
    int last = size - 1, first = (int)whole, second = first + 1;
    if (wrap == WRAP_REPEAT) { /* one step over either end comes back in at the other */
        if (first < 0) first = last;
        if (first > last) first = 0;
        if (second > last) second = 0;
    }
    first = first < 0 ? 0 : first > last ? last : first;
    second = second < 0 ? 0 : second > last ? last : second;
    return (TexelSpan){(size_t)first, (size_t)(nearest ? first : second), nearest ? 0.0f : x - whole};
}

static inline Channels read_u8(const uint8_t *p, const SrgbTable *srgb, int channels) {
    const float scale = 1.0f / 255.0f;
    float alpha = channels & 1 ? 1.0f : (float)p[channels - 1] * scale;
    int g = channels < 3 ? 0 : 1, b = channels < 3 ? 0 : 2;
    if (srgb) return (Channels){srgb->linear[p[0]], srgb->linear[p[g]], srgb->linear[p[b]], alpha};
    return (Channels){(float)p[0] * scale, (float)p[g] * scale, (float)p[b] * scale, alpha};
}

static inline Channels read_u16(const uint16_t *p, const SrgbTable *srgb, int channels) {
    float c[4] = {0};
    for (int k = 0; k < channels; k++) c[k] = (float)p[k] * (1.0f / 65535.0f);
    float alpha = channels & 1 ? 1.0f : c[channels - 1];
    for (int k = 0; srgb && k < channels; k++) c[k] = srgb_decode(c[k]);
    int g = channels < 3 ? 0 : 1, b = channels < 3 ? 0 : 2;
    return (Channels){c[0], c[g], c[b], alpha};
}

static inline Channels read_f32(const float *p, int channels) {
    int g = channels < 3 ? 0 : 1, b = channels < 3 ? 0 : 2;
    return (Channels){p[0], p[g], p[b], channels & 1 ? 1.0f : p[channels - 1]};
}

static inline Channels read_texel(const WeftImage *image, const SrgbTable *srgb, size_t x, size_t y) {
    size_t channels = (size_t)image->channels, at = (y * (size_t)image->width + x) * channels;
    /* the channel counts of colour and of data, spelt out so that the compiler sees them */
    if (image->type == WEFT_PIXEL_F32) {
        const float *p = (const float *)image->pixels + at;
        return channels == 3 ? read_f32(p, 3) : read_f32(p, image->channels);
    }
    if (image->type == WEFT_PIXEL_U16)
        return read_u16((const uint16_t *)image->pixels + at, srgb, image->channels);
    const uint8_t *p = (const uint8_t *)image->pixels + at;
    return channels == 3   ? read_u8(p, srgb, 3)
           : channels == 4 ? read_u8(p, srgb, 4)
                           : read_u8(p, srgb, image->channels);
}

Texel texture_fetch(const Texture *texture, const WeftImage *images, const SrgbTable *srgb, float u,
                    float v) {
    const WeftImage *image = &images[texture->image];
    TexelSpan x = span(u, image->width, texture->wrap_u, texture->nearest);
    TexelSpan y = span(v, image->height, texture->wrap_v, texture->nearest);
    Channels c = read_texel(image, srgb, x.first, y.first);
    if (!texture->nearest) {
        Channels right = read_texel(image, srgb, x.second, y.first);
        Channels below = read_texel(image, srgb, x.first, y.second);
        Channels across = read_texel(image, srgb, x.second, y.second);
        c += (right - c) * x.t;
        below += (across - below) * x.t;
        c += (below - c) * y.t;
    }
    return (Texel){{c[0], c[1], c[2], c[3]}};
}
