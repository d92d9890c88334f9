/* merl.h - a measured isotropic BRDF in the format of the MERL database
 *
 * Wojciech Matusik, Hanspeter Pfister, Matt Brand, Leonard McMillan, "A Data-Driven Reflectance Model", ACM
 * Transactions on Graphics 22(3), 2003. The file has three little-endian 32-bit integers, the bins of theta_h, theta_d
 * and phi_d (90 90 180), then a double for each bin, phi_d fastest, for red, green and blue, in units of 1/1500,
 * 1.15/1500 and 1.66/1500 per steradian; negative means unmeasured. Angles are those of Szymon Rusinkiewicz, "A New
 * Change of Variables for Efficient BRDF Representation", 1998. With 360 bins phi_d covers the whole circle, and f need
 * not be reciprocal; with 180 the other half of the circle is equal. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "shading/dialect/angles.h"
#include "weft/result.h"

enum {
    MERL_THETA_H = 90,
    MERL_THETA_D = 90,
    MERL_PHI_D = 180,
    MERL_ALL_AROUND = 2 * MERL_PHI_D,
    MERL_BINS = 90 * 90 * 180
};

/* The number of bins of each angle. */
typedef struct MerlShape {
    int theta_h, theta_d, phi_d;
    bool around; /* phi_d covers the circle, not its half */
} MerlShape;

/* f[channel][bin], 1/sr, negative where it was not measured. */
typedef struct Merl {
    MerlShape shape;
    float *f[3];
} Merl;

/* Reads size bytes of a file. Fails with WEFT_MESSAGE_MEASURED or _MEMORY; release with merl_free in any case. */
WeftResult merl_read_memory(const void *data, size_t size, const char *name, Merl *out, WeftError *error);
void merl_free(Merl *merl);

/* Works as merl_read_memory, for a file with numbers of bins that the format does not have: a fuzzer needs inputs
 * smaller than 35 MB. */
WeftResult merl_read_shape(const void *data, size_t size, MerlShape shape, const char *name, Merl *out,
                           WeftError *error);

/* Evaluates f, linear between the middles of the bins, over those that were measured. Returns false where none was, and
 * below the horizon. */
bool merl_at(const Merl *merl, Dir o, Dir i, float f[3]);
