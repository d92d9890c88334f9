/* weave.glsl - the light of a woven material at a fragment, from points of threads and from both systems from afar
 *
 *   light = sum over bases of weight (direct light + light of the environment's lights) + the rest
 *
 * A pixel much smaller than a thread has one point, a larger one up to five, and from about one thread on the lobes of
 * both systems from afar take over. Points and systems are bases (weave_base.h), each lit by itself. The rest is
 * computed a single time: the layers above the bases, except under polygon lights, and the residual of the environment
 * on the mean base. That is linear in the colours of a base, and each base has them times what its system reflects of an
 * even sky, so that an even sky is that of the fit (cloth_sky.h). */
#include "raster/glsl/weave_far.glsl"
#ifdef AMBIENT
#include "raster/glsl/weave_sky.glsl"
#endif
#include "shading/weave/weave_base.h"

#ifdef COARSE
#include "raster/glsl/weave_motion.glsl"
#else
WovenPrepared pixel_afar(bool weft) { return woven_afar(weft); }

float pixel_far(WeaveFootprint f) { return weave_far_weight(f); }

/* Returns the number of points of a pixel: enough that pixels vary at most a quarter more than their true means do. */
int pixel_points(WeaveFootprint f, float far) {
    int few = f.longest < 0.14 ? 1 : f.longest < 0.45 ? 2 : 3;
    return far >= 1.0 ? 0 : f.longest < 0.65 || far > 0.5 ? few : 5;
}
#endif

/* Returns three numbers from -1 to 1 that are random from pixel to pixel. */
vec3 pixel_random() {
    uint key = weave_hash(uint(gl_FragCoord.x) + (uint(gl_FragCoord.y) << 16u));
    return vec3(weave_first(key), weave_second(key), weave_first(weave_hash(key + 1u)));
}

/* Returns a point of a lattice of n, shifted around the pixel by a distance that differs from pixel to pixel: equal
 * lattices would make a moire with threads. Robert Cranley, Thomas Patterson, "Randomization of Number Theoretic
 * Methods for Multiple Integration", 1976. A single point stays in the middle, so that edges of threads are smooth. */
vec2 pixel_shifted(vec2 from, int n, vec3 random) {
    return n > 1 ? fract(from + 0.5 * random.xy + 0.5) - 0.5 : from;
}

/* Returns the place across a fibre, -1 to 1, for a point of the lattice that is too far from others to have its own. It
 * follows the rows of the lattice with a shift of its own, so that it does not depend on the place of the point. */
float pixel_across(vec2 from, vec3 random) { return 2.0 * fract(from.y + random.z) - 1.0; }

/* Returns the stack m on base b. */
Stack woven_stack(Stack m, WeaveBase b) {
    Stack n = m;
    compose_base(n, b.lobe, b.single, b.multiple);
    return n;
}

/* Weighted sums over the bases of a pixel. */
struct WovenSum {
    Rgb direct;           /* radiance to the eye by direct lights */
    Rgb around;           /* and by the environment's lights, before layers above dim it */
    Rgb single, multiple; /* colours times E of an even sky */
    float covered;        /* the part of the pixel that threads cover */
};

/* Adds base b. n: the stack on it; w: the view of the stack without a base; sky: E of its two colours. */
void woven_add(inout WovenSum sum, Stack n, StackView w, WeaveBase b, vec2 sky, float weight, PolygonReach reach,
               Facing at, Frame frame) {
    StackView v = w;
    Slots base = slots_of(SHOWS_DIFFUSE, false, false, false, false);
    view_base(n, v);
    Rgb direct = rgb_add(punctual_light(n, v, base, at, frame), polygon_light(n, v, reach, frame));
    sum.direct = rgb_add(sum.direct, rgb_scale(direct, weight));
#ifdef AMBIENT
    v.scale.diffuse = 1.0;
    Rgb around = ambient_reflect_lights(n, v, base, frame, sky_open(frame).x);
    sum.around = rgb_add(sum.around, rgb_scale(around, weight));
#endif
    sum.single = rgb_add(sum.single, rgb_scale(rgb_scale(b.single, sky.x), weight));
    sum.multiple = rgb_add(sum.multiple, rgb_scale(rgb_scale(b.multiple, sky.y), weight));
}

