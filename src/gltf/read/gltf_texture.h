/* gltf_texture.h - textures, their samplers and images */
#ifndef WEFT_GLTF_GLTF_TEXTURE_H
#define WEFT_GLTF_GLTF_TEXTURE_H

#include "gltf/asset/asset.h"

/* The records of textures; checks the images and samplers too. */
void textures_read(Asset *asset);

/* Turns the inputs of the scene's materials, which hold indices of glTF textures, into those of scene
 * textures and decodes the images behind them, each once, in parallel. Materials that nothing shown wears
 * lose their textures. */
void textures_resolve(Asset *asset);

#endif
