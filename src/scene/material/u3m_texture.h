/* u3m_texture.h - a texture of a U3M file as one of weft's: its formula put into a factor, or into the pixels */
#pragma once

#include "scene/u3m/u3m_fields.h"
#include "weft/image.h"

/* The ways in which a colour texture and its factor are mixed. */
typedef enum U3mMode {
    U3M_ADD = 0,
    U3M_SUBTRACT,
    U3M_MULTIPLY,
    U3M_DIVIDE,
    U3M_MAX,
    U3M_MIN,
    U3M_OVERLAY,
    U3M_MODES
} U3mMode;

extern const char *const u3m_modes[U3M_MODES + 1]; /* their names, then NULL */

/* The formula of a texture. */
typedef struct U3mFormula {
    U3mMode mode;    /* of a colour */
    float factor[3]; /* of a colour linear; of a number and of a normal map [0] */
    float offset;    /* of a number */
} U3mFormula;

/* Returns true if an image has one channel for a number, or three that are equal everywhere. */
bool u3m_texture_grey(const WeftImage *image);

/* Returns true if the value of an input is a factor times the image, and fills the factor in. */
bool u3m_texture_plain(const U3mField *field, const U3mFormula *formula, const WeftImage *image, float value[3]);

/* Replaces the image by one of floats that is the value of the input as it is, and writes the factor that says so.
 * Fails with WEFT_MESSAGE_MEMORY; the image then stays. */
WeftResult u3m_texture_make(const U3mField *field, const U3mFormula *formula, WeftImage *image, float value[3],
                            WeftError *error);