/* Returns the rest: the layers above bases, and the residual of the environment on the mean base. */
Rgb woven_rest(WovenSum sum, Stack m, StackView w, Facing at, Frame frame) {
    Slots above = slots_of(false, SHOWS_SPECULAR, SHOWS_SHEEN, SHOWS_COAT, SHOWS_DUST);
    Rgb rest = punctual_light(m, w, above, at, frame);
#ifdef AMBIENT
    WeaveBase mean;
    mean.lobe = lobe_default(LOBE_YARN);
    mean.single = sum.single;
    mean.multiple = sum.multiple;
    StackView lights;
    Slots only;
    vec2 open = sky_open(frame);
    Stack n = woven_stack(m, mean);
    rest = rgb_add(rest, ambient_smooth(n, w, material_ambient(), frame, open.x, open.y, lights, only));
    rest = rgb_add(rest, rgb_scale(sum.around, lights.scale.diffuse));
    only.diffuse = false;
    rest = rgb_add(rest, ambient_reflect_lights(m, lights, only, frame, open.x));
#endif
    return rest;
}

/* Returns the light (rgb) and the part of the pixel that threads cover (a). Loops may have 0 rounds: a driver that does
 * not branch would run a branch around them. */
vec4 woven_light(Stack m, Dir o, Facing at, Frame frame, float occlusion, float wear) {
    Weave c = material_cloth();
    vec2 place = weave_place();
    vec2 across = dFdx(place), up = dFdy(place);
    WeaveFootprint f = weave_footprint(across.x, across.y, up.x, up.y);
    float far = pixel_far(f);
    int points = pixel_points(f, far), systems = far > 0.0 ? 2 : 0;
    vec3 random = pixel_random();
    StackView w;
    stack_view(m, o, w);
    vec4 sky = vec4(1.0);
#ifdef AMBIENT
    occlude_by_texture(occlusion);
    sky = weave_sky(o);
#endif
    PolygonReach reach = polygon_reach(HAS_TRANSMITTED(m), at);
    float whole = 1.0; /* the part of the cloth without gaps; a mask, which is there or not, has none from afar */
#ifndef MASKED
    if (MATERIAL_HOLED) whole = c.warp_far.share + c.weft_far.share;
#endif
    WovenSum sum = WovenSum(rgb_grey(0.0), rgb_grey(0.0), rgb_grey(0.0), rgb_grey(0.0), 0.0);
    sum.covered = far * whole;
    for (int k = 0; k < points; k++) {
        float weight = (1.0 - far) / float(points);
#ifdef COARSE
        polygons_weight = weight;
#endif
        vec2 lattice = pixel_point(k, points), from = pixel_shifted(lattice, points, random);
        vec2 spot = place + from.x * across + from.y * up;
        float spacing = f.longest * inversesqrt(float(points));
        WeavePoint p = weave_point(c, spot.x, spot.y, spacing, pixel_across(lattice, random));
        sum.covered = sum.covered + (p.height > WEAVE_NONE ? weight : 0.0);
        WeaveBase b = weave_near(c, p, wear);
        Stack n = woven_stack(m, b);
        n.diffuse_prepared.yarn.axis = p.fibre; /* exactly, instead of through the azimuth */
        woven_add(sum, n, w, b, p.weft ? sky.zw : sky.xy, weight, reach, at, frame);
    }
    for (int k = 0; k < systems; k++) {
        float weight = 0.5 * far * whole; /* colours of a holed cloth are those of its threads */
        WeaveBase b = woven_far(c, k > 0, place, across, up, f, wear);
#ifdef COARSE
        polygons_weight = weight;
        polygons_first = k * (POLYGON_POINTS / 2);
        polygons_number = POLYGON_POINTS / 2;
#endif
        Stack n = woven_stack(m, b);
        n.diffuse_prepared.woven = pixel_afar(k > 0);
        vec2 fitted = k > 0 ? vec2(c.weft_far.single, c.weft_far.multiple) : vec2(c.warp_far.single, c.warp_far.multiple);
        vec2 own = (k > 0 ? sky.zw : sky.xy) / max(fitted, vec2(1e-6)); /* the colours have the factors of the lobe */
        woven_add(sum, n, w, b, own, weight, reach, at, frame);
    }
    if (MATERIAL_HOLED) {
        float scale = 1.0 / max(sum.covered, 1e-3);
        sum.direct = rgb_scale(sum.direct, scale);
#ifdef COARSE
        polygons_open *= scale;
        polygons_shadowed *= scale;
#endif
        sum.around = rgb_scale(sum.around, scale);
        sum.single = rgb_scale(sum.single, scale);
        sum.multiple = rgb_scale(sum.multiple, scale);
    }
    Rgb light = rgb_add(sum.direct, woven_rest(sum, m, w, at, frame));
    return vec4(vec_of(light), MATERIAL_HOLED ? sum.covered : 1.0);
}
