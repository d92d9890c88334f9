/* fit.h - measured reflectance, and the lobes of the catalogue that come closest to it
 *
 * A candidate is a lobe over a diffuse base: f = base color * white base + lobe. The fit varies
 *
 * - the parameters of both that are numbers, within their plausible ranges;
 * - the choices of the lobe: every combination is evaluated, and the best ones are searched;
 * - the colours of both, at least 0, and such that base and lobe together reflect no more light than they receive in
 *   any direction and channel (E <= 1). WeftFitDesc.free lifts that bound. A colour above 1 may then still be within it,
 *   since f90 is reached at the horizon alone; weft_fitted_notes notes it.
 *
 * Candidates are all lobes but diffuse ones and WEFT_LOBE_REFERENCE.
 *
 * A weave is fitted where base is "woven": lobe woven is the warp, along the bitangent as in materials, and base woven
 * is the weft. f0 of each is the colour of light that met one fibre, f90 that of all other light; both are factors.
 * The fit varies these colours and all parameters but the azimuth, each within its possible range; the shares of both
 * systems sum to 1. Data that are isotropic or lie in one plane cannot separate warp from weft: WEFT_MESSAGE_DESC.
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

/* A measurement: pairs of directions and f. It is immutable, so any number of threads may read it. */
typedef struct WeftData WeftData;

/* Reads a measurement: ".binary", ".bsdf" or ".bin" (reflection.h has the formats), of which every bin, or every
 * pair of directions, on a grid of 24 x 24 x 12 (theta_h, theta_d, phi_d) is a sample; else a table of lines
 *
 *   theta_o, phi_o, theta_i, phi_i, r, g, b        degrees, from the normal and the tangent; f in 1/sr
 *
 * separated by commas, semicolons, blanks or tabs, at most 1 million lines. Empty lines, lines that begin with #, a
 * byte-order mark and one line of names above the numbers are skipped. A negative r, g or b marks an unmeasured pair.
 * Fails with WEFT_MESSAGE_MEASURED, _BSDF, _UTIA, _BRDF_TABLE (with the number of the line), _MEMORY and as reading a
 * file does. Release with weft_data_free. */
WEFT_API WeftResult weft_data_read(const char *path, WeftData **out, WeftError *error);

/* Works as weft_data_read, from size bytes. Errors begin with name, whose suffix names the format. */
WEFT_API WeftResult weft_data_read_memory(const void *data, size_t size, const char *name, WeftData **out,
                                          WeftError *error);

/* Makes data of count pairs of unit directions and their f, 1/sr, all copied. isotropic: not 0 if rotating both
 * directions about the normal leaves f unchanged, which halves the work. Fails with WEFT_MESSAGE_DESC where no f is
 * above 0 or no sample is in use, or _MEMORY. */
WEFT_API WeftResult weft_data_create(int count, const float (*wo)[3], const float (*wi)[3], const float (*f)[3],
                                     int isotropic, WeftData **out, WeftError *error);

WEFT_API void weft_data_free(WeftData *data); /* may be NULL */

/* Returns the number of samples in use. *all is the number of samples read, including grazing and
 * unmeasured ones. */
WEFT_API int weft_data_count(const WeftData *data, int *all);

/* Fills in sample k of those in use: unit directions and f, 1/sr. */
WEFT_API void weft_data_sample(const WeftData *data, int k, float wo[3], float wi[3], float f[3]);

/* Error and colours of a measurement that was made a lobe. */
typedef struct WeftDataLobe {
    double error;        /* LOG, of the lobe in these colours */
    float f0[3], f90[3]; /* colours of the lobe, which is white in its file */
} WeftDataLobe;

/* Makes the text of a lobe's file, for weft_lobe_load, from a measurement: f and the weight of the second colour as
 * polynomials of half vector and difference angle (docs/measured.md), averaged over phi_d and over rotations about
 * the normal. name: of the file without .h; about: a sentence for its comment. *text is owned by the caller: free it.
 * Fails with WEFT_MESSAGE_DESC (name cannot name a lobe) or _MEMORY. */
WEFT_API WeftResult weft_data_lobe(const WeftData *data, const char *name, const char *about, char **text,
                                   WeftDataLobe *out, WeftError *error);

