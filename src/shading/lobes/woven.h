/* woven - the yarns of one direction in a woven cloth, from afar: streaks across the yarn on a soft ground
 *
 *   f = part (A <single> + rho(A) many)                                                           [1/sr]
 *   part: the share, of the cloth that these yarns cover
 *   <single>: the mean over slopes s_x = roundness r, s_y = tan(crimp) s |s|^(floats - 1), r and s in [-1, 1],
 *     with the weight 1 - 0.3 r^2
 *
 *   The yarn, its fibres and what hides it are those of shading/media/yarn_medium.h: flakes of Eric Heitz, Jonathan
 * Dupuy, Cyril Crassin, Carsten Dachsbacher, "The SGGX Microflake Distribution", ACM TOG 34(4), 2015, along
 * yarns as Piti Irawan, Steve Marschner, "Specular Reflection from Woven Cloth", ACM TOG 31(1), 2012, have
 * them. A yarn that goes over one is an arc; one that floats is level for a while: floats is the power of its
 * slope. Fibres run along the yarn, or turn about it by the twist.
 *   The mean is a sum over 5 to 33 slopes s_y, the more the narrower D is and the steeper the yarn, which vary as all of
 * the yarn do, and over 3 r of those that face both directions; where 33 are too few, D is wider instead. Errors:
 * docs/weave.md.
 * The weight is our own: of threads in woven cloth the neighbours hide more of the sides than of the middle.
 *   color: the albedo A of the fibres. The first colour dims light that met one of them, the second, rho(A),
 *     all other light. A cloth of two yarns is two of these lobes, at right angles.
 *   roughness: alpha = roughness^2, the width of the highlight across the fibres' direction: silk 0.1, linen
 *     0.3, cotton 0.4, wool 0.5.
 *   reciprocal: yes.
 *   energy: E <= 1; what is missing is light that the yarns hide from each other.
 *   sampling: by flakes of a level surface, as wide as slopes and twist spread those of the yarns, and by the cosine
 * (shading/media/yarn_draw.h). Own.
 *   Not for: cloth so near that threads are told apart, which is yarn.
 *   measured by weft check woven: E at most 0.98 (alpha 1, cos_o 1);
 *     reciprocal to 1e-3; weight variance 1.60 of the cosine's;
 *     half precision: finite for any cosines. */
#ifndef WEFT_WOVEN_H
#define WEFT_WOVEN_H

#include "shading/lobe/lobe.h"
#include "shading/media/yarn_draw.h"

#define WOVEN_PARAMS(P)                                                                                      \
    P(float, alpha, 0.4f, 0.05f, 1.0f, 0.05f, 1.0f, "what a fibre shows along its axis")                     \
    P(float, share, 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, "of the cloth that these yarns cover")                     \
    P(float, crimp, 0.44f, 0.0f, 0.8f, 0.0f, 1.2f, "steepest angle of the yarn along it, radians")           \
    P(float, azimuth, 0.0f, 0.0f, 6.28318531f, -7.0f, 7.0f, "where it runs, from the tangent, radians")      \
    P(float, twist, 0.0f, -0.8f, 0.8f, -1.5f, 1.5f, "of the fibres about the yarn, radians; 0 is filament")  \
    P(float, roundness, 0.9f, 0.0f, 1.2f, 0.0f, 1.5f, "steepest slope across the yarn")                      \
    P(float, floats, 1.0f, 1.0f, 6.0f, 0.4f, 16.0f, "1 plain weave; more where yarns lie level longer")      \
    P(float, cross_crimp, 0.44f, 0.0f, 0.8f, 0.0f, 1.2f, "of the yarns at right angles, radians")
#define WOVEN_TRAITS                                                                                         \
    (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_ANISOTROPIC | TRAIT_TWO_COLORS | TRAIT_SYSTEM)

STRUCT(Woven){WOVEN_PARAMS(FIELD)};

/* roundness, crimp, cross_crimp: slopes by which yarns hide each other, as yarn_area takes them; of a cloth those of its
 * points, where what else is here is fitted (weave/woven_fit.c). edge: of the weight 1 + edge s_x^2. count: of bins, the
 * level part among them. part: the share; 1 where colours hold it (raster/glsl/weave.glsl). again: of many, beside what
 * directions add. e: of D, as yarn_met_once has it. steep: s_y where mean is 1. level: the gain of the level part. wide,
 * lean, narrow: of WovenSlopes. */
