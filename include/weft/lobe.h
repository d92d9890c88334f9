/* lobe.h - the catalogue of shading models: what there is, and eval, sample, pdf and albedo of each
 *
 * Local frame: +z is the shading normal, +x the tangent. wo points to the viewer, wi to the light, both away
 * from the surface, unit length. f is in 1/sr and excludes the cosine; pdf is over solid angle, 1/sr. All
 * functions are pure: they may be called from any number of threads. */
#ifndef WEFT_LOBE_H
#define WEFT_LOBE_H

#include "weft/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* No lobe has more parameters. */
enum { WEFT_LOBE_PARAMS_MAX = 8 };

/* Traits: what holds of a lobe over its whole parameter range. */
enum {
    WEFT_LOBE_RECIPROCAL = 1,   /* f(wo, wi) = f(wi, wo) */
    WEFT_LOBE_CONSERVES = 2,    /* E <= 1 */
    WEFT_LOBE_LOSSLESS = 4,     /* E = 1 when white */
    WEFT_LOBE_TWO_COLORS = 8,   /* f mixes f0 and f90: from normal to grazing, or from yarn to yarn */
    WEFT_LOBE_ANISOTROPIC = 16, /* f changes when both directions turn about the normal */
    WEFT_LOBE_REFERENCE = 32,   /* f is an estimate, and its mean over near directions is meant */
    WEFT_LOBE_DIFFUSE = 64,     /* a diffuse term: may be the base of a material */
    WEFT_LOBE_TABLE = 128,      /* reads a table, which the lobe's first use makes or the library holds */
    WEFT_LOBE_TINTED = 256,     /* its colour is no factor on f but the albedo of its fibres, in [0, 1] */
    WEFT_LOBE_SYSTEM = 512      /* one system of threads; warp and weft, both of this lobe, are a cloth */
};

/* A parameter of a lobe. */
typedef struct WeftParamInfo {
    const char *name, *help;   /* as weft_lobe_set takes it, and a line on what it does */
    float def;                 /* default */
    float low, high;           /* plausible range: what a slider spans */
    float hard_low, hard_high; /* values are clamped to this */
    /* A choice has the ids it is made from, ended by NULL; its value is the index of one. NULL: a number. */
    const char *const *choices;
} WeftParamInfo;

/* A lobe of the catalogue; lives as long as the program. */
typedef struct WeftLobeInfo {
    const char *id;              /* "charlie-neubelt" */
    unsigned traits;             /* a sum of WEFT_LOBE_RECIPROCAL and its like */
    int param_count;             /* <= WEFT_LOBE_PARAMS_MAX */
    const WeftParamInfo *params; /* param_count of them */
} WeftLobeInfo;

/* The catalogue: lobes [0, weft_lobe_count()); NULL out of range. */
WEFT_API int weft_lobe_count(void);
WEFT_API const WeftLobeInfo *weft_lobe_info(int lobe);

/* The index of an id, or -1. */
WEFT_API int weft_lobe_find(const char *id);

/* Returns the index of a lobe's parameter by name, which is its place in WeftLobe.params; or -1. */
WEFT_API int weft_lobe_param_find(int lobe, const char *name);

/* Takes a lobe of the user's own, in the dialect of docs/adding-a-lobe.md, from a file NAME.h: from here on
 * it is a lobe as any other, with the index *lobe (may be NULL) and the id NAME, "-" for "_". The file runs
 * as native code: the machine's C compiler ($CC, or cc) makes a library of it, which the user's cache keeps.
 * A file of the same name takes the place of the one before; what is rendering goes on with that. May be
 * called from any thread, while others use lobes too; a WeftLobeInfo stays as it was. Fails with
 * WEFT_MESSAGE_LOBE_FILE, _LOBE_COMPILE, _TEXT_DIALECT, _COMPILER or as reading a file does; what there was
 * then stays. Warns log (may be NULL) with WEFT_MESSAGE_CACHE_IGNORED where the cache cannot keep it. */
WEFT_API WeftResult weft_lobe_load(const char *path, int *lobe, const WeftLog *log, WeftError *error);

/* The layer rules by index, and a line on what each does; NULL past the end. */
WEFT_API const char *weft_layer_name(int layer);
WEFT_API const char *weft_layer_help(int layer);

