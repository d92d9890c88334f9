/* cook-torrance - whatever you put together: any distribution of facets or fibres with any shadowing and any
 * Fresnel term
 *
 *   f = D(h) V(wo, wi) F(wi . h),   F = f0 (1 - s) + second s                                    [1/sr]
 *   alpha_x = stretch alpha,  alpha_y = alpha,  of a round V beside D = ggx-aniso sqrt(alpha_x alpha_y)
 *
 *   Robert L. Cook, Kenneth E. Torrance, "A Reflectance Model for Computer Graphics", ACM Transactions on
 * Graphics 1(1), 1982. The choice of terms is that of Brian Karis, "Specular BRDF Reference", 2013, GTR1
 * (Burley 2012) and those of cloth; each file of terms/ names its source.
 *   roughness: alpha = roughness^2 in all of them (Karis), but D = velvet has alpha = sigma of Cycles.
 *   reciprocal: yes, but with V = conty-kulla-soft.
 *   energy: no, a V that does not belong to its D may give E > 1 at grazing.
 *   sampling: half by D, visible normals for ggx and ggx-aniso, h from D cos_h else; half uniform, which
 *     bounds the weight where D finds nothing. 1/2 D cos_h / (4 d) bounds it by 8 V cos_i d / cos_h, the
 *     uniform half by 4 pi D V cos_i.
 *   measured by weft check cook-torrance, other parameters at default: E at most 1.00 (alpha 0.01, cos_o 1);
 *     reciprocal to 1e-3; weight variance 0.05 of the cosine's;
 *     half precision: finite for cosines >= 2^-7 and alpha >= 0.062. */
#pragma once

#include "shading/lobe/lobe.h"
#include "shading/lobe/terms.h"

#define COOK_TORRANCE_PARAMS(P)                                                                                        \
    P(float, alpha, 0.25f, 0.01f, 1.0f, 0.005f, 1.0f, "width of D, and of the V that have one")                        \
    P(DTerm, d, D_GGX, 0, D_LAST, 0, D_LAST, "distribution of half vectors")                                           \
    P(VTerm, v, V_SMITH_GGX_CORRELATED, 0, V_LAST, 0, V_LAST, "shadowing and masking, over 4 cos_o cos_i")             \
    P(FTerm, f, F_SCHLICK, 0, F_LAST, 0, F_LAST, "reflectance from normal to grazing")                                 \
    P(float, stretch, 1.0f, 1.0f, 10.0f, 0.01f, 100.0f, "of ggx-aniso and smith-ggx-aniso along x")                    \
    P(float, ior, 1.5f, 1.0f, 3.0f, 0.05f, 10.0f, "index of refraction for F = dielectric and conductor")              \
    P(float, k, 3.0f, 0.0f, 8.0f, 0.0f, 20.0f, "extinction of F = conductor")
#define COOK_TORRANCE_TRAITS (TRAIT_RECIPROCAL | TRAIT_ANISOTROPIC | TRAIT_TWO_COLORS)

STRUCT(CookTorrance){COOK_TORRANCE_PARAMS(FIELD)};
PREPARED_AS_IT_IS(cook_torrance, CookTorrance)
SEEN_AS_IT_IS(cook_torrance, CookTorrance)

FN float cook_torrance_ax(CookTorrance m) { return m.alpha * m.stretch; }

/* Returns D; cook_torrance_shadow returns V. */
FN float cook_torrance_spread(CookTorrance m, Angles a) {
    return term_d(m.d, m.alpha, cook_torrance_ax(m), m.alpha, a.h);
}
FN float cook_torrance_shadow(CookTorrance m, Angles a) {
    float mean = m.alpha;
    if (m.d == D_GGX_ANISO) mean = m.alpha * sqrt(m.stretch);
    return term_v(m.v, mean, cook_torrance_ax(m), m.alpha, a);
}

FN float cook_torrance_fresnel_weight(CookTorrance m, Angles a) { return term_f(m.f, m.ior, m.k, a.d); }
FN float cook_torrance_second(CookTorrance m, float f0, float f90) { return term_second(m.f, f0, f90); }

/* Returns the density of samples. spread: D of the half vector. */
FN float cook_torrance_sample_pdf(CookTorrance m, float spread, Angles a) {
    float pdf;
    if (m.d == D_GGX)
        pdf = ggx_pdf_h(m.alpha, m.alpha, a);
    else if (m.d == D_GGX_ANISO)
        pdf = ggx_pdf_h(cook_torrance_ax(m), m.alpha, a);
    else
        pdf = facet_pdf(spread * a.h.z, a);
    return 0.5f * pdf + 0.5f * warp_uniform_pdf(a.i);
}
FN Proxy cook_torrance_proxy(CookTorrance m) { return term_proxy(m.d, m.alpha, cook_torrance_ax(m), m.alpha); }

FN LobeValue cook_torrance_value(const CookTorrancePrepared *p, const CookTorranceView *w, Angles a) {
    float spread = cook_torrance_spread(p->m, a);
    return lobe_value_of(spread * cook_torrance_shadow(p->m, a), cook_torrance_fresnel_weight(p->m, a),
                         cook_torrance_sample_pdf(p->m, spread, a));
}

FN Dir cook_torrance_sample(const CookTorrancePrepared *p, const CookTorranceView *view, Dir o, float u, float v) {
    if (u >= 0.5f) return warp_uniform(2.0f * u - 1.0f, v);
    CookTorrance m = p->m;
    float ax = cook_torrance_ax(m), w = 2.0f * u;
    if (m.d == D_GGX) return dir_mirror(o, ggx_sample_h(m.alpha, m.alpha, o, w, v));
    if (m.d == D_GGX_ANISO) return dir_mirror(o, ggx_sample_h(ax, m.alpha, o, w, v));
    return dir_mirror(o, facet_towards(o, term_facet(m.d, m.alpha, ax, m.alpha, w, v)));
}

/* Returns a strip of samples without the uniform half: strips of ggx-aniso, ordinary samples of other D. */
FN Strip cook_torrance_strip(const CookTorrancePrepared *p, Dir o, float u, float v) {
    CookTorrance m = p->m;
    float ax = cook_torrance_ax(m);
    Strip strip;
    strip.density = 1.0f;
    if (m.d == D_GGX_ANISO)
        strip = ggx_strip_h(ax, m.alpha, o, u, v);
    else if (m.d == D_GGX)
        strip.h = ggx_sample_h(m.alpha, m.alpha, o, u, v);
    else
        strip.h = facet_towards(o, term_facet(m.d, m.alpha, ax, m.alpha, u, v));
    Angles a = angles_between(o, dir_mirror(o, strip.h));
    float pdf = cook_torrance_sample_pdf(m, cook_torrance_spread(m, a), a);
    float even = 0.5f * warp_uniform_pdf(a.i) / max(pdf, 1e-20f);
    strip.density = strip.density * 2.0f * max(1.0f - even, 1e-3f);
    return strip;
}
