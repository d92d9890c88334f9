/* ltc-fibre-half - velvet, felt and fuzz as Babylon.js draws them: a table read at the half vector, and too dark
 *
 *   f = R v_z / |v|,  v = (a wi_x + b wi_y, wi_y, wi_z);  a, b, R at the cosine n . h            [1/sr]
 *   a = 0.005 + 0.875 g((a_t - 0.005) / 0.875),  b = -0.18 + 0.182 g((b_t + 0.18) / 0.182),  R = 0.75 g(R_t / 0.75)
 *   g(x) = x^2.2;  a_t, b_t, R_t: the published table
 *
 *   BabylonJS/Babylon.js, ShadersInclude: evalFuzz of pbrDirectLightingFunctions, openpbrDirectLighting,
 * getFuzzBRDFLookup of pbrBRDFFunctions, brdfTextureTools, 2025. Tizian Zeltner, Brent Burley, Matt Jen-Yuan Chiang,
 * "Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines", SIGGRAPH Talks 2022, mean the table for
 * n . wo and x along wo, and have a norm. The picture of the table is linear, but decoded as if it were not, as the
 * engine's other tables are: hence g (docs/fuzz.md).
 *   Departures: the numbers are those of lobe ltc-fibre-published; Babylon.js has 8 bits of them, and mixes after g.
 *   color: a factor.
 *   reciprocal: no, v is of wi alone.
 *   roughness: alpha = roughness^2; Babylon.js has the root of its roughness (profile babylon-openpbr).
 *   energy: E <= 1; it is not R.
 *   sampling: the cosine.
 *   measured by weft check ltc-fibre-half: E at most 0.61 (alpha 1, cos_o 0.001);
 *     f(wo, wi) and f(wi, wo) up to 1.00 of the larger apart; weight variance 1.00 of the cosine's;
 *     half precision: finite for any cosines. */
#pragma once

#include "shading/dialect/warp.h"
#include "shading/lobe/lobe.h"
#include "shading/lobe/lobe_tables.h"
#include "shading/ltc/ltc_table.h"

#define LTC_FIBRE_HALF_PARAMS(P)                                                                                       \
    P(float, alpha, 0.5f, 0.05f, 1.0f, 0.05f, 1.0f, "square root of what a fibre shows along its axis")
#define LTC_FIBRE_HALF_TRAITS (TRAIT_CONSERVES | TRAIT_ANISOTROPIC | TRAIT_TABLE)

STRUCT(LtcFibreHalf){LTC_FIBRE_HALF_PARAMS(FIELD)};
PREPARED_AS_IT_IS(ltc_fibre_half, LtcFibreHalf)
SEEN_AS_IT_IS(ltc_fibre_half, LtcFibreHalf)

/* Returns the fraction of the way between the centres of the first and the last of n texels, as a filtered texture is
 * read. */
FN float ltc_fibre_half_along(float x, int n) {
    float last = to_float(n - 1);
    return clamp((x * (last + 1.0f) - 0.5f) / last, 0.0f, 1.0f);
}

/* Returns the texture's number at a position, which is stored as its share of low to high. */
FN float ltc_fibre_half_read(LtcTable t, LtcSpot at, int plane, float low, float high) {
    float share = clamp((ltc_table_interpolate(t, at, plane) - low) / (high - low), 1e-6f, 1.0f);
    return low + (high - low) * pow(share, 2.2f);
}

FN LtcSpot ltc_fibre_half_spot(LtcTable t, float cosine, float alpha) {
    return ltc_table_spot_at(t, ltc_fibre_half_along(cosine, t.columns), ltc_fibre_half_along(alpha, t.rows));
}

/* Returns R at a cosine. */
FN float ltc_fibre_half_r(float cosine, float alpha) {
    LtcTable t = ltc_table_of(lobe_table_ltc_fibre_published(), LTC_PUBLISHED_PLANES);
    return ltc_fibre_half_read(t, ltc_fibre_half_spot(t, cosine, alpha), LTC_PUBLISHED_R, 0.0f, 0.75f);
}

FN LobeValue ltc_fibre_half_value(const LtcFibreHalfPrepared *p, const LtcFibreHalfView *w, Angles a) {
    LtcTable t = ltc_table_of(lobe_table_ltc_fibre_published(), LTC_PUBLISHED_PLANES);
    LtcSpot at = ltc_fibre_half_spot(t, a.h.z, p->m.alpha);
    float along = ltc_fibre_half_read(t, at, LTC_PUBLISHED_A, 0.005f, 0.88f);
    float across = ltc_fibre_half_read(t, at, LTC_PUBLISHED_B, -0.18f, 0.002f);
    float r = ltc_fibre_half_read(t, at, LTC_PUBLISHED_R, 0.0f, 0.75f);
    float x = along * a.i.x + across * a.i.y;
    float length = sqrt(max(x * x + a.i.y * a.i.y + a.i.z * a.i.z, 1e-12f));
    return lobe_value_of(r * a.i.z / length, 0.0f, warp_cosine_pdf(a.i));
}
FN Dir ltc_fibre_half_sample(const LtcFibreHalfPrepared *p, const LtcFibreHalfView *w, Dir o, float u, float v) {
    return warp_cosine(u, v);
}
