/* rewrite.h - a glTF file written again with its JSON edited, and all else as it is
 *
 * Animations, skins, extensions that weft does not know, the spelling of numbers and the blanks between them:
 * what was not edited is not lost, since nothing of it needs to be understood. Where weft_scene_save writes a
 * scene anew, this keeps a file. */
#ifndef WEFT_GLTF_REWRITE_H
#define WEFT_GLTF_REWRITE_H

#include "gltf/asset/asset.h"

/* A picture that the file did not have. */
typedef struct NewImage {
    unsigned char *png; /* owned */
    size_t size;
    int index; /* in "images" */
} NewImage;

typedef struct Rewrite {
    Asset *asset; /* borrowed: opened by gltf_open, and not closed before the end */
    json_t *root; /* a copy of its JSON, to be edited by whom it may concern */
    NewImage *images;
    int image_count;
} Rewrite;

/* Sticky of nothing: each call says how it went. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult rewrite_begin(Rewrite *rewrite, Asset *asset, WeftError *error);

/* Appends a picture to "images", whose bytes are copied, and a texture of it like texture number `like` (its
 * sampler; -1: none): the texture's index, or -1 with *error. */
int rewrite_texture(Rewrite *rewrite, const void *png, size_t size, int like, WeftError *error);

/* Notes in extensionsUsed that an extension is used, once; drops it there and from extensionsRequired. */
WeftResult rewrite_uses(Rewrite *rewrite, const char *extension, WeftError *error);
void rewrite_uses_no_more(Rewrite *rewrite, const char *extension);

/* Writes the file as .glb or .gltf, by the suffix of path, which may be that of the asset. From .gltf to .glb
 * all that it refers to moves in; from .glb to .gltf its bytes go to a .bin beside it, and chunks that only
 * others know are dropped. New pictures go into a .glb, or beside a .gltf. Files that are still referred to
 * are copied where path is in another folder; one that is there with other contents is not replaced:
 * WEFT_MESSAGE_FILE_WRITE. Each file appears complete or not at all, the one that names the others last.
 * Fails also with WEFT_MESSAGE_SCENE_KIND (another suffix), _FILE_OPEN, _MEMORY. */
WeftResult rewrite_save(const Rewrite *rewrite, const char *path, WeftError *error);

void rewrite_end(Rewrite *rewrite);

#endif
