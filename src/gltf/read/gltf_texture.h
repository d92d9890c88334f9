/* gltf_texture.h - textures, their samplers and images */
#pragma once

#include "gltf/asset/asset.h"

/* Reads the records of textures; checks the images and samplers too. */
void textures_read(Asset *asset);

/* Replaces the indices of glTF textures in the inputs of the scene's materials by those of scene textures, and decodes
 * their images, each only once, in parallel. Materials that nothing shown uses lose their textures. */
void textures_resolve(Asset *asset);