/* One candidate, fitted. */
typedef struct WeftFitted {
    WeftLobe lobe;         /* with the fitted parameters and colours */
    WeftLobe base;         /* likewise; f0 and f90 are its colour, a factor on the white base; of a weave the weft */
    int numbers;           /* count of fitted numbers: parameters of both, and three a colour, or one if all is grey */
    double error;          /* by the metric that was chosen */
    double free_error;     /* of the same fit without the bound on E; equal to error where that is not reached */
    float albedo;          /* the largest E of both together, over directions and channels */
    long long evaluations; /* of the error during the search */
} WeftFitted;

/* Notes on a fit beside its error. */
enum {
    WEFT_FITTED_NOTHING = 1 << 0, /* the lobe's colours are 0: only the base is left */
    WEFT_FITTED_BRIGHT = 1 << 1,  /* a colour, of the base, f0 or f90, is above 1 */
    WEFT_FITTED_EDGE = 1 << 2,    /* a number ends where its plausible range does */
    WEFT_FITTED_GAINS = 1 << 3    /* albedo is above 1, by more than 0.002 */
};

/* Returns the notes on a fit, or-ed together; 0 without any. */
WEFT_API unsigned weft_fitted_notes(const WeftFitted *fitted);

/* The most candidates of a ranking, and the most bases. */
enum { WEFT_FITTED_MOST = 768, WEFT_FITTED_BASES = 16 };

/* The ranking. */
typedef struct WeftFit {
    int count;                           /* of fitted, <= WEFT_FITTED_MOST */
    WeftFitted fitted[WEFT_FITTED_MOST]; /* the best first */
    WeftFitted baseline;                 /* ggx over lambert, f90 = 1: the default of engines */
    double base_alone;                   /* the error of the base without a lobe */
} WeftFit;

/* Zero-initialise for the defaults. */
typedef struct WeftFitDesc {
    WeftBrdfMetric metric; /* LOG where `chosen` is 0; PICTURE is refused */
    int chosen;            /* not 0: metric was chosen */
    const char *base;      /* a diffuse lobe, or "all": over each of them; NULL: body; "woven": a weave */
    const char *only;      /* one candidate instead of all; NULL: all */
    int free;              /* not 0: without the bound on E */
    int expressible;       /* not 0: parameters that no material has an input for stay at their default */
    int threads;           /* 0: one a processor; no influence on the result */
    WeftProgress progress; /* may be NULL */
    void *user;            /* handed to progress */
} WeftFitDesc;

/* Fits all candidates and ranks them. The same data give the same result. Fails with WEFT_MESSAGE_LOBE_NAME,
 * _DESC or _MEMORY; returns WEFT_INTERRUPTED if progress, which is called while lobes are fitted, stops it. */
WEFT_API WeftResult weft_fit(const WeftData *data, const WeftFitDesc *desc, WeftFit *out, WeftError *error);

/* Changes material so that it comes closest to the data. The search begins at the material as given and at several
 * other starts, and varies the inputs that weft_match_material varies. out->matched is the error. Of desc, only
 * metric is read. Fails with WEFT_MESSAGE_PARAM_VALUE, _DESC or _MEMORY. */
WEFT_API WeftResult weft_fit_material(const WeftData *data, const WeftFitDesc *desc, WeftMaterial *material,
                                      WeftMatch *out, WeftError *error);

/* Sets *distance to the error of a reflection as it is. Of desc, only metric is read. Fails with
 * WEFT_MESSAGE_DESC or _MEMORY. */
WEFT_API WeftResult weft_data_distance(const WeftData *data, const WeftFitDesc *desc, const WeftReflection *reflection,
                                       double *distance, WeftError *error);

/* Returns 1 if lobe and base are warp and weft of a weave; 0 if the base is a diffuse lobe. */
WEFT_API int weft_fitted_is_weave(const WeftFitted *fitted);

/* Makes the reflection of a fit: base and lobe, or warp and weft. Fails with WEFT_MESSAGE_MEMORY. */
WEFT_API WeftResult weft_fitted_reflection(const WeftFitted *fitted, WeftReflection **out, WeftError *error);

/* Fills in the material that is exactly that base and lobe: workflow cloth, layer rule additive. Returns 0 if no
 * material can express the fit: a parameter of lobe or base has no input (WeftFitDesc.expressible avoids that), or the
 * base is brighter than white. */
WEFT_API int weft_fitted_material(const WeftFitted *fitted, WeftMaterial *out);

#ifdef __cplusplus
}
#endif

#endif
