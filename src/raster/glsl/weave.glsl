/* weave.glsl - the light of a woven material at a fragment: of points of threads, and of both systems from afar
 *
 * A pixel has one point while it is much smaller than a thread, then five, and eight where it is as large as one. The
 * text before it supplies stack_light, which is all that a stack sends to the eye; each base is lit alone, so whatever
 * lies on it is there every time, and the weights sum up to 1. */
uniform highp sampler2DArray weave_colors;

#include "raster/glsl/weave_cloth.glsl"
#include "shading/weave_base.h"

/* Point k of n over a pixel, from its middle, in pixels: of the Fibonacci lattice (k, k g mod n) / n, where n is 1, 5 or
 * 8 and g the Fibonacci number before it. Points of a square lattice would beat with threads. */
vec2 pixel_point(int k, int n) {
    float g = n == 8 ? 5.0 : n == 5 ? 3.0 : 1.0, x = float(k) + 0.5, y = float(k) * g + 0.5;
    return vec2(x, y) / float(n) - vec2(0.5, 0.5 + floor(y / float(n)));
}

/* One system from afar, its colours as the mean of five places half a pixel wide: a level as wide as the pixel would
 * mix neighbours that are still told apart. Two bases stand for the cloth, each with half of the weight: so it
 * reflects twice as much. All bases have one table for the light of the environment, which is of a whole cloth. */
WeaveBase woven_far(Weave c, bool weft, vec2 place, vec2 across, vec2 up, WeaveFootprint f) {
    vec2 repeat = vec2(weave_number(CLOTH_WARPS), weave_number(CLOTH_PICKS));
    vec2 texel = repeat / vec2(weave_number(CLOTH_FAR_WIDTH), weave_number(CLOTH_FAR_HEIGHT));
    float level = weave_far_level(f, 2.0 * texel.x, 2.0 * texel.y);
    float layer = weft ? 2.0 : 0.0;
    vec4 once = vec4(0.0), again = vec4(0.0);
    for (int k = 0; k < 5; k++) {
        vec2 from = pixel_point(k, 5);
        vec2 at = (place + from.x * across + from.y * up) / repeat;
        once += 0.2 * textureLod(weave_colors, vec3(at, layer), level);
        again += 0.2 * textureLod(weave_colors, vec3(at, layer + 1.0), level);
    }
    float dye = weave_far_dye(c, weft, weft ? place.y : place.x, weft ? f.y : f.x);
    float scale = MATERIAL_HOLED ? 2.0 / max(c.warp_far.share + c.weft_far.share, 1e-3) : 2.0;
    WeaveBase b = weave_far(c, weft, rgb(once.r, once.g, once.b), rgb(again.r, again.g, again.b), once.a, dye);
    b.once = rgb_scale(b.once, scale);
    b.again = rgb_scale(b.again, scale);
    return b;
}

/* In the place of the stack's base. Colours from afar have the share of the system, so that the lobe has it no more. */
Stack woven_stack(Stack m, WeaveBase b) {
    Stack n = m;
    compose_base(n, b.lobe, b.once, b.again);
    n.diffuse_prepared.woven.part = 1.0;
    return n;
}

/* rgb: the light; a: the part of the pixel that threads cover. */
vec4 woven_light(Stack m, Dir o, Facing at, Frame frame, float occlusion) {
    Weave c = material_cloth();
    vec2 place = weave_place();
    vec2 across = dFdx(place), up = dFdy(place);
    WeaveFootprint f = weave_footprint(across.x, across.y, up.x, up.y);
    float far = weave_far_weight(f), covered = 0.0;
    int points = far >= 1.0 ? 0 : f.longest < 0.2 ? 1 : f.longest < 0.6 ? 5 : 8;
    int count = far > 0.0 ? points + 2 : points;
    Rgb sum = rgb_grey(0.0);
    for (int k = 0; k < count; k++) {
        WeaveBase b;
        float weight = 0.5 * far;
        if (k < points) {
            vec2 from = pixel_point(k, points);
            vec2 spot = place + from.x * across + from.y * up;
            WeavePoint p = weave_point(c, spot.x, spot.y, f.longest * inversesqrt(float(points)));
            b = weave_near(c, p);
            weight = (1.0 - far) / float(points);
            covered = covered + (p.height > WEAVE_NONE ? weight : 0.0);
        } else {
            b = woven_far(c, k > points, place, across, up, f);
            covered = covered + weight;
        }
        sum = rgb_add(sum, rgb_scale(stack_light(woven_stack(m, b), o, at, frame, occlusion), weight));
    }
    if (MATERIAL_HOLED) sum = rgb_scale(sum, 1.0 / max(covered, 1e-3));
    return vec4(vec_of(sum), MATERIAL_HOLED ? covered : 1.0);
}
