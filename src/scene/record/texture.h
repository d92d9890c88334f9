/* texture.h - an image with its wrapping and filter */
#pragma once

#include <stdbool.h>

#include "scene/record/levels.h"
#include "weft/image.h"

typedef enum TextureWrap { WRAP_REPEAT = 0, WRAP_MIRROR, WRAP_CLAMP } TextureWrap;

typedef struct Texture {
    int image; /* index into the scene's images */
    TextureWrap wrap_u, wrap_v;
    bool nearest;   /* no interpolation between texels */
    bool single;    /* the sampler asks for no mip levels: minFilter NEAREST or LINEAR of glTF */
    int source;     /* number of the texture that this one was smoothed from (scene/material/relief.h); 0: none */
    float sigma[2]; /* of that Gaussian along u and v, as parts of the sides; infinite: flat */
    /* Properties of the image, equal for all textures of it: */
    const char *path;      /* path of its file; NULL if it is not a file of its own */
    unsigned version;      /* counts changes of the pixels */
    TextureLevels *levels; /* of its own; owned by the scene with the image; NULL: none */
    unsigned inverted;     /* bit c: channel c is 1 - that of the file, as roughness is of a picture of gloss */
} Texture;

typedef struct Texel {
    float c[4]; /* RGBA; a grey image gives r = g = b, a missing alpha gives 1 */
} Texel;

/* Linear value of every sRGB byte (IEC 61966-2-1), made once per scene. */
typedef struct SrgbTable {
    float linear[256];
} SrgbTable;

SrgbTable srgb_table(void);

/* Returns the levels of its own that are drawn of a texture from afar, by both renderers; NULL where it has none, or where
 * its sampler asks for the picture itself: `single`, and `nearest`, of which all texels are meant to be seen. */
static inline const TextureLevels *texture_levels(const Texture *texture) {
    return texture->single || texture->nearest ? NULL : texture->levels;
}

/* Gives the textures of an image these levels, which may be NULL, and releases those before. Takes the levels over. */
void textures_put_levels(Texture *textures, int count, int image, TextureLevels *levels);

/* Returns the texture's value at (u, v), v running down the image as in glTF: bilinear unless nearest. If srgb is not
 * NULL the RGB of integer images is decoded to linear Rec. 709 before it is interpolated; alpha never is.
 * Non-finite coordinates read as 0. */
Texel texture_fetch(const Texture *texture, const WeftImage *images, const SrgbTable *srgb, float u, float v);

/* Looks up n <= ROW_MOST places (shading/stack/surface_rows.h), in arrays of row_whole(n) entries. Channel c of place k
 * is texels[c * ROW_CAPACITY + k]. */
void texture_fetch_rows(const Texture *texture, const WeftImage *images, const SrgbTable *srgb, int n, const float *u,
                        const float *v, float *texels);

/* Does the same for a texture with levels of its own: place k is looked up in level[k], 0 to levels->count. */
void texture_fetch_levels(const Texture *texture, const WeftImage *images, const SrgbTable *srgb, int n, const float *u,
                          const float *v, const int *level, float *texels);
