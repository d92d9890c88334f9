/* registry.h - the catalogue as data: every lobe, its parameters, and its functions behind one signature
 *
 * Dialect texts include this file too: in GLSL the flattener (text/) puts in its place what is here made by
 * macros, for the lobes that a program needs: LOBE_ constants, Lobe, LobeValue, lobe_at, lobe_second,
 * lobe_default, lobe_rough and lobe_fibres.
 *
 * Adding a lobe: one file in lobes/, one line in WEFT_LOBES. Command line, docs, tests and renderers follow.
 */
#ifndef WEFT_SHADING_REGISTRY_H
#define WEFT_SHADING_REGISTRY_H

#include <stddef.h>

#include "shading/angles.h"
#include "shading/lobe_value.h"
#include "weft/lobe.h"

/* L(id, functions' prefix, record, macros' prefix).  A lobe of one colour has the functions
 *
 *   float NAME_eval(Record m, Angles a)              f, 1/sr, of a white lobe
 *   float NAME_pdf(Record m, Angles a)               density of NAME_sample at a.i, 1/sr
 *   Dir NAME_sample(Record m, Dir o, float u, float v)
 *
 * One of two colours mixes f0 and f90 by its own share s, f = NAME_eval (f0 (1 - s) + f90 s), and has two
 * more:
 *
 *   float NAME_share(Record m, Angles a)             s in [0, 1]
 *   float NAME_second(Record m, float f0, float f90) the second colour: f90 where the user is free to choose
 * it
 *
 * One of TRAIT_REFERENCE, which is of one colour, takes a random walk: its f is an estimate, a function of
 * its inputs whose mean over a neighbourhood is meant. Its text is C, with loops: it is kept from GPU, arrays
 * and 16-bit floats. It has one function more, for no quadrature integrates chance:
 *
 *   float NAME_albedo(Record m, Dir o, int walks)    E of the white lobe
 * A tinted one has a colour that is no factor, the albedo of what it is made of (tint.h), and one more:
 *
 *   Tint NAME_tint(RecordReady r, Angles a)          how f depends on it
 *
 * and a record of what the parameters make once for all directions, which its NAME_eval takes too:
 *
 *   RecordReady NAME_ready(Record m)
 */
#define WEFT_ONE_COLOR_LOBES(L)                                                                              \
    L("lambert", lambert, Lambert, LAMBERT)                                                                  \
    L("burley", burley, Burley, BURLEY)                                                                      \
    L("burley-subsurface", burley_subsurface, BurleySubsurface, BURLEY_SUBSURFACE)                           \
    L("oren-nayar", oren_nayar, OrenNayar, OREN_NAYAR)                                                       \
    L("fabric-lambert", fabric_lambert, FabricLambert, FABRIC_LAMBERT)                                       \
    L("wrap", wrap, Wrap, WRAP)                                                                              \
    L("burley-sheen", burley_sheen, BurleySheen, BURLEY_SHEEN)                                               \
    L("ashikhmin-neubelt", ashikhmin_neubelt, AshikhminNeubelt, ASHIKHMIN_NEUBELT)                           \
    L("ashikhmin-conty-kulla", ashikhmin_conty_kulla, AshikhminContyKulla, ASHIKHMIN_CONTY_KULLA)            \
    L("charlie-neubelt", charlie_neubelt, CharlieNeubelt, CHARLIE_NEUBELT)                                   \
    L("charlie-conty-kulla", charlie_conty_kulla, CharlieContyKulla, CHARLIE_CONTY_KULLA)                    \
    L("charlie-khronos", charlie_khronos, CharlieKhronos, CHARLIE_KHRONOS)                                   \
    L("charlie-neubelt-normalised", charlie_neubelt_normalised, CharlieNeubeltNormalised,                    \
      CHARLIE_NEUBELT_NORMALISED)                                                                            \
    L("exponential", exponential, Exponential, EXPONENTIAL)                                                  \
    L("exponential-lit", exponential_lit, ExponentialLit, EXPONENTIAL_LIT)                                   \
    L("patry", patry, Patry, PATRY)                                                                          \
    L("ltc-fibre", ltc_fibre, LtcFibre, LTC_FIBRE)                                                           \
    L("fibre-table", fibre_table, FibreTable, FIBRE_TABLE)

#define WEFT_TWO_COLOR_LOBES(L)                                                                              \
    L("eon", eon, Eon, EON)                                                                                  \
    L("ggx", ggx, Ggx, GGX)                                                                                  \
    L("silk", silk, Silk, SILK)                                                                              \
    L("threads", threads, Threads, THREADS)                                                                  \
    L("burley-coat", burley_coat, BurleyCoat, BURLEY_COAT)                                                   \
    L("cook-torrance", cook_torrance, CookTorrance, COOK_TORRANCE)

#define WEFT_TINTED_LOBES(L)    L("fibre", fibre, Fibre, FIBRE)
#define WEFT_REFERENCE_LOBES(L) L("fibre-walk", fibre_walk, FibreWalk, FIBRE_WALK)

