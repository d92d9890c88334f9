/* parity.h - comparison of the GPU's results with those of C, from the same text */
#pragma once

#include "measure/bsdf/bsdf.h"

/* Fills the parity_ members of the passport of a lobe. */
void parity_measure(const Bsdf *bsdf, WeftPassport *out);
