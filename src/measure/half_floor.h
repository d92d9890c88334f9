/* half_floor.h - what floors keep a lobe finite in half precision */
#ifndef WEFT_MEASURE_HALF_FLOOR_H
#define WEFT_MEASURE_HALF_FLOOR_H

#include "measure/subject.h"

/* Fills the half_ members of the passport of a lobe. */
void half_floor_measure(const Subject *subject, WeftPassport *out, int threads);

#endif
