/* arrays.h - evaluation of a lobe for arrays of directions, several times faster than pair by pair
 *
 * Conventions, units and the meaning of f, pdf and E are those of lobe.h. Directions and colours are
 * structures of arrays: element k of every array belongs to evaluation k, and each array has n elements. n may
 * be 0. Arrays belong to the caller and need no more alignment than a float. An array that is written must not
 * overlap any other array.
 *
 * A result depends on its own inputs alone: not on n, on its index, or on where arrays begin. A caller may
 * therefore cut the work into pieces and share it among threads. From processor to processor, and from the
 * calls of lobe.h, results differ by rounding. All calls may be made from any number of threads.
 *
 * Fails, with 0 in every array it was to write, with WEFT_MESSAGE_LOBE_NAME where there is no lobe of that
 * index; and, with nothing written, with WEFT_MESSAGE_DESC where an array that is not optional is NULL and n
 * is not 0. */
#ifndef WEFT_ARRAYS_H
#define WEFT_ARRAYS_H

#include <stddef.h>

#include "weft/lobe.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Unit vectors that a call reads. */
typedef struct WeftDirections {
    const float *x, *y, *z; /* n components each */
} WeftDirections;

/* Colours that a call writes; an array may be NULL: that channel is not written. */
typedef struct WeftColors {
    float *r, *g, *b; /* n values each */
} WeftColors;

/* Evaluates f for n pairs, 1/sr; 0 where a direction is not above the horizon, or a component is infinite or NaN. */
WEFT_API WeftResult weft_eval_n(const WeftLobe *lobe, size_t n, WeftDirections wo, WeftDirections wi, WeftColors f,
                                WeftError *error);

/* Evaluates the density of weft_sample_n at wi for n pairs, 1/sr; 0 where f is. */
WEFT_API WeftResult weft_pdf_n(const WeftLobe *lobe, size_t n, WeftDirections wo, WeftDirections wi, float *pdf,
                               WeftError *error);

/* Draws n directions wi for (u, v) in [0, 1)^2, and their pdf; 0 means no sample, and wi must then not be
 * used. A u or v outside [0, 1) is clamped to it; NaN becomes 0. */
WEFT_API WeftResult weft_sample_n(const WeftLobe *lobe, size_t n, WeftDirections wo, const float *u, const float *v,
                                  float *wi_x, float *wi_y, float *wi_z, float *pdf, WeftError *error);

/* Computes the directional albedo E for n cosines with the conventions of weft_lobe_albedo: exact to 1e-4 and
 * some thousand times slower than a table, so that it pays to share the work among threads. */
WEFT_API WeftResult weft_albedo_n(const WeftLobe *lobe, size_t n, const float *cos_o, WeftColors e, WeftError *error);

/* Lobes of one kind with different parameters and colours, as arrays of n values. An array may be NULL: then the
 * value of `lobe` applies to all n. A parameter that is a choice (WeftParamInfo.choices) can have no array. */
typedef struct WeftLobes {
    WeftLobe lobe; /* the lobe, and the values that no array gives */
    /* In the order of WeftLobeInfo.params; clamped to their hard ranges. */
    const float *params[WEFT_LOBE_PARAMS_MAX];
    const float *f0[3], *f90[3]; /* colours, each channel */
} WeftLobes;

/* Evaluates f and pdf in one pass, as weft_eval_n and weft_pdf_n do, each pair with a lobe of its own. pdf may be
 * NULL too. Values that depend on parameters alone are computed for each element: with one lobe for all, the calls
 * above are faster. Fails as they do, and with WEFT_MESSAGE_DESC where there is an array for a choice. */
WEFT_API WeftResult weft_eval_each(const WeftLobes *lobes, size_t n, WeftDirections wo, WeftDirections wi, WeftColors f,
                                   float *pdf, WeftError *error);

/* Draws as weft_sample_n does, each element with a lobe of its own; fails as weft_eval_each does. */
WEFT_API WeftResult weft_sample_each(const WeftLobes *lobes, size_t n, WeftDirections wo, const float *u,
                                     const float *v, float *wi_x, float *wi_y, float *wi_z, float *pdf,
                                     WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
