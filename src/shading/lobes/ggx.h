/* ggx - the sharp or blurred mirror of a dielectric, a metal or a coat; stretched when brushed
 *
 *   f = D(h) V(wo, wi) F(wi . h),   F = f0 (1 - s) + f90 s                                       [1/sr]
 *   alpha_x = alpha + (1 - alpha) anisotropy^2,  alpha_y = alpha
 *
 *   D, V, F: terms d_ggx, v_smith_ggx_correlated, f_schlick, where the papers are named.
 *   Anisotropy: Khronos Group, KHR_materials_anisotropy, 2023.
 *   roughness: alpha = roughness^2 (Burley 2012, section 5.4).
 *   reciprocal: yes.
 *   energy: E <= 1; multiple scattering between facets is lost, of a white lobe at most 16 % at
 *     alpha 0.25, 32 % at 0.5 and, at normal incidence, ln 2 = 69 % at alpha 1.
 *   sampling: visible normals; the weight is F G2 / G1 <= 1.
 *   Not for: cloth whose fibres stand up; those have no highlight in the mirror direction.
 *   measured by weft check ggx, other parameters at default: E at most 1.00 (alpha 0.01, cos_o 1);
 *     reciprocal to 1e-3; weight variance under 0.01 of the cosine's;
 *     half precision: finite for cosines >= 2^-7 and alpha >= 0.062. */
#pragma once

#include "shading/lobe/lobe.h"
#include "shading/terms/d_ggx.h"
#include "shading/terms/f_schlick.h"

/* P(type, name, default, low, high, hard_low, hard_high, help): low .. high is what a slider spans; values
 * beyond it are taken with a warning up to the hard clamp. */
#define GGX_PARAMS(P)                                                                                                  \
    P(float, alpha, 0.25f, 0.01f, 1.0f, 0.001f, 4.0f, "width of the facet slopes across the brushing")                 \
    P(float, anisotropy, 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, "0 round, 1 as rough along x as can be")
#define GGX_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_ANISOTROPIC | TRAIT_TWO_COLORS)

STRUCT(Ggx){GGX_PARAMS(FIELD)};

FN float ggx_ax(Ggx m) { return mix(m.alpha, 1.0f, m.anisotropy * m.anisotropy); }

STRUCT(GgxPrepared) {
    float ax, ay;         /* alpha along x and y */
    float per_ax, per_ay; /* their reciprocals */
    float d_scale;        /* 1 / (pi ax ay) */
};
FN GgxPrepared ggx_stretched(float ax, float ay) {
    GgxPrepared p;
    p.ax = ax;
    p.ay = ay;
    p.per_ax = 1.0f / ax;
    p.per_ay = 1.0f / ay;
    p.d_scale = 1.0f / (PI * ax * ay);
    return p;
}
FN void ggx_prepare(Ggx m, GgxPrepared *p) { *p = ggx_stretched(ggx_ax(m), m.alpha); }

STRUCT(GgxView) {
    float length_o;  /* |A wo|, A = diag(ax, ay, 1) */
    float pdf_scale; /* pdf = D pdf_scale */
};
FN void ggx_view(const GgxPrepared *p, Dir o, GgxView *w) {
    w->length_o = ggx_length(p->ax, p->ay, o);
    w->pdf_scale = 0.5f / (o.z + w->length_o);
}

FN LobeValue ggx_value(const GgxPrepared *p, const GgxView *w, Angles a) {
    float x = a.h.x * p->per_ax, y = a.h.y * p->per_ay, q = x * x + y * y + a.h.z * a.h.z;
    float d = p->d_scale / (q * q);
    float visibility = 0.5f / max(a.i.z * w->length_o + a.o.z * ggx_length(p->ax, p->ay, a.i), 1e-12f);
    return lobe_value_of(d * visibility, schlick_s(a.d), d * w->pdf_scale);
}
FN Dir ggx_sample(const GgxPrepared *p, const GgxView *w, Dir o, float u, float v) {
    return dir_mirror(o, ggx_sample_h(p->ax, p->ay, o, u, v));
}
FN Proxy ggx_proxy(Ggx m) { return proxy_facets(ggx_ax(m), m.alpha); }
FN Strip ggx_strip(const GgxPrepared *p, Dir o, float u, float v) { return ggx_strip_h(p->ax, p->ay, o, u, v); }
