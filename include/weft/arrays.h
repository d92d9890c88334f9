/* arrays.h - a lobe asked about many directions at once, several times faster than pair by pair
 *
 * Conventions, units and the meaning of f, pdf and E are those of lobe.h. Directions and colours are
 * structures of arrays: element k of every array belongs to question k, and each array has n elements. n may
 * be 0. Arrays belong to the caller, need no more alignment than a float, and what is written must not
 * overlap what is read or another that is written.
 *
 * An answer depends on its own question alone: not on n, on its place among the others, or on where arrays
 * begin; so a caller may cut the work into pieces and share it among threads. From processor to processor,
 * and from the calls of lobe.h, answers differ by rounding. All calls may be made from any number of threads.
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

/* Unit vectors to be read. */
typedef struct WeftDirections {
    const float *x, *y, *z; /* n components each */
} WeftDirections;

/* Colours to be written; each array may be NULL: that channel is not wanted. */
typedef struct WeftColors {
    float *r, *g, *b; /* n values each */
} WeftColors;

/* f for n pairs, 1/sr; 0 where a direction is not above the horizon, or a component is infinite or NaN. */
WEFT_API WeftResult weft_eval_n(const WeftLobe *lobe, size_t n, WeftDirections wo, WeftDirections wi,
                                WeftColors f, WeftError *error);

/* Density of weft_sample_n at wi for n pairs, 1/sr; 0 where f is. */
WEFT_API WeftResult weft_pdf_n(const WeftLobe *lobe, size_t n, WeftDirections wo, WeftDirections wi,
                               float *pdf, WeftError *error);

/* Draws n directions wi for (u, v) in [0, 1)^2, and their pdf; 0 means no sample, and wi is then not to be
 * used. What is not in [0, 1) is moved to its nearer end, NaN to 0. */
WEFT_API WeftResult weft_sample_n(const WeftLobe *lobe, size_t n, WeftDirections wo, const float *u,
                                  const float *v, float *wi_x, float *wi_y, float *wi_z, float *pdf,
                                  WeftError *error);

/* Directional albedo E for n cosines, as weft_lobe_albedo takes and gives them: exact to 1e-4 and some
 * thousand times slower than a table, so that it pays to share the work among threads. */
WEFT_API WeftResult weft_albedo_n(const WeftLobe *lobe, size_t n, const float *cos_o, WeftColors e,
                                  WeftError *error);

/* Lobes of one kind, each with numbers of its own. Arrays of n, each of which may be NULL: then `lobe` has
 * that number for all of them. A parameter that is a choice (WeftParamInfo.choices) is one for all. */
typedef struct WeftLobes {
    WeftLobe lobe; /* the lobe, and the values that no array gives */
    const float
        *params[WEFT_LOBE_PARAMS_MAX]; /* in the order of WeftLobeInfo.params; clamped as lobe's are */
    const float *f0[3], *f90[3];       /* colours, each channel */
} WeftLobes;

/* weft_eval_n and weft_pdf_n at once, of the lobe of each pair. pdf may be NULL too. What depends on
 * parameters alone is made for each element: with one lobe for all, the calls above are faster. Fails as they
 * do, and with WEFT_MESSAGE_DESC where there is an array for a choice. */
WEFT_API WeftResult weft_eval_each(const WeftLobes *lobes, size_t n, WeftDirections wo, WeftDirections wi,
                                   WeftColors f, float *pdf, WeftError *error);

/* weft_sample_n, of the lobe of each pair; fails likewise. */
WEFT_API WeftResult weft_sample_each(const WeftLobes *lobes, size_t n, WeftDirections wo, const float *u,
                                     const float *v, float *wi_x, float *wi_y, float *wi_z, float *pdf,
                                     WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
