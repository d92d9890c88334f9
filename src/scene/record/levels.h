/* levels.h - the mip levels that a KTX 2 file has of its own
 *
 * Viewers draw them from afar in place of means of the picture, and so do both renderers: a file can have levels whose
 * light is that of the surface, which means of normals and of roughness do not keep. */
#pragma once

#include "weft/image.h"

typedef struct TextureLevels {
    WeftImage *images; /* after the picture itself: each half of the one before, down to a single texel */
    int count;
    unsigned char *file; /* the file as it is */
    size_t size;
} TextureLevels;

/* Decodes a picture as weft_image_read_memory does, and its levels. *levels is NULL where the bytes are no KTX 2 file, lack
 * a level down to a single texel, or, with a warning, are damaged after the first or memory is short: the picture alone then
 * is drawn. Release it with levels_free. */
WeftResult levels_decode(const void *data, size_t size, const char *name, WeftImage *out, TextureLevels **levels,
                         const WeftLog *log, WeftError *error);

/* Does the same for a file, as weft_image_read does. */
WeftResult levels_read(const char *path, WeftImage *out, TextureLevels **levels, const WeftLog *log, WeftError *error);

/* Releases levels, which may be NULL. */
void levels_free(TextureLevels *levels);
