/* lobe.h - a lobe with its parameters, and what every lobe gives */
#ifndef WEFT_SHADING_LOBE_H
#define WEFT_SHADING_LOBE_H

#include "shading/dialect/angles.h"
#include "shading/dialect/proxy.h"
#include "shading/lobe/lobe_value.h"

/* A lobe is one file in lobes/ and one row of lobes.list. For the row ID, "-" in it read as "_", as NAME and
 * in the upper and lower case that the language wants, its file gives
 *
 *   NAME_PARAMS(P), NAME_TRAITS             the parameters, one line each; what holds of it (registry.h)
 *   STRUCT(Name)                            the parameters as a record
 *   STRUCT(NamePrepared)                    what they make, once for all directions
 *   STRUCT(NameView)                        what wo adds, once for all wi
 *   void name_prepare(Name m, NamePrepared *p)
 *   void name_view(const NamePrepared *p, Dir o, NameView *w)
 *   LobeValue name_value(const NamePrepared *p, const NameView *w, Angles a)
 *   Dir name_sample(const NamePrepared *p, const NameView *w, Dir o, float u, float v)
 *
 * f of the value is that of a white lobe, pdf the density of name_sample. All of it is inlined: what a caller
 * does not read is not computed. One with TRAIT_TWO_COLORS mixes f0 and f90 by the share s of its value;
 * where the second is not the user's own f90 it has
 *
 *   float name_second(Name m, float f0, float f90)
 *
 * One with TRAIT_TINTED has a colour that is no factor, the albedo of what it is made of: the tint of its
 * value (tint.h). One with TRAIT_REFERENCE takes a random walk: its f is an estimate, a function of its
 * inputs whose mean over a neighbourhood is meant. Its text is C, with loops: it is kept from GPU, arrays and
 * 16-bit floats. Since no quadrature integrates chance it has E of the white lobe too:
 *
 *   float name_albedo(Name m, Dir o, int walks)
 *
 * One whose highlight is drawn out may have its normals in strips (terms/d_ggx.h), which light from an
 * environment then takes in place of name_sample:
 *
 *   Strip name_strip(const NamePrepared *p, Dir o, float u, float v)
 *
 * One that is not broad names what stands for it under polygon lights (proxy.h):
 *
 *   Proxy name_proxy(Name m)
 *
 * One that computes with another first parameter than it is given where it was not fitted says with which:
 *
 *   float name_fitted(Name m)
 *
 * One whose f bends as a function of cos_i, where it is clamped or since it mixes what is between the columns
 * of a table linearly, lists these cosines, rising, and then 0:
 *
 *   float name_crease(Name m, float cos_o, int k)
 *
 * cmake/lobes.cmake makes of all files what knows every lobe: dispatch.gen.h and lobe_ids.gen.h. */

/* The most that a lobe has. */
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

/* For a lobe whose parameters are all that there is to know, and for one to which wo adds nothing. */
#define PREPARED_AS_IT_IS(name, Name)                                                                        \
    STRUCT(Name##Prepared) { Name m; };                                                                      \
    FN void name##_prepare(Name m, Name##Prepared *p) { p->m = m; }
#define SEEN_AS_IT_IS(name, Name)                                                                            \
    STRUCT(Name##View) { float none; };                                                                      \
    FN void name##_view(const Name##Prepared *p, Dir o, Name##View *w) { w->none = 0.0f; }

#endif
