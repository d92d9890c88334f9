/* relief.h - the relief of an asset under a woven cloth: a normal map without its fine details
 *
 * The normal map of an asset shows folds and seams, and often the threads or the pile of the cloth that it was made
 * with, which another cloth does not have. A normal map is the source of a smoothed one, which is a texture of the scene
 * too: the mean of normals about each place, weighted by a Gaussian. Materials of the scene refer to the smoothed
 * texture, so that every renderer reads it; whoever reads or saves a material gets the source. */
#pragma once

#include "scene/record/scene.h"

/* Gives the normal map of every woven material the smoothness that its cloth asks for, and the source back to the
 * others. Call it when materials, their cloths or the meshes that have them have changed. Fails with
 * WEFT_MESSAGE_MEMORY. */
WeftResult reliefs_fit(WeftScene *scene, WeftError *error);

/* Smooths anew what came from an image whose pixels have changed. It stays as it was where memory is short. */
void reliefs_renew(WeftScene *scene, int image);

/* Completes materials that have changed: reliefs_fit, tangents_complete (scene/record/tangents.h),
 * and hairs_fit (scene/material/hair.h). */
WeftResult materials_complete(WeftScene *scene, WeftError *error);

/* Returns a texture's source, or the texture itself if it has none; both are numbers counted from 1. */
static inline int relief_source(const WeftScene *scene, int texture) {
    const int source = texture ? scene->textures[texture - 1].source : 0;
    return source ? source : texture;
}

/* Returns a material as it was given: with the source of its normal map. */
Material relief_given(const WeftScene *scene, int material);
