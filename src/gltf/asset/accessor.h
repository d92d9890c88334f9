/* accessor.h - typed arrays in buffer views */
#pragma once

#include "gltf/asset/asset.h"

/* Reads the record of every accessor and checks its types, references and bounds. */
void accessors_read(Asset *asset);

/* Adds an accessor of bytes that were decoded, without padding, and returns its index. The bytes live as long as the
 * asset. Returns 0 after a sticky failure. */
int accessor_add(Asset *asset, Accessor accessor, Span bytes);

/* Decodes an accessor into columns * rows floats an element (matrices column by column); normalized integers
 * are divided by their range. Returns NULL after a sticky failure. */
float *accessor_floats(Asset *asset, Arena *arena, int accessor);

/* Decodes a scalar or vector accessor of integers without conversion. Returns NULL after a sticky failure. */
uint32_t *accessor_integers(Asset *asset, Arena *arena, int accessor);
