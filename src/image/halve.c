#include "image/halve.h"

#include <stddef.h>

#include "image/srgb.h"

/* The source texels of a texel along one axis; a side of 2 n + 1 in n parts gives each part up to three texels. */
typedef struct Cover {
    int first, count;
    float part[3];
} Cover;

static Cover cover_at(int k, int side) {
    int n = halved(side);
    float s = 1.0f / (float)side;
    if (side == 1) return (Cover){0, 1, {1.0f}};
    if (side % 2 == 0) return (Cover){2 * k, 2, {0.5f, 0.5f}};
    return (Cover){2 * k, 3, {(float)(n - k) * s, (float)n * s, (float)(k + 1) * s}};
}

/* The values of the 256 codes, and the least value to which each is the nearest code. */
typedef struct Codes {
    float value[256], from[256];
    uint8_t near[4097]; /* the code of k / 4096 */
} Codes;

static void make_codes(Codes *codes, bool srgb) {
    for (int k = 0; k < 256; k++) {
        float at = (float)k / 255.0f, edge = ((float)k - 0.5f) / 255.0f;
        codes->value[k] = srgb ? srgb_decode(at) : at;
        codes->from[k] = k == 0 ? 0.0f : srgb ? srgb_decode(edge) : edge;
    }
    for (int k = 0, code = 0; k <= 4096; k++) {
        while (code < 255 && (float)k / 4096.0f >= codes->from[code + 1]) code++;
        codes->near[k] = (uint8_t)code;
    }
}

static inline uint8_t code_of(const Codes *codes, float x) {
    int code = codes->near[(int)(fminf(x, 1.0f) * 4096.0f)];
    while (code < 255 && x >= codes->from[code + 1]) code++;
    return (uint8_t)code;
}

/* Sets four sums over the texels that a texel covers. `from` contains codes or, if `color` is NULL, floats. */
static inline void mean(const void *from, const Codes *color, const Codes *alpha, size_t width, Cover x, Cover y,
                        float sum[4]) {
    for (int c = 0; c < 4; c++) sum[c] = 0.0f;
    for (int j = 0; j < y.count; j++)
        for (int k = 0; k < x.count; k++) {
            size_t at = 4 * ((size_t)(y.first + j) * width + (size_t)(x.first + k));
            float part = y.part[j] * x.part[k];
            for (size_t c = 0; c < 4; c++)
                sum[c] += part * (color ? (c < 3 ? color : alpha)->value[((const uint8_t *)from)[at + c]]
                                        : ((const float *)from)[at + c]);
        }
}

void halve_u8(const uint8_t *from, int width, int height, bool srgb, uint8_t *to) {
    Codes color, alpha;
    float sum[4];
    make_codes(&color, srgb);
    make_codes(&alpha, false);
    for (int y = 0; y < halved(height); y++)
        for (int x = 0; x < halved(width); x++) {
            mean(from, &color, &alpha, (size_t)width, cover_at(x, width), cover_at(y, height), sum);
            for (int c = 0; c < 4; c++) *to++ = code_of(c < 3 ? &color : &alpha, sum[c]);
        }
}

void halve_f32(const float *from, int width, int height, float *to) {
    for (int y = 0; y < halved(height); y++)
        for (int x = 0; x < halved(width); x++, to += 4)
            mean(from, NULL, NULL, (size_t)width, cover_at(x, width), cover_at(y, height), to);
}
