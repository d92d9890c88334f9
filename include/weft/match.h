/* match.h - the parameters of one lobe or material that come closest to another: what to write when a look
 * has to move from one engine to the next
 *
 * How far two are apart is a sum over a fixed set of pairs of directions, of x = f cos_i:
 *
 *   error = sum w |g(x_to) - g(x_from)| / sum w g(x_from)       in each colour channel, w as below
 *
 *   COSINE:  g(x) = x, w the measure cos_o dwo dwi. That is the integral of |f_to - f_from| over all pairs of
 *            directions as a sphere shows them, each point weighed by what one sees of it, over what that
 *            sphere reflects: E, twice over. 0.1 is a tenth of the light that came back.
 *   LOG:     g(x) = ln(1 + x / m), m the mean of x_from, and the same w: dark directions count nearly as much
 *            as bright ones. After Alejandro Sztrajman, Gilles Rainer, Tobias Ritschel, Tim Weyrich, "Neural
 *            BRDF Representation and Importance Sampling", Computer Graphics Forum 40(6), 2021, where m is 1;
 *            with the mean, dark cloth is judged as light cloth is.
 *   PICTURE: g(x) = the sRGB value, 0 .. 1, of pi x, at most 1, and the sum over w alone below the line: the
 *            mean difference of display values over four pictures of a sphere, seen from far away under a
 *            directional light of irradiance pi, 15, 60, 105 and 150 degrees off the viewer.
 *
 * Over 16 wo and 256 wi each, drawn once and for all (Halton), azimuths all around; half of the wi as the
 * cosine spreads them, the rest about the mirror direction. The same arguments give the same answer, on any
 * number of threads. */
#ifndef WEFT_MATCH_H
#define WEFT_MATCH_H

#include "weft/lobe.h"
#include "weft/material.h"
#include "weft/reflection.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The metrics, as above. */
typedef enum WeftBrdfMetric {
    WEFT_BRDF_METRIC_COSINE = 0,
    WEFT_BRDF_METRIC_LOG,
    WEFT_BRDF_METRIC_PICTURE,
    WEFT_BRDF_METRIC_COUNT
} WeftBrdfMetric;

/* "cosine", "log" or "picture". */
WEFT_API const char *weft_brdf_metric_name(WeftBrdfMetric metric);

/* Sets *distance to the distance of two reflections in one part (WeftPart; WEFT_PART_ALL: as wholes). 0 means
 * equal. Fails with WEFT_MESSAGE_DESC or _MEMORY; where `from` reflects nothing in that part the answer is 0
 * if `to` does so too, else 1. */
WEFT_API WeftResult weft_brdf_distance(const WeftReflection *to, const WeftReflection *from, int part,
                                       WeftBrdfMetric metric, double *distance, WeftError *error);

/* The result of a search. */
typedef struct WeftMatch {
    double copied, matched; /* the error at the start and of the answer, which is never above it */
    long long evaluations;  /* of a lobe or material over the directions */
} WeftMatch;

/* Changes lobe, whose numbers are where to begin, to what comes closest to `from`: all parameters that are
 * numbers within their plausible range (or from where they begin), f0, and f90 of WEFT_LOBE_TWO_COLORS, which
 * are at least 0 and with WEFT_LOBE_TINTED at most 1. Choices stay. Bit k of hold (may be 0): parameter k
 * stays; WEFT_HOLD_COLOR: f0, WEFT_HOLD_COLOR_2: f90. Where `from` is
 * isotropic and the start too, parameters stay by which that would end. Of parameters that have no influence
 * the start's numbers stay. Fails with WEFT_MESSAGE_LOBE_NAME, _DESC (a lobe with WEFT_LOBE_REFERENCE on
 * either side: what is an estimate would be met in its noise; match fibre, which is the mean) or _MEMORY. */
enum { WEFT_HOLD_COLOR = 1 << 8, WEFT_HOLD_COLOR_2 = 1 << 9 };
WEFT_API WeftResult weft_match_lobe(const WeftReflection *from, WeftBrdfMetric metric, unsigned hold,
                                    WeftLobe *lobe, WeftMatch *out, WeftError *error);

