/* furnace.h - the white furnace: the light that a white lobe as the sheen of a white Lambert base returns */
#pragma once

#include "measure/bsdf/bsdf.h"

typedef struct Furnace {
    double e, noise; /* the standard error of e: 0 unless something walks at random */
} Furnace;

/* Measures the lobe, with parameter 0 from an artist's roughness, under a layer rule, towards o. e is the table of the
 * lobe at that roughness. A layer rule that walks at random does so until the noise is below 5e-4, 10,000 times at
 * least and `walks` times at most. A lobe that walks makes everything a mean over samples, with a quarter of that. */
Furnace furnace_measure(const Lobe *lobe, float roughness, int layer, const AlbedoTable *e, Dir o, int cells,
                        int walks);
