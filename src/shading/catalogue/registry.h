/* registry.h - the catalogue as data: every lobe, its parameters, and its functions behind one signature
 *
 * lobe.h describes a lobe and how to add one. Dialect texts include this file too: in GLSL the flattener
 * (text/) puts in its place lobe_ids.gen.h and dispatch.gen.h, for the lobes that a program needs. */
#pragma once

#include <stddef.h>

/* Makes the tables of a lobe (lobe_tables.h). */
void lobe_tables_make_for(int id);
#undef LOBE_TABLES_MAKE
#define LOBE_TABLES_MAKE(id) lobe_tables_make_for(id)

#include "shading/lobe/traits.h"
#include "shading/lobe_ids.gen.h"
#include "shading/lobes.gen.h"
#include "shading/terms/d_ggx.h"
#include "weft/lobe.h"

/* The names of things in a lobe's text: "ggx", "Ggx" and "GGX". */
typedef struct LobeNames {
    const char *prefix, *record, *macros;
    bool strips; /* true if the lobe has strips (lobe.h) */
} LobeNames;
const LobeNames *lobe_names(int id);

/* A lobe from outside the catalogue (outside.h), which lives as long as the program. */
typedef struct OutsideLobe {
    WeftLobeInfo info;
    LobeNames names;
    const struct Plugin *plugin;
    const struct OutsideLobe *before; /* the lobe that this one replaced; set by outside_take */
    const char *file, *text;          /* "shading/lobes/toy.h", as though it were there, and what is in it */
} OutsideLobe;

/* Adds a lobe, in place of one of the same name or behind the last. Returns false if no place is free. May be
 * called from any thread while others use lobes. outside_lobe returns NULL if the id is not that of an
 * outside lobe. */
bool outside_take(OutsideLobe *lobe, int *id);
const OutsideLobe *outside_lobe(int id);
int outside_count(void);

/* The functions of dispatch.gen.h, one copy of each. */
#define LOBE_COPY __attribute__((noinline))
LOBE_COPY void lobe_prepare(const Lobe *m, LobePrepared *p);
LOBE_COPY void lobe_view(int id, const LobePrepared *p, const Dir *o, LobeView *w);
LOBE_COPY void lobe_value_at(int id, const LobePrepared *p, const LobeView *w, const Angles *a, LobeValue *v);
LOBE_COPY void lobe_reflect(int id, const LobePrepared *p, const LobeView *w, const Angles *a, const Rgb *f0,
                            const Rgb *f90, LobeReflected *s);
LOBE_COPY void lobe_sample_at(int id, const LobePrepared *p, const LobeView *w, const Dir *o, float u, float v, Dir *i);
LOBE_COPY LobeValue lobe_value(const Lobe *m, Angles a);
LOBE_COPY Dir lobe_sample(const Lobe *m, Dir o, float u, float v);
LOBE_COPY Strip lobe_strip(const Lobe *m, Dir o, float u, float v);

static inline Lobe lobe_fibres(Lobe lobe, float density, float tilt, float azimuth) {
    LobeNamed n = lobe_unnamed();
    n.density = density, n.tilt = tilt, n.azimuth = azimuth;
    return lobe_named(lobe, n);
}
static inline float lobe_eval(const Lobe *lobe, Angles a) { return lobe_value(lobe, a).f; }
static inline float lobe_pdf(const Lobe *lobe, Angles a) { return lobe_value(lobe, a).pdf; }

/* Returns the ids that a parameter of a term's type, such as "DTerm", takes (WeftParamInfo); NULL for
 * other types. */
const char *const *lobe_choices(const char *type);

/* Sets parameter k, clamped to its hard range. */
void lobe_set(Lobe *lobe, int k, float value);

/* Returns true if the lobe depends on azimuth: upright fibres and unbrushed lobes do not. */
bool lobe_depends_on_azimuth(const Lobe *lobe);

/* Fills lobe with the registry's lobe for a public one, its parameters clamped. Returns false if no lobe has that
 * index. */
bool lobe_of(const WeftLobe *public_lobe, Lobe *lobe);

/* Warns if a lobe computes with another first parameter than it has, as weft_lobe_fitted does. */
void lobe_fitted(const Lobe *lobe, const char *name, const WeftLog *log);

/* Returns the first parameter that the lobe computes with. */
float lobe_fitted_first(const Lobe *lobe);

/* Fills cosines with those of name_crease (lobe.h). Returns their number, 0 for most lobes. */
enum { LOBE_CREASES_MOST = 62 };
int lobe_creases(const Lobe *lobe, float cos_o, float cosines[LOBE_CREASES_MOST]);

/* Returns E of a lobe with TRAIT_REFERENCE, estimated by that many walks; 0 for other lobes. */
LOBE_COPY float lobe_walked_albedo(const Lobe *lobe, Dir o, int walks);

/* Computes f[k] and, if s is not NULL, the share s[k] of the second colour, for n pairs of directions as structures of
 * arrays. Both are 0 if a direction is not above the horizon or a component is infinite or NaN. */
void lobe_eval_n(const Lobe *lobe, size_t n, const float *ox, const float *oy, const float *oz, const float *ix,
                 const float *iy, const float *iz, float *f, float *s);

/* Computes pdf[k] in the same way. */
void lobe_pdf_n(const Lobe *lobe, size_t n, const float *ox, const float *oy, const float *oz, const float *ix,
                const float *iy, const float *iz, float *pdf);

/* Computes f[c][k] of a lobe with TRAIT_TINTED whose scatterers have albedo w[c], in the same way. Not for other
 * lobes. */
void lobe_tinted_n(const Lobe *lobe, const float w[3], size_t n, const float *ox, const float *oy, const float *oz,
                   const float *ix, const float *iy, const float *iz, float *const f[3]);