#define WOVEN_NUMBERS(N)                                                                                     \
    N(alpha)                                                                                                 \
    N(share)                                                                                                 \
    N(roundness)                                                                                             \
    N(edge)                                                                                                  \
    N(count)                                                                                                 \
    N(part)                                                                                                  \
    N(crimp)                                                                                                 \
    N(cross_crimp)                                                                                           \
    N(cos_a) N(sin_a) N(cos_t) N(sin_t) N(again) N(e) N(steep) N(level) N(wide) N(lean) N(narrow)

/* A part of the yarn: s between two bounds, or between their opposites. The first lies on both sides of 0 and is level, and
 * stands in WOVEN_NUMBERS; the others follow it here.
 *   mean: of s_y, over steep. gain: of its weight in the mean over s, and of D; 0: no part. */
#define WOVEN_BIN_NUMBERS(N) N(mean) N(gain)
#define WOVEN_EACH_BIN(N)                                                                                    \
    N(b1) N(b2) N(b3) N(b4) N(b5) N(b6) N(b7) N(b8) N(b9) N(b10) N(b11) N(b12) N(b13) N(b14) N(b15) N(b16)
#define WOVEN_NUMBER(name) float name;
#define WOVEN_BIN(name)    WovenBin name;
STRUCT(WovenBin){WOVEN_BIN_NUMBERS(WOVEN_NUMBER)};
STRUCT(WovenPrepared){WOVEN_NUMBERS(WOVEN_NUMBER) WOVEN_EACH_BIN(WOVEN_BIN)};

#define WOVEN_BINS 17 /* with the level one; ROUNDS writes out the others, up to 16 */

/* There are 2 n - 1 parts. t: how many of its widths D would move along the yarn at the pace that it has at the end. n grows
 * with t, and a little with t^2. Yarns that are steep and rough need more parts than D asks for. n need not be whole: the
 * last bin is as much narrower, so that f does not jump. Own fit. */
FN float woven_needed(Woven m) {                                /* n, however many bins that asks for */
    float turn = 1.5f * m.floats / (m.floats + 0.5f) * m.crimp; /* at the end of the yarn, where x is 1 */
    float t = turn / max(m.alpha, 1e-3f);
    return max(max(t * (1.55f + 0.06f * t) + 1.0f, 9.0f * (turn - 0.65f) + 3.0f), 3.0f);
}
FN float woven_count(Woven m) { return min(woven_needed(m), to_float(WOVEN_BINS)); }

/* Bin k reaches from x_k to x_(k + 1), s = x^(1.5 (1 + 0.05 crimp^2) / (floats + 0.5)), x_0 = 0, x_1 = 1.2 / (2 n - 1), and
 * the others are even, up to 1. Bin 0 and its opposite are one part, level on the mean. In x that part is a little wider:
 * where light grazes the others turn away one by one, and it never does. Steep yarns have their bins closer to it. Own fit to
 * means over points. */
FN float woven_place(float n, float k) { /* x_k, k > 0 */
    float first = 1.2f / (2.0f * n - 1.0f), next = (1.0f - first) / (n - 1.0f);
    return min(first + (k - 1.0f) * next, 1.0f);
}

/* s at the upper end of bin k, the part of the yarn up to there, and s^(floats + 1), floats + 1 times what its slopes sum up
 * to. */
STRUCT(WovenEnd) { float s, sum; };
FN WovenEnd woven_end(Woven m, float n, float k) {
    WovenEnd e;
    e.s = pow(woven_place(n, k + 1.0f), 1.5f * (1.0f + 0.05f * m.crimp * m.crimp) / (m.floats + 0.5f));
    e.sum = e.s * pow(e.s, m.floats);
    return e;
}
FN WovenBin woven_bin(Woven m, WovenEnd low, WovenEnd high) {
    WovenBin b;
    b.gain = max(high.s - low.s, 0.0f); /* the width in s, of which WOVEN_SCALE makes the gain */
    b.mean = min((high.sum - low.sum) / ((m.floats + 1.0f) * max(b.gain, 1e-4f)), 1.0f);
    return b;
}

