#include "scene/record/texture.h"

#include "image/pixel.h"
#include "image/srgb.h"
#include "shading/dialect/loop.h"
#include "shading/stack/surface_rows.h"

SrgbTable srgb_table(void) {
    SrgbTable table;
    for (int k = 0; k < 256; k++) table.linear[k] = srgb_decode((float)k / 255.0f);
    return table;
}

void textures_put_levels(Texture *textures, int count, int image, TextureLevels *levels) {
    TextureLevels *before = NULL;
    bool taken = false;
    for (int k = 0; k < count; k++) {
        if (textures[k].image != image) continue;
        if (textures[k].levels) before = textures[k].levels;
        textures[k].levels = levels;
        taken = true;
    }
    levels_free(before);
    if (!taken) levels_free(levels);
}

/* A texel's four channels, in one register. */
typedef float Channels __attribute__((vector_size(16)));

/* The two texels around a coordinate and how far it is from the first. */
typedef struct TexelSpan {
    int first, second;
    float t;
} TexelSpan;

/* Returns a texel index after a step over either end: the other end if the texture repeats, else the same end. */
FN int step_in(int texel, int last, TextureWrap wrap) {
    int low = wrap == WRAP_REPEAT ? last : 0, high = wrap == WRAP_REPEAT ? 0 : last;
    return texel < 0 ? low : texel > last ? high : texel;
}

/* Returns the texels at u after wrapping, for `size` texels; step is 1, or 0 for the nearest alone. Non-finite and
 * absurd coordinates read as 0. */
FN TexelSpan span_at(float u, int size, TextureWrap wrap, int step) {
    const uint32_t absurd = 0x49742400u; /* the bits of 1e6 */
    uint32_t bits;
    memcpy(&bits, &u, 4);
    u = (bits & 0x7fffffffu) < absurd ? u : 0.0f;
    float period = wrap == WRAP_MIRROR ? 0.5f * u : u;
    float wrapped = period - floor(period); /* in [0, 1]; rounding can reach 1 */
    wrapped = wrap == WRAP_MIRROR ? 1.0f - abs(2.0f * wrapped - 1.0f) : wrapped;
    u = wrap == WRAP_CLAMP ? clamp(u, -1.0f, 2.0f) : wrapped;
    float x = u * (float)size - 0.5f * (float)step, whole = floor(x); /* texel centres */
    int first = (int)whole, last = size - 1;
    return (TexelSpan){step_in(first, last, wrap), step_in(first + step, last, wrap), (x - whole) * (float)step};
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
    if (image->type == WEFT_PIXEL_U16) return read_u16((const uint16_t *)image->pixels + at, srgb, image->channels);
    const uint8_t *p = (const uint8_t *)image->pixels + at;
    return channels == 3   ? read_u8(p, srgb, 3)
           : channels == 4 ? read_u8(p, srgb, 4)
                           : read_u8(p, srgb, image->channels);
}

static inline Channels interpolate(const WeftImage *image, const SrgbTable *srgb, TexelSpan x, TexelSpan y) {
    size_t left = (size_t)x.first, right = (size_t)x.second, top = (size_t)y.first, bottom = (size_t)y.second;
    Channels c = read_texel(image, srgb, left, top);
    c += (read_texel(image, srgb, right, top) - c) * x.t;
    Channels below = read_texel(image, srgb, left, bottom);
    below += (read_texel(image, srgb, right, bottom) - below) * x.t;
    return c + (below - c) * y.t;
}

/* Looks up one place in an image of the texture. */
static Channels fetch_one(const Texture *texture, const WeftImage *image, const SrgbTable *srgb, float u, float v) {
    TexelSpan x = span_at(u, image->width, texture->wrap_u, !texture->nearest);
    TexelSpan y = span_at(v, image->height, texture->wrap_v, !texture->nearest);
    return interpolate(image, srgb, x, y);
}