/* Likewise the terms a Cook-Torrance lobe is composed of, the workflows and the engine profiles. */
typedef enum WeftTermKind { WEFT_TERM_D, WEFT_TERM_V, WEFT_TERM_F } WeftTermKind;
WEFT_API const char *weft_term_name(WeftTermKind kind, int term);
WEFT_API const char *weft_term_help(WeftTermKind kind, int term);
WEFT_API const char *weft_workflow_name(int workflow);
WEFT_API const char *weft_workflow_help(int workflow);
WEFT_API const char *weft_profile_name(int profile);
WEFT_API const char *weft_profile_help(int profile);

/* The names that sources use for some terms ("charlie-v"), taken wherever the id is, and the kind and id that
 * each stands for ("v conty-kulla"); NULL past the end. */
WEFT_API const char *weft_alias_name(int alias);
WEFT_API const char *weft_alias_help(int alias);

/* The text of a file of the catalogue, "terms/d_charlie.h", "lobes/ggx.h", "layers/reciprocal.h",
 * "workflows/disney.h", "profiles/three.h", as it was compiled: it begins with a comment that says what one
 * sees, formula and source. Zero-terminated; NULL where there is no such file. */
WEFT_API const char *weft_catalogue_text(const char *path);

/* A lobe with its parameters. Plain data, may be copied and filled by hand: the calls below clamp params to
 * their hard ranges, and where there is no lobe of that index the answer is 0. f0 and f90 are taken as they
 * are. */
typedef struct WeftLobe {
    int lobe;                           /* index in the catalogue */
    float params[WEFT_LOBE_PARAMS_MAX]; /* in the order of WeftLobeInfo.params */
    /* Colour; f90 counts only for WEFT_LOBE_TWO_COLORS. With WEFT_LOBE_TINTED f0 is the albedo of the fibres:
     * light scattered n times has its n-th power, so f and E fall faster than f0, and more saturated. */
    float f0[3], f90[3];
} WeftLobe;

/* The lobe with its default parameters, white. Fails with WEFT_MESSAGE_LOBE_NAME. */
WEFT_API WeftResult weft_lobe_init(const char *id, WeftLobe *out, WeftError *error);

/* Sets a parameter by name: one number, the id or alias of a choice, or "color" ("f0") and "f90" as "r,g,b"
 * or one number for all three. "roughness" is an artist's, 0 to 1, and sets the first parameter as that of a
 * material would, where no parameter is called so. Beyond the plausible range the value is taken with a
 * warning and clamped to the hard range; beyond that range too the warning says so. Fails with
 * WEFT_MESSAGE_PARAM_NAME or _PARAM_VALUE, and with _LOBE_NAME where there is no lobe of that index. */
WEFT_API WeftResult weft_lobe_set(WeftLobe *lobe, const char *param, const char *value, const WeftLog *log,
                                  WeftError *error);

/* Says with WEFT_MESSAGE_PARAM_FITTED where the lobe takes another number than it was given, since its form
 * was not fitted as far as that: of `fibre`, alpha where fibres lean. messages begin with name. */
WEFT_API void weft_lobe_fitted(const WeftLobe *lobe, const char *name, const WeftLog *log);

/* f per colour channel, 1/sr; 0 where a direction is not above the horizon. */
WEFT_API void weft_lobe_eval(const WeftLobe *lobe, const float wo[3], const float wi[3], float f[3]);

/* Density of weft_lobe_sample at wi, 1/sr; 0 means that wi is never sampled. */
WEFT_API float weft_lobe_pdf(const WeftLobe *lobe, const float wo[3], const float wi[3]);

/* Draws wi for u in [0, 1)^2 and returns its pdf; 0 means no sample, and wi is then not to be used. */
WEFT_API float weft_lobe_sample(const WeftLobe *lobe, const float wo[3], const float u[2], float wi[3]);

/* Directional albedo E per colour channel for wo = (sin, 0, cos_o), cos_o in (0, 1]: adaptive quadrature to
 * 1e-4 absolute, or 4e-3 and 1e-3 where `silk` and `woven` have alpha below 0.1; with WEFT_LOBE_REFERENCE a mean whose
 * standard error is 0.0011 at most. A smaller cos_o is taken for 1e-6, a larger one for 1. */
WEFT_API void weft_lobe_albedo(const WeftLobe *lobe, float cos_o, float e[3]);

#ifdef __cplusplus
}
#endif

#endif
