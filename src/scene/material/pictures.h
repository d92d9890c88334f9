/* pictures.h - a scene's images and textures: made longer by some, and other pixels put in their place */
#ifndef WEFT_SCENE_PICTURES_H
#define WEFT_SCENE_PICTURES_H

#include "scene/record/scene.h"

/* Appends an image, which is the scene's then and zeroed, and textures of it that are like `like` but for the
 * image they name: their number, counted from 1. 0 where memory is short. */
int picture_add(WeftScene *scene, WeftImage *image, Texture like);

/* Another texture of an image that is there already, likewise. */
int texture_number_of(WeftScene *scene, Texture texture);

/* Puts pixels in the place of an image's, zeroes *fresh, and marks all textures of it as changed and of that
 * file, or NULL: of none. path must live as long as the scene. */
void picture_replace(WeftScene *scene, int image, WeftImage *fresh, const char *path);

#endif