/* Likewise material, whose inputs and choices are where to begin. Free are those of base_color, sheen_color,
 * sheen_roughness, roughness (0.25 at least) and specular that it reads (weft_material_reads), sheen and
 * sheen_tint where it does not read sheen_color, and specular_color in the workflow of that name; all within
 * their plausible range, or from where they begin. held (may be NULL): not 0 for an input that stays,
 * WEFT_INPUTS_MAX of them. Where both are grey, colours stay grey. Fails with WEFT_MESSAGE_PARAM_VALUE,
 * _DESC (a lobe with WEFT_LOBE_REFERENCE on either side) or _MEMORY. */
WEFT_API WeftResult weft_match_material(const WeftReflection *from, WeftBrdfMetric metric, const int *held,
                                        WeftMaterial *material, WeftMatch *out, WeftError *error);

/* Returns 1 if weft_match_material may change that input of the material, else 0. */
WEFT_API int weft_match_is_free(const WeftMaterial *material, int input);

/* Many matches at once, on `threads` threads (0: one a processor). progress (may be NULL) can stop it,
 * in the midst of a search: WEFT_INTERRUPTED. Each says in `result` how it went; fails with the first that
 * did not. */
typedef struct WeftMatchJob {
    const WeftReflection *from; /* borrowed */
    int is_lobe;                /* lobe is what is matched, else material */
    unsigned hold;              /* of the lobe */
    const int *held;            /* of the material; may be NULL */
    WeftLobe lobe;              /* where to begin, then the match */
    WeftMaterial material;      /* likewise */
    WeftMatch found;            /* the errors of copy and match */
    WeftResult result;          /* how it went */
} WeftMatchJob;

/* Does jobs[0 .. count) on so many threads (0: one a processor); user is handed to progress, which may be
 * NULL. */
WEFT_API WeftResult weft_match_many(WeftMatchJob *jobs, int count, WeftBrdfMetric metric, int threads,
                                    WeftProgress progress, void *user, WeftError *error);

/* The result for one material of an asset. Numbers are those of its factors: with textures, `matched` is made
 * for what texel and factor are on average, and the factor scaled as that was. */
typedef struct WeftAssetMatch {
    char name[64];   /* of the material, cut where it is long */
    int changed;     /* 0: it has no sheen, or is unlit, and stays as it is */
    int clipped;     /* not 0: a factor would have passed 1, where glTF ends */
    int search;      /* number of the search, counted from 1; equal averages share one; 0: none */
    WeftMatch found; /* the errors of copy and match */
    WeftMaterial copied, matched; /* under profile `to`: with the numbers as they were, and as they are now */
} WeftAssetMatch;

/* Writes the glTF file at `path` again for another engine, as `out`: the factors base_color, roughness,
 * sheen_color, sheen_roughness and specular of materials that have a sheen, so that under profile `to` they
 * come closest to what they are under profile `from` (indices of weft_profile_name); all else stays as it is,
 * byte for byte. Materials that are the same on average share one search; these run on all processors.
 * progress (may be NULL) receives the fraction done, without reading, and can stop it, in the midst of a
 * search: WEFT_INTERRUPTED, and nothing is written. *report (report may be NULL) receives a record of each of
 * *count materials; on success it is owned by the caller: release it with weft_match_report_free. Fails with
 * WEFT_MESSAGE_DESC (a profile that there is not), and with what reading and writing the file can fail
 * with. */
WEFT_API WeftResult weft_match_asset(const char *path, const char *out, int from, int to,
                                     WeftBrdfMetric metric, WeftProgress progress, void *user,
                                     WeftAssetMatch **report, int *count, const WeftLog *log,
                                     WeftError *error);

WEFT_API void weft_match_report_free(WeftAssetMatch *report); /* may be NULL */

#ifdef __cplusplus
}
#endif

#endif
