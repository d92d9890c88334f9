/* tone.h - tone mapping: from linear radiance to display values
 *
 * One text for pictures in memory (image/tonemap.c) and for those that the GPU shows (raster/gl/display.h). */
#pragma once

#include "shading/dialect/rgb.h"

/* The numbers of WeftTonemap; any other number is the last. */
#define TONE_PBR_NEUTRAL 0
#define TONE_ACES        1

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

/* Returns the display value of a linear one in [0, 1] (IEC 61966-2-1:1999, sRGB). */
FN float tone_encode(float linear) {
    float low = 12.92f * linear, high = 1.055f * pow(max(linear, 0.0031308f), 1.0f / 2.4f) - 0.055f;
    return linear <= 0.0031308f ? low : high;
}

/* Returns a radiance clamped to 0 .. 1e9, so that no tone curve overflows. NaN becomes 0. */
FN float tone_bounded(float x) { return x > 0.0f ? min(x, 1e9f) : 0.0f; }

/* Returns the light, linear and in [0, 1], that a display has to emit for a linear colour multiplied by gain. */
FN Rgb tone_light(Rgb color, float gain, int curve) {
    Rgb c = rgb(tone_bounded(color.r * gain), tone_bounded(color.g * gain), tone_bounded(color.b * gain));
    if (curve == TONE_PBR_NEUTRAL) c = tone_pbr_neutral(c);
    if (curve == TONE_ACES) c = rgb(tone_aces(c.r), tone_aces(c.g), tone_aces(c.b));
    return rgb_min(c, 1.0f);
}

/* Returns the light to emit where `light` covers the part `cover`, 0 to 1, of `behind`, which no tone curve changes. */
FN Rgb tone_over(Rgb light, float cover, Rgb behind) {
    return rgb_add(rgb_scale(light, cover), rgb_scale(behind, 1.0f - cover));
}

/* Returns the display values, in [0, 1], of such light. */
FN Rgb tone_display(Rgb light) { return rgb(tone_encode(light.r), tone_encode(light.g), tone_encode(light.b)); }