Texel texture_fetch(const Texture *texture, const WeftImage *images, const SrgbTable *srgb, float u, float v) {
    Channels c = fetch_one(texture, &images[texture->image], srgb, u, v);
    return (Texel){{c[0], c[1], c[2], c[3]}};
}

void texture_fetch_levels(const Texture *texture, const WeftImage *images, const SrgbTable *srgb, int n, const float *u,
                          const float *v, const int *level, float *texels) {
    const TextureLevels *levels = texture_levels(texture);
    for (int k = 0; k < n; k++) {
        const WeftImage *image = level[k] > 0 ? &levels->images[level[k] - 1] : &images[texture->image];
        Channels c = fetch_one(texture, image, srgb, u[k], v[k]);
        for (int channel = 0; channel < 4; channel++) texels[channel * ROW_CAPACITY + k] = c[channel];
    }
}

typedef struct SpanRows {
    int first[ROW_CAPACITY], second[ROW_CAPACITY];
    float t[ROW_CAPACITY];
} SpanRows;

FN void spans(const float *u, int size, TextureWrap wrap, int step, int n, SpanRows *restrict rows) {
    EACH(k, (size_t)n) {
        TexelSpan s = span_at(u[k], size, wrap, step);
        rows->first[k] = s.first;
        rows->second[k] = s.second;
        rows->t[k] = s.t;
    }
}
LOOP(spans_repeat_n, (const float *u, int size, int step, int n, SpanRows *rows), (u, size, step, n, rows)) {
    spans(u, size, WRAP_REPEAT, step, n, rows);
}
LOOP(spans_mirror_n, (const float *u, int size, int step, int n, SpanRows *rows), (u, size, step, n, rows)) {
    spans(u, size, WRAP_MIRROR, step, n, rows);
}
LOOP(spans_clamp_n, (const float *u, int size, int step, int n, SpanRows *rows), (u, size, step, n, rows)) {
    spans(u, size, WRAP_CLAMP, step, n, rows);
}

static void take_spans(const float *u, int size, TextureWrap wrap, int step, int n, SpanRows *rows) {
    if (wrap == WRAP_REPEAT)
        spans_repeat_n(u, size, step, n, rows);
    else if (wrap == WRAP_MIRROR)
        spans_mirror_n(u, size, step, n, rows);
    else
        spans_clamp_n(u, size, step, n, rows);
}

static TexelSpan span_of(const SpanRows *rows, int k) {
    return (TexelSpan){rows->first[k], rows->second[k], rows->t[k]};
}

/* Asks for the cache lines of a texel and the one below it, which most lookups of a path tracer miss. */
static void prefetch(const WeftImage *image, size_t texel, int x, int y, int below) {
    const char *pixels = (const char *)image->pixels;
    size_t width = (size_t)image->width;
    __builtin_prefetch(pixels + ((size_t)y * width + (size_t)x) * texel);
    __builtin_prefetch(pixels + ((size_t)below * width + (size_t)x) * texel);
}

void texture_fetch_rows(const Texture *texture, const WeftImage *images, const SrgbTable *srgb, int n, const float *u,
                        const float *v, float *texels) {
    enum { AHEAD = 16 };
    const WeftImage *image = &images[texture->image];
    size_t texel = (size_t)image->channels * pixel_type_size(image->type);
    SpanRows x = {0}, y = {0};
    int step = texture->nearest ? 0 : 1;
    take_spans(u, image->width, texture->wrap_u, step, row_whole(n), &x);
    take_spans(v, image->height, texture->wrap_v, step, row_whole(n), &y);
    for (int k = -AHEAD; k < n; k++) {
        int next = k + AHEAD;
        if (next < n) prefetch(image, texel, x.first[next], y.first[next], y.second[next]);
        if (k < 0) continue;
        Channels t = interpolate(image, srgb, span_of(&x, k), span_of(&y, k));
        for (int channel = 0; channel < 4; channel++) texels[channel * ROW_CAPACITY + k] = t[channel];
    }
}
