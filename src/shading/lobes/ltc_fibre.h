/* ltc-fibre - velvet, felt and fuzz as engines draw them: the soft rim of fibres, by one look-up
 *
 *   f = E D / cos_i,  D = cos_i z |M^-1| / (pi |v|^4),  v = M^-1 wi                              [1/sr]
 *   v_xy = wi_xy + ((q - 1) t + b cos_i) wo_xy,  v_z = z cos_i,  t = wi_xy . wo_xy
 *
 *   The form of Tizian Zeltner, Brent Burley, Matt Jen-Yuan Chiang, "Practical Multiple-Scattering Sheen
 * Using Linearly Transformed Cosines", SIGGRAPH Talks 2022; Eric Heitz, Jonathan Dupuy, Stephen Hill, David
 * Neubelt, "Real-Time Polygonal-Light Shading with Linearly Transformed Cosines", ACM TOG 35(4), 2016.
 * Departures: z, q, b and E are fitted to the lobe fibre, upright, white and of density 1, without noise and
 * with one number more, q; no tangent and no angle is taken, so that nothing is singular at normal incidence
 * (ltc.h). And alpha is a roughness squared, as of every sheen here, where the talk gives alpha itself to
 * artists: its .35 is roughness .59 (profile openpbr takes the roughness as it is).
 *   color: a factor, as engines have it; that of fibres is not.
 *   roughness: alpha = roughness^2.
 *   reciprocal: no; z, q, b and E belong to wo alone.
 *   energy: E <= 1, and exact at the nodes of the table.
 *   sampling: D itself; weight E.
 *   measured by weft check ltc-fibre: E at most 0.79 (alpha 0.09, cos_o 0.001);
 *     f(wo, wi) and f(wi, wo) up to 1.00 of the larger apart; weight variance under 0.01 of the cosine's;
 *     half precision: finite for cosines >= 2^-11. */
#pragma once

#include "shading/lobe/lobe.h"
#include "shading/lobe/lobe_tables.h"
#include "shading/ltc/ltc_sheen.h"
#include "shading/ltc/ltc_table.h"

#define LTC_FIBRE_PARAMS(P)                                                                                            \
    P(float, alpha, 0.5f, 0.05f, 1.0f, 0.05f, 1.0f, "square root of what a fibre shows along its axis")
#define LTC_FIBRE_TRAITS (TRAIT_CONSERVES | TRAIT_TABLE)

STRUCT(LtcFibre){LTC_FIBRE_PARAMS(FIELD)};
PREPARED_AS_IT_IS(ltc_fibre, LtcFibre)

STRUCT(LtcFibreView) {
    Ltc ltc;
    float r; /* what it reflects */
};
FN void ltc_fibre_view(const LtcFibrePrepared *p, Dir o, LtcFibreView *w) {
    LtcLobe at = ltc_table_level(lobe_table_ltc_fibre(), o.z, p->m.alpha);
    w->ltc = at.m;
    w->r = min(at.f0, 1.0f);
}

FN LobeValue ltc_fibre_value(const LtcFibrePrepared *p, const LtcFibreView *w, Angles a) {
    return ltc_sheen_value(w->ltc, w->r, a);
}
FN Dir ltc_fibre_sample(const LtcFibrePrepared *p, const LtcFibreView *w, Dir o, float u, float v) {
    return ltc_sample(w->ltc, o, u, v);
}
FN Proxy ltc_fibre_proxy(LtcFibre m) { return proxy_fibres(m.alpha); }
