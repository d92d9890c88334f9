/* lobe.h - a lobe with its parameters, and the functions that every lobe defines */
#pragma once

#include "shading/dialect/angles.h"
#include "shading/dialect/proxy.h"
#include "shading/lobe/lobe_value.h"

/* A lobe is one file in lobes/ and one row of lobes.list. For the row ID, "-" in it read as "_", as NAME and in the
 * upper and lower case of the language, its file defines
 *
 *   NAME_PARAMS(P), NAME_TRAITS             the parameters, one line each; its traits (traits.h)
 *   STRUCT(Name)                            the parameters as a record
 *   STRUCT(NamePrepared)                    what is computed from them, for all directions
 *   STRUCT(NameView)                        what is computed from wo, for all wi
 *   void name_prepare(Name m, NamePrepared *p)
 *   void name_view(const NamePrepared *p, Dir o, NameView *w)
 *   LobeValue name_value(const NamePrepared *p, const NameView *w, Angles a)
 *   Dir name_sample(const NamePrepared *p, const NameView *w, Dir o, float u, float v)
 *
 * f of the value is that of a white lobe, pdf the density of name_sample. Everything is inlined: what a caller does
 * not read is not computed. A lobe with TRAIT_TWO_COLORS mixes f0 and f90 by the share s of its value; if the second
 * colour is not the user's f90 it has
 *
 *   float name_second(Name m, float f0, float f90)
 *
 * A lobe with TRAIT_TINTED has a colour that is no factor, the albedo of what it is made of: the tint of its value
 * (tint.h). A lobe with TRAIT_REFERENCE takes a random walk: its f is an estimate, a function of its inputs whose
 * mean over a neighbourhood is meant. Its text is C, with loops: GPUs, arrays and 16-bit floats do without it. Since
 * no quadrature integrates random numbers it has E of the white lobe too:
 *
 *   float name_albedo(Name m, Dir o, int walks)
 *
 * A lobe whose highlight is elongated may have its normals in strips (terms/d_ggx.h), which light from an
 * environment then takes in place of name_sample:
 *
 *   Strip name_strip(const NamePrepared *p, Dir o, float u, float v)
 *
 * A lobe that is not broad names its stand-in under polygon lights (proxy.h):
 *
 *   Proxy name_proxy(Name m)
 *
 * A lobe that replaces its first parameter where it was not fitted returns the one that it uses:
 *
 *   float name_fitted(Name m)
 *
 * A lobe whose f has a crease as a function of cos_i, from a clamp or from the columns of a table that is mixed
 * linearly, lists these cosines in ascending order, then 0:
 *
 *   float name_crease(Name m, float cos_o, int k)
 *
 * From all files cmake/lobes.cmake generates dispatch.gen.h and lobe_ids.gen.h. */

/* The greatest number of parameters. */
#define LOBE_PARAMS_MAX 8

/* A lobe with its parameters, in the order of its table. */
STRUCT(Lobe) {
    int id; /* one of LOBE_... */
    float params[LOBE_PARAMS_MAX];
};

/* The numbers that a material gives the parameters of these names; one below 0 leaves its parameter as it is.
 * Angles are radians. All but beta and wrap leave the first parameter alone, which is the roughness's. */
#define LOBE_NAMES(N)         N(density) N(tilt) N(azimuth) N(tail) N(rise) N(retro) N(lift) N(beta) N(wrap)
#define LOBE_NAME_FIELD(name) float name;
STRUCT(LobeNamed){LOBE_NAMES(LOBE_NAME_FIELD)};

/* Leaves all parameters as they are. */
#define LOBE_NAME_NONE(name) n.name = -1.0f;
FN LobeNamed lobe_unnamed(void) {
    LobeNamed n;
    LOBE_NAMES(LOBE_NAME_NONE)
    return n;
}

/* Whoever makes a lobe makes the tables that it reads; a shader has them already. */
#ifndef LOBE_TABLES_MAKE
#define LOBE_TABLES_MAKE(id)
#endif

/* For a lobe that prepares only its parameters, and for one with an empty view. */
#define PREPARED_AS_IT_IS(name, Name)                                                                                  \
    STRUCT(Name##Prepared) { Name m; };                                                                                \
    FN void name##_prepare(Name m, Name##Prepared *p) { p->m = m; }
#define SEEN_AS_IT_IS(name, Name)                                                                                      \
    STRUCT(Name##View) { float none; };                                                                                \
    FN void name##_view(const Name##Prepared *p, Dir o, Name##View *w) { w->none = 0.0f; }
