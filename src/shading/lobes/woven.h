/* woven - the yarns of one direction in a woven cloth, from afar: streaks across the yarn on a soft ground
 *
 *   f = share (A <single> + rho(A) multiple)                                                      [1/sr]
 *   <single> = the mean over s and r in [-1, 1], with the weight (1 - 0.3 r^2) / 0.9, of single at the slopes
 *     s_x = roundness r  across the yarn,  s_y = tan(crimp) s |s|^(floats - 1)  along it
 *
 *   From afar a yarn shows all of its slopes at once. A yarn that passes over one other yarn is an arc, on which s_y is
 * uniform (floats 1). One that passes over several is level in the middle and falls at its ends (floats above 1). Its
 * fibres run along it, or wind around it by the twist. So light that met one fibre makes streaks across the yarn: Piti
 * Irawan, Steve Marschner, "Specular Reflection from Woven Cloth", ACM TOG 31(1), 2012. The weight is our own:
 * neighbours in a cloth hide more of a thread's sides than of its middle.
 *   single is light that met one fibre, and multiple is all other light (shading/media/yarn_medium.h). The fibres are
 * flakes with the distribution D of Eric Heitz, Jonathan Dupuy, Cyril Crassin, Carsten Dachsbacher, "The SGGX
 * Microflake Distribution", ACM TOG 34(4), 2015. Below, P is the area of a yarn that a direction sees, per area of
 * cloth. V is the mean of P over all yarns. R is the part of light that single scattering leaves to multiple.
 *   The mean is a sum over 5 to 33 slopes s_y, which stand for bins of s (shading/media/woven_bins.h). A steep yarn
 * with a narrow highlight has more of them. For each s_y, three s_x that face both wo and wi are summed. Where 33
 * slopes are too few, a wider D fills the gaps between them. docs/weave.md has the errors.
 *   color: the albedo A of the fibres. The first colour, A, dims light that met one of them. The second, rho(A),
 *     dims all other light. A cloth of two yarns is two of these lobes, at right angles.
 *   roughness: alpha = roughness^2, the width of the highlight across the fibres' direction: silk 0.1, linen
 *     0.3, cotton 0.4, wool 0.5.
 *   reciprocal: yes.
 *   energy: E <= 1; what is missing is light that the yarns hide from each other.
 *   sampling: by the cosine, and by flakes of a level surface (shading/media/yarn_draw.h). The flakes' D is as
 * wide as the slopes and the twist of the yarns make it. Own.
 *   Not for: cloth so near that threads are told apart, for which there is lobe yarn.
 *   measured by weft check woven, other parameters at default: E at most 0.98 (alpha 1, cos_o 1);
 *     reciprocal to 1e-3; weight variance 1.60 of the cosine's;
 *     half precision: finite for any cosines. */
#pragma once

#include "shading/lobe/lobe.h"
#include "shading/media/woven_bins.h"
#include "shading/media/yarn_draw.h"

/* Lists for each parameter: type, name, default, range, hard range, meaning. */
#define WOVEN_PARAMS(P)                                                                                                \
    P(float, alpha, 0.4f, 0.05f, 1.0f, 0.05f, 1.0f, "what a fibre shows along its axis")                               \
    P(float, share, 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, "of the cloth that these yarns cover")                               \
    P(float, crimp, 0.44f, 0.0f, 0.8f, 0.0f, 1.2f, "steepest angle of the yarn along it, radians")                     \
    P(float, azimuth, 0.0f, 0.0f, 6.28318531f, -7.0f, 7.0f, "where it runs, from the tangent, radians")                \
    P(float, twist, 0.0f, -0.8f, 0.8f, -1.5f, 1.5f, "of the fibres about the yarn, radians; 0 is filament")            \
    P(float, roundness, 0.9f, 0.0f, 1.2f, 0.0f, 1.5f, "steepest slope across the yarn")                                \
    P(float, floats, 1.0f, 1.0f, 6.0f, 0.4f, 16.0f, "1 plain weave; more where yarns lie level longer")                \
    P(float, cross_crimp, 0.44f, 0.0f, 0.8f, 0.0f, 1.2f, "of the yarns at right angles, radians")
