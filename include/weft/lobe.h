/* lobe.h - the catalogue of shading models, and eval, sample, pdf and albedo of each
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

/* Traits: properties of a lobe over its whole parameter range. */
enum {
    WEFT_LOBE_RECIPROCAL = 1,   /* f(wo, wi) = f(wi, wo) */
    WEFT_LOBE_CONSERVES = 2,    /* E <= 1 */
    WEFT_LOBE_LOSSLESS = 4,     /* E = 1 when white */
    WEFT_LOBE_TWO_COLORS = 8,   /* f mixes f0 and f90: from normal to grazing, or from yarn to yarn */
    WEFT_LOBE_ANISOTROPIC = 16, /* f changes when both directions rotate about the normal */
    WEFT_LOBE_REFERENCE = 32,   /* f is a random-walk estimate; its mean over nearby directions is the model */
    WEFT_LOBE_DIFFUSE = 64,     /* a diffuse term: may be the base of a material */
    WEFT_LOBE_TABLE = 128,      /* reads a table, made on the lobe's first use or contained in the library */
    WEFT_LOBE_TINTED = 256,     /* the colour is the albedo of the fibres, in [0, 1], not a factor on f */
    WEFT_LOBE_SYSTEM = 512      /* one system of threads; warp and weft, both of this lobe, are a cloth */
};

/* A parameter of a lobe. */
typedef struct WeftParamInfo {
    const char *name, *help;   /* name for weft_lobe_set, and a line on its effect */
    float def;                 /* default */
    float low, high;           /* plausible range: what a slider spans */
    float hard_low, hard_high; /* values are clamped to this */
    /* The ids of a choice, ended by NULL; its value is the index of one. NULL: a number. */
    const char *const *choices;
} WeftParamInfo;

/* A lobe of the catalogue; lives as long as the program. */
typedef struct WeftLobeInfo {
    const char *id;              /* "charlie-neubelt" */
    unsigned traits;             /* WEFT_LOBE_RECIPROCAL and so on, or-ed together */
    int param_count;             /* <= WEFT_LOBE_PARAMS_MAX */
    const WeftParamInfo *params; /* param_count of them */
} WeftLobeInfo;

/* Returns the number of lobes in the catalogue, and a lobe by index; NULL out of range. */
WEFT_API int weft_lobe_count(void);
WEFT_API const WeftLobeInfo *weft_lobe_info(int lobe);

/* Returns the index of an id, or -1. */
WEFT_API int weft_lobe_find(const char *id);

/* Returns the index of a lobe's parameter by name, which is its place in WeftLobe.params; or -1. */
WEFT_API int weft_lobe_param_find(int lobe, const char *name);

/* Adds a lobe of the user's own, in the dialect of docs/adding-a-lobe.md, from a file NAME.h. It is then a lobe like
 * any other, with the index *lobe (may be NULL) and the id NAME, "-" for "_". The file runs as native code: the
 * machine's C compiler ($CC, or cc) makes a library of it, which is kept in the user's cache. A file of the same name
 * replaces the earlier lobe; renders in progress keep the earlier one. May be called from any thread, while others use
 * lobes too; a WeftLobeInfo that was returned stays as it is. Fails with WEFT_MESSAGE_LOBE_FILE, _LOBE_COMPILE,
 * _TEXT_DIALECT, _COMPILER or as reading a file does; the catalogue is then unchanged. Warns log (may be NULL) with
 * WEFT_MESSAGE_CACHE_IGNORED where the library cannot be cached. */
WEFT_API WeftResult weft_lobe_load(const char *path, int *lobe, const WeftLog *log, WeftError *error);

/* Returns the layer rules by index, and a line on what each does; NULL past the end. */
WEFT_API const char *weft_layer_name(int layer);
WEFT_API const char *weft_layer_help(int layer);

/* The terms that a Cook-Torrance lobe is composed of: distribution, visibility, Fresnel. */
typedef enum WeftTermKind { WEFT_TERM_D, WEFT_TERM_V, WEFT_TERM_F } WeftTermKind;

