/* exceeds.h - the search for the largest of many results, some of which may not be numbers */
#pragma once

#include <math.h>
#include <stdbool.h>

/* Returns true if value replaces the largest value so far. NaN exceeds every number, so that it is not lost. */
static inline bool exceeds_or_nan(double value, double most) { return value > most || (isnan(value) && !isnan(most)); }