/* TRAIT_SYSTEM: warp and weft, each with this lobe, make a cloth. */
#define WOVEN_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_ANISOTROPIC | TRAIT_TWO_COLORS | TRAIT_SYSTEM)

STRUCT(Woven){WOVEN_PARAMS(FIELD)};

/* The numbers of a prepared lobe. woven_prepare computes them for a yarn alone. For the yarns of a draft,
 * weave/woven_fit.c changes some of them, so that the lobe reflects as the points of the cloth do near by. */
#define WOVEN_NUMBERS(N)                                                                                               \
    N(alpha)         /* of the fibres */                                                                               \
    N(share)         /* of the cloth that these yarns cover */                                                         \
    N(scale)         /* factor of f: the share, or 1 if the colours contain it */                                      \
    N(v_roundness)   /* for V: roundness of the yarns of both directions */                                            \
    N(v_crimp)       /* for V: uniform slopes up to it have the mean square of s_y */                                  \
    N(v_cross_crimp) /* the same of the yarns at right angles */                                                       \
    N(cos_a)         /* cosine of the yarn's azimuth */                                                                \
    N(sin_a)         /* sine of it */                                                                                  \
    N(cos_t)         /* cosine of the twist */                                                                         \
    N(sin_t)         /* sine of it */                                                                                  \
    N(multiple)      /* factor of multiple that does not depend on directions */                                       \
    N(e)             /* (1 - a^2) / a^2, where a is the alpha of D, which may be wider than the fibres' */             \
    N(edge)          /* the weight of s_x is 1 + edge s_x^2 */                                                         \
    N(steepest)      /* s_y of a bin with slope 1; the slope of a bin is 0 to 1 */                                     \
    N(width)         /* s_x of a level bin lies between -width and width */                                            \
    N(taper)         /* how much narrower the range of s_x is at slope 1, on either side */                            \
    N(lean)          /* the middle of the range at slope 1 */                                                          \
    N(level)         /* weight of the level bin */                                                                     \
    N(count)         /* of bins, the level one among them */
#define WOVEN_NUMBER(name) float name;
STRUCT(WovenPrepared) {
    WOVEN_NUMBERS(WOVEN_NUMBER)
    WovenBins bins; /* without the level one */
};

/* Returns how many bins the yarn needs. */
FN float woven_needed(Woven m) { return woven_bins_needed(m.alpha, m.crimp, m.floats); }

/* Returns how many bins the lobe has. The last may be a fraction of one. */
FN float woven_count(Woven m) { return min(woven_needed(m), to_float(WOVEN_BINS)); }

/* Returns how the yarn is cut into n bins, whose ends s are even steps to that power (woven_bins.h). */
FN WovenCut woven_cut(Woven m) {
    WovenCut c;
    c.floats = m.floats;
    c.power = 1.5f * (1.0f + 0.05f * m.crimp * m.crimp) / (m.floats + 0.5f);
    c.n = woven_count(m);
    return c;
}

/* Three s_x stand for a range of s_x: its middle, and one on either side, g of the way to the end. The outer two have
 * the weight 1 / (6 g^2) each and the middle has the rest, so that the mean is exact for cubic functions. Gauss's rule
 * has g^2 = 0.6 and is exact up to fifth powers. But its error is at least 1.5 times as large where fibres are twisted
 * by 30 degrees. Own fit. */
#define WOVEN_G2 0.545f

/* <single> is WOVEN_FACTOR / (a^2 width) times the sum over bins of woven_across times their width in s. The
 * parts of WOVEN_FACTOR are 1 / 2 for the mean over s, 1 / (6 g^2) and 1 / 0.9 for that over s_x, and 1 / (4 pi) for
 * yarn_single. */
