/* accessor.h - typed arrays in buffer views */
#ifndef WEFT_GLTF_ACCESSOR_H
#define WEFT_GLTF_ACCESSOR_H

#include "gltf/asset/asset.h"

/* Every accessor's record, its types, references and bounds checked. */
void accessors_read(Asset *asset);

/* The accessor's elements as floats, columns * rows each (matrices column by column), integers divided by
 * their range where normalized. NULL after a sticky failure. */
float *accessor_floats(Asset *asset, Arena *arena, int accessor);

/* A scalar or vector accessor of integers as they are. NULL after a sticky failure. */
uint32_t *accessor_integers(Asset *asset, Arena *arena, int accessor);

#endif