/* The mean slopes of bins vary less than all slopes, whose mean square is 1 / (2 floats + 1) of the largest one's. Where
 * there are enough bins, all are moved outwards by one factor, which makes up for it. Where D asks for more, D is wider
 * instead. widened goes from the first, 0, to the second, 1, as D asks for up to 1.5 times the bins; between, each
 * makes up for its part. A bin and its opposite are half of the mean each, 1 / (6 g^2) is the outer weight of woven_row, and
 * 0.9 is the mean of 1 - 0.3 r^2. */
#define WOVEN_GAIN (0.5f / (6.0f * WOVEN_G2 * 0.9f) / (4.0f * PI))
#define WOVEN_G2   0.545f
#define WOVEN_MAKE(name)                                                                                     \
    next = woven_end(m, n, k);                                                                               \
    p->name = woven_bin(m, end, next);                                                                       \
    vary = vary + p->name.gain * p->name.mean * p->name.mean;                                                \
    end = next;                                                                                              \
    k = k + 1.0f;
#define WOVEN_SCALE(name) p->name.gain = p->name.gain * gain;
FN void woven_prepare(Woven m, WovenPrepared *p) {
    float tan_crimp = sin(m.crimp) / cos(m.crimp), n = woven_count(m),
          slopes = 1.0f / (2.0f * m.floats + 1.0f);
    p->alpha = m.alpha;
    p->share = m.share;
    p->part = m.share;
    p->roundness = max(m.roundness, 1e-2f); /* so that edge fits a half float */
    p->edge = -0.3f / (p->roundness * p->roundness);
    p->count = -floor(-n);
    p->crimp = tan_crimp * sqrt(3.0f * slopes);
    p->cross_crimp = sin(m.cross_crimp) / cos(m.cross_crimp);
    p->cos_a = cos(m.azimuth);
    p->sin_a = sin(m.azimuth);
    p->cos_t = cos(m.twist);
    p->sin_t = sin(m.twist);
    p->again = 0.5f / (PI * yarn_left_mean(m.alpha));
    p->wide = p->roundness;
    p->lean = 0.0f;
    p->narrow = 0.0f;
    WovenEnd end = woven_end(m, n, 0.0f), next;
    p->level = end.s;
    float k = 1.0f, vary = 0.0f;
    WOVEN_EACH_BIN(WOVEN_MAKE)
    float widened = clamp(2.0f * (woven_needed(m) / n - 1.0f), 0.0f, 1.0f);
    p->steep = tan_crimp * mix(sqrt(slopes / vary), 1.0f, widened);
    float a2 = max(m.alpha * m.alpha, 1e-6f);
    float spread = tan_crimp / (1.0f + tan_crimp * tan_crimp * slopes); /* of angles, by that of slopes */
    a2 = a2 + (1.0f - a2) * widened * spread * spread * max(slopes - vary, 0.0f);
    p->e = (1.0f - a2) / a2;
    float gain = WOVEN_GAIN / a2 / p->wide;
    p->level = 2.0f * gain * p->level;
    WOVEN_EACH_BIN(WOVEN_SCALE)
}
FN float woven_second(Woven m, float f0, float f90) { return yarn_reflectance(f0); }

/* A direction in the frame of the yarn, which runs along y. */
FN Dir woven_turn(const WovenPrepared *p, Dir w) {
    return dir(p->sin_a * w.x - p->cos_a * w.y, p->cos_a * w.x + p->sin_a * w.y, w.z);
}

/* A direction over the cloth. */
STRUCT(WovenView) {
    Dir w;        /* in the yarn's frame */
    float over_x; /* 1 / w.x */
    float over_seen, left;
    float shown; /* the mean of P / V over these yarns */
};
FN WovenView woven_look(const WovenPrepared *p, Dir w) {
    WovenView v;
    v.w = woven_turn(p, w);
    v.over_x = 1.0f / (abs(v.w.x) < 1e-4f ? 1e-4f : v.w.x);
    float own = yarn_hidden(v.w.x, v.w.y, w.z, p->roundness, p->crimp);
    float cross = yarn_hidden(v.w.y, v.w.x, w.z, p->roundness, p->cross_crimp);
    v.over_seen = 1.0f / max(w.z + p->share * own + (1.0f - p->share) * cross, 1e-4f);
    v.shown = (w.z + own) * v.over_seen;
    v.left = yarn_left(p->alpha, w.z);
    return v;
}
FN void woven_view(const WovenPrepared *p, Dir o, WovenView *w) { *w = woven_look(p, o); }

