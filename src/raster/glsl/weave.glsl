/* weave.glsl - the light of a woven material at a fragment: of points of threads, and of both systems from afar
 *
 * A pixel has one point while it is much smaller than a thread, and more the larger it is, until the cloth from afar takes
 * over. Each is a base of its own under the lights. What lies on it, but under polygons, and what all reflect of the
 * environment without its lights, which is linear in a base's colours, are found once, of the mean base. */
uniform highp sampler2DArray weave_colors;

#include "raster/glsl/weave_cloth.glsl"
#include "shading/weave/weave_base.h"

/* Returns how many points a pixel has: as many as keep pixels from varying a quarter more than they should. */
int pixel_points(WeaveFootprint f, float far) {
    int few = f.longest < 0.14 ? 1 : f.longest < 0.45 ? 2 : 3;
    return far >= 1.0 ? 0 : f.longest < 0.65 || far > 0.5 ? few : 5;
}

/* Point k of n over a pixel, from its middle, in pixels: of the Fibonacci lattice (k, k g mod n) / n, where n is 1, 2, 3 or
 * 5 and g the Fibonacci number before it. */
vec2 pixel_point(int k, int n) {
    float g = n == 5 ? 3.0 : n == 3 ? 2.0 : 1.0, x = float(k) + 0.5, y = float(k) * g + 0.5;
    return vec2(x, y) / float(n) - vec2(0.5, 0.5 + floor(y / float(n)));
}

/* Returns three numbers from -1 to 1 that are random from pixel to pixel. */
vec3 pixel_random() {
    uint key = weave_hash(uint(gl_FragCoord.x) + (uint(gl_FragCoord.y) << 16u));
    return vec3(weave_first(key), weave_second(key), weave_first(weave_hash(key + 1u)));
}

/* Moves a lattice of n points around the pixel, in each pixel by another way, since the same in all would beat with
 * threads: Robert Cranley, Thomas Patterson, "Randomization of Number Theoretic Methods for Multiple Integration", 1976. A
 * single point stays in the middle, where it leaves the edges of threads smooth. */
vec2 pixel_moved(vec2 from, int n, vec3 random) {
    return n > 1 ? fract(from + 0.5 * random.xy + 0.5) - 0.5 : from;
}

/* The place across a fibre of that point, if it lies too far from others to tell: by rows of the lattice, moved by another
 * way, so that it does not depend on where the point is. */
float pixel_across(vec2 from, vec3 random) { return 2.0 * fract(from.y + random.z) - 1.0; }

/* One system from afar, its colours as the mean of five places half a pixel wide: a level as wide as the pixel would
 * mix neighbours that are still told apart; the last level is the same at all. Two bases stand for the cloth, each with
 * half of the weight: so it reflects twice as much. All bases have one table for the light of the environment, which is
 * of a whole cloth. */
WeaveBase woven_far(Weave c, bool weft, vec2 place, vec2 across, vec2 up, WeaveFootprint f) {
    vec2 repeat = vec2(weave_number(CLOTH_WARPS), weave_number(CLOTH_PICKS));
    vec2 texel = repeat / vec2(weave_number(CLOTH_FAR_WIDTH), weave_number(CLOTH_FAR_HEIGHT));
    float level = weave_far_level(f, 2.0 * texel.x, 2.0 * texel.y), layer = weft ? 2.0 : 0.0;
    float last = log2(max(weave_number(CLOTH_FAR_WIDTH), weave_number(CLOTH_FAR_HEIGHT)));
    int places = level < last ? 5 : 1;
    vec4 once = vec4(0.0), again = vec4(0.0);
    for (int k = 0; k < places; k++) {
        vec2 from = pixel_point(k, places);
        vec2 at = (place + from.x * across + from.y * up) / repeat;
        once += textureLod(weave_colors, vec3(at, layer), level) / float(places);
        again += textureLod(weave_colors, vec3(at, layer + 1.0), level) / float(places);
    }
    float dye = weave_far_dye(c, weft, weft ? place.y : place.x, weft ? f.y : f.x);
    float scale = MATERIAL_HOLED ? 2.0 / max(c.warp_far.share + c.weft_far.share, 1e-3) : 2.0;
    WeaveBase b = weave_far(c, weft, rgb(once.r, once.g, once.b), rgb(again.r, again.g, again.b), once.a, dye);
    b.once = rgb_scale(b.once, scale);
    b.again = rgb_scale(b.again, scale);
    return b;
}

/* Lobe woven of a system is the same at all pixels, and fitted when the cloth is made (weave/woven_fit.c). Both systems are
 * read, since an index that a loop counts costs a software driver a load for each pixel. */
#define ONE_NUMBER(name)  +1
#define BIN_NUMBERS(name) WOVEN_BIN_NUMBERS(ONE_NUMBER)
const int CLOTH_AFAR = 68, CLOTH_AFAR_EACH = 0 WOVEN_NUMBERS(ONE_NUMBER) WOVEN_EACH_BIN(BIN_NUMBERS);
#define TAKE_NUMBER(to)                                                                                      \
    to = weft ? weave_number(k + CLOTH_AFAR_EACH) : weave_number(k);                                         \
    k++;
#define TAKE_AFAR(name)   TAKE_NUMBER(taken.name)
#define TAKE_OF_BIN(name) TAKE_NUMBER(bin.name)
#define TAKE_BIN(name)                                                                                       \
    WOVEN_BIN_NUMBERS(TAKE_OF_BIN)                                                                           \
    taken.name = bin;
