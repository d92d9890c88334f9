/* parity.h - comparison of the GPU's results with those of C, from the same text */
#ifndef WEFT_MEASURE_PARITY_H
#define WEFT_MEASURE_PARITY_H

#include "measure/bsdf/bsdf.h"

/* Fills the parity_ members of the passport of a lobe. */
void parity_measure(const Bsdf *bsdf, WeftPassport *out);

#endif
