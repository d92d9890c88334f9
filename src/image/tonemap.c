/* tonemap.c - tone mapping of linear images to display-referred bytes, with dither */
#define WEFT_LIBM /* pow of the C library, so that pictures do not depend on the dialect's own */
#include "shading/dialect/tone.h"

#include "base/fail.h"
#include "image/tone_check.h"
#include "weft/image.h"

_Static_assert((int)TONE_PBR_NEUTRAL == (int)WEFT_TONEMAP_PBR_NEUTRAL && (int)TONE_ACES == (int)WEFT_TONEMAP_ACES &&
                   (int)TONE_AGX == (int)WEFT_TONEMAP_AGX,
               "");

const char *weft_tonemap_name(int tonemap) {
    static const char *const names[WEFT_TONEMAP_COUNT] = {"pbr-neutral", "aces", "none", "agx"};
    return tonemap >= 0 && tonemap < WEFT_TONEMAP_COUNT ? names[tonemap] : NULL;
}

WeftResult tone_check(const WeftTone *tone, const char *subject, WeftError *error) {
    if ((unsigned)tone->curve >= WEFT_TONEMAP_COUNT || !isfinite(tone->exposure))
        return fail(error, WEFT_MESSAGE_DESC, subject, "curve %d, exposure %g", (int)tone->curve,
                    (double)tone->exposure);
    const float x = tone->white[0], y = tone->white[1];
    const bool none = !(x > 0.0f) && !(x < 0.0f) && !(y > 0.0f) && !(y < 0.0f) && isfinite(x) && isfinite(y);
    if (none || (x > 0.0f && y > 0.01f && x + y < 1.0f)) return WEFT_OK;
    return fail(error, WEFT_MESSAGE_DESC, subject, "white x %g, y %g is not the colour of a light", (double)x,
                (double)y);
}

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

static ToneBalance balance_of(const float white[2]) {
    float m[9];
    weft_white_matrix(white, m);
    return (ToneBalance){{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}};
}

/* Returns the light of the display of a pixel, over `behind` unless that is NULL. */
static Rgb light_of(const WeftTone *tone, const ToneBalance *white, const float *in, float alpha, const Rgb *behind) {
    Rgb light = tone_light(rgb(in[0], in[1], in[2]), exp2f(tone->exposure), *white, (int)tone->curve);
    return behind ? tone_over(light, alpha, *behind) : light;
}

/* Makes the pixels over `behind`; if that is NULL, alpha is kept. */
static void map(const WeftImage *linear, const WeftTone *tone, const Rgb *behind, const WeftImage *out) {
    const ToneBalance white = balance_of(tone->white);
    const float *in = linear->pixels;
    unsigned char *to = out->pixels;
    for (unsigned y = 0; y < (unsigned)linear->height; y++)
        for (unsigned x = 0; x < (unsigned)linear->width; x++) {
            float alpha = linear->channels == 4 ? fminf(tone_bounded(in[3]), 1.0f) : 1.0f;
            Rgb c = tone_display(light_of(tone, &white, in, alpha, behind));
            float fraction = dither(x, y);
            to[0] = quantized(c.r, fraction);
            to[1] = quantized(c.g, fraction);
            to[2] = quantized(c.b, fraction);
            if (linear->channels == 4) to[3] = (unsigned char)((behind ? 1.0f : alpha) * 255.0f + 0.5f);
            in += linear->channels;
            to += linear->channels;
        }
}

WeftResult weft_image_show(const WeftImage *linear, const WeftTone *tone, const float behind[3], WeftImage *out,
                           WeftError *error) {
    *out = (WeftImage){0};
    if (linear->type != WEFT_PIXEL_F32 || linear->channels < 3)
        return fail(error, WEFT_MESSAGE_DESC, "tone mapping", "it takes float images of 3 or 4 channels");
    WeftResult result = tone_check(tone, "tone mapping", error);
    if (result == WEFT_OK)
        result = weft_image_create(linear->width, linear->height, linear->channels, WEFT_PIXEL_U8, out, error);
    if (result != WEFT_OK) return result;
    Rgb light = {0.0f, 0.0f, 0.0f};
    if (behind) light = rgb_min(rgb(tone_bounded(behind[0]), tone_bounded(behind[1]), tone_bounded(behind[2])), 1.0f);
    map(linear, tone, behind ? &light : NULL, out);
    return WEFT_OK;
}

WeftResult weft_image_tonemap(const WeftImage *linear, WeftTonemap tonemap, float exposure, WeftImage *out,
                              WeftError *error) {
    return weft_image_show(linear, &(WeftTone){tonemap, exposure, {0.0f, 0.0f}}, NULL, out, error);
}

WeftResult weft_image_tonemap_over(const WeftImage *linear, WeftTonemap tonemap, float exposure, const float behind[3],
                                   WeftImage *out, WeftError *error) {
    return weft_image_show(linear, &(WeftTone){tonemap, exposure, {0.0f, 0.0f}}, behind, out, error);
}