WovenPrepared woven_afar(bool weft) {
    int k = CLOTH_AFAR;
    WovenBin bin;
    WovenPrepared taken;
    WOVEN_NUMBERS(TAKE_AFAR)
    WOVEN_EACH_BIN(TAKE_BIN)
    taken.part = 1.0; /* colours from afar have the share of the system */
    return taken;
}

/* In the place of the stack's base. */
Stack woven_stack(Stack m, WeaveBase b) {
    Stack n = m;
    compose_base(n, b.lobe, b.once, b.again);
    return n;
}

struct WovenSum {
    Rgb direct;      /* what bases send to the eye of lights */
    Rgb around;      /* and of the environment's lights, if nothing dims them */
    Rgb once, again; /* the mean colours of bases */
    float covered; /* the part of the pixel that threads cover */
};

/* Adds a base, that of n, which but for it is seen as w. */
void woven_add(inout WovenSum sum, Stack n, StackView w, WeaveBase b, float weight, PolygonReach reach,
               Facing at, Frame frame) {
    StackView v = w;
    Slots base = slots_of(SHOWS_DIFFUSE, false, false, false, false);
    view_base(n, v);
    Rgb direct = rgb_add(punctual_light(n, v, base, at, frame), polygon_light(n, v, reach, frame));
    sum.direct = rgb_add(sum.direct, rgb_scale(direct, weight));
#ifdef AMBIENT
    v.scale.diffuse = 1.0;
    Rgb around = ambient_reflect_lights(n, v, base, frame, sky_open().x);
    sum.around = rgb_add(sum.around, rgb_scale(around, weight));
#endif
    sum.once = rgb_add(sum.once, rgb_scale(b.once, weight));
    sum.again = rgb_add(sum.again, rgb_scale(b.again, weight));
}

/* The rest: what lies on bases, and what the mean one reflects of the environment without its lights. */
Rgb woven_rest(WovenSum sum, Stack m, StackView w, Facing at, Frame frame) {
    Slots above = slots_of(false, SHOWS_SPECULAR, SHOWS_SHEEN, SHOWS_COAT, SHOWS_DUST);
    Rgb rest = punctual_light(m, w, above, at, frame);
#ifdef AMBIENT
    WeaveBase mean;
    mean.lobe = lobe_default(LOBE_YARN);
    mean.once = sum.once;
    mean.again = sum.again;
    StackView lights;
    Slots only;
    vec2 open = sky_open();
    Stack n = woven_stack(m, mean);
    rest = rgb_add(rest, ambient_smooth(n, w, material_ambient(), frame, open.x, open.y, lights, only));
    rest = rgb_add(rest, rgb_scale(sum.around, lights.scale.diffuse));
    only.diffuse = false;
    rest = rgb_add(rest, ambient_reflect_lights(m, lights, only, frame, open.x));
#endif
    return rest;
}

/* rgb: the light; a: the part of the pixel that threads cover. Of loops of no rounds drivers that do not branch run one. */
vec4 woven_light(Stack m, Dir o, Facing at, Frame frame, float occlusion) {
    Weave c = material_cloth();
    vec2 place = weave_place();
    vec2 across = dFdx(place), up = dFdy(place);
    WeaveFootprint f = weave_footprint(across.x, across.y, up.x, up.y);
    float far = weave_far_weight(f);
    int points = pixel_points(f, far), systems = far > 0.0 ? 2 : 0;
    vec3 random = pixel_random();
    StackView w;
    stack_view(m, o, w);
#ifdef AMBIENT
    texture_occlusion = occlusion;
#endif
    PolygonReach reach = polygon_reach(HAS_TRANSMITTED(m), at);
    WovenSum sum = WovenSum(rgb_grey(0.0), rgb_grey(0.0), rgb_grey(0.0), rgb_grey(0.0), far);
    for (int k = 0; k < points; k++) {
        float weight = (1.0 - far) / float(points);
        vec2 lattice = pixel_point(k, points), from = pixel_moved(lattice, points, random);
        vec2 spot = place + from.x * across + from.y * up;
        float spacing = f.longest * inversesqrt(float(points));
        WeavePoint p = weave_point(c, spot.x, spot.y, spacing, pixel_across(lattice, random));
        sum.covered = sum.covered + (p.height > WEAVE_NONE ? weight : 0.0);
        WeaveBase b = weave_near(c, p);
        Stack n = woven_stack(m, b);
        n.diffuse_prepared.yarn.axis = p.fibre; /* what its azimuth says, without an arc */
        woven_add(sum, n, w, b, weight, reach, at, frame);
    }
    for (int k = 0; k < systems; k++) {
        WeaveBase b = woven_far(c, k > 0, place, across, up, f);
        Stack n = woven_stack(m, b);
        n.diffuse_prepared.woven = woven_afar(k > 0);
        woven_add(sum, n, w, b, 0.5 * far, reach, at, frame);
    }
    if (MATERIAL_HOLED) {
        float scale = 1.0 / max(sum.covered, 1e-3);
        sum.direct = rgb_scale(sum.direct, scale);
        sum.around = rgb_scale(sum.around, scale);
        sum.once = rgb_scale(sum.once, scale);
        sum.again = rgb_scale(sum.again, scale);
    }
    Rgb light = rgb_add(sum.direct, woven_rest(sum, m, w, at, frame));
    return vec4(vec_of(light), MATERIAL_HOLED ? sum.covered : 1.0);
}
