/* table.h - directional albedo looked up: weft's own tables and those that engines ship
 *
 * A map has cos_o along its columns and one shape parameter down its `rows` rows. A table is one map or more, one below
 * the other. Texels are fetched one by one and interpolated here, so that C and GPU agree: a GPU's filter has 8 bits of
 * fraction.
 *
 * If fibres lean, E depends on the azimuth too. Then five more maps follow, for the headings -1, -1/2, 0, 1/2 and 1
 * (nap.h: 1 is along the nap, 0 across it). If a texture scales the tilt, there are five sets of five, for 0, 1/16,
 * 1/4, 9/16 and 1 times the greatest tilt. */
#pragma once

#include "shading/dialect/tint.h"
#include "shading/lobe/nap.h"

#define TABLE_NONE 0 /* E is 0 */
/* weft's own, bicubic. Columns are uniform in y, cos_o = (1 - (1 - y)^2)^4; rows in the parameter's eighth root. */
#define TABLE_ROOTS  1
#define TABLE_LINEAR 2 /* an engine's, bilinear: texel centres uniform in cos_o and in the parameter */
#define TABLE_TINTED 3 /* as TABLE_ROOTS; the maps s, q and e of the tint (albedo.h) follow that of E */
#define TABLE_PLANES 4 /* read by a lobe's own code, one plane after another (lobe_tables.h) */

#define TABLE_HEADINGS 5
#define TABLE_TILTS    5

STRUCT(TableRef) {
    Table texels;
    int kind;
    int rows, columns; /* of a map; weft's own have one column more, the average of each row over wo */
    float low, high;   /* weft's: eighth roots of the parameter in the first and the last row */
    int tilts;         /* number of tilts with maps by heading: 0 (no fibres lean), 1 or TABLE_TILTS */
    float tilt;        /* the greatest tilt, radians */
};

/* Weights of four neighbouring nodes: the cubic whose slope at a node is that of the line through its two neighbours.
 * At an end of the table a parabola extrapolates the missing node. Edwin Catmull, Raphael Rom, "A Class of Local
 * Interpolating Splines", 1974. */
STRUCT(Taps) {
    int first;
    float a, b, c, d; /* weights of nodes first .. first + 3 */
};

/* Returns the four nodes around a position and their weights. x: the position, in nodes. count: number of nodes, at
 * least 4. */
FN Taps table_taps(float x, int count) {
    float k = clamp(floor(x), 0.0f, to_float(count - 2));
    float t = clamp(x - k, 0.0f, 1.0f), s = 1.0f - t;
    float a = -0.5f * t * s * s, d = -0.5f * t * t * s;
    float b = s * (1.0f + t - 1.5f * t * t), c = t * (1.0f + s - 1.5f * s * s);
    int first = to_int(k); /* any number if x is NaN, hence the bounds of m.first */
    Taps m;
    m.first = first < 1 ? 0 : first > count - 3 ? count - 4 : first - 1;
    m.a = a;
    m.b = b;
    m.c = c;
    m.d = d;
    if (k < 0.5f) {
        m.a = b + 3.0f * a;
        m.b = c - 3.0f * a;
        m.c = d + a;
        m.d = 0.0f;
    } else if (k > to_float(count - 2) - 0.5f) {
        m.a = 0.0f;
        m.b = a + d;
        m.c = b - 3.0f * d;
        m.d = c + 3.0f * d;
    }
    return m;
}

/* Returns a row of a map, interpolated between columns. */
FN float table_row(TableRef m, int row, Taps x) {
    return x.a * table_texel(m.texels, m.columns + 1, row, x.first) +
           x.b * table_texel(m.texels, m.columns + 1, row, x.first + 1) +
           x.c * table_texel(m.texels, m.columns + 1, row, x.first + 2) +
           x.d * table_texel(m.texels, m.columns + 1, row, x.first + 3);
}

/* Returns the position of parameter p among the rows: 0 is the first. */
FN float table_height(TableRef m, float p) {
    float root = sqrt(sqrt(sqrt(max(p, 0.0f))));
    return m.rows > 1 ? (root - m.low) / (m.high - m.low) * to_float(m.rows - 1) : 0.0f;
}

/* A position in weft's maps: x from the cosine, y from the parameter. */
STRUCT(TablePlace) { Taps x, y; };

/* Returns the weights of the rows for parameter p, which serve all directions. */
FN Taps table_rows(TableRef m, float p) { return table_taps(table_height(m, p), m.rows < 4 ? 4 : m.rows); }

