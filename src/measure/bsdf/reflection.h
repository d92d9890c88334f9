/* reflection.h - a reflection whose material changes often */
#ifndef WEFT_MEASURE_REFLECTION_H
#define WEFT_MEASURE_REFLECTION_H

#include "shading/catalogue/albedo.h"
#include "weft/reflection.h"

/* Puts another material in place of that which a reflection was created of, in no time: E of its sheen is
 * looked up in one table for all roughnesses, which is made in `shared`, all zero at first, and again where
 * that does not serve. It must outlive the reflection. Of a sheen that takes nothing from the base E, which
 * is then asked for no f, is not known. */
void reflection_change(WeftReflection *reflection, const WeftMaterial *material, AlbedoTable *shared);

/* The id of the lobe of which a reflection is an estimate (WEFT_LOBE_REFERENCE), by itself or as the sheen of
 * a material; NULL: it is none. */
const char *reflection_walks(const WeftReflection *reflection);

#endif
