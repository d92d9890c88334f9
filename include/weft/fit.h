/* fit.h - measured reflectance, and the lobes of the catalogue that come closest to it
 *
 * A candidate is a lobe over a diffuse base: f = base color * white base + lobe. Free are all parameters of
 * both that are numbers, within their plausible ranges; the choices of the lobe, of which all that may be put
 * together are looked at and the best searched; its colours and that of the base, which are at least 0 and
 * may pass 1 (weft_fitted_notes says so). Candidates are all lobes but diffuse ones and WEFT_LOBE_REFERENCE.
 *   A weave is lobe woven, the warp, over base woven, the weft, which are fitted where base is "woven": as materials have
 * them, the warp along the bitangent. f0 of each is the colour of light that met one fibre, f90 of all other, both factors;
 * free are those and all numbers but the azimuth, the shares together being 1, within what is possible. Data that are
 * isotropic or lie in one plane are refused with WEFT_MESSAGE_DESC: they do not tell warp from weft.
 *
 * The error is that of match.h over the samples of the data, each of which counts alike:
 *
 *   error = sum |g(x_fit) - g(x)| / sum g(x) over samples and channels,  x = f cos_i
 *
 * LOG (the default): g(x) = ln(1 + x / mean x); COSINE: g(x) = x. Samples with a direction more than 80
 * degrees off the normal are left out, as is usual, since there the measurement is least to be trusted: Addy
 * Ngan, Fredo Durand, Wojciech Matusik, "Experimental Analysis of BRDF Models", EGSR 2005, section 3.2. */
#ifndef WEFT_FIT_H
#define WEFT_FIT_H

#include "weft/match.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A measurement: directions and f. It does not change, so any number of threads may read it. */
typedef struct WeftData WeftData;

/* Reads a measurement: ".binary", ".bsdf" or ".bin" (reflection.h has the formats), of which every bin, or every
 * pair of directions, on a grid of 24 x 24 x 12 (theta_h, theta_d, phi_d) is a sample; else a table of lines
 *
 *   theta_o, phi_o, theta_i, phi_i, r, g, b        degrees, from the normal and the tangent; f in 1/sr
 *
 * separated by commas, semicolons, blanks or tabs, at most 1 million of them; empty lines and those that
 * begin with # are passed over, and so are a byte-order mark and one line of names above the numbers. Where
 * one of r, g, b is negative, nothing was measured. Fails with WEFT_MESSAGE_MEASURED, _BSDF, _UTIA, _BRDF_TABLE (which says
 * in what line), _MEMORY and with what reading a file can fail with. Release with weft_data_free. */
WEFT_API WeftResult weft_data_read(const char *path, WeftData **out, WeftError *error);

/* Works as weft_data_read, from size bytes. Errors begin with name, whose suffix names the format. */
WEFT_API WeftResult weft_data_read_memory(const void *data, size_t size, const char *name, WeftData **out,
                                          WeftError *error);

/* Makes data of count pairs of unit directions and their f, 1/sr, all copied. isotropic: not 0 if f stays the
 * same as both directions turn, which halves the work. Fails with WEFT_MESSAGE_DESC where nothing is above 0
 * or nothing is left, or _MEMORY. */
WEFT_API WeftResult weft_data_create(int count, const float (*wo)[3], const float (*wi)[3],
                                     const float (*f)[3], int isotropic, WeftData **out, WeftError *error);

WEFT_API void weft_data_free(WeftData *data); /* may be NULL */

/* Returns the number of samples in use. *all is the number of samples read, including grazing and
 * unmeasured ones. */
WEFT_API int weft_data_count(const WeftData *data, int *all);

/* Sample k of those in use: unit directions and f, 1/sr. */
WEFT_API void weft_data_sample(const WeftData *data, int k, float wo[3], float wi[3], float f[3]);

/* A measurement as a lobe. */
typedef struct WeftDataLobe {
    double error;        /* LOG, of the lobe in these colours */
    float f0[3], f90[3]; /* of the lobe, which is white in its file */
} WeftDataLobe;

/* Makes the text of a lobe's file, which weft_lobe_load takes, out of a measurement: f and the share of the
 * second colour as polynomials of half vector and difference angle (docs/measured.md); what depends on phi_d or
 * on how the pair is turned is averaged. name: of the file without .h; about: a sentence for its comment.
 * *text is owned by the caller: free it. Fails with WEFT_MESSAGE_DESC (no name of a lobe) or _MEMORY. */
