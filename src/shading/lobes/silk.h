/* silk - the stretched highlight of satin weave and filament yarn, in a colour of its own
 *
 *   f = D(h) V(wo, wi) F(wi . h),   F = f0 (1 - s) + f90 s                                      [1/sr]
 *   alpha_x = alpha (1 + anisotropy),  alpha_y = alpha (1 - anisotropy),  neither below 1/1024
 *
 *   D, V, F: terms d_ggx, v_smith_ggx_correlated, f_schlick, where the papers are named.
 *   Unity Technologies, High Definition Render Pipeline, 2018 on: Fabric.hlsl (silk) and
 *     CommonMaterial.hlsl (ConvertAnisotropyToClampRoughness). The mapping: Christopher Kulla, Alejandro
 *     Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH 2017 course, page 15. It differs
 *     from that of lobe ggx.
 *   Departures: f90 is free, Unity's is 1. Anisotropy ends at 0.8 of Unity's 1, where the lobe is a ridge
 *     1/1024 wide that no quadrature of E resolves.
 *   roughness: alpha = roughness^2 = (1 - smoothness)^2 (Unity).
 *   reciprocal: yes.
 *   energy: E <= 1; multiple scattering between facets is lost, by default 12 % at the normal, 16 % at cos_o
 *     0.5.
 *   sampling: visible normals; the weight is F G2 / G1 <= 1.
 *   Not for: two yarns of two colours; that is threads.
 *   measured by weft check silk, other parameters at default: E at most 1.00 (alpha 0.01, cos_o 1);
 *     reciprocal to 1e-3; weight variance under 0.01 of the cosine's;
 *     half precision: finite for cosines >= 2^-7 and alpha >= 0.088. */
#pragma once

#include "shading/lobes/ggx.h"

#define SILK_PARAMS(P)                                                                                                 \
    P(float, alpha, 0.25f, 0.01f, 1.0f, 0.001f, 1.0f, "mean width of the facet slopes")                                \
    P(float, anisotropy, 0.6f, -0.8f, 0.8f, -0.8f, 0.8f, "above 0 rougher along x, below 0 along y")
#define SILK_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_ANISOTROPIC | TRAIT_TWO_COLORS)

STRUCT(Silk){SILK_PARAMS(FIELD)};

FN float silk_ax(Silk m) { return max(m.alpha * (1.0f + m.anisotropy), 1.0f / 1024.0f); }
FN float silk_ay(Silk m) { return max(m.alpha * (1.0f - m.anisotropy), 1.0f / 1024.0f); }

STRUCT(SilkPrepared) { GgxPrepared ggx; };
FN void silk_prepare(Silk m, SilkPrepared *p) { p->ggx = ggx_stretched(silk_ax(m), silk_ay(m)); }

STRUCT(SilkView) { GgxView ggx; };
FN void silk_view(const SilkPrepared *p, Dir o, SilkView *w) { ggx_view(&p->ggx, o, &w->ggx); }

FN LobeValue silk_value(const SilkPrepared *p, const SilkView *w, Angles a) { return ggx_value(&p->ggx, &w->ggx, a); }
FN Dir silk_sample(const SilkPrepared *p, const SilkView *w, Dir o, float u, float v) {
    return ggx_sample(&p->ggx, &w->ggx, o, u, v);
}
FN Proxy silk_proxy(Silk m) { return proxy_facets(silk_ax(m), silk_ay(m)); }
FN Strip silk_strip(const SilkPrepared *p, Dir o, float u, float v) { return ggx_strip(&p->ggx, o, u, v); }
