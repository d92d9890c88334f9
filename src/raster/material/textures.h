/* textures.h - a scene's images in the driver's memory: those of one size, kind and wrap are layers of one
 * array texture, so that a material with many maps needs few samplers
 *
 * All calls are for the context that is current. */
#ifndef WEFT_RASTER_TEXTURES_H
#define WEFT_RASTER_TEXTURES_H

#include "scene/record/scene.h"

/* Array textures that one material may read at once. */
enum { TEXTURE_SLOTS = 8 };

/* The place of a texture of the scene. A colour is decoded before it is filtered; plain numbers are not. / */
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
    TexturePlace *places; /* two a texture of the scene: as numbers, as a colour */
    unsigned *turns;      /* of each texture of the scene, when it was uploaded */
    int texture_count;    /* textures of the scene at the upload */
    bool one_size;        /* images are scaled to that of their group */
} GlTextures;

/* Uploads what the materials that are used look up, with smaller copies of it, made on `threads` threads (0:
 * all). Should a material need more than TEXTURE_SLOTS groups, images are scaled to one size, with a warning.
 * Zero on failure: WEFT_MESSAGE_MEMORY or _GL_MEMORY. */
WeftResult textures_create(const WeftScene *scene, int threads, GlTextures *out, const WeftLog *log,
                           WeftError *error);
void textures_destroy(GlTextures *textures);

/* Returns true if the input reads its texture as a colour. */
bool textures_color(const Material *material, int input);

/* Returns true if all textures that materials read are uploaded, for each material in at most TEXTURE_SLOTS
 * groups, and if changed pixels fit in the place of the old ones. */
bool textures_serve(const GlTextures *textures, const WeftScene *scene);

/* Returns true if the pixels of a texture of the scene differ from the uploaded ones. */
bool textures_stale(const GlTextures *textures, const WeftScene *scene, int texture);

/* Uploads those that are, which must serve, with their smaller copies. Fails with WEFT_MESSAGE_MEMORY or
 * _GL_MEMORY. */
WeftResult textures_refresh(GlTextures *textures, const WeftScene *scene, int threads, WeftError *error);

/* Returns the place of the texture that an input reads. */
TexturePlace textures_place(const GlTextures *textures, const Input *input, bool color);

/* From now on they are looked up without, or again with, their smaller copies. */
void textures_filter(const GlTextures *textures, bool plain);

/* Binds a group to a unit. */
void textures_bind(const GlTextures *textures, int group, int unit);

#endif
