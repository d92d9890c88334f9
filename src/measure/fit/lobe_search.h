/* lobe_search.h - the parameters and colours of a lobe, alone or over a diffuse base, that come closest to samples
 *
 * Colours are factors on f, so the best ones for given parameters follow at once (blend_solve). Only the parameters of
 * lobe and base are searched, and the colour of a tinted lobe, which is no factor. */
#pragma once

#include "measure/bsdf/progress_loop.h"
#include "measure/fit/samples.h"

typedef struct LobeSearch {
    const Samples *samples;
    const WeftLobe *base;        /* start of its parameters; scaled in white by a base colour; NULL: none */
    unsigned hold;               /* as in weft_match_lobe */
    unsigned hold_base;          /* bit k: parameter k of the base is locked */
    bool isotropic;              /* the goal is isotropic: an isotropic lobe stays so */
    bool bound;                  /* base and lobe together reflect no more light than they receive */
    ItemProgress *item_progress; /* may be NULL */
} LobeSearch;

typedef struct LobeFound {
    WeftLobe lobe;
    WeftLobe base; /* the base with its parameters, and its colour as f0 and f90 */
    int numbers;   /* number of free values: parameters of both, and three a colour, or one if all is grey */
    double start, error;
    long long evaluations;
} LobeFound;

/* Returns the largest directional albedo of a base (may be NULL) and a lobe in their colours, of any channel, over
 * cosines down to 0.005; of an anisotropic one for wo along x. */
float lobe_search_albedo(const WeftLobe *base, const WeftLobe *lobe);

/* Searches from out->lobe. Fails with WEFT_RESOURCES if memory is short, WEFT_INTERRUPTED if item_progress stops it. */
WeftResult lobe_search_run(const LobeSearch *search, LobeFound *out);

/* Estimates the error that a search would find for out->lobe, in far less time; adds to out->evaluations.
 * Fails as the search does. */
WeftResult lobe_search_glance(const LobeSearch *search, LobeFound *out);
