/* lobe_search.h - the numbers and colours of a lobe, over a diffuse base or alone, that come closest to
 * samples
 *
 * Colours are factors on f, so the best ones for given numbers follow at once (blend_solve); only the numbers
 * of lobe and base are searched, and of a tinted lobe its colour too, which is no factor. */
#ifndef WEFT_MEASURE_LOBE_SEARCH_H
#define WEFT_MEASURE_LOBE_SEARCH_H

#include "measure/bsdf/progress_loop.h"
#include "measure/fit/samples.h"

typedef struct LobeSearch {
    const Samples *samples;
    const WeftLobe *base; /* where its parameters begin; a base colour scales it in white; NULL: none */
    unsigned hold;        /* as weft_match_lobe has it */
    unsigned hold_base;   /* bit k: parameter k of the base stays */
    bool isotropic;       /* what is to be met is: then a lobe that is stays so */
    ItemProgress *item_progress; /* may be NULL */
} LobeSearch;

typedef struct LobeFound {
    WeftLobe lobe;
    WeftLobe base; /* the base with its numbers, the colour as f0 and f90 */
    int numbers;   /* free ones: parameters of both, and three a colour, or one if all is grey */
    double start, error;
    long long evaluations;
} LobeFound;

/* From out->lobe. WEFT_RESOURCES where memory is short, WEFT_INTERRUPTED where the progress says that it should
 * end. */
WeftResult lobe_search_run(const LobeSearch *search, LobeFound *out);

/* Estimates the error that a search would find for out->lobe, in far less time; evaluations are counted. It
 * fails as the search does. */
WeftResult lobe_search_glance(const LobeSearch *search, LobeFound *out);

#endif
