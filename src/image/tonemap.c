/* tonemap.c - tone mapping of linear images to display-referred bytes, with dither */
#define WEFT_LIBM /* pow of the C library, so that pictures do not depend on the dialect's own */
#include "shading/dialect/tone.h"

#include "base/fail.h"
#include "weft/image.h"

_Static_assert(TONE_PBR_NEUTRAL == WEFT_TONEMAP_PBR_NEUTRAL && TONE_ACES == WEFT_TONEMAP_ACES, "");

/* Returns the dither that is added to a value at (x, y) before truncation to an integer. Over any small neighbourhood
 * these fractions are uniform in 0 .. 1, so the mean brightness is kept. They are middles of 256 steps, so that
 * rounding errors do not change integral values. The sequence is R2 of Martin Roberts, "The Unreasonable Effectiveness
 * of Quasirandom Sequences", 2018; the constants are 2^32 / g and 2^32 / g^2 with g^3 = g + 1. All channels share the
 * fraction, so that grey stays grey. */
static float dither(unsigned x, unsigned y) {
    const unsigned step = (x * 0xc13fa9a9u + y * 0x91e10da5u) >> 24;
    return ((float)step + 0.5f) / 256.0f;
}

/* Returns the byte of a display value; fraction is the dither. */
static unsigned char quantized(float display, float fraction) {
    return (unsigned char)fminf(display * 255.0f + fraction, 255.0f);
}

/* Makes the display image over `behind`; if that is NULL, alpha is kept. */
static WeftResult map(const WeftImage *linear, WeftTonemap tonemap, float exposure, const float *behind, WeftImage *out,
                      WeftError *error) {
    *out = (WeftImage){0};
    if (linear->type != WEFT_PIXEL_F32 || linear->channels < 3)
        return fail(error, WEFT_MESSAGE_DESC, "tone mapping", "it takes float images of 3 or 4 channels");
    if ((unsigned)tonemap > WEFT_TONEMAP_NONE || !isfinite(exposure))
        return fail(error, WEFT_MESSAGE_DESC, "tone mapping", "curve %d, exposure %g", (int)tonemap, (double)exposure);
    WeftResult result = weft_image_create(linear->width, linear->height, linear->channels, WEFT_PIXEL_U8, out, error);
    if (result != WEFT_OK) return result;

    const float gain = exp2f(exposure);
    const float *in = linear->pixels;
    unsigned char *to = out->pixels;
    for (unsigned y = 0; y < (unsigned)linear->height; y++)
        for (unsigned x = 0; x < (unsigned)linear->width; x++) {
            Rgb light = tone_light(rgb(in[0], in[1], in[2]), gain, (int)tonemap);
            float alpha = linear->channels == 4 ? fminf(tone_bounded(in[3]), 1.0f) : 1.0f;
            if (behind) light = tone_over(light, alpha, rgb(behind[0], behind[1], behind[2]));
            Rgb c = tone_display(light);
            float fraction = dither(x, y);
            to[0] = quantized(c.r, fraction);
            to[1] = quantized(c.g, fraction);
            to[2] = quantized(c.b, fraction);
            if (linear->channels == 4) to[3] = (unsigned char)((behind ? 1.0f : alpha) * 255.0f + 0.5f);
            in += linear->channels;
            to += linear->channels;
        }
    return WEFT_OK;
}

WeftResult weft_image_tonemap(const WeftImage *linear, WeftTonemap tonemap, float exposure, WeftImage *out,
                              WeftError *error) {
    return map(linear, tonemap, exposure, NULL, out, error);
}

WeftResult weft_image_tonemap_over(const WeftImage *linear, WeftTonemap tonemap, float exposure, const float behind[3],
                                   WeftImage *out, WeftError *error) {
    float light[3];
    for (int k = 0; k < 3; k++) light[k] = fminf(tone_bounded(behind[k]), 1.0f);
    return map(linear, tonemap, exposure, light, out, error);
}
