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
 * (ltc.h).
 *   color: a factor, as engines have it; that of fibres is not.
 *   roughness: alpha = roughness^2.
 *   reciprocal: no; z, q, b and E belong to wo alone.
 *   energy: E <= 1, and exact at the nodes of the table.
 *   sampling: D itself; weight E.
 *   measured by weft check ltc-fibre: E at most 0.79 (alpha 0.09, cos_o 0.001);
 *     f(wo, wi) and f(wi, wo) up to 1.00 of the larger apart; weight variance under 0.01 of the cosine's;
 *     half precision: finite for cosines >= 2^-11. */
#ifndef WEFT_LOBES_LTC_FIBRE_H
#define WEFT_LOBES_LTC_FIBRE_H

#include "shading/angles.h"
#include "shading/lobe_tables.h"
#include "shading/ltc_table.h"

#define LTC_FIBRE_PARAMS(P)                                                                                  \
    P(float, alpha, 0.5f, 0.05f, 1.0f, 0.05f, 1.0f, "square root of what a fibre shows along its axis")
#define LTC_FIBRE_TRAITS (TRAIT_CONSERVES | TRAIT_TABLE)

STRUCT(LtcFibre){LTC_FIBRE_PARAMS(FIELD)};

FN LtcLobe ltc_fibre_at(LtcFibre m, float cos_o) {
    LtcLobe l = ltc_table_level(lobe_table_ltc_fibre(), cos_o, m.alpha);
    l.f0 = min(l.f0, 1.0f);
    return l;
}

FN float ltc_fibre_eval(LtcFibre m, Angles a) {
    LtcLobe l = ltc_fibre_at(m, a.o.z);
    Dir v = ltc_inverse(l.m, a.o, a.i);
    float r2 = max(dir_dot(v, v), 1e-18f); /* keeps its square a normal number */
    return l.f0 * l.m.z * l.m.det / (PI * r2 * r2);
}

FN float ltc_fibre_pdf(LtcFibre m, Angles a) { return ltc_pdf(ltc_fibre_at(m, a.o.z).m, a.o, a.i); }

FN Dir ltc_fibre_sample(LtcFibre m, Dir o, float u, float v) {
    return ltc_sample(ltc_fibre_at(m, o.z).m, o, u, v);
}

#endif
