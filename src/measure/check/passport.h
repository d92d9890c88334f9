/* passport.h - a passport of any BSDF, so that tests can measure a broken one */
#pragma once

#include "measure/bsdf/bsdf.h"

/* Fills all that does not need the id. Returns false if memory is short. */
bool passport_measure(const Bsdf *bsdf, const WeftPassportDesc *desc, WeftPassport *out);