#define WOVEN_FACTOR (0.5f / (6.0f * WOVEN_G2 * 0.9f) / (4.0f * PI))

/* Prepares the lobe. The mean of s_y^2 is tan(crimp)^2 / (2 floats + 1). Over bins it is smaller, since the slope of a
 * bin is a mean itself. If the yarn has as many bins as it needs, their slopes are scaled up to the true mean square.
 * If it needs 1.5 times as many, the slopes stay and D is wider by the missing variance. In between, `widening` blends
 * from 0, the first case, to 1, the second. */
FN void woven_prepare(Woven m, WovenPrepared *p) {
    float tan_crimp = sin(m.crimp) / cos(m.crimp), square = 1.0f / (2.0f * m.floats + 1.0f);
    WovenCut cut = woven_cut(m);
    p->alpha = m.alpha;
    p->share = m.share;
    p->scale = m.share;
    p->v_roundness = max(m.roundness, 1e-2f); /* so that edge fits a half float */
    p->v_crimp = tan_crimp * sqrt(3.0f * square);
    p->v_cross_crimp = sin(m.cross_crimp) / cos(m.cross_crimp);
    p->cos_a = cos(m.azimuth);
    p->sin_a = sin(m.azimuth);
    p->cos_t = cos(m.twist);
    p->sin_t = sin(m.twist);
    p->multiple = yarn_multiple(m.alpha, m.roundness);
    p->edge = -0.3f / (p->v_roundness * p->v_roundness);
    p->width = p->v_roundness;
    p->taper = 0.0f;
    p->lean = 0.0f;
    p->count = -floor(-cut.n);

    WovenBins bins = woven_bins_cut(cut);
    float bins_square = woven_bins_square(&bins); /* the mean of their squared slopes */
    float widening = clamp(2.0f * (woven_needed(m) / cut.n - 1.0f), 0.0f, 1.0f);
    p->steepest = tan_crimp * mix(sqrt(square / bins_square), 1.0f, widening);
    float a2 = max(m.alpha * m.alpha, 1e-6f);
    float angle = tan_crimp / (1.0f + tan_crimp * tan_crimp * square); /* of the yarn, per slope of a bin */
    a2 = a2 + (1.0f - a2) * widening * angle * angle * max(square - bins_square, 0.0f);
    p->e = (1.0f - a2) / a2;
    float factor = WOVEN_FACTOR / a2 / p->width;
    p->level = 2.0f * factor * woven_bin_end(cut, 1.0f).s; /* the level bin is from -s to s */
    p->bins = woven_bins_scaled(&bins, factor);
}
/* Returns the second colour, rho(A). f0: the first, A. */
FN float woven_second(Woven m, float f0, float f90) { return yarn_reflectance(f0); }

/* Returns a direction in the yarn's frame: x across the yarn, y along it. */
FN Dir woven_to_yarn(const WovenPrepared *p, Dir w) {
    return dir(p->sin_a * w.x - p->cos_a * w.y, p->cos_a * w.x + p->sin_a * w.y, w.z);
}

/* The numbers that depend on a single direction w. */
STRUCT(WovenView) {
    Dir w;           /* in the yarn's frame */
    float per_x;     /* 1 / w.x */
    float per_v;     /* 1 / V */
    float seen;      /* mean of P / V over these yarns */
    float remainder; /* R */
};
/* Returns the view of w. In the mean over some yarns, P is w_z plus the area that faces away from w. */
FN WovenView woven_view_of(const WovenPrepared *p, Dir w) {
    WovenView v;
    v.w = woven_to_yarn(p, w);
    v.per_x = 1.0f / (abs(v.w.x) < 1e-4f ? 1e-4f : v.w.x);
    float own = yarn_averted_area(v.w.x, v.w.y, w.z, p->v_roundness, p->v_crimp);
    float cross = yarn_averted_area(v.w.y, v.w.x, w.z, p->v_roundness, p->v_cross_crimp);
    v.per_v = 1.0f / max(w.z + p->share * own + (1.0f - p->share) * cross, 1e-4f);
    v.seen = (w.z + own) * v.per_v;
    v.remainder = yarn_remainder(p->alpha, w.z);
    return v;
}
FN void woven_view(const WovenPrepared *p, Dir o, WovenView *w) { *w = woven_view_of(p, o); }

