/* ambient_table.h - a lobe's albedo and shape, looked up for image-based lighting (ambient_lobe.h)
 *
 * ambient_fit.h makes the table of any lobe. Over cos_o and the lobe's first parameter, which is alpha in most lobes,
 * it stores the directional albedo E, its division among the four look-ups of the residual, and the mean direction
 * and width of the lobe. The nodes are uniform in the square root of the parameter and in y, with
 * cos_o = (1 - (1 - y)^2)^2.
 *
 * If no texture changes the parameter, the table is baked. Its one row then becomes polynomials, which a shader reads
 * from uniforms instead of a texture:
 *
 *   entry(y) = sum_k c_k (2 y - 1)^k,  k = 0 .. AMBIENT_DEGREE
 *
 * Departure: a lobe that depends on the azimuth of wo has five sets of entries only, for wo along the nap, across it,
 * against it, and midway. Between two of them entries are linear in the square of the heading (nap.h). */
#pragma once

#include "shading/ambient/ambient_source.h"

/* A table consists of planes of `rows` rows each. Four planes make a group:
 *
 *   FIRST    first colour: w_1 / E, w_2 / E, w_3 / E, E. These ratios stay smooth where E goes to 0.
 *   SHAPE    the sine of the angle between the normal and the lobe's mean direction, positive towards wo;
 *            log2 of the lobe's kappa; its tail, 0 for a Gaussian and 1 for ggx; log2 of the kappa of a
 *            single-axis lobe with the same density as this lobe (for AmbientFit.denser)
 *   SECOND   second colour: w_0, w_1, w_2, w_3. A tinted lobe has none: its w_0 is s of its tint (tint.h), which is the
 *            mean of s over the light that it reflects, and the rest is 0.
 *
 * The plane after the groups is E of the second colour. */
#define AMBIENT_GROUP_FIRST  0
#define AMBIENT_GROUP_SHAPE  1
#define AMBIENT_GROUP_SECOND 2
#define AMBIENT_GROUPS       3
#define AMBIENT_PLANES       13

#define AMBIENT_PLANE_E        3
#define AMBIENT_PLANE_E_SECOND 12

#define AMBIENT_DEGREE   9
#define AMBIENT_HEADING  (3 * (AMBIENT_DEGREE + 1)) /* coefficients of one heading */
#define AMBIENT_HEADINGS 5                          /* azimuths of wo, 45 degrees from one to the next */
#define AMBIENT_BAKED    (AMBIENT_HEADINGS * AMBIENT_HEADING)

/* The table of one slot's lobe. */
STRUCT(AmbientTable) {
    Table texels;
    int rows, columns; /* of a plane; rows is 1 if the table is baked */
    float low, high;   /* square roots of the parameter in the first and the last row */
    bool focus;        /* some entries are too narrow for the four look-ups of the residual */
    bool narrow;       /* some entries are too narrow for the lights too */
    bool second;       /* the lobe has a second colour */
    bool lossless;     /* E is 1 everywhere */
    bool strips;       /* the lobe has lobe_strip */
    bool by_azimuth;   /* the lobe depends on azimuth: AMBIENT_HEADINGS headings of entries follow each other */
    int strategy;      /* one of the AMBIENT_... of ambient_lobe.h */
    int baked;         /* index of the first coefficient; negative if the table is not baked */
};

STRUCT(AmbientTables) { AmbientTable diffuse, specular, sheen, coat, dust; };

/* A position in a table. */
STRUCT(AmbientCoord) {
    int row, column;                     /* the nodes before the position */
    float row_fraction, column_fraction; /* from these nodes to the next, 0 to 1 */
    int outer, inner;   /* numbers of the headings beside that of wo: inner is nearer to across the nap */
    float outer_weight; /* of the outer heading; the rest is the inner one's */
    float t;            /* 2 y - 1, for polynomials */
};

/* Returns the position of cos_o and parameter p. heading: cosine of the azimuth of wo from that of the lobe (nap.h). */
FN AmbientCoord ambient_coord(AmbientTable t, float cos_o, float heading, float p) {
    AmbientCoord at;
    float y = 1.0f - sqrt(max(1.0f - sqrt(clamp(cos_o, 0.0f, 1.0f)), 0.0f)), x = y * to_float(t.columns - 1);
    float left = clamp(floor(x), 0.0f, to_float(t.columns - 2));
    float h = heading * heading;
    int steps = h < 0.5f ? 1 : 2; /* of the outer heading from across the nap */
    at.outer = heading < 0.0f ? 2 + steps : 2 - steps;
    at.inner = heading < 0.0f ? at.outer - 1 : at.outer + 1;
    at.outer_weight = h < 0.5f ? 2.0f * h : 2.0f * h - 1.0f;
    at.t = 2.0f * y - 1.0f;
    at.column = to_int(left);
    at.column_fraction = clamp(x - left, 0.0f, 1.0f);
    at.row = 0;
    at.row_fraction = 0.0f;
    if (t.rows > 1) {
        float row = (sqrt(max(p, 0.0f)) - t.low) / (t.high - t.low) * to_float(t.rows - 1);
        float top = clamp(floor(row), 0.0f, to_float(t.rows - 2));
        at.row = to_int(top);
        at.row_fraction = clamp(row - top, 0.0f, 1.0f);
    }
    return at;
}

