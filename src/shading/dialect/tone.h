/* tone.h - tone mapping: from linear radiance to display values
 *
 * One text for pictures in memory (image/tonemap.c) and for those that the GPU shows (raster/gl/display.h). */
#pragma once

#include "shading/dialect/rgb.h"

/* The numbers of WeftTonemap; any other number is that of none. */
#define TONE_PBR_NEUTRAL 0
#define TONE_ACES        1
#define TONE_AGX         3

/* Returns the tone-mapped colour. Khronos Group, "PBR Neutral Tone Mapper", specification, 2024. The offset
 * subtracts what a dielectric's 4 % Fresnel reflection adds; below the start of compression, colours change by that
 * only. */
FN Rgb tone_pbr_neutral(Rgb color) {
    float start = 0.8f - 0.04f, desaturation = 0.15f;
    float x = min(color.r, min(color.g, color.b)), offset = x < 0.08f ? x - 6.25f * x * x : 0.04f;
    Rgb c = rgb(color.r - offset, color.g - offset, color.b - offset);
    float peak = rgb_max3(c);
    if (peak < start) return c;
    float d = 1.0f - start, squeezed = 1.0f - d * d / (peak + d - start);
    float keep = 1.0f / (desaturation * (peak - squeezed) + 1.0f);
    return rgb_add(rgb_scale(rgb_scale(c, squeezed / peak), keep), rgb_grey(squeezed * (1.0f - keep)));
}

/* Returns x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), a fit for each channel. Krzysztof Narkowicz, "ACES Filmic
 * Tone Mapping Curve", 2015. */
FN float tone_aces(float x) { return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f); }

/* Returns a channel of AgX' curve, for a power of 2.2, from the place x of its logarithm in [0, 1]. The polynomial is
 * Wrensch's; it is stretched from -0.00232 .. 0.99858, so that black is black and white is white. */
FN float tone_agx_curve(float x) {
    float fit = (((((15.5f * x - 40.14f) * x + 31.96f) * x - 6.868f) * x + 0.4298f) * x + 0.1191f) * x;
    return fit * (1.0f / 1.0009f);
}

/* Returns a channel's place between 12.47393 stops below 1 and 4.026069 above. */
FN float tone_agx_place(float x) {
    return (clamp(log2(max(x, 1e-10f)), -12.47393f, 4.026069f) + 12.47393f) * (1.0f / 16.5f);
}

/* Returns x moved towards y and z. */
FN float tone_agx_mix(float x, float y, float by_y, float z, float by_z) { return x + by_y * (y - x) + by_z * (z - x); }

/* Returns Troy Sobotka's "AgX", 2022, in the fit of Benjamin Wrensch, "Minimal AgX Implementation", 2023: a smaller
 * gamut, a curve for each channel of its logarithm, and back. Of the matrices only the numbers beside the diagonal are
 * taken, so that grey stays grey; the published rows sum to 1 within 1.8e-4. */
FN Rgb tone_agx(Rgb color) {
    float r = tone_agx_mix(color.r, color.g, 0.0784336f, color.b, 0.0792237451f);
    float g = tone_agx_mix(color.g, color.r, 0.0423282423f, color.b, 0.0791661275f);
    float b = tone_agx_mix(color.b, color.r, 0.0423756549f, color.g, 0.0784336f);
    r = tone_agx_curve(tone_agx_place(r));
    g = tone_agx_curve(tone_agx_place(g));
    b = tone_agx_curve(tone_agx_place(b));
    Rgb c = rgb(tone_agx_mix(r, g, -0.0980208811f, b, -0.0990297441f),
                tone_agx_mix(g, r, -0.0528968518f, b, -0.0989611768f),
                tone_agx_mix(b, r, -0.0529716355f, g, -0.0980434501f));
    return rgb(pow(max(c.r, 0.0f), 2.2f), pow(max(c.g, 0.0f), 2.2f), pow(max(c.b, 0.0f), 2.2f));
}

/* A matrix that turns the colour of a light into white, by rows (weft_white_matrix). */
STRUCT(ToneBalance) { Rgb r, g, b; };

FN float tone_dot(Rgb a, Rgb b) { return a.r * b.r + a.g * b.g + a.b * b.b; }

/* Returns the display value of a linear one in [0, 1] (IEC 61966-2-1:1999, sRGB). */
FN float tone_encode(float linear) {
    float low = 12.92f * linear, high = 1.055f * pow(max(linear, 0.0031308f), 1.0f / 2.4f) - 0.055f;
    return linear <= 0.0031308f ? low : high;
}

/* Returns a radiance clamped to 0 .. 1e9, so that no tone curve overflows. NaN becomes 0. */
FN float tone_bounded(float x) { return x > 0.0f ? min(x, 1e9f) : 0.0f; }

/* Returns the light, linear and in [0, 1], that a display has to emit for a linear colour multiplied by gain and then by
 * a matrix. */
FN Rgb tone_light(Rgb color, float gain, ToneBalance white, int curve) {
    Rgb c = rgb(tone_bounded(color.r * gain), tone_bounded(color.g * gain), tone_bounded(color.b * gain));
    c = rgb(tone_bounded(tone_dot(white.r, c)), tone_bounded(tone_dot(white.g, c)), tone_bounded(tone_dot(white.b, c)));
    if (curve == TONE_PBR_NEUTRAL) c = tone_pbr_neutral(c);
    if (curve == TONE_ACES) c = rgb(tone_aces(c.r), tone_aces(c.g), tone_aces(c.b));
    if (curve == TONE_AGX) c = tone_agx(c);
    return rgb_min(c, 1.0f);
}

/* Returns the light to emit where `light` covers the part `cover`, 0 to 1, of `behind`, which no tone curve changes. */
FN Rgb tone_over(Rgb light, float cover, Rgb behind) {
    return rgb_add(rgb_scale(light, cover), rgb_scale(behind, 1.0f - cover));
}

/* Returns the display values, in [0, 1], of such light. */
FN Rgb tone_display(Rgb light) { return rgb(tone_encode(light.r), tone_encode(light.g), tone_encode(light.b)); }