/* The slopes of a bin on one half of the yarn: one s_y, and s_x from middle - width to middle + width. */
STRUCT(WovenSlopes) {
    float s_y, middle, width;
    float c; /* 1 / sqrt(1 + s_y^2) */
};
FN WovenSlopes woven_slopes(const WovenPrepared *p, float slope) {
    WovenSlopes b;
    b.s_y = p->steepest * slope;
    b.middle = p->lean * slope;
    b.width = p->width - p->taper * slope * slope;
    b.c = 1.0f / sqrt(1.0f + b.s_y * b.s_y);
    return b;
}
FN WovenSlopes woven_opposite(WovenSlopes b) {
    b.s_y = -b.s_y;
    b.middle = -b.middle;
    return b;
}

/* A direction w and the slopes of a bin. The yarn has the normal N = n (s_x, s_y, 1) and the direction
 * T = c (0, 1, -s_y). Its fibres run along t = cos twist T + sin twist (N x T). So P and t . w depend on s_x by
 *   P = p + s_x w_x,  t . w = t_along + n (s_x t_slope - t_side) */
STRUCT(WovenLine) {
    float x;   /* w_x */
    float p;   /* P where s_x is 0 */
    float end; /* the s_x where P is 0 */
    float t_along, t_slope, t_side;
};
FN WovenLine woven_line(const WovenPrepared *p, WovenSlopes b, const WovenView *v) {
    WovenLine l;
    l.x = v->w.x;
    l.p = v->w.z + b.s_y * v->w.y;
    l.end = -l.p * v->per_x;
    l.t_along = p->cos_t * b.c * (v->w.y - b.s_y * v->w.z);
    l.t_slope = p->sin_t * b.c * l.p;
    l.t_side = p->sin_t * b.c * (1.0f + b.s_y * b.s_y) * l.x;
    return l;
}

/* Returns 1 / sqrt(1 + q) within 0.001 for q up to 2.25. Own fit. */
FN float woven_inverse_root(float q) {
    return 1.0f + q * (-0.483265f + q * (0.276777f + q * (-0.10213f + q * 0.0158065f)));
}

/* Returns single at s_x, times 4 pi a^2 V_i V_o and the weight of s_x. c: that of the slopes; q: 1 / |wi + wo|^2. P is
 * positive at the s_x that woven_across takes, and abs ensures that even if there are none. m, which is t . (wo + wi),
 * is summed part by part. So SIMD and scalar code round alike where wi and wo nearly cancel, which is light that goes
 * straight on along the cloth. */
FN float woven_facet(const WovenPrepared *p, float c, float s_x, const WovenLine *o, const WovenLine *i, float q) {
    float x2 = s_x * s_x, n = c * woven_inverse_root(c * c * x2);
    float p_o = abs(o->p + s_x * o->x), p_i = abs(i->p + s_x * i->x);
    float m = (o->t_along + i->t_along) + n * (s_x * (o->t_slope + i->t_slope) - (o->t_side + i->t_side));
    float t_o = o->t_along + n * (s_x * o->t_slope - o->t_side);
    return (1.0f + p->edge * x2) * yarn_single(p->e, q, m, p_o, p_i, t_o, m - t_o);
}

/* Returns the integral of woven_facet over the s_x of a bin, times 3 g^2. It covers only the s_x that face both wo and
 * wi. Three samples of all s_x would give f a step wherever one of them turns away. */
