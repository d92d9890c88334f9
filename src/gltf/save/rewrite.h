/* rewrite.h - a glTF file written again with edited JSON, and everything else unchanged
 *
 * Nothing that was not edited is lost, because nothing of it needs to be understood: animations, skins,
 * extensions that weft does not support, the spelling of numbers and the blanks between them.
 * weft_scene_save, in contrast, writes a new file from a scene. */
#pragma once

#include "gltf/asset/asset.h"
#include "weft/image.h"

/* An image that the file did not have. */
typedef struct NewImage {
    unsigned char *bytes; /* of a PNG, or of a KTX 2 file; owned */
    size_t size;
    int index;   /* index in "images" */
    int texture; /* index in "textures" */
    bool levels; /* the picture is what KHR_texture_basisu of the texture names, not the plain one */
} NewImage;

typedef struct Rewrite {
    Asset *asset; /* borrowed: opened by gltf_open, and closed after rewrite_end */
    json_t *root; /* a copy of its JSON, which callers edit */
    NewImage *images;
    int image_count;
} Rewrite;

/* Begins a rewrite of an open asset. No error is sticky: each call returns its own result. Fails with
 * WEFT_MESSAGE_MEMORY. */
WeftResult rewrite_begin(Rewrite *rewrite, Asset *asset, WeftError *error);

/* Appends an image to "images", whose bytes are copied, and a texture of it with the sampler of texture
 * number `like` (-1: none). Returns the index of the texture, or -1 with *error. */
int rewrite_texture(Rewrite *rewrite, const void *png, size_t size, int like, WeftError *error);

/* Works as rewrite_texture with an image of U8 or U16, and sets *texture to the index. data: its colours are plain
 * numbers. Of more than one level the texture names a KTX 2 file of all of them by KHR_texture_basisu beside a PNG of the
 * first. An image that was added before with an equal sampler, equal at all levels, keeps its texture, so that uses share
 * it. */
WeftResult rewrite_image(Rewrite *rewrite, const WeftImage *levels, int count, bool data, int like, int *texture,
                         WeftError *error);

/* Adds an extension to extensionsUsed unless it is there; the second function removes it from there and from
 * extensionsRequired. */
WeftResult rewrite_uses(Rewrite *rewrite, const char *extension, WeftError *error);
void rewrite_uses_no_more(Rewrite *rewrite, const char *extension);

/* Writes the file as .glb or .gltf, by the suffix of path, which may be the path of the asset. From .gltf to
 * .glb everything that it refers to is packed; from .glb to .gltf its bytes go to a .bin beside it, and
 * chunks of unknown type are dropped. New images go into a .glb, or beside a .gltf. Files that are still
 * referred to are copied if path is in another folder; a file that is there with other contents is not
 * replaced: WEFT_MESSAGE_FILE_WRITE. Each file is written completely or not at all, and the one that names
 * the others last. Fails also with WEFT_MESSAGE_SCENE_KIND (another suffix), _FILE_OPEN, _MEMORY. */
WeftResult rewrite_save(const Rewrite *rewrite, const char *path, WeftError *error);

void rewrite_end(Rewrite *rewrite);
