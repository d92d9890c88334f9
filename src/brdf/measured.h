/* measured.h - a measured BRDF, whichever file it comes from
 *
 * Its format is that of the name: .binary MERL (merl.h), .bsdf RGL (rgl.h), .bin UTIA (utia.h). */
#ifndef WEFT_BRDF_MEASURED_H
#define WEFT_BRDF_MEASURED_H

#include "brdf/merl.h"
#include "brdf/rgl.h"
#include "brdf/utia.h"

typedef enum MeasuredFormat { MEASURED_NONE, MEASURED_MERL, MEASURED_RGL, MEASURED_UTIA } MeasuredFormat;

typedef struct Measured {
    MeasuredFormat format;
    char *path; /* of its file, absolute; NULL: it was read from memory, or the system gave none */
    Merl merl;
    Rgl rgl;
    Utia utia;
} Measured;

/* The most bytes of a file. */
enum { MEASURED_MOST = 1 << 28 };

/* The format of a file of that name; MEASURED_NONE: it is none of these. */
MeasuredFormat measured_format(const char *name);

/* Reads a file, or size bytes of one. Fails as the reader of its format does, and as file_read; a name of
 * none of them is taken for MERL. Release with measured_free in any case. */
WeftResult measured_read(const char *path, Measured *out, WeftError *error);
WeftResult measured_read_memory(const void *data, size_t size, const char *name, Measured *out,
                                WeftError *error);
void measured_free(Measured *measured);

/* Returns true if f stays the same however both directions turn. */
bool measured_isotropic(const Measured *measured);

/* f, 1/sr; 0 below the horizon and where nothing was measured, where it returns false. */
bool measured_at(const Measured *measured, Dir o, Dir i, float f[3]);

/* A direction for two numbers in [0, 1), and its density, 1/sr: as the file has it, or the cosine's. */
Dir measured_sample(const Measured *measured, Dir o, float u, float v);
float measured_pdf(const Measured *measured, Dir o, Dir i);

#endif
