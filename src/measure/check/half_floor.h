/* half_floor.h - the floors that keep a lobe finite in half precision */
#ifndef WEFT_MEASURE_HALF_FLOOR_H
#define WEFT_MEASURE_HALF_FLOOR_H

#include "measure/bsdf/bsdf.h"

/* Fills the half_ members of the passport of a lobe. */
void half_floor_measure(const Bsdf *bsdf, WeftPassport *out, int threads);

#endif