/* A direction over yarn of one slope along it: P = p + s_x x and t . w = along + n (s_x turn - side), of
 * t = cos twist T + sin twist (N x T),  T = c (0, 1, -s_y),  N = n (s_x, s_y, 1). */
STRUCT(WovenLine) {
    float x, p, end; /* end: the s_x from which on P is 0 */
    float along, turn, side;
};
FN WovenLine woven_line(const WovenPrepared *p, float slope, float c, const WovenView *v) {
    WovenLine l;
    l.x = v->w.x;
    l.p = v->w.z + slope * v->w.y;
    l.end = -l.p * v->over_x;
    l.along = p->cos_t * c * (v->w.y - slope * v->w.z);
    l.turn = p->sin_t * c * l.p;
    l.side = p->sin_t * c * (1.0f + slope * slope) * l.x;
    return l;
}

/* n = 1 / |(s_x, s_y, 1)| over c, from q = (c s_x)^2, without a root: within 0.001 up to the steepest roundness, own fit. */
FN float woven_flat(float q) {
    return 1.0f + q * (-0.483265f + q * (0.276777f + q * (-0.10213f + q * 0.0158065f)));
}

/* The slopes of a bin: s_y is slope, and s_x lies within wide of middle; at the opposite slope within wide of its opposite.
 * wide is that of p less narrow mean^2, and middle is lean mean. c: 1 / sqrt(1 + slope^2). */
STRUCT(WovenSlopes) { float slope, middle, wide, c; };
FN WovenSlopes woven_slopes(const WovenPrepared *p, float mean) {
    WovenSlopes b;
    b.slope = p->steep * mean;
    b.middle = p->lean * mean;
    b.wide = p->wide - p->narrow * mean * mean;
    b.c = 1.0f / sqrt(1.0f + b.slope * b.slope);
    return b;
}
FN WovenSlopes woven_opposite(WovenSlopes b) {
    b.slope = -b.slope;
    b.middle = -b.middle;
    return b;
}

/* yarn_met_once of one facet, by its part of the yarn. P is not below 0 where the facet counts, and abs keeps it so where
 * reach is 0. t . (wo + wi) is summed term by term, so that vectors and single calls round alike where the two nearly
 * cancel, as light does that goes straight on along the cloth. */
FN float woven_facet(const WovenPrepared *p, float c, float x, const WovenLine *o, const WovenLine *i,
                     float q) {
    float x2 = x * x, n = c * woven_flat(c * c * x2);
    float p_o = abs(o->p + x * o->x), p_i = abs(i->p + x * i->x);
    float m = (o->along + i->along) + n * (x * (o->turn + i->turn) - (o->side + i->side));
    float t_o = o->along + n * (x * o->turn - o->side);
    return (1.0f + p->edge * x2) * yarn_met_once(p->e, q, m, p_o, p_i, t_o, m - t_o);
}

/* The mean over s_x, by three nodes on the part of it that faces both directions: beyond, the sum would meet an edge.
 * The outer ones, at g of the way to its ends, have the weight 1 / (6 g^2), so that the rule is right for cubes, and the
 * middle one 6 g^2 - 2 times that. g^2 is 0.545: Gauss's 0.6 would be right up to fifth powers, but errs by half as much
 * again and more where fibres turn by 30 degrees (own fit). */
FN float woven_row(const WovenPrepared *p, WovenSlopes b, const WovenView *o, const WovenView *i, float q) {
    WovenLine l = woven_line(p, b.slope, b.c, o), n = woven_line(p, b.slope, b.c, i);
    float least = b.middle - b.wide, most = b.middle + b.wide;
    float low = clamp(max(o->over_x > 0.0f ? l.end : least, i->over_x > 0.0f ? n.end : least), least, most);
    float high = clamp(min(o->over_x > 0.0f ? most : l.end, i->over_x > 0.0f ? most : n.end), least, most);
    float reach = 0.5f * max(high - low, 0.0f), middle = 0.5f * (high + low), g = sqrt(WOVEN_G2) * reach;
    float sides = woven_facet(p, b.c, middle - g, &l, &n, q) + woven_facet(p, b.c, middle + g, &l, &n, q);
    return reach * (sides + (6.0f * WOVEN_G2 - 2.0f) * woven_facet(p, b.c, middle, &l, &n, q));
}

