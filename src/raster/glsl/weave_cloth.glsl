/* weave_cloth.glsl - the cloth of a woven material, from its numbers and its texture of runs and albedos */
uniform highp sampler2D weave_cells;

#include "shading/weave/weave_cell.h"

/* Indices in cloth_numbers (raster/material/cloths.h), after the yarns. */
const int CLOTH_SEED = 72, CLOTH_LOW = 73, CLOTH_HIGH = 74, CLOTH_OPENNESS = 75, CLOTH_WARPS = 76, CLOTH_PICKS = 77,
          CLOTH_FAR_WIDTH = 78, CLOTH_FAR_HEIGHT = 79, CLOTH_PER_U = 80, CLOTH_PER_V = 81, CLOTH_ROTATION_COS = 82,
          CLOTH_ROTATION_SIN = 83;

float weave_number(int k) { return material_weave[k / 4][k - 4 * (k / 4)]; }

/* Returns a cell of the runs. */
WeaveCell weave_fetch_cell(int row, int at) {
    vec4 c = texelFetch(weave_cells, ivec2(at, row), 0);
    return WeaveCell(c.x, c.y, c.z, c.w);
}

/* Returns a channel of an albedo. The row is divided as a float, which is exact up to 2^22 threads, since software
 * drivers divide integers pixel by pixel. */
float weave_fetch(int row, int channel) {
    int warps = int(weave_number(CLOTH_WARPS)), picks = int(weave_number(CLOTH_PICKS));
    int up = int((float(row) + 0.5) / float(warps));
    return texelFetch(weave_cells, ivec2(row - warps * up, picks + up), 0)[channel];
}

#include "shading/weave/weave_place.h"
#include "shading/weave/weave_point.h"

/* Return the yarn, or its numbers from afar, that begin at number k, and move k behind them. */
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

/* Returns the place of a fragment on the cloth, in warp threads from the left and picks from the bottom. */
vec2 weave_place() {
    WeavePlacing p = WeavePlacing(weave_number(CLOTH_PER_U), weave_number(CLOTH_PER_V),
                                  weave_number(CLOTH_ROTATION_COS), weave_number(CLOTH_ROTATION_SIN));
    Dir at = weave_place_of(p, texcoord_0.x, texcoord_0.y);
    return vec2(at.x, at.y);
}

/* Returns true if the fragment lies in a gap between threads. */
bool weave_is_gap() {
    vec2 place = weave_place();
    return weave_gap(material_cloth(), place.x, place.y);
}
