/* primaries.h - colours of other primaries as linear Rec. 709, which all float images have */
#pragma once

#include <stdbool.h>

#include "weft/image.h"

/* Chromaticities x, y of red, green, blue and white. */
typedef struct Primaries {
    double xy[8];
} Primaries;

/* A matrix from colours of a file to Rec. 709, by rows. */
typedef struct ColorConversion {
    double m[9];
} ColorConversion;

/* Returns true if they are Rec. 709's, as far as files with four digits say. */
bool primaries_rec709(const Primaries *primaries);

/* Fills *matrix for colours of these primaries; their white becomes white. Returns false if they span no colours. */
bool primaries_matrix(const Primaries *primaries, ColorConversion *matrix);

/* Returns the matrix for CIE X, Y and Z. */
ColorConversion xyz_matrix(void);

/* Fills the matrix that takes Rec. 709 colours under light of chromaticity x, y to those under D65. Returns false for one
 * without light. */
bool primaries_adapted(const double white[2], ColorConversion *matrix);

/* Fills the chromaticity of a Rec. 709 colour; returns false for one without light. */
bool primaries_chromaticity(const double rgb[3], double xy[2]);

/* Converts the colours of a float image of three or four channels; finite ones stay finite. */
void image_convert_colors(WeftImage *image, const ColorConversion *matrix);
