/* weave_far.glsl - both systems of a woven cloth from afar: their colours over a pixel, and lobe woven of each */
uniform highp sampler2DArray weave_colors;

#include "raster/glsl/weave_cloth.glsl"
#include "shading/weave/weave_base.h"

/* Returns point k of n over a pixel, from its middle, in pixels. The points are a Fibonacci lattice, (k, k g mod n) / n
 * with n = 1, 2, 3 or 5 and g the Fibonacci number before n. */
vec2 pixel_point(int k, int n) {
    float g = n == 5 ? 3.0 : n == 3 ? 2.0 : 1.0, x = float(k) + 0.5, y = float(k) * g + 0.5;
    return vec2(x, y) / float(n) - vec2(0.5, 0.5 + floor(y / float(n)));
}

#ifdef COARSE
const float FAR_TEXELS = 1.0; /* along the side of a pixel */
#else
const float FAR_TEXELS = 2.0;
#endif

/* Returns one system from afar. Its colours are the mean over five texels half a pixel wide: a level of texels as wide
 * as the pixel would blur neighbours that the picture still resolves. In motion one is enough, and on the last level, one
 * texel. Two bases stand for the cloth, each with half of the weight, so each reflects twice as much. Then one table for
 * the light of the environment, made for a whole cloth, serves all bases. */
WeaveBase woven_far(Weave c, bool weft, vec2 place, vec2 across, vec2 up, WeaveFootprint f, float wear) {
    vec2 repeat = vec2(weave_number(CLOTH_WARPS), weave_number(CLOTH_PICKS));
    vec2 texel = repeat / vec2(weave_number(CLOTH_FAR_WIDTH), weave_number(CLOTH_FAR_HEIGHT));
    float level = weave_far_level(f, FAR_TEXELS * texel.x, FAR_TEXELS * texel.y), layer = weft ? 2.0 : 0.0;
    float last = log2(max(weave_number(CLOTH_FAR_WIDTH), weave_number(CLOTH_FAR_HEIGHT)));
    int places = level < last && FAR_TEXELS > 1.0 ? 5 : 1;
    vec4 single = vec4(0.0), multiple = vec4(0.0);
    for (int k = 0; k < places; k++) {
        vec2 from = pixel_point(k, places);
        vec2 at = (place + from.x * across + from.y * up) / repeat;
        single += textureLod(weave_colors, vec3(at, layer), level) / float(places);
        multiple += textureLod(weave_colors, vec3(at, layer + 1.0), level) / float(places);
    }
    float dye = weave_far_dye(c, weft, place.x, place.y, f);
    float scale = MATERIAL_HOLED ? 2.0 / max(c.warp_far.share + c.weft_far.share, 1e-3) : 2.0;
    WeaveBase b = weave_far(c, weft, rgb(single.r, single.g, single.b), rgb(multiple.r, multiple.g, multiple.b),
                            single.a, dye, wear);
    b.single = rgb_scale(b.single, scale);
    b.multiple = rgb_scale(b.multiple, scale);
    return b;
}

/* The uniform block has the numbers of two WovenPrepared, of warp and weft, from CLOTH_AFAR on. */
#define ONE_NUMBER(name)  +1
#define TWO_NUMBERS(name) +2
const int CLOTH_AFAR = 84, CLOTH_AFAR_EACH = 0 WOVEN_NUMBERS(ONE_NUMBER) WOVEN_EACH_BIN(TWO_NUMBERS);
#define TAKE_NUMBER(to)                                                                                      \
    to = weft ? weave_number(k + CLOTH_AFAR_EACH) : weave_number(k);                                         \
    k++;
#define TAKE_AFAR(name) TAKE_NUMBER(taken.name)
#define TAKE_BIN(name)                                                                                       \
    TAKE_NUMBER(taken.bins.name.slope)                                                                       \
    TAKE_NUMBER(taken.bins.name.weight)

/* Returns lobe woven of a system, fitted when the cloth was made (weave/woven_fit.c) and equal at all pixels.
 * TAKE_NUMBER reads both systems, since an index that depends on `weft` costs a software driver a load for each
 * pixel. */
WovenPrepared woven_afar(bool weft) {
    int k = CLOTH_AFAR;
    WovenPrepared taken;
    WOVEN_NUMBERS(TAKE_AFAR)
    WOVEN_EACH_BIN(TAKE_BIN)
    taken.scale = 1.0; /* colours from afar contain the share of the system */
    return taken;
}
