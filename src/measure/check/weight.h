/* weight.h - variance of the weights f cos / pdf of a sampler, by quadrature */
#pragma once

#include "measure/bsdf/grid.h"

typedef struct Weight {
    double albedo;         /* E */
    double own, by_cosine; /* variance of f cos / pdf: with the sampling of the BSDF, and of the cosine */
    double missed;         /* the part of E from directions whose pdf is 0, which no sample finds */
} Weight;

double weight_albedo(const BsdfView *view, int cells);

Weight weight_measure(const BsdfView *view, int cells);
