/* registry.h - the catalogue as data: every lobe, its parameters, and its functions behind one signature
 *
 * Adding a lobe: one file in lobes/, one line in WEFT_LOBES. Command line, docs, tests and renderers follow.
 */
#ifndef WEFT_SHADING_REGISTRY_H
#define WEFT_SHADING_REGISTRY_H

#include <stddef.h>

#include "shading/angles.h"
#include "weft/lobe.h"

/* L(id, functions' prefix, record, macros' prefix) */
#define WEFT_LOBES(L)                                                                                        \
    L("lambert", lambert, Lambert, LAMBERT)                                                                  \
    L("ggx", ggx, Ggx, GGX)                                                                                  \
    L("charlie-neubelt", charlie_neubelt, CharlieNeubelt, CHARLIE_NEUBELT)                                   \
    L("charlie-conty-kulla", charlie_conty_kulla, CharlieContyKulla, CHARLIE_CONTY_KULLA)

typedef enum LobeId {
#define LOBE_ENUM(id, name, Record, NAME) LOBE_##NAME,
    WEFT_LOBES(LOBE_ENUM)
#undef LOBE_ENUM
        LOBE_COUNT
} LobeId;

/* What holds of a lobe over its whole parameter range. The tests check each claim. */
enum {
    TRAIT_RECIPROCAL = WEFT_LOBE_RECIPROCAL,
    TRAIT_CONSERVES = WEFT_LOBE_CONSERVES,
    TRAIT_LOSSLESS = WEFT_LOBE_LOSSLESS,
    TRAIT_FRESNEL = WEFT_LOBE_FRESNEL,
    TRAIT_ANISOTROPIC = WEFT_LOBE_ANISOTROPIC,
    TRAIT_REFERENCE = WEFT_LOBE_REFERENCE
};

enum { LOBE_PARAMS_MAX = WEFT_LOBE_PARAMS_MAX };

/* A lobe with its parameters, in the order of its table. */
typedef struct Lobe {
    LobeId id;
    float params[LOBE_PARAMS_MAX];
} Lobe;

/* The lobe with its defaults. */
Lobe lobe_default(LobeId id);

/* Index of a parameter by name, or -1. */
int lobe_param(LobeId id, const char *name);

/* Sets parameter k, clamped to its hard range. */
void lobe_set(Lobe *lobe, int k, float value);

/* What a pair of directions gets from a lobe. */
typedef struct LobeValue {
    float f;   /* 1/sr, without colour or Fresnel: a lobe with TRAIT_FRESNEL is weighed by F0 (1 - s) + f90 s
                * outside,   with s = schlick_s(a.d) */
    float pdf; /* density of lobe_sample at a.i, 1/sr */
} LobeValue;

/* Both directions must be above the horizon (z > 0), unit length. Together they cost less than apart: the
 * distribution is in both. */
LobeValue lobe_value(const Lobe *lobe, Angles a);

static inline float lobe_eval(const Lobe *lobe, Angles a) { return lobe_value(lobe, a).f; }
static inline float lobe_pdf(const Lobe *lobe, Angles a) { return lobe_value(lobe, a).pdf; }

/* A wi for (u, v) in [0, 1)^2. It may lie below the horizon: that is no sample. */
Dir lobe_sample(const Lobe *lobe, Dir o, float u, float v);

/* f[k] for n pairs of directions as structures of arrays; 0 where a direction is not above the horizon. */
void lobe_eval_n(const Lobe *lobe, size_t n, const float *ox, const float *oy, const float *oz,
                 const float *ix, const float *iy, const float *iz, float *f);

#endif
