/* equal.h - equality of floats in which NaN equals every value */
#pragma once

#include <stdbool.h>

/* Returns true if neither value is less than the other. `==` is false for NaN: a table, shader or default that is looked
 * up by its values would then never be found, and made again each time. */
static inline bool is_equal(float a, float b) { return !(a < b) && !(a > b); }
