/* ltc-fibre-published - velvet, felt and fuzz by the table that its authors published, to match it
 *
 *   f = R D / cos_i,  D = a^2 v_z / (pi |v|^4),  v = (a wi_x + b wi_z, a wi_y, wi_z),  x along wo  [1/sr]
 *
 *   Tizian Zeltner, Brent Burley, Matt Jen-Yuan Chiang, "Practical Multiple-Scattering Sheen Using Linearly
 * Transformed Cosines", SIGGRAPH Talks 2022. a, b and R are those of 32 cosines by 32 alphas, mixed linearly
 * in both, as in the authors' program. They are of white flakes around upright fibres, density 1, with walks
 * that end at the 16th flake (docs/fibre.md, section 3): at low alpha the horizon is darker than fibres are,
 * which ltc-fibre has right.
 *   Departures: the numbers are made anew by weft's own walk and fit (fibre/truncated_walk.h), so they have noise of
 * their own. Where light is too faint for a shape the authors have a = b = 0 and so no light; here the shape
 * is that of the next rougher row. At normal incidence b is 0; theirs is noise below .003. Theirs has alpha
 * down to 0.
 *   color: a factor, as engines have it; that of fibres is not.
 *   roughness: alpha = roughness^2, as of every sheen here; the talk gives alpha itself to artists.
 *   reciprocal: no; a, b and R belong to wo alone.
 *   energy: E <= 1.
 *   sampling: D itself; weight R.
 *   measured by weft check ltc-fibre-published: E at most 0.75 (alpha 1, cos_o 0.001);
 *     f(wo, wi) and f(wi, wo) up to 0.99 of the larger apart; weight variance under 0.01 of the cosine's;
 *     half precision: finite for any cosines. */
#pragma once

#include "shading/lobe/lobe.h"
#include "shading/lobe/lobe_tables.h"
#include "shading/ltc/ltc_sheen.h"
#include "shading/ltc/ltc_table.h"

#define LTC_FIBRE_PUBLISHED_PARAMS(P)                                                                                  \
    P(float, alpha, 0.5f, 0.05f, 1.0f, 0.05f, 1.0f, "square root of what a fibre shows along its axis")
#define LTC_FIBRE_PUBLISHED_TRAITS (TRAIT_CONSERVES | TRAIT_TABLE)

STRUCT(LtcFibrePublished){LTC_FIBRE_PUBLISHED_PARAMS(FIELD)};
PREPARED_AS_IT_IS(ltc_fibre_published, LtcFibrePublished)

STRUCT(LtcFibrePublishedView) {
    Ltc ltc;
    float r; /* what it reflects */
};
FN void ltc_fibre_published_view(const LtcFibrePublishedPrepared *p, Dir o, LtcFibrePublishedView *w) {
    LtcLobe at = ltc_table_published(lobe_table_ltc_fibre_published(), o.z, p->m.alpha);
    w->ltc = at.m;
    w->r = min(at.f0, 1.0f);
}

FN LobeValue ltc_fibre_published_value(const LtcFibrePublishedPrepared *p, const LtcFibrePublishedView *w, Angles a) {
    return ltc_sheen_value(w->ltc, w->r, a);
}
FN Dir ltc_fibre_published_sample(const LtcFibrePublishedPrepared *p, const LtcFibrePublishedView *w, Dir o, float u,
                                  float v) {
    return ltc_sample(w->ltc, o, u, v);
}
FN Proxy ltc_fibre_published_proxy(LtcFibrePublished m) { return proxy_fibres(m.alpha); }
