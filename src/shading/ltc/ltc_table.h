/* ltc_table.h - the linearly transformed cosine of a lobe looked up
 *
 * Planes of rows below each other, one plane a channel. Columns run from grazing to normal incidence, uniform
 * in the root of cos_o; rows over one shape parameter, uniform in its root, which for alpha = roughness^2 is
 * the roughness. Mixed linearly, which keeps z > 0, q >= 0 and r >= 0; a function of cos_o is flat in o at
 * normal incidence, so the mixing makes no edge there. */
#pragma once

#include "shading/lobe/table.h"
#include "shading/ltc/ltc.h"

/* The planes, in their order: of ltc_of, then what f0 and f90 are multiplied by. */
#define LTC_Z             0
#define LTC_Q             1
#define LTC_B             2
#define LTC_R             3
#define LTC_AMPLITUDE     4
#define LTC_AMPLITUDE_F90 5

STRUCT(LtcTable) {
    Table texels;
    int rows, columns; /* of a plane; columns >= 2 */
    float low, high;   /* roots of the parameter in the first and the last row */
};

/* A position between four neighbouring nodes. */
STRUCT(LtcSpot) {
    int row, below, column;
    float x, y;
};

/* f cos_i = (f0 white + f90 grazing) ltc_pdf(m, ..) */
STRUCT(LtcLobe) {
    Ltc m;
    float f0, f90;
};

/* Returns the position at the fractions `along` of the columns and `down` of the rows, both in [0, 1]. */
FN LtcSpot ltc_table_spot_at(LtcTable t, float along, float down) {
    float x = along * to_float(t.columns - 1), y = down * to_float(t.rows - 1);
    float left = clamp(floor(x), 0.0f, to_float(t.columns - 2));
    float top = clamp(floor(y), 0.0f, to_float(t.rows - 1));
    LtcSpot s;
    s.column = to_int(left);
    s.row = to_int(top);
    s.below = s.row + 1 < t.rows ? s.row + 1 : s.row;
    s.x = x - left;
    s.y = y - top;
    return s;
}

FN LtcSpot ltc_table_spot(LtcTable t, float cos_o, float p) {
    float y = t.rows > 1 ? clamp((sqrt(max(p, 0.0f)) - t.low) / (t.high - t.low), 0.0f, 1.0f) : 0.0f;
    return ltc_table_spot_at(t, sqrt(clamp(cos_o, 0.0f, 1.0f)), y);
}

FN float ltc_table_interpolate(LtcTable t, LtcSpot s, int plane) {
    int row = plane * t.rows + s.row, below = plane * t.rows + s.below;
    float a =
        mix(table_texel(t.texels, t.columns, row, s.column), table_texel(t.texels, t.columns, row, s.column + 1), s.x);
    float b = mix(table_texel(t.texels, t.columns, below, s.column),
                  table_texel(t.texels, t.columns, below, s.column + 1), s.x);
    return mix(a, b, s.y);
}

/* Returns the lobe for a wo of that cosine and parameter p. */
FN LtcLobe ltc_table_at(LtcTable t, float cos_o, float p) {
    LtcSpot s = ltc_table_spot(t, cos_o, p);
    LtcLobe l;
    l.m = ltc_of(ltc_table_interpolate(t, s, LTC_Z), ltc_table_interpolate(t, s, LTC_Q),
                 ltc_table_interpolate(t, s, LTC_B), ltc_table_interpolate(t, s, LTC_R), cos_o);
    l.f0 = ltc_table_interpolate(t, s, LTC_AMPLITUDE);
    l.f90 = ltc_table_interpolate(t, s, LTC_AMPLITUDE_F90);
    return l;
}

/* The planes of a table with r = 0 (weft/ltc.h), the others in the same order. */
#define LTC_LEVEL_E      3
#define LTC_LEVEL_PLANES 4

/* Returns a lobe's own table, which has that many planes. */
FN LtcTable ltc_table_of(TableRef e, int planes) {
    LtcTable t;
    t.texels = e.texels;
    t.rows = e.rows / planes;
    t.columns = e.columns;
    t.low = e.low;
    t.high = e.high;
    return t;
}

FN LtcLobe ltc_table_level(TableRef e, float cos_o, float p) {
    LtcTable t = ltc_table_of(e, LTC_LEVEL_PLANES);
    LtcSpot s = ltc_table_spot(t, cos_o, p);
    LtcLobe l;
    l.m = ltc_of(ltc_table_interpolate(t, s, LTC_Z), ltc_table_interpolate(t, s, LTC_Q),
                 ltc_table_interpolate(t, s, LTC_B), 0.0f, cos_o);
    l.f0 = ltc_table_interpolate(t, s, LTC_LEVEL_E);
    l.f90 = 0.0f;
    return l;
}

/* The planes of a published one: a and b of M^-1 = (a 0 b, 0 a 0, 0 0 1), x along wo, and R (lobe
 * ltc-fibre-published). Nodes are uniform in cos_o and in alpha, and a, b and R are mixed linearly, as its authors
 * do. */
#define LTC_PUBLISHED_A      0
#define LTC_PUBLISHED_B      1
#define LTC_PUBLISHED_R      2
#define LTC_PUBLISHED_PLANES 3

/* Returns the lobe from a published table. M^-1 / a is that of ltc_of with z = 1 / a, q = 1 and b / (a s). b goes as
 * s^2 towards the normal; the floors prevent 0 / 0 in 16 bits. */
FN LtcLobe ltc_table_published(TableRef e, float cos_o, float alpha) {
    LtcTable t = ltc_table_of(e, LTC_PUBLISHED_PLANES);
    float c = clamp(cos_o, 0.0f, 1.0f), s = sqrt(max(1.0f - c * c, 1e-4f));
    LtcSpot at = ltc_table_spot_at(t, c, clamp(alpha, 0.0f, 1.0f));
    float a = max(ltc_table_interpolate(t, at, LTC_PUBLISHED_A), 1e-3f);
    LtcLobe l;
    l.m = ltc_of(1.0f / a, 1.0f, ltc_table_interpolate(t, at, LTC_PUBLISHED_B) / (a * s), 0.0f, cos_o);
    l.f0 = ltc_table_interpolate(t, at, LTC_PUBLISHED_R);
    l.f90 = 0.0f;
    return l;
}
