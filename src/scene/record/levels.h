/* levels.h - the mip levels that a KTX 2 file has of its own
 *
 * Viewers draw them from afar in place of means of the picture, and so do both renderers: a file can have levels whose
 * light is that of the surface, which means of normals and of roughness do not keep. */
#pragma once

#include "base/memory.h"
#include "weft/image.h"

typedef struct TextureLevels {
    const WeftImage *images; /* after the picture itself: each half of the one before, down to a single texel */
    int count;
    const unsigned char *file; /* the file as it is */
    size_t size;
} TextureLevels;

/* Reads the levels of a file into the arena. Returns NULL where the bytes are no KTX 2 file, lack a level down to a
 * single texel, are damaged or memory is short: the picture alone then is drawn. picture: level 0. */
const TextureLevels *levels_read(Arena *arena, const unsigned char *data, size_t size, const WeftImage *picture);

/* Does the same for a file at a path; path may be NULL. */
const TextureLevels *levels_read_file(Arena *arena, const char *path, const WeftImage *picture);
