/* terms.h - the terms by name: D, V and F to compose a lobe of (lobes/cook_torrance.h)
 *
 * Dialect, like the terms. A row of a list is one term: id, number, calls, a line of help. A new term needs a file in
 * terms/ and a row here (CONTRIBUTING.md has an example); cmake/terms.cmake makes terms.gen.h of both, with all files and
 * the numbers, which are the places of the rows. Tests need the formula a second time. The numbers are constants in GLSL,
 * where a chain of conditions folds to one term. */
#pragma once

#include "shading/dialect/proxy.h"
#include "shading/lobe/fresnel_weight.h"
#include "shading/terms.gen.h"

/* The types of a parameter that is one of these; its value is the number of a row. */
#define DTerm int
#define VTerm int
#define FTerm int

/* T(id, number, D(h), h drawn from D cos_h by u and v, its proxy, help); distributions of cloth are broad */
#define WEFT_D_TERMS(T)                                                                                                \
    T("blinn-phong", D_BLINN_PHONG, blinn_phong_d(alpha, h), blinn_phong_facet(alpha, u, v),                           \
      proxy_facets(alpha, alpha), "power of a cosine; a round highlight with an edge")                                 \
    T("beckmann", D_BECKMANN, beckmann_d(alpha, h), beckmann_facet(alpha, u, v), proxy_facets(alpha, alpha),           \
      "bell curve of slopes; a highlight with an edge")                                                                \
    T("ggx", D_GGX, ggx_d(alpha, alpha, h), ggx_facet(alpha, alpha, u, v), proxy_facets(alpha, alpha),                 \
      "Trowbridge-Reitz; a highlight that glows")                                                                      \
    T("ggx-aniso", D_GGX_ANISO, ggx_d(ax, ay, h), ggx_facet(ax, ay, u, v), proxy_facets(ax, ay),                       \
      "ggx drawn out along the tangent by anisotropy")                                                                 \
    T("gtr1", D_GTR1, gtr1_d(alpha, h), gtr1_facet(alpha, u, v), gtr1_proxy(alpha),                                    \
      "a core in a wide haze, Disney's coat")                                                                          \
    T("ashikhmin", D_ASHIKHMIN, ashikhmin_d(alpha, h), ashikhmin_facet(alpha, u, v), proxy_cosine(),                   \
      "velvet: an even floor and a bright rim")                                                                        \
    T("charlie", D_CHARLIE, charlie_d(alpha, h), charlie_facet(alpha, u, v), proxy_cosine(),                           \
      "power of a sine; the sheen of glTF")                                                                            \
    T("charlie-floored", D_CHARLIE_FLOORED, charlie_floored_d(alpha, h), charlie_floored_facet(alpha, u, v),           \
      proxy_cosine(), "charlie with a faint floor, as engines with half floats have it")                               \
    T("inverse-ggx", D_INVERSE_GGX, inverse_ggx_d(alpha, h), inverse_ggx_facet(alpha, u, v), proxy_cosine(),           \
      "an even floor and a soft rim, Unreal's cloth")                                                                  \
    T("velvet", D_VELVET, velvet_d(alpha, h), velvet_facet(alpha, u, v), proxy_cosine(),                               \
      "the rim of ashikhmin alone, Cycles' old velvet")

