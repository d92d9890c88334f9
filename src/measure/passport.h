/* passport.h - a passport of any subject, for the tests to measure a broken one */
#ifndef WEFT_MEASURE_PASSPORT_H
#define WEFT_MEASURE_PASSPORT_H

#include "measure/subject.h"

/* Fills all that does not need the id. False when memory is short. */
bool passport_measure(const Subject *subject, const WeftPassportDesc *desc, WeftPassport *out);

#endif