FN float ambient_row(AmbientTable t, AmbientCoord at, int row) {
    return mix(table_texel(t.texels, t.columns, row, at.column), table_texel(t.texels, t.columns, row, at.column + 1),
               at.column_fraction);
}

FN float ambient_plane(AmbientTable t, AmbientCoord at, int plane) {
    int row = plane * t.rows + at.row;
    float a = ambient_row(t, at, row);
    if (t.rows < 2) return a;
    return mix(a, ambient_row(t, at, row + 1), at.row_fraction);
}

FN float ambient_entry(AmbientTable t, AmbientCoord at, int plane) {
    if (!t.by_azimuth) return ambient_plane(t, at, plane);
    return mix(ambient_plane(t, at, at.inner * AMBIENT_PLANES + plane),
               ambient_plane(t, at, at.outer * AMBIENT_PLANES + plane), at.outer_weight);
}

FN AmbientWeights ambient_weights(float a, float b, float c, float d) {
    AmbientWeights w;
    w.a = a;
    w.b = b;
    w.c = c;
    w.d = d;
    return w;
}
FN AmbientWeights ambient_weights_mix(AmbientWeights x, AmbientWeights y, float t) {
    return ambient_weights(mix(x.a, y.a, t), mix(x.b, y.b, t), mix(x.c, y.c, t), mix(x.d, y.d, t));
}
FN float ambient_weights_sum(AmbientWeights w) { return w.a + w.b + w.c + w.d; }

FN AmbientWeights ambient_polynomial(AmbientSource s, int first, float t) {
    AmbientWeights w = ambient_baked(s, first + AMBIENT_DEGREE);
    for (int k = AMBIENT_DEGREE - 1; k >= 0; k--) {
        AmbientWeights c = ambient_baked(s, first + k);
        w = ambient_weights(w.a * t + c.a, w.b * t + c.b, w.c * t + c.c, w.d * t + c.d);
    }
    return w;
}

/* Clamps values of the polynomials to the range that tables have. Near 0 a polynomial oscillates, but w_k and
 * E are never negative. Where E is almost 0, log2 kappa is arbitrary and stays within -2 to 22. */
FN AmbientWeights ambient_clamp_weights(AmbientWeights w, int group) {
    if (group == AMBIENT_GROUP_SHAPE) return ambient_weights(w.a, clamp(w.b, -2.0f, 22.0f), w.c, w.d);
    return ambient_weights(max(w.a, 0.0f), max(w.b, 0.0f), max(w.c, 0.0f), max(w.d, 0.0f));
}

FN AmbientWeights ambient_baked_group(AmbientTable t, AmbientSource s, AmbientCoord at, int group) {
    int first = t.baked + (AMBIENT_DEGREE + 1) * group;
    if (!t.by_azimuth) return ambient_clamp_weights(ambient_polynomial(s, first, at.t), group);
    AmbientWeights inner = ambient_polynomial(s, first + at.inner * AMBIENT_HEADING, at.t),
                   outer = ambient_polynomial(s, first + at.outer * AMBIENT_HEADING, at.t);
    return ambient_clamp_weights(ambient_weights_mix(inner, outer, at.outer_weight), group);
}

/* Returns the four planes of a group. */
FN AmbientWeights ambient_group(AmbientTable t, AmbientSource s, AmbientCoord at, int group) {
    if (t.baked >= 0) return ambient_baked_group(t, s, at, group);
    return ambient_weights(ambient_entry(t, at, 4 * group), ambient_entry(t, at, 4 * group + 1),
                           ambient_entry(t, at, 4 * group + 2), ambient_entry(t, at, 4 * group + 3));
}

/* Returns the tint of the light that a tinted lobe reflects to a wo of that heading. Of a lobe with a nap s depends on
 * the heading: against the nap most light meets one fibre, along it several. q and e hardly do, and stay those of
 * `tint`, which are across the nap. */
FN Tint ambient_tint_at(AmbientTable t, AmbientSource s, AmbientCoord at, Tint tint) {
    Tint x = tint;
    if (IS_TINTED(tint) && t.by_azimuth && !t.second)
        x.s = clamp(ambient_group(t, s, at, AMBIENT_GROUP_SECOND).a, 0.0f, 1.0f);
    return x;
}

/* E of a lobe's two colours, and its division among the four look-ups. */
STRUCT(AmbientAlbedo) {
    float first, second;
    AmbientWeights first_weights, second_weights; /* only ratios count; `first` and `second` have the scale */
};

/* Returns E and its division from the table. albedo: E of both colours together if the caller has a more exact one than
 * this table, otherwise negative. */
FN AmbientAlbedo ambient_albedo(AmbientTable t, AmbientSource s, AmbientCoord at, float albedo) {
    AmbientAlbedo e;
    AmbientWeights w = ambient_group(t, s, at, AMBIENT_GROUP_FIRST);
    e.second_weights = ambient_weights(0.0f, 0.0f, 0.0f, 0.0f);
    if (t.second) e.second_weights = ambient_group(t, s, at, AMBIENT_GROUP_SECOND);
    e.first = t.lossless ? 1.0f : w.d;
    e.second = ambient_weights_sum(e.second_weights);
    e.first_weights = ambient_weights(max(1.0f - w.a - w.b - w.c, 0.0f), w.a, w.b, w.c);
    if (albedo >= 0.0f) {
        float part = e.second / max(e.first + e.second, 1e-20f);
        e.first = albedo * (1.0f - part);
        e.second = albedo * part;
    }
    return e;
}
