/* weave.glsl - the light of a woven material at a fragment: of points of threads, and of both systems from afar
 *
 * A pixel has one point while it is much smaller than a thread, and up to nine where it is as large as one, sheared:
 * rows of points would beat with threads. The text before it supplies stack_light, which is all that a stack sends to
 * the eye; each base is lit alone, so whatever lies on it is there every time, and the weights sum up to 1. */
uniform highp sampler2D weave_cells;
uniform highp sampler2DArray weave_colors;

/* Places of cloth_numbers (raster/cloths.h), behind the yarns. */
const int CLOTH_SEED = 42, CLOTH_LOW = 43, CLOTH_HIGH = 44, CLOTH_OPENNESS = 45, CLOTH_WARPS = 46, CLOTH_PICKS = 47,
          CLOTH_FAR_WIDTH = 48, CLOTH_FAR_HEIGHT = 49, CLOTH_PER_U = 50, CLOTH_PER_V = 51;

float weave_number(int k) { return material_weave[k / 4][k - 4 * (k / 4)]; }

/* Table 0 is the runs, 1 the albedos. */
float weave_fetch(int table, int row, int column) {
    int warps = int(weave_number(CLOTH_WARPS)), picks = int(weave_number(CLOTH_PICKS));
    int k = table == 0 ? column - 4 * (column / 4) : column;
    ivec2 at = table == 0 ? ivec2(column / 4, row) : ivec2(row - warps * (row / warps), picks + row / warps);
    return texelFetch(weave_cells, at, 0)[k];
}

#include "shading/weave_base.h"

/* Each takes its numbers from the k-th on, which moves behind them. */
#define WEAVE_TAKE(name) taken.name = weave_number(k++);
WeaveYarn weave_yarn_from(inout int k) {
    WeaveYarn taken;
    WEAVE_YARN_NUMBERS(WEAVE_TAKE)
    return taken;
}

WeaveFar weave_far_from(inout int k) {
    WeaveFar taken;
    WEAVE_FAR_NUMBERS(WEAVE_TAKE)
    return taken;
}

Weave material_cloth() {
    Weave m;
    m.warps = int(weave_number(CLOTH_WARPS));
    m.picks = int(weave_number(CLOTH_PICKS));
    int k = 0;
    m.warp = weave_yarn_from(k);
    m.weft = weave_yarn_from(k);
    m.seed = weave_number(CLOTH_SEED);
    m.warp_far = weave_far_from(k);
    m.weft_far = weave_far_from(k);
    m.low = weave_number(CLOTH_LOW);
    m.high = weave_number(CLOTH_HIGH);
    m.openness = weave_number(CLOTH_OPENNESS);
    m.cycle_x = 0.0;
    m.cycle_y = 0.0;
    m.runs = 0;
    m.albedos = 1;
    return m;
}

/* One system from afar. Two bases stand for the cloth, each with half of the weight: so it reflects twice as much. All
 * bases have one table for the light of the environment, so that the lobe is of a whole cloth. Departure: then only
 * yarns of its own system hide it, which at grazing are not all. */
WeaveBase woven_far(Weave c, bool weft, vec2 place, WeaveFootprint f) {
    float warps = weave_number(CLOTH_WARPS), picks = weave_number(CLOTH_PICKS), layer = weft ? 2.0 : 0.0;
    float level = weave_far_level(f, 2.0 * warps / weave_number(CLOTH_FAR_WIDTH), 2.0 * picks / weave_number(CLOTH_FAR_HEIGHT));
    vec2 at = vec2(place.x / warps, place.y / picks);
    vec4 once = textureLod(weave_colors, vec3(at, layer), level);
    vec4 again = textureLod(weave_colors, vec3(at, layer + 1.0), level);
    float dye = weave_far_dye(c, weft, weft ? place.y : place.x, weft ? f.y : f.x);
    float scale = MATERIAL_HOLED ? 2.0 / max(c.warp_far.share + c.weft_far.share, 1e-3) : 2.0;
    WeaveBase b = weave_far(c, weft, rgb(once.r, once.g, once.b), rgb(again.r, again.g, again.b), once.a, dye);
    scale = scale * b.lobe.params[WOVEN_SHARE];
    b.lobe.params[WOVEN_SHARE] = 1.0;
    b.once = rgb_scale(b.once, scale);
    b.again = rgb_scale(b.again, scale);
    return b;
}

/* In the place of the stack's base. */
Stack woven_stack(Stack m, WeaveBase b) {
    Stack n = m;
    n.diffuse.lobe = b.lobe;
    n.diffuse.f0 = b.once;
    n.diffuse.f90 = b.again;
    n.diffuse.normal = max(0.33 * rgb_mean(b.once) + 0.67 * rgb_mean(b.again), 1e-3);
    n.diffuse.grazing = n.diffuse.normal;
    n.base_fresnel = BASE_FRESNEL_NONE;
    diffuse_prepare(n.diffuse.lobe, n.diffuse_prepared);
    return n;
}

/* rgb: the light; a: the part of the pixel that threads cover. */
vec4 woven_light(Stack m, Dir o, Facing at, Frame frame, float occlusion) {
    Weave c = material_cloth();
    vec2 place = vec2(texcoord_0.x * weave_number(CLOTH_PER_U), -texcoord_0.y * weave_number(CLOTH_PER_V));
    vec2 across = dFdx(place), up = dFdy(place);
    WeaveFootprint f = weave_footprint(across.x, across.y, up.x, up.y);
    float far = weave_far_weight(f), covered = 0.0;
    int side = far >= 1.0 ? 0 : f.longest < 0.2 ? 1 : f.longest < 0.6 ? 2 : 3;
    int points = side * side, count = far > 0.0 ? points + 2 : points;
    Rgb sum = rgb_grey(0.0);
    for (int k = 0; k < count; k++) {
        WeaveBase b;
        float weight = 0.5 * far;
        if (k < points) {
            float n = float(side), i = float(k - side * (k / side)), j = float(k / side);
            vec2 from = vec2((i + (j + 0.5) / n) / n - 0.5, (j + (i + 0.5) / n) / n - 0.5);
            vec2 spot = place + from.x * across + from.y * up;
            WeavePoint p = weave_point(c, spot.x, spot.y);
            b = weave_near(c, p);
            weight = (1.0 - far) / (n * n);
            covered = covered + (p.height > WEAVE_NONE ? weight : 0.0);
        } else {
            b = woven_far(c, k > points, place, f);
            covered = covered + weight;
        }
        sum = rgb_add(sum, rgb_scale(stack_light(woven_stack(m, b), o, at, frame, occlusion), weight));
    }
    if (MATERIAL_HOLED) sum = rgb_scale(sum, 1.0 / max(covered, 1e-3));
    return vec4(vec_of(sum), MATERIAL_HOLED ? covered : 1.0);
}
