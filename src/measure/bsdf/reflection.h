/* reflection.h - a reflection whose material changes often */
#pragma once

#include "shading/catalogue/albedo.h"
#include "shading/stack/surface.h"
#include "weft/reflection.h"

/* Replaces the material of a reflection in almost no time. E of its sheen is looked up in one table for all
 * roughnesses, which is made in `shared` (all zero at first) and made anew if it does not fit. `shared` must outlive
 * the reflection. If the sheen takes nothing from the base, E is not tabulated, since no f needs it. */
void reflection_change(WeftReflection *reflection, const WeftMaterial *material, AlbedoTable *shared);

/* Returns the id of the lobe of which a reflection is an estimate (WEFT_LOBE_REFERENCE), by itself or as the
 * sheen of a material; NULL if there is none. */
const char *reflection_walks(const WeftReflection *reflection);

/* Returns the surface of a reflection of a material, and the table of E of its sheen, which lives as long as it does. */
Surface reflection_surface(const WeftReflection *reflection);
TableRef reflection_table(const WeftReflection *reflection);
