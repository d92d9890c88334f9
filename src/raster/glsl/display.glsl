/* display.glsl - the picture for a display: over a background, with exposure, tone curve and sRGB encoding */
#include "shading/dialect/tone.h"

uniform highp sampler2D picture_mean;
uniform highp vec4 show_place; /* the picture's corner and size in the framebuffer */
uniform highp vec4 show_back;  /* linear colour of the background; w: the gain */
uniform int show_curve;
uniform highp vec3 show_white[3]; /* rows of ToneBalance */
out highp vec4 shown;

/* Returns the dither of a pixel, counted from the top left, as image/tonemap.c has it. */
float show_dither(ivec2 at) {
    uint hash = uint(at.x) * 0xc13fa9a9u + uint(at.y) * 0x91e10da5u;
    return (float(hash >> 24) + 0.5) / 256.0;
}

void main() {
    vec2 at = gl_FragCoord.xy - show_place.xy, size = vec2(textureSize(picture_mean, 0));
    vec4 c = texelFetch(picture_mean, ivec2(min(at * (size / show_place.zw), size - 0.5)), 0);
    float alpha = c.a > 0.0 ? min(c.a, 1.0) : 0.0;
    vec3 straight = alpha > 0.0 ? c.rgb / c.a : vec3(0.0);
    ToneBalance white;
    white.r = rgb(show_white[0].x, show_white[0].y, show_white[0].z);
    white.g = rgb(show_white[1].x, show_white[1].y, show_white[1].z);
    white.b = rgb(show_white[2].x, show_white[2].y, show_white[2].z);
    Rgb light = tone_light(rgb(straight.r, straight.g, straight.b), show_back.w, white, show_curve);
    Rgb over = tone_display(tone_over(light, alpha, rgb(show_back.r, show_back.g, show_back.b)));
    float fraction = show_dither(ivec2(int(at.x), int(show_place.w - at.y)));
    shown = vec4(min(floor(vec3(over.r, over.g, over.b) * 255.0 + fraction) / 255.0, vec3(1.0)), 1.0);
}
