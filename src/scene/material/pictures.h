/* pictures.h - adding images and textures to a scene, and replacing pixels */
#pragma once

#include "scene/record/scene.h"

/* Appends an image, which it takes over and zeroes, and a texture of it that is otherwise like `like`. Returns the
 * texture's number, counted from 1, or 0 if memory is short. */
int picture_add(WeftScene *scene, WeftImage *image, Texture like);

/* Appends a texture of an image of the scene. Returns its number, counted from 1, or 0 if memory is short. */
int texture_number_of(WeftScene *scene, Texture texture);

/* Replaces the pixels of an image, zeroes *fresh, and marks all its textures as changed and of the file `path`, or of
 * none if that is NULL. path must live as long as the scene. levels: those of the fresh pixels, taken over; NULL: none. */
void picture_replace(WeftScene *scene, int image, WeftImage *fresh, TextureLevels *levels, const char *path);

/* Replaces v by 1 - v in channels: bits 0 to 2 are red, green and blue, which a grey image has as one, bit 3 is
 * alpha. If there are any the levels of the file, which show the other thing, are released and *levels becomes NULL. */
void picture_invert(WeftImage *image, TextureLevels **levels, unsigned channels);
