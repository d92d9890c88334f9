/* glossiness.h - KHR_materials_pbrSpecularGlossiness as workflow specular
 *
 * Khronos Group, KHR_materials_pbrSpecularGlossiness, 2017, archived since. Its fields are rows of material_fields.h;
 * here is what is no row: that there is no metal, and that glossiness is 1 - roughness. A picture of glossiness becomes
 * one of roughness, so that neither renderer knows of it. */
#pragma once

#include "gltf/asset/asset.h"

/* Sets what follows from the extension, after its rows were read. An input with a picture of glossiness keeps the
 * channel CHANNEL_A_GLOSS, and the factor of the glossiness, until glossiness_end. */
void glossiness_begin(Material *material);

/* Returns the number of materials with a picture of glossiness: so many textures and images glossiness_end may add. */
size_t glossiness_count(const WeftScene *scene);

/* Turns pictures of glossiness, once decoded, into pictures of roughness. */
void glossiness_end(Asset *asset);
