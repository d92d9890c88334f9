/* ltc-fibre-half - velvet, felt and fuzz as Babylon.js draws them: the published table read at the half vector
 *
 *   f = R v_z / |v|,  v = (a wi_x + b wi_y, wi_y, wi_z);  a, b, R at the cosine n . h            [1/sr]
 *
 *   BabylonJS/Babylon.js, ShadersInclude: evalFuzz of pbrDirectLightingFunctions, openpbrDirectLighting, 2025. Tizian
 * Zeltner, Brent Burley, Matt Jen-Yuan Chiang, "Practical Multiple-Scattering Sheen Using Linearly Transformed
 * Cosines", SIGGRAPH Talks 2022, mean the table for n . wo and x along wo, and have a norm; a = 1, b = 0 give 2 pi / 3 R.
 *   Departures: the table is that of lobe ltc-fibre-published; Babylon.js reads it from a picture of 8 bits.
 *   color: a factor.
 *   reciprocal: no, v is of wi alone.
 *   roughness: alpha = roughness^2; Babylon.js has the root of its roughness (profile babylon-openpbr).
 *   energy: no, E is not R and may pass 1.
 *   sampling: the cosine.
 *   measured by weft check ltc-fibre-half: E at most 1.02 (alpha 1, cos_o 0.001);
 *     f(wo, wi) and f(wi, wo) up to 1.00 of the larger apart; weight variance 1.00 of the cosine's;
 *     half precision: finite for any cosines. */
#pragma once

#include "shading/dialect/warp.h"
#include "shading/lobe/lobe.h"
#include "shading/lobe/lobe_tables.h"
#include "shading/ltc/ltc_table.h"

#define LTC_FIBRE_HALF_PARAMS(P)                                                                                       \
    P(float, alpha, 0.5f, 0.05f, 1.0f, 0.05f, 1.0f, "square root of what a fibre shows along its axis")
#define LTC_FIBRE_HALF_TRAITS (TRAIT_ANISOTROPIC | TRAIT_TABLE)

STRUCT(LtcFibreHalf){LTC_FIBRE_HALF_PARAMS(FIELD)};
PREPARED_AS_IT_IS(ltc_fibre_half, LtcFibreHalf)
SEEN_AS_IT_IS(ltc_fibre_half, LtcFibreHalf)

FN LobeValue ltc_fibre_half_value(const LtcFibreHalfPrepared *p, const LtcFibreHalfView *w, Angles a) {
    LtcTable t = ltc_table_of(lobe_table_ltc_fibre_published(), LTC_PUBLISHED_PLANES);
    LtcSpot at = ltc_table_spot_at(t, clamp(a.h.z, 0.0f, 1.0f), p->m.alpha);
    float x =
        ltc_table_interpolate(t, at, LTC_PUBLISHED_A) * a.i.x + ltc_table_interpolate(t, at, LTC_PUBLISHED_B) * a.i.y;
    float length = sqrt(max(x * x + a.i.y * a.i.y + a.i.z * a.i.z, 1e-12f));
    float r = min(ltc_table_interpolate(t, at, LTC_PUBLISHED_R), 1.0f);
    return lobe_value_of(r * a.i.z / length, 0.0f, warp_cosine_pdf(a.i));
}
FN Dir ltc_fibre_half_sample(const LtcFibreHalfPrepared *p, const LtcFibreHalfView *w, Dir o, float u, float v) {
    return warp_cosine(u, v);
}