FN float woven_pick(int k, float a, float b, float c, float d, float e, float f, float g, float h) {
    float low = k < 2 ? (k < 1 ? a : b) : (k < 3 ? c : d), high = k < 6 ? (k < 5 ? e : f) : (k < 7 ? g : h);
    return k < 4 ? low : high;
}
#define WOVEN_PICK(of)                                                                                       \
    low = woven_pick(k, p->b1.of, p->b2.of, p->b3.of, p->b4.of, p->b5.of, p->b6.of, p->b7.of, p->b8.of);     \
    high = woven_pick(k - 8, p->b9.of, p->b10.of, p->b11.of, p->b12.of, p->b13.of, p->b14.of, p->b15.of,     \
                      p->b16.of);                                                                            \
    b.of = k < 8 ? low : high;
FN WovenBin woven_part(const WovenPrepared *p, int k) {
    WovenBin b;
    float low, high;
    WOVEN_BIN_NUMBERS(WOVEN_PICK)
    return b;
}

/* The mean of single: of the level part, and of the others by twos. */
FN float woven_once(const WovenPrepared *p, const WovenView *o, const WovenView *i, float q) {
    WovenSlopes level; /* known, so that the compiler leaves out what its zeros multiply */
    level.slope = 0.0f;
    level.middle = 0.0f;
    level.wide = p->wide;
    level.c = 1.0f;
    float sum = p->level * woven_row(p, level, o, i, q);
    ROUNDS_OF(k, to_int(p->count) - 1, WOVEN_BINS - 1) {
        WovenBin b = woven_part(p, k);
        WovenSlopes s = woven_slopes(p, b.mean);
        sum = sum + b.gain * (woven_row(p, s, o, i, q) + woven_row(p, woven_opposite(s), o, i, q));
    }
    return sum * o->over_seen * i->over_seen;
}

/* The level surface that directions are drawn at: a'^2 = a^2 + (1 - a^2) (crimp^2 + sin^2 twist roundness^2) / 3, crimp as
 * yarn_area takes it. */
FN YarnSurface woven_surface(const WovenPrepared *p) {
    float a2 = p->alpha * p->alpha, lean = p->sin_t * p->roundness;
    float spread = min((p->crimp * p->crimp + lean * lean) / 3.0f, 1.0f);
    YarnSurface s;
    s.axis = dir(p->cos_a * p->cos_t - p->sin_a * p->sin_t, p->sin_a * p->cos_t + p->cos_a * p->sin_t, 0.0f);
    s.alpha = sqrt(a2 + (1.0f - a2) * spread);
    s.slope_x = 0.0f;
    s.slope_y = 0.0f;
    s.over_n = 1.0f;
    return s;
}
FN YarnProposal woven_proposal(YarnSurface s, const WovenView *w, Dir o) {
    YarnProposal d;
    d.along = dir_dot(o, s.axis);
    d.flakes = yarn_by_flakes(s.alpha, o.z, w->left);
    d.slope = 0.0f;
    return d;
}

FN LobeValue woven_value(const WovenPrepared *p, const WovenView *w, Angles a) {
    WovenView v = woven_look(p, a.i);
    float once = woven_once(p, w, &v, yarn_half(a));
    float many = p->again * w->left * v.left * (w->shown + v.shown);
    float f = p->part * (once + many);
    YarnSurface s = woven_surface(p);
    return lobe_value_of(f, many / (once + many), yarn_draw_pdf(s, woven_proposal(s, w, a.o), a));
}
FN Dir woven_sample(const WovenPrepared *p, const WovenView *w, Dir o, float u, float v) {
    YarnSurface s = woven_surface(p);
    return yarn_draw(s, woven_proposal(s, w, o), o, u, v);
}

#endif
