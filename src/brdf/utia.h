/* utia.h - a measured anisotropic BRDF in the format of the UTIA database, ".bin"
 *
 * Jiri Filip, Radomir Vavra, "Template-Based Sampling of Anisotropic BRDFs", Computer Graphics Forum 33(7), 2014. The
 * file has no header, and for red, green and blue 288 x 288 little-endian doubles, 1/sr, over theta_i, phi_i, theta_v
 * and phi_v, the last fastest. Thetas go from 0 to 75 in steps of 15 degrees, phis in steps of 7.5 degrees. Negative
 * numbers count as 0. */
#pragma once

#include <stddef.h>

#include "shading/dialect/angles.h"
#include "weft/result.h"

enum { UTIA_THETAS = 6, UTIA_PHIS = 48, UTIA_SIDE = UTIA_THETAS * UTIA_PHIS };

/* f[channel][light][view]. */
typedef struct Utia {
    float *f[3];
} Utia;

/* Reads size bytes of a file. Fails with WEFT_MESSAGE_UTIA or _MEMORY; release with utia_free in any case. */
WeftResult utia_read_memory(const void *data, size_t size, const char *name, Utia *out, WeftError *error);
void utia_free(Utia *utia);

/* Evaluates f, linear in the four angles; beyond 75 degrees it is that of 75. 0 below the horizon. */
void utia_at(const Utia *utia, Dir o, Dir i, float f[3]);
