/* difference.h - the relative squared error of two values */
#pragma once

/* Returns (a - b)^2 / (b^2 + 1e-2), whose mean over pixels and channels is relMSE. */
static inline double relative_square(float a, float b) {
    const double reference = (double)b, off = (double)a - reference;
    return off * off / (reference * reference + 1e-2);
}
