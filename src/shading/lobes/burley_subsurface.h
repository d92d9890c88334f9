/* burley-subsurface - a surface that light sinks into before it returns: flatter and softer at the edges
 *
 *   f = color mix(burley, ss, subsurface),  ss = 1.25 (Fss (1 / (cos_i + cos_o) - 0.5) + 0.5) / pi  [1/sr]
 *   Fss = (1 + (fss90 - 1) s_i) (1 + (fss90 - 1) s_o)
 *   fss90 = d^2 roughness,  s = (1 - cos)^5,  d = wi . h
 *
 *   Brent Burley, "Physically Based Shading at Disney", SIGGRAPH 2012 course, Section 5.3, and disney.brdf of
 * the BRDF Explorer; flattened after Pat Hanrahan, Wolfgang Krueger, "Reflection from Layered Surfaces due to
 * Subsurface Scattering", SIGGRAPH 1993.
 *   roughness: the artist's own, not squared.
 *   reciprocal: yes.
 *   energy: no, E passes 1 at any roughness: at roughness 0 it is 0.749 at the normal and up to 1.211 on
 *     the way to grazing; at cos_o 0.02 it is 0.758 at roughness 0 and 1.504 at 1.
 *   sampling: half cosine, half uniform; the weight is at most 5.
 *   measured by weft check burley-subsurface, other parameters at default: E at most 1.51 (roughness 1, cos_o 0.001);
 *     reciprocal to 1e-3; weight variance 0.71 of the cosine's;
 *     half precision: finite for cosines >= 2^-16. */
#pragma once

#include "shading/lobes/burley.h"

#define BURLEY_SUBSURFACE_PARAMS(P)                                                                                    \
    P(float, roughness, 0.5f, 0.0f, 1.0f, 0.0f, 1.0f, "brightness of grazing light thrown back")                       \
    P(float, subsurface, 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, "1 is this lobe, 0 is burley")
#define BURLEY_SUBSURFACE_TRAITS (TRAIT_RECIPROCAL | TRAIT_DIFFUSE)

STRUCT(BurleySubsurface){BURLEY_SUBSURFACE_PARAMS(FIELD)};
PREPARED_AS_IT_IS(burley_subsurface, BurleySubsurface)

STRUCT(BurleySubsurfaceView) { float s_o; };
FN void burley_subsurface_view(const BurleySubsurfacePrepared *p, Dir o, BurleySubsurfaceView *w) {
    w->s_o = schlick_s(o.z);
}

/* Returns mix(1, fss90, s) with 1 - s multiplied out. At grazing both would be lost in the rounding of 1 - s, and the
 * rest is divided by cos_i + cos_o. */
FN float burley_subsurface_f(float fss90, float z) {
    float k = z * (5.0f - z * (10.0f - z * (10.0f - z * (5.0f - z))));
    return k + (1.0f - k) * fss90;
}

FN LobeValue burley_subsurface_value(const BurleySubsurfacePrepared *p, const BurleySubsurfaceView *w, Angles a) {
    float fss90 = a.d * a.d * p->m.roughness;
    float fss = burley_subsurface_f(fss90, a.i.z) * burley_subsurface_f(fss90, a.o.z);
    float ss = 1.25f * (fss * (1.0f / (a.i.z + a.o.z) - 0.5f) + 0.5f) / PI;
    float f = burley_f(p->m.roughness, w->s_o, schlick_s(a.i.z), a.d);
    return lobe_value_of(mix(f, ss, p->m.subsurface), 0.0f, warp_uniform_cosine_pdf(0.5f, a.i));
}
FN Dir burley_subsurface_sample(const BurleySubsurfacePrepared *p, const BurleySubsurfaceView *w, Dir o, float u,
                                float v) {
    return warp_uniform_cosine(0.5f, u, v);
}