#define WEFT_TEXT_LOBES(L) WEFT_ONE_COLOR_LOBES(L) WEFT_TWO_COLOR_LOBES(L) WEFT_TINTED_LOBES(L)
#define WEFT_LOBES(L)      WEFT_TEXT_LOBES(L) WEFT_REFERENCE_LOBES(L)

enum {
#define LOBE_ENUM(id, name, Record, NAME) LOBE_##NAME,
    WEFT_LOBES(LOBE_ENUM)
#undef LOBE_ENUM
        LOBE_COUNT
};

/* What holds of a lobe over its whole parameter range. The tests check each claim. */
enum {
    TRAIT_RECIPROCAL = WEFT_LOBE_RECIPROCAL,
    TRAIT_CONSERVES = WEFT_LOBE_CONSERVES,
    TRAIT_LOSSLESS = WEFT_LOBE_LOSSLESS,
    TRAIT_TWO_COLORS = WEFT_LOBE_TWO_COLORS, /* set by being in WEFT_TWO_COLOR_LOBES */
    TRAIT_ANISOTROPIC = WEFT_LOBE_ANISOTROPIC,
    TRAIT_REFERENCE = WEFT_LOBE_REFERENCE, /* of those in WEFT_REFERENCE_LOBES */
    TRAIT_DIFFUSE = WEFT_LOBE_DIFFUSE,
    TRAIT_TABLE = WEFT_LOBE_TABLE,
    TRAIT_TINTED = WEFT_LOBE_TINTED /* set by being in WEFT_TINTED_LOBES */
};

enum { LOBE_PARAMS_MAX = WEFT_LOBE_PARAMS_MAX };

/* A lobe with its parameters, in the order of its table. */
typedef struct Lobe {
    int id; /* one of LOBE_... */
    float params[LOBE_PARAMS_MAX];
} Lobe;

/* The lobe with its defaults. */
Lobe lobe_default(int id);

/* The same with parameter 0 from an artist's roughness: squared where it is an alpha, as it is where it is a
 * roughness, and else over its plausible range. */
Lobe lobe_rough(int id, float roughness);

/* The same with density, tilt and azimuth, radians, in the parameters of these names, clamped to their hard
 * range; nothing changes where a lobe has none. Parameter 0 belongs to the roughness. */
Lobe lobe_fibres(Lobe lobe, float density, float tilt, float azimuth);

/* Index of a parameter by name, or -1. */
int lobe_param(int id, const char *name);

/* Sets parameter k, clamped to its hard range. */
void lobe_set(Lobe *lobe, int k, float value);

/* The registry's lobe for a public one, its parameters clamped; false where there is none of that index. */
bool lobe_of(const WeftLobe *public_lobe, Lobe *lobe);

/* Both directions must be above the horizon (z > 0), unit length. Together they cost less than apart: the
 * distribution is in both. */
__attribute__((noinline)) LobeValue lobe_value(const Lobe *lobe, Angles a);

/* The dialect's way to say it. */
static inline LobeValue lobe_at(Lobe lobe, Angles a) { return lobe_value(&lobe, a); }

static inline float lobe_eval(const Lobe *lobe, Angles a) { return lobe_value(lobe, a).f; }
static inline float lobe_pdf(const Lobe *lobe, Angles a) { return lobe_value(lobe, a).pdf; }

/* The second colour, per channel, given both as the user sets them. Of a tinted lobe it is 1, the weight of
 * which the first is a part; of others f0. */
__attribute__((noinline)) float lobe_second(Lobe lobe, float f0, float f90);

/* A wi for (u, v) in [0, 1)^2. It may lie below the horizon: that is no sample. */
__attribute__((noinline)) Dir lobe_sample(const Lobe *lobe, Dir o, float u, float v);

/* The dialect's way to say it; in GLSL it is lobe_sample itself. */
static inline Dir lobe_sample_at(Lobe lobe, Dir o, float u, float v) { return lobe_sample(&lobe, o, u, v); }

/* E of a lobe of TRAIT_REFERENCE, from so many walks; 0 of any other. */
__attribute__((noinline)) float lobe_walked_albedo(const Lobe *lobe, Dir o, int walks);

/* f[k] and, where s is not NULL, the share s[k] of the second colour, for n pairs of directions as structures
 * of arrays; 0 where a direction is not above the horizon or a component is infinite or NaN. */
void lobe_eval_n(const Lobe *lobe, size_t n, const float *ox, const float *oy, const float *oz,
                 const float *ix, const float *iy, const float *iz, float *f, float *s);

/* pdf[k] likewise. */
void lobe_pdf_n(const Lobe *lobe, size_t n, const float *ox, const float *oy, const float *oz,
                const float *ix, const float *iy, const float *iz, float *pdf);

/* f[c][k] of a tinted lobe made of what has albedo w[c], likewise. Not for other lobes. */
void lobe_tinted_n(const Lobe *lobe, const float w[3], size_t n, const float *ox, const float *oy,
                   const float *oz, const float *ix, const float *iy, const float *iz, float *const f[3]);

#endif
