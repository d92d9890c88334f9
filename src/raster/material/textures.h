/* textures.h - a scene's images on the GPU: those of one size, format and wrap are layers of one array texture, so that
 * a material with many maps needs few samplers
 *
 * All calls are for the context that is current. */
#pragma once

#include "scene/record/scene.h"

/* Most array textures of one material. */
enum { TEXTURE_SLOTS = 8 };

/* The use of a texture decides what is uploaded of it: its texels as numbers, or as colours that are decoded from sRGB
 * before they are filtered; or, of a normal map, how its slopes vary within the texels of each level (slopes.h). */
typedef enum TextureUse { TEXTURE_NUMBERS, TEXTURE_COLORS, TEXTURE_SLOPES, TEXTURE_USES } TextureUse;

/* The place of a texture of the scene. */
typedef struct TexturePlace {
    int group; /* -1: not uploaded */
    int layer;
} TexturePlace;

/* The properties that the layers of one array texture share. */
typedef struct TextureGroup {
    int width, height;
    unsigned format; /* of the driver's texels */
    TextureWrap wrap_u, wrap_v;
    bool nearest;
    int layers;
} TextureGroup;

typedef struct GlTextures {
    unsigned *groups;    /* array textures */
    TextureGroup *kinds; /* of each */
    int group_count;
    TexturePlace *places; /* TEXTURE_USES a texture of the scene */
    unsigned *versions;   /* of each texture of the scene, as uploaded */
    int texture_count;    /* textures of the scene at the upload */
    bool one_size;        /* images are scaled to that of their group */
} GlTextures;

/* Uploads the textures that materials look up, with mipmaps, made on `threads` threads (0: all). If a material needs
 * more than TEXTURE_SLOTS groups, images are scaled to one size, with a warning. Fails with WEFT_MESSAGE_MEMORY or
 * _GL_MEMORY; *out is then zero. */
WeftResult textures_create(const WeftScene *scene, int threads, GlTextures *out, const WeftLog *log, WeftError *error);
void textures_destroy(GlTextures *textures);

/* Returns how the input reads its texture: as numbers or as colours. */
TextureUse textures_use(const Material *material, int input);

/* Returns true if all textures that materials read are uploaded, for each material in at most TEXTURE_SLOTS
 * groups, and if changed pixels fit in the place of the old ones. */
bool textures_serve(const GlTextures *textures, const WeftScene *scene);

/* Returns true if the pixels of a texture of the scene differ from the uploaded ones. */
bool textures_stale(const GlTextures *textures, const WeftScene *scene, int texture);

/* Uploads the stale textures, with mipmaps; textures_serve must be true. Fails with WEFT_MESSAGE_MEMORY or
 * _GL_MEMORY. */
WeftResult textures_refresh(GlTextures *textures, const WeftScene *scene, int threads, WeftError *error);

/* Returns the place of the texture that an input reads. */
TexturePlace textures_place(const GlTextures *textures, const Input *input, TextureUse use);

/* Returns log2 of the width of a texture's texels as slopes, in texels of the map; 0 where it has none. */
float textures_slopes_level(const GlTextures *textures, const Input *input);

/* Sets whether textures are looked up with mipmaps. */
void textures_filter(const GlTextures *textures, bool mipmaps);

/* Binds a group to a unit. */
void textures_bind(const GlTextures *textures, int group, int unit);