WEFT_API WeftResult weft_data_lobe(const WeftData *data, const char *name, const char *about, char **text,
                                   WeftDataLobe *out, WeftError *error);

/* One candidate, fitted. */
typedef struct WeftFitted {
    WeftLobe lobe; /* with the parameters and colours that were found */
    WeftLobe base; /* likewise; f0 and f90 are its colour, a factor on the white base; of a weave the weft */
    int numbers;   /* free ones: parameters of both, and three a colour, or one if all is grey */
    double error;  /* by the metric that was chosen */
    long long evaluations; /* of the error, that it took */
} WeftFitted;

/* Notes on a fit beside its error. */
enum {
    WEFT_FITTED_NOTHING = 1 << 0, /* the lobe's colours are 0: only the base is left */
    WEFT_FITTED_BRIGHT = 1 << 1,  /* a colour, of the base, f0 or f90, is above 1 */
    WEFT_FITTED_EDGE = 1 << 2     /* a number ends where its plausible range does */
};

/* Returns the notes that hold of a fit, or-ed together; 0 without any. */
WEFT_API unsigned weft_fitted_notes(const WeftFitted *fitted);

/* The most candidates of a ranking, and the most bases. */
enum { WEFT_FITTED_MOST = 768, WEFT_FITTED_BASES = 16 };

/* The ranking. */
typedef struct WeftFit {
    int count;                           /* of fitted, <= WEFT_FITTED_MOST */
    WeftFitted fitted[WEFT_FITTED_MOST]; /* the best first */
    WeftFitted baseline;                 /* ggx over lambert, f90 = 1: what engines have for everything */
    double base_alone;                   /* the error of the base without a lobe */
} WeftFit;

/* Zero-initialise for the defaults. */
typedef struct WeftFitDesc {
    WeftBrdfMetric metric; /* LOG where `chosen` is 0; PICTURE is refused */
    int chosen;            /* not 0: metric was chosen */
    const char *base;      /* a diffuse lobe, or "all": over each of them; NULL: lambert; "woven": a weave */
    const char *only;      /* one candidate instead of all; NULL: all */
    int sayable;           /* not 0: parameters that no material has an input for stay at their default */
    int threads;           /* 0: one a processor; no influence on the result */
    WeftProgress progress; /* may be NULL */
    void *user;            /* handed to progress */
} WeftFitDesc;

/* Fits all candidates and ranks them. The same data give the same answer. Fails with WEFT_MESSAGE_LOBE_NAME,
 * _DESC or _MEMORY; WEFT_INTERRUPTED where progress, which is asked while lobes are fitted, says so. */
WEFT_API WeftResult weft_fit(const WeftData *data, const WeftFitDesc *desc, WeftFit *out, WeftError *error);

/* Changes material, whose inputs and choices are where to begin, to what comes closest to the data: the free
 * inputs are those of weft_match_material, and the search has several starts besides. out->matched is the
 * error. Of desc, metric alone counts. Fails with WEFT_MESSAGE_PARAM_VALUE, _DESC or _MEMORY. */
WEFT_API WeftResult weft_fit_material(const WeftData *data, const WeftFitDesc *desc, WeftMaterial *material,
                                      WeftMatch *out, WeftError *error);

/* Sets *distance to the error of a reflection as it is. Of desc, metric alone counts. Fails with
 * WEFT_MESSAGE_DESC or _MEMORY. */
WEFT_API WeftResult weft_data_distance(const WeftData *data, const WeftFitDesc *desc,
                                       const WeftReflection *reflection, double *distance, WeftError *error);

/* Returns 1 if lobe and base are warp and weft of a weave: under all else lies a diffuse base. */
WEFT_API int weft_fitted_is_weave(const WeftFitted *fitted);

/* Makes the reflection of a fit: base and lobe, or warp and weft. Fails with WEFT_MESSAGE_MEMORY. */
WEFT_API WeftResult weft_fitted_reflection(const WeftFitted *fitted, WeftReflection **out, WeftError *error);

/* The material that is exactly that base and lobe: workflow cloth, layer rule additive. Returns 0 where
 * inputs cannot say it: a lobe or base with more shape than inputs have (`sayable` fits them as they can be
 * said), or a base brighter than white. */
WEFT_API int weft_fitted_material(const WeftFitted *fitted, WeftMaterial *out);

#ifdef __cplusplus
}
#endif

#endif
