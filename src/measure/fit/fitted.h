/* fitted.h - the parameters of a fitted lobe that a material can hold */
#ifndef WEFT_MEASURE_FITTED_H
#define WEFT_MEASURE_FITTED_H

#include "weft/fit.h"

/* Returns the parameters, as bits, that no input of a material sets: all but the first, which is its
 * roughness, and those that are named. Choices are inputs. */
unsigned params_without_input(const WeftLobe *lobe);

#endif
