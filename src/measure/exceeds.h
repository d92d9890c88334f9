/* exceeds.h - the search for the largest of many results, some of which may not be numbers */
#ifndef WEFT_MEASURE_EXCEEDS_H
#define WEFT_MEASURE_EXCEEDS_H

#include <math.h>
#include <stdbool.h>

/* Whether value takes the place of the most so far. NaN is more than any number: it must not get lost. */
static inline bool exceeds_or_nan(double value, double most) {
    return value > most || (isnan(value) && !isnan(most));
}

#endif