/* Returns the terms, the workflows and the engine profiles likewise. */
WEFT_API const char *weft_term_name(WeftTermKind kind, int term);
WEFT_API const char *weft_term_help(WeftTermKind kind, int term);
WEFT_API const char *weft_workflow_name(int workflow);
WEFT_API const char *weft_workflow_help(int workflow);
WEFT_API const char *weft_profile_name(int profile);
WEFT_API const char *weft_profile_help(int profile);

/* Returns the names that sources use for some terms ("charlie-v"), which are accepted wherever the id is, and the kind
 * and id of the term ("v conty-kulla"); NULL past the end. */
WEFT_API const char *weft_alias_name(int alias);
WEFT_API const char *weft_alias_help(int alias);

/* Returns the text of a file of the catalogue as it was compiled: "terms/d_charlie.h", "lobes/ggx.h",
 * "layers/reciprocal.h", "workflows/disney.h", "profiles/three.h". It begins with a comment that gives appearance,
 * formula and source. Zero-terminated; NULL where there is no such file. */
WEFT_API const char *weft_catalogue_text(const char *path);

/* A lobe with its parameters. It owns nothing and may be copied and filled in by hand: the calls below clamp params to
 * their hard ranges, and return 0 where there is no lobe of that index. f0 and f90 are not clamped. */
typedef struct WeftLobe {
    int lobe;                           /* index in the catalogue */
    float params[WEFT_LOBE_PARAMS_MAX]; /* in the order of WeftLobeInfo.params */
    /* Colour; f90 is read only with WEFT_LOBE_TWO_COLORS. With WEFT_LOBE_TINTED f0 is the albedo of the fibres:
     * light scattered n times is multiplied by its n-th power, so f and E are darker and more saturated than f0. */
    float f0[3], f90[3];
} WeftLobe;

/* Fills in the lobe with its default parameters, white. Fails with WEFT_MESSAGE_LOBE_NAME. */
WEFT_API WeftResult weft_lobe_init(const char *id, WeftLobe *out, WeftError *error);

/* Sets a parameter by name: one number, the id or alias of a choice, or "color" ("f0") and "f90" as "r,g,b"
 * or one number for all three. "roughness", where no parameter has that name, is an artist's, 0 to 1, and sets the
 * first parameter as the roughness of a material does. A value beyond the plausible range is a warning and is clamped
 * to the hard range; the warning states the clamping. Fails with
 * WEFT_MESSAGE_PARAM_NAME or _PARAM_VALUE, and with _LOBE_NAME where there is no lobe of that index. */
WEFT_API WeftResult weft_lobe_set(WeftLobe *lobe, const char *param, const char *value, const WeftLog *log,
                                  WeftError *error);

/* Warns with WEFT_MESSAGE_PARAM_FITTED if the lobe replaces a parameter that lies outside the range that its model was
 * fitted to: alpha of `fibre` where fibres lean. Messages begin with name. */
WEFT_API void weft_lobe_fitted(const WeftLobe *lobe, const char *name, const WeftLog *log);

/* Evaluates f per colour channel, 1/sr; 0 where a direction is not above the horizon. */
WEFT_API void weft_lobe_eval(const WeftLobe *lobe, const float wo[3], const float wi[3], float f[3]);

/* Returns the density of weft_lobe_sample at wi, 1/sr; 0 means that wi is never sampled. */
WEFT_API float weft_lobe_pdf(const WeftLobe *lobe, const float wo[3], const float wi[3]);

/* Draws wi for u in [0, 1)^2 and returns its pdf; 0 means no sample, and wi must then not be used. */
WEFT_API float weft_lobe_sample(const WeftLobe *lobe, const float wo[3], const float u[2], float wi[3]);

/* Computes the directional albedo E per colour channel for wo = (sin, 0, cos_o): adaptive quadrature to 1e-4 absolute, or
 * to 2e-4 of `charlie-khronos`, whose clamp is a crease; with WEFT_LOBE_REFERENCE a mean whose standard error is 0.0011
 * at most. cos_o is clamped to [1e-6, 1]. */
WEFT_API void weft_lobe_albedo(const WeftLobe *lobe, float cos_o, float e[3]);

#ifdef __cplusplus
}
#endif

#endif
