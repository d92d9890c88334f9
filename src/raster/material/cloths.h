/* cloths.h - the cloths of a scene as textures: the runs and albedos of their threads, and their colours from afar
 *
 * All calls are for the context that is current. */
#pragma once

#include "scene/record/scene.h"

typedef struct GlCloth {
    const WeftCloth *cloth;
    unsigned cells;  /* RGBA32F: a row of runs for each pick, then albedos, one a texel */
    unsigned colors; /* ClothFar as an array texture with its levels */
} GlCloth;

/* Zero-initialise. */
typedef struct GlCloths {
    GlCloth *all; /* two a cloth of the scene: itself and its other face, all zero where that is not seen */
    int count;
} GlCloths;

/* Uploads the cloths that are new. Fails with WEFT_MESSAGE_MEMORY or _GL_MEMORY; those before stay. */
WeftResult cloths_update(GlCloths *cloths, const WeftScene *scene, WeftError *error);

/* Binds the textures of a cloth to two units. cloth: its number, as a material has it. */
void cloths_bind(const GlCloths *cloths, int cloth, int cells_unit, int colors_unit);

void cloths_destroy(GlCloths *cloths);

enum { CLOTH_NUMBERS = 188 }; /* rounded up to vectors of four */

/* Writes the numbers of a cloth in the order in which weave_cloth.glsl and weave.glsl read them. */
void cloth_numbers(const WeftCloth *cloth, float numbers[CLOTH_NUMBERS]);
