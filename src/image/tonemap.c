#include <math.h>

#include "base/fail.h"
#include "image/srgb.h"
#include "weft/image.h"

typedef struct Color {
    float r, g, b;
} Color;

static float least(Color c) { return fminf(c.r, fminf(c.g, c.b)); }
static float most(Color c) { return fmaxf(c.r, fmaxf(c.g, c.b)); }

/* Khronos Group, "PBR Neutral Tone Mapper", specification, 2024. The offset takes off what a dielectric's 4 %
 * Fresnel reflection adds; below the start of compression colours come out as they are, less that. */
static Color pbr_neutral(Color c) {
    const float start = 0.8f - 0.04f, desaturation = 0.15f;
    float x = least(c), offset = x < 0.08f ? x - 6.25f * x * x : 0.04f;
    c = (Color){c.r - offset, c.g - offset, c.b - offset};
    float peak = most(c);
    if (peak < start) return c;
    float d = 1.0f - start, squeezed = 1.0f - d * d / (peak + d - start), scale = squeezed / peak;
    float keep = 1.0f / (desaturation * (peak - squeezed) + 1.0f), white = squeezed * (1.0f - keep);
    return (Color){c.r * scale * keep + white, c.g * scale * keep + white, c.b * scale * keep + white};
}

/* Krzysztof Narkowicz, "ACES Filmic Tone Mapping Curve", 2015: a fit, for each channel. */
static float aces(float x) { return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f); }

/* A radiance as a tone curve wants it: at least 0 (also from NaN) and so small that no curve overflows. */
static float bounded(float x) { return fminf(fmaxf(x, 0.0f), 1e9f); }

static Color mapped(Color c, WeftTonemap tonemap) {
    switch (tonemap) {
    case WEFT_TONEMAP_PBR_NEUTRAL: return pbr_neutral(c);
    case WEFT_TONEMAP_ACES: return (Color){aces(c.r), aces(c.g), aces(c.b)};
    case WEFT_TONEMAP_NONE: break;
    }
    return c;
}

/* What is added to a value at (x, y) before it is cut to an integer: over any small neighbourhood these
 * fractions spread evenly over 0 .. 1, so the mean brightness stays right. They are middles of 256 steps, so
 * that rounding errors do not move a value that is a whole number. The sequence is R2 of Martin Roberts, "The
 * Unreasonable Effectiveness of Quasirandom Sequences", 2018; the constants are 2^32 / g and 2^32 / g^2 with
 * g^3 = g + 1. One fraction serves all channels: grey stays grey. */
static float dither(unsigned x, unsigned y) {
    const unsigned step = (x * 0xc13fa9a9u + y * 0x91e10da5u) >> 24;
    return ((float)step + 0.5f) / 256.0f;
}

/* The byte of a display value; fraction is the dither. */
static unsigned char quantized(float linear, float fraction) {
    float display = srgb_encode(fminf(linear, 1.0f));
    return (unsigned char)fminf(display * 255.0f + fraction, 255.0f);
}

WeftResult weft_image_tonemap(const WeftImage *linear, WeftTonemap tonemap, float exposure, WeftImage *out,
                              WeftError *error) {
    *out = (WeftImage){0};
    if (linear->type != WEFT_PIXEL_F32 || linear->channels < 3)
        return fail(error, WEFT_MESSAGE_DESC, "tone mapping", "it takes float images of 3 or 4 channels");
    if ((unsigned)tonemap > WEFT_TONEMAP_NONE || !isfinite(exposure))
        return fail(error, WEFT_MESSAGE_DESC, "tone mapping", "curve %d, exposure %g", (int)tonemap,
                    (double)exposure);
    WeftResult result =
        weft_image_create(linear->width, linear->height, linear->channels, WEFT_PIXEL_U8, out, error);
    if (result != WEFT_OK) return result;

    const float gain = exp2f(exposure);
    const float *in = linear->pixels;
    unsigned char *to = out->pixels;
    for (unsigned y = 0; y < (unsigned)linear->height; y++)
        for (unsigned x = 0; x < (unsigned)linear->width; x++) {
            Color c = {bounded(in[0] * gain), bounded(in[1] * gain), bounded(in[2] * gain)};
            float fraction = dither(x, y);
            c = mapped(c, tonemap);
            to[0] = quantized(c.r, fraction);
            to[1] = quantized(c.g, fraction);
            to[2] = quantized(c.b, fraction);
            if (linear->channels == 4) to[3] = (unsigned char)(fminf(bounded(in[3]), 1.0f) * 255.0f + 0.5f);
            in += linear->channels;
            to += linear->channels;
        }
    return WEFT_OK;
}
