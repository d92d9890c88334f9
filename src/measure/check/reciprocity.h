/* reciprocity.h - test of reciprocity: f with viewer and light exchanged */
#pragma once

#include "measure/bsdf/bsdf.h"

typedef struct Reciprocity {
    float error; /* the largest |f(wo, wi) - f(wi, wo)| over the larger, at least 1e-3 / sr */
    WeftPlace place;
} Reciprocity;

/* Measures one setting over random pairs, half of which graze in one direction. */
Reciprocity reciprocity_measure(const Bsdf *bsdf, int setting, int pairs);