/* Returns the position of cos_o in weft's maps, in rows of those weights. */
FN TablePlace table_place(TableRef m, float cos_o, Taps rows) {
    float y_o = 1.0f - sqrt(max(1.0f - sqrt(sqrt(max(cos_o, 0.0f))), 0.0f));
    TablePlace at;
    at.x = table_taps(y_o * to_float(m.columns - 1), m.columns);
    at.y = rows;
    return at;
}

/* Returns a map at a position. */
FN float table_map(TableRef m, int map, TablePlace at) {
    if (m.rows < 2) return table_row(m, map, at.x);
    int row = map * m.rows + at.y.first;
    return at.y.a * table_row(m, row, at.x) + at.y.b * table_row(m, row + 1, at.x) +
           at.y.c * table_row(m, row + 2, at.x) + at.y.d * table_row(m, row + 3, at.x);
}

/* Returns E from one of weft's own tables. */
FN float table_roots(TableRef m, float cos_o, float p) {
    return max(table_map(m, 0, table_place(m, cos_o, table_rows(m, p))), 0.0f);
}

/* Returns the cosine-weighted average over wo of a map: of E, if it is the first. */
FN float table_map_average(TableRef m, int map, Taps y) {
    if (m.rows < 2) return table_texel(m.texels, m.columns + 1, map, m.columns);
    int row = map * m.rows + y.first;
    return y.a * table_texel(m.texels, m.columns + 1, row, m.columns) +
           y.b * table_texel(m.texels, m.columns + 1, row + 1, m.columns) +
           y.c * table_texel(m.texels, m.columns + 1, row + 2, m.columns) +
           y.d * table_texel(m.texels, m.columns + 1, row + 3, m.columns);
}

/* Returns E from an engine's table, which is bilinear. */
FN float table_linear(TableRef m, float cos_o, float p) {
    float x = clamp(cos_o * to_float(m.columns) - 0.5f, 0.0f, to_float(m.columns - 1));
    float y = clamp(p * to_float(m.rows) - 0.5f, 0.0f, to_float(m.rows - 1));
    float x0 = min(floor(x), to_float(m.columns - 2)), y0 = min(floor(y), to_float(m.rows - 2));
    int j = to_int(y0), k = to_int(x0);
    float low = mix(table_texel(m.texels, m.columns, j, k), table_texel(m.texels, m.columns, j, k + 1), x - x0);
    float high =
        mix(table_texel(m.texels, m.columns, j + 1, k), table_texel(m.texels, m.columns, j + 1, k + 1), x - x0);
    return mix(low, high, y - y0);
}

/* A shader whose kind of table is fixed defines these as constants. */
#ifndef SHEEN_KIND
#define SHEEN_KIND(m)  (m).kind
#define SHEEN_TILTS(m) (m).tilts
#endif

/* E of a white sheen, and the tint by which E of another colour differs (tint.h). With tint_none, E of a sheen of
 * colour c is e c. */
STRUCT(SheenE) {
    float e;
    Tint tint;
};

FN SheenE sheen_e_of(float e) {
    SheenE x;
    x.e = e;
    x.tint = tint_none();
    return x;
}

/* Works as sheen_e_of, with the tint from a table's maps s, q and e. rest: e of the tint. */
FN SheenE sheen_e_tinted(float e, float s, float q, float rest) {
    SheenE x;
    x.e = e;
    x.tint.s = clamp(s, 0.0f, 1.0f);
    x.tint.q_o = clamp(q, 0.0f, 1.0f);
    x.tint.q_i = x.tint.q_o;
    x.tint.e = rest;
    return x;
}

/* Returns E of a sheen of that colour, divided by the colour. */
FN float sheen_e_in(SheenE x, float color) {
    return IS_TINTED(x.tint) ? x.e * tint_color(x.tint, color) / max(color, 1e-6f) : x.e;
}

/* Tests whether the table is weft's own. Only those store averages and are read with table_rows. */
#define SHEEN_IS_OWN(m) (SHEEN_KIND(m) == TABLE_ROOTS || SHEEN_KIND(m) == TABLE_TINTED)

/* Returns E and tint at a position, without regard to the heading. */
FN SheenE table_sheen_at(TableRef m, TablePlace at) {
    float e = max(table_map(m, 0, at), 0.0f);
    if (SHEEN_KIND(m) != TABLE_TINTED) return sheen_e_of(e);
    return sheen_e_tinted(e, table_map(m, 1, at), table_map(m, 2, at), table_map(m, 3, at));
}

/* Returns E from an engine's table. p: the parameter as that engine defines it. */
FN float table_engine(TableRef m, float cos_o, float p) {
    return SHEEN_KIND(m) == TABLE_LINEAR ? table_linear(m, cos_o, p) : 0.0f;
}

