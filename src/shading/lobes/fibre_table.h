/* fibre-table - velvet, felt and fuzz as fibre has them, upright, its functions read from a table of 3 KB
 *
 *   f = f1 + M,  f1 = D(h) / 4 (1 - exp(-L / (mu_i mu_o))) / L                                   [1/sr]
 *   M = 2^(A_o + A_i + h_o h_i - g_o g_i - k_o k_i (wo . wi - mu_o mu_i)) (mu_o + mu_i + alpha / 5)^-p
 *   p = 1.4 - 2.5 log2 alpha;  D and L: those of fibre
 *
 *   The slab of Tizian Zeltner, Brent Burley, Matt Jen-Yuan Chiang, "Practical Multiple-Scattering Sheen
 * Using Linearly Transformed Cosines", SIGGRAPH Talks 2022. Departures: A, h, g and k, one texel for each
 * direction, are fitted to its solution as they are mixed between the nodes; fibres stand upright, and their
 * density is 1.
 *   The text below reads the table texel by texel, in 32 bits; an engine binds it as one filtered texture of
 * four half floats, at (23 / 24 x + 1 / 48, 15 / 16 y + 1 / 32) for 24 by 16 texels.
 *   color: a factor; that of fibre is not.
 *   roughness: alpha = roughness^2.
 *   reciprocal: yes.
 *   energy: E <= 1; what is missing goes through.
 *   sampling: that of fibre.
 *   measured by weft check fibre-table: E at most 0.77 (alpha 0.19, cos_o 0.001);
 *     reciprocal to 1e-3; weight variance under 0.01 of the cosine's;
 *     half precision: finite for cosines >= 2^-13. */
#pragma once

#include "shading/lobe/lobe_tables.h"
#include "shading/lobes/fibre.h"

#define FIBRE_TABLE_PARAMS(P)                                                                                          \
    P(float, alpha, 0.5f, 0.19f, 1.0f, 0.19f, 1.0f, "square root of what a fibre shows along its axis")
#define FIBRE_TABLE_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_TABLE)

/* A, h, g and k. */
#define FIBRE_TABLE_PLANES 4

STRUCT(FibreTable){FIBRE_TABLE_PARAMS(FIELD)};

/* Between four neighbouring nodes. */
STRUCT(FibreTableSpot) {
    TableRef t;
    int rows, row, column;
    float x, y;
};

/* Returns the place in [0, 1] among the columns, which are uniform in the root of mu + 0.001, from the
 * horizon on. */
FN float fibre_table_column(float mu) { return (sqrt(mu + 1e-3f) - 0.0316227766f) * 1.03212265f; }

/* Returns the cosine of a column, the inverse of fibre_table_column. */
FN float fibre_table_cosine(float column) {
    float root = column / 1.03212265f + 0.0316227766f;
    return root * root - 1e-3f;
}

FN float fibre_table_crease(FibreTable m, float cos_o, int k) {
    int last = lobe_table_fibre().columns - 1;
    return k + 1 < last ? fibre_table_cosine(to_float(k + 1) / to_float(last)) : 0.0f;
}

/* Returns the position of alpha and mu. Rows are uniform in the logarithm of alpha. */
FN FibreTableSpot fibre_table_spot(float alpha, float mu) {
    FibreTableSpot s;
    s.t = lobe_table_fibre();
    s.rows = s.t.rows / FIBRE_TABLE_PLANES;
    float x = fibre_table_column(mu) * to_float(s.t.columns - 1);
    float y = (log2(alpha) - s.t.low) / (s.t.high - s.t.low) * to_float(s.rows - 1);
    float left = clamp(floor(x), 0.0f, to_float(s.t.columns - 2));
    float top = clamp(floor(y), 0.0f, to_float(s.rows - 2));
    s.column = to_int(left);
    s.row = to_int(top);
    s.x = clamp(x - left, 0.0f, 1.0f);
    s.y = clamp(y - top, 0.0f, 1.0f);
    return s;
}

FN float fibre_table_interpolate(FibreTableSpot s, int plane) {
    int row = plane * s.rows + s.row, n = s.t.columns;
    float a = mix(table_texel(s.t.texels, n, row, s.column), table_texel(s.t.texels, n, row, s.column + 1), s.x);
    float b =
        mix(table_texel(s.t.texels, n, row + 1, s.column), table_texel(s.t.texels, n, row + 1, s.column + 1), s.x);
    return mix(a, b, s.y);
}

/* The result of one look-up. */
STRUCT(FibreTableSide) { float a, h, g, k; };

FN FibreTableSide fibre_table_side(float alpha, float mu) {
    FibreTableSpot s = fibre_table_spot(alpha, mu);
    FibreTableSide r;
    r.a = fibre_table_interpolate(s, 0);
    r.h = fibre_table_interpolate(s, 1);
    r.g = fibre_table_interpolate(s, 2);
    r.k = fibre_table_interpolate(s, 3);
    return r;
}

/* Returns M, the multiple scattering, 1/sr. */
FN float fibre_table_multiple(FibreTableSide o, FibreTableSide i, Dir wo, Dir wi, float alpha, float p) {
    float e = (o.a + i.a) + (o.h * i.h - o.g * i.g) - o.k * i.k * (wo.x * wi.x + wo.y * wi.y);
    return exp2(e - p * log2(wo.z + wi.z + 0.2f * alpha));
}

/* The fibres of lobe `fibre`, upright and of density 1. */
STRUCT(FibreTablePrepared) {
    FibreNap nap;
    FlakeUpright flake;
    float power;
};
FN void fibre_table_prepare(FibreTable m, FibreTablePrepared *p) {
    p->nap = fibre_nap_of(m.alpha, 0.0f, 0.0f);
    p->flake = flake_upright(m.alpha * m.alpha, 1.0f);
    p->power = 1.4f - 2.5f * log2(m.alpha);
}

STRUCT(FibreTableView) {
    Ltc ltc;
    FibreDraw draw;
    FibreTableSide side;
};
FN void fibre_table_view(const FibreTablePrepared *p, Dir o, FibreTableView *w) {
    w->ltc = fibre_ltc(p->nap.alpha, o.z);
    w->draw = fibre_draw(p->nap, o);
    w->side = fibre_table_side(p->nap.alpha, o.z);
}

FN LobeValue fibre_table_value(const FibreTablePrepared *p, const FibreTableView *w, Angles a) {
    FibreTableSide i = fibre_table_side(p->nap.alpha, a.i.z);
    float multiple = fibre_table_multiple(w->side, i, a.o, a.i, p->nap.alpha, p->power);
    return lobe_value_of(flake_single_upright(p->flake, a.o, a.i) + multiple, 0.0f,
                         fibre_sample_pdf(p->nap, w->draw, w->ltc, a));
}
FN Dir fibre_table_sample(const FibreTablePrepared *p, const FibreTableView *w, Dir o, float u, float v) {
    return fibre_direction(p->nap, w->draw, w->ltc, o, u, v);
}
FN Proxy fibre_table_proxy(FibreTable m) { return proxy_fibres(m.alpha); }
