/* measured.h - a measured BRDF of any of three file formats
 *
 * The suffix of the name selects the format: .binary MERL (merl.h), .bsdf RGL (rgl.h), .bin UTIA (utia.h). */
#pragma once

#include "brdf/merl.h"
#include "brdf/rgl.h"
#include "brdf/utia.h"

typedef enum MeasuredFormat { MEASURED_NONE, MEASURED_MERL, MEASURED_RGL, MEASURED_UTIA } MeasuredFormat;

typedef struct Measured {
    MeasuredFormat format;
    char *path; /* of its file, absolute; NULL: it was read from memory, or realpath failed */
    Merl merl;
    Rgl rgl;
    Utia utia;
} Measured;

/* The most bytes of a file. */
enum { MEASURED_MOST = 1 << 28 };

/* Returns the format of a file of that name; MEASURED_NONE for another suffix. */
MeasuredFormat measured_format(const char *name);

/* Reads a file, or size bytes of one; any other suffix means MERL. Fails as the reader of its format does, and as
 * file_read. Release with measured_free in any case. */
WeftResult measured_read(const char *path, Measured *out, WeftError *error);
WeftResult measured_read_memory(const void *data, size_t size, const char *name, Measured *out, WeftError *error);
void measured_free(Measured *measured);

/* Returns true if f does not change when both directions rotate about the normal. */
bool measured_isotropic(const Measured *measured);

/* Evaluates f, 1/sr. Returns false, with f = 0, below the horizon and where nothing was measured. */
bool measured_at(const Measured *measured, Dir o, Dir i, float f[3]);

/* Draws a direction for two numbers in [0, 1), and returns a direction's density, 1/sr: by the sampling tables of an
 * RGL file, else by the cosine. */
Dir measured_sample(const Measured *measured, Dir o, float u, float v);
float measured_pdf(const Measured *measured, Dir o, Dir i);