/* Returns E of the sheen at cos_o, for parameter p of the lobe. */
FN SheenE table_sheen(TableRef m, float cos_o, float p) {
    if (!SHEEN_IS_OWN(m)) return sheen_e_of(table_engine(m, cos_o, p));
    return table_sheen_at(m, table_place(m, cos_o, table_rows(m, p)));
}
/* Returns E from any table, whether it is the sheen's or not. */
FN float table_albedo(TableRef m, float cos_o, float p) {
    if (m.kind == TABLE_LINEAR) return table_linear(m, cos_o, p);
    if (m.kind == TABLE_NONE) return 0.0f;
    return table_roots(m, cos_o, p);
}

/* Returns the index of the first map for headings. */
FN int table_headings(TableRef m) { return SHEEN_KIND(m) == TABLE_TINTED ? 4 : 1; }

/* Returns the position of a tilt among the tilts that have maps. These are uniform in the root of the tilt, since E
 * changes fastest as fibres begin to lean. */
FN Taps table_tilt(TableRef m, float tilt) {
    return table_taps(sqrt(max(tilt, 0.0f) / m.tilt) * to_float(SHEEN_TILTS(m) - 1), SHEEN_TILTS(m));
}

/* Returns E at a heading, from the five maps of one tilt. map: the first of these. */
FN float table_at_heading(TableRef m, int map, Taps heading, TablePlace at) {
    int k = map + heading.first;
    return heading.a * table_map(m, k, at) + heading.b * table_map(m, k + 1, at) + heading.c * table_map(m, k + 2, at) +
           heading.d * table_map(m, k + 3, at);
}

/* Returns E of leaning fibres, interpolated between headings and, if there are several, tilts. */
FN float table_leaning(TableRef m, Nap nap, float heading, TablePlace at) {
    Taps h = table_taps((0.5f + 0.5f * heading) * to_float(TABLE_HEADINGS - 1), TABLE_HEADINGS);
    int map = table_headings(m);
    if (SHEEN_TILTS(m) < 2) return table_at_heading(m, map, h, at);
    Taps t = table_tilt(m, nap.tilt);
    map = map + TABLE_HEADINGS * t.first;
    return t.a * table_at_heading(m, map, h, at) + t.b * table_at_heading(m, map + TABLE_HEADINGS, h, at) +
           t.c * table_at_heading(m, map + 2 * TABLE_HEADINGS, h, at) +
           t.d * table_at_heading(m, map + 3 * TABLE_HEADINGS, h, at);
}

/* Returns E towards w of a sheen with a nap, from one of weft's tables. rows: table_rows of the parameter. The tint is
 * that of a direction across the nap. */
FN SheenE table_sheen_nap(TableRef m, Dir w, Nap nap, Taps rows) {
    TablePlace at = table_place(m, w.z, rows);
    SheenE x = table_sheen_at(m, at);
    if (SHEEN_TILTS(m) > 0) x.e = clamp(table_leaning(m, nap, nap_heading(nap, w), at), 0.0f, 1.0f);
    return x;
}

/* Returns the cosine-weighted average of E, 2 integral of E(mu) mu dmu; 0 if the table is an engine's. */
FN SheenE table_sheen_average(TableRef m, Taps rows) {
    if (!SHEEN_IS_OWN(m)) return sheen_e_of(0.0f);
    float e = max(table_map_average(m, 0, rows), 0.0f);
    if (SHEEN_KIND(m) != TABLE_TINTED) return sheen_e_of(e);
    return sheen_e_tinted(e, table_map_average(m, 1, rows), table_map_average(m, 2, rows),
                          table_map_average(m, 3, rows));
}

/* Works as table_sheen_average, for a sheen with a nap: E is averaged over azimuths too. Every map of a tilt stores
 * it. */
FN SheenE table_sheen_nap_average(TableRef m, Nap nap, Taps rows) {
    SheenE x = table_sheen_average(m, rows);
    if (!SHEEN_IS_OWN(m) || SHEEN_TILTS(m) < 1) return x;
    int map = table_headings(m);
    x.e = table_map_average(m, map, rows);
    if (SHEEN_TILTS(m) > 1) {
        Taps t = table_tilt(m, nap.tilt);
        map = map + TABLE_HEADINGS * t.first;
        x.e = t.a * table_map_average(m, map, rows) + t.b * table_map_average(m, map + TABLE_HEADINGS, rows) +
              t.c * table_map_average(m, map + 2 * TABLE_HEADINGS, rows) +
              t.d * table_map_average(m, map + 3 * TABLE_HEADINGS, rows);
    }
    x.e = clamp(x.e, 0.0f, 1.0f);
    return x;
}
