/* fits.h - tables for the light that lobes reflect of an environment (shading/ambient/ambient_fit.h), each made at its
 * first use and kept */
#pragma once

#include "shading/ambient/ambient_fit.h"
#include "weft/result.h"

typedef struct Fits {
    struct Fit *first;
    int threads;
    bool no_cache; /* neither read from the user's cache nor written */
} Fits;

/* Returns the fit of a lobe over the plausible range of its first parameter, with its other parameters; NULL if memory
 * is short. Lives until fits_destroy. */
const AmbientFit *fits_get(Fits *fits, const Lobe *lobe);
void fits_destroy(Fits *fits);