FN float woven_across(const WovenPrepared *p, WovenSlopes b, const WovenView *o, const WovenView *i, float q) {
    WovenLine l = woven_line(p, b, o), k = woven_line(p, b, i);
    float least = b.middle - b.width, most = b.middle + b.width;
    float low = clamp(max(o->per_x > 0.0f ? l.end : least, i->per_x > 0.0f ? k.end : least), least, most);
    float high = clamp(min(o->per_x > 0.0f ? most : l.end, i->per_x > 0.0f ? most : k.end), least, most);
    float reach = 0.5f * max(high - low, 0.0f), middle = 0.5f * (high + low), g = sqrt(WOVEN_G2) * reach;
    float sides = woven_facet(p, b.c, middle - g, &l, &k, q) + woven_facet(p, b.c, middle + g, &l, &k, q);
    return reach * (sides + (6.0f * WOVEN_G2 - 2.0f) * woven_facet(p, b.c, middle, &l, &k, q));
}

/* Returns <single>. The s_y, middle and c of the level bin are constants, so that the compiler drops terms of 0. */
FN float woven_single(const WovenPrepared *p, const WovenView *o, const WovenView *i, float q) {
    WovenSlopes level;
    level.s_y = 0.0f;
    level.middle = 0.0f;
    level.width = p->width;
    level.c = 1.0f;
    float sum = p->level * woven_across(p, level, o, i, q);
    ROUNDS_OF(k, to_int(p->count) - 1, WOVEN_BINS - 1) { /* a loop over k, unrolled */
        WovenBin b = woven_bin_at(&p->bins, k);
        WovenSlopes s = woven_slopes(p, b.slope);
        sum = sum + b.weight * (woven_across(p, s, o, i, q) + woven_across(p, woven_opposite(s), o, i, q));
    }
    return sum * o->per_v * i->per_v;
}

/* Returns the level surface whose flakes are sampled. Its alpha a' has the spread by slopes and twist in it:
 *   a'^2 = a^2 + (1 - a^2) (v_crimp^2 + (sin twist v_roundness)^2) / 3 */
FN YarnSurface woven_surface(const WovenPrepared *p) {
    float a2 = p->alpha * p->alpha, twisted = p->sin_t * p->v_roundness;
    float spread = min((p->v_crimp * p->v_crimp + twisted * twisted) / 3.0f, 1.0f);
    YarnSurface s;
    s.axis = dir(p->cos_a * p->cos_t - p->sin_a * p->sin_t, p->sin_a * p->cos_t + p->cos_a * p->sin_t, 0.0f);
    s.alpha = sqrt(a2 + (1.0f - a2) * spread);
    s.slope_x = 0.0f;
    s.slope_y = 0.0f;
    s.per_n = 1.0f;
    return s;
}
FN YarnProposal woven_proposal(YarnSurface s, const WovenView *w, Dir o) {
    YarnProposal d;
    d.along = dir_dot(o, s.axis);
    d.c = yarn_flake_chance(s.alpha, o.z, w->remainder); /* chance of a flake */
    d.q = 0.0f;                                          /* else a cosine about z */
    return d;
}

/* Returns f, the share of the second colour, and the pdf of woven_sample. */
FN LobeValue woven_value(const WovenPrepared *p, const WovenView *w, Angles a) {
    WovenView v = woven_view_of(p, a.i);
    float single = woven_single(p, w, &v, yarn_per_sum2(a));
    float multiple = p->multiple * w->remainder * v.remainder * (w->seen + v.seen);
    float f = p->scale * (single + multiple);
    YarnSurface s = woven_surface(p);
    return lobe_value_of(f, multiple / (single + multiple), yarn_draw_pdf(s, woven_proposal(s, w, a.o), a));
}
FN Dir woven_sample(const WovenPrepared *p, const WovenView *w, Dir o, float u, float v) {
    YarnSurface s = woven_surface(p);
    return yarn_draw(s, woven_proposal(s, w, o), o, u, v);
}
