/* gltf_texture.h - textures, their samplers and images */
#pragma once

#include "gltf/asset/asset.h"

/* Reads the records of textures; checks the images and samplers too. */
void textures_read(Asset *asset);

/* Returns true for an extension by which a texture names a picture of a format that is read. */
bool texture_extension_read(const char *extension);

/* Replaces the indices of glTF textures in the inputs of the scene's materials by those of scene textures, and decodes
 * their images, each only once, in parallel. Materials that nothing shown uses lose their textures, and so do, with a
 * warning, inputs whose picture cannot be read, unless a plain one lies beside it. */
void textures_resolve(Asset *asset);
