/* half_floor.h - the floors that keep a lobe finite in half precision */
#pragma once

#include "measure/bsdf/bsdf.h"

/* Fills the half_ members of the passport of a lobe. */
void half_floor_measure(const Bsdf *bsdf, WeftPassport *out, int threads);