/* T(id, number, V, help). 1 / (4 cos_o cos_i) is inside. */
#define WEFT_V_TERMS(T)                                                                                                \
    T("implicit", V_IMPLICIT, implicit_v(a.o.z, a.i.z), "constant: shadows by the cosines alone")                      \
    T("neumann", V_NEUMANN, neumann_v(a.o.z, a.i.z), "the smaller cosine")                                             \
    T("cook-torrance", V_COOK_TORRANCE, cook_torrance_v(a), "V-shaped grooves")                                        \
    T("kelemen", V_KELEMEN, kelemen_v(a.d), "cook-torrance, made cheap")                                               \
    T("smith-beckmann", V_SMITH_BECKMANN, smith_beckmann_v(alpha, a.o, a.i), "Smith's, of beckmann")                   \
    T("smith-ggx", V_SMITH_GGX, smith_ggx_v(alpha, a.o, a.i), "Smith's, of ggx, one factor a direction")               \
    T("smith-ggx-correlated", V_SMITH_GGX_CORRELATED, smith_ggx_correlated_v(alpha, alpha, a.o, a.i),                  \
      "Smith's, of ggx, by the height of the facet")                                                                   \
    T("smith-ggx-fast", V_SMITH_GGX_FAST, smith_ggx_fast_v(alpha, a.o.z, a.i.z),                                       \
      "smith-ggx-correlated without square roots")                                                                     \
    T("schlick-beckmann", V_SCHLICK_BECKMANN, schlick_beckmann_v(alpha, a.o.z, a.i.z), "smith-beckmann, made cheap")   \
    T("schlick-ggx", V_SCHLICK_GGX, schlick_ggx_v(alpha, a.o.z, a.i.z), "smith-ggx, made cheap")                       \
    T("smith-ggx-aniso", V_SMITH_GGX_ANISO, smith_ggx_aniso_v(ax, ay, a.o, a.i), "smith-ggx-correlated, of ggx-aniso") \
    T("smith-ggx-aniso-separate", V_SMITH_GGX_ANISO_SEPARATE, smith_ggx_aniso_separate_v(ax, ay, a.o, a.i),            \
      "smith-ggx, of ggx-aniso")                                                                                       \
    T("urp", V_URP, urp_v(alpha, a), "Smith's and Fresnel's in one quotient, Unity's on phones")                       \
    T("neubelt", V_NEUBELT, neubelt_v(a.o.z, a.i.z), "the smooth stand-in that most engines give cloth")               \
    T("neubelt-clamped", V_NEUBELT_CLAMPED, neubelt_clamped_v(a.o.z, a.i.z), "neubelt at most 1, as three.js has it")  \
    T("conty-kulla", V_CONTY_KULLA, conty_kulla_v(alpha, a.o.z, a.i.z), "fitted to charlie")                           \
    T("conty-kulla-clamped", V_CONTY_KULLA_CLAMPED, conty_kulla_clamped_v(alpha, a.o.z, a.i.z),                        \
      "conty-kulla at most 1, as glTF's viewer has it")                                                                \
    T("conty-kulla-soft", V_CONTY_KULLA_SOFT, conty_kulla_soft_v(alpha, a.o.z, a.i.z),                                 \
      "conty-kulla without a hard terminator; not reciprocal")

/* T(id, number, share s of the second colour, the second colour, help):  F = f0 (1 - s) + second s, or with
 * a cosine for a share what fresnel_weight.h makes of it */
#define WEFT_F_TERMS(T)                                                                                                \
    T("none", F_NONE, 0.0f, f0, "f0 from everywhere")                                                                  \
    T("schlick", F_SCHLICK, schlick_s(d), 1.0f, "to white by a fifth power")                                           \
    T("schlick-f90", F_SCHLICK_F90, schlick_s(d), f90, "to the colour f90 by a fifth power")                           \
    T("schlick-gaussian", F_SCHLICK_GAUSSIAN, schlick_gaussian_s(d), f90,                                              \
      "schlick-f90 by an exponential, as three.js has it")                                                             \
    T("cook-torrance", F_COOK_TORRANCE, fresnel_weight_of_cosine(d), 1.0f,                                             \
      "exact, by the index that each f0 stands for")                                                                   \
    T("dielectric", F_DIELECTRIC, dielectric_s(ior, d), 1.0f, "to white as a dielectric of that ior does")             \
    T("conductor", F_CONDUCTOR, conductor_s(ior, k, d), 1.0f, "to white as a metal of that ior and k does")

#define D_CASE(id, NAME, value, drawn, proxy, help)                                                                    \
    if (term == NAME) return value;
#define D_FACET(id, NAME, value, drawn, proxy, help)                                                                   \
    if (term == NAME) return drawn;
#define D_PROXY(id, NAME, value, drawn, proxy, help)                                                                   \
    if (term == NAME) return proxy;
#define V_CASE(id, NAME, value, help)                                                                                  \
    if (term == NAME) return value;
#define F_CASE(id, NAME, share, second, help)                                                                          \
    if (term == NAME) return share;
#define F_OTHER(id, NAME, share, second, help)                                                                         \
    if (term == NAME) return second;

/* Returns D of h, 1/sr: integral of D cos_h = 1. alpha <= 1; ax and ay are the widths of ggx-aniso. */
FN float term_d(int term, float alpha, float ax, float ay, Dir h) {
    WEFT_D_TERMS(D_CASE)
    return 0.0f;
}

/* Samples a half vector from D cos_h for u, v in [0, 1). */
FN Dir term_facet(int term, float alpha, float ax, float ay, float u, float v) {
    WEFT_D_TERMS(D_FACET)
    return dir(0.0f, 0.0f, 1.0f);
}

FN Proxy term_proxy(int term, float alpha, float ax, float ay) {
    WEFT_D_TERMS(D_PROXY)
    return proxy_cosine();
}

FN float term_v(int term, float alpha, float ax, float ay, Angles a) {
    WEFT_V_TERMS(V_CASE)
    return 0.0f;
}

/* Returns the Fresnel weight s at d = wi . h, in [0, 1] if it is a fraction. */
FN float term_f(int term, float ior, float k, float d) {
    WEFT_F_TERMS(F_CASE)
    return 0.0f;
}

FN float term_second(int term, float f0, float f90) {
    WEFT_F_TERMS(F_OTHER)
    return f0;
}
