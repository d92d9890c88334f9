/* average.h - materials of a scene with the means of their textures in the place of the textures */
#pragma once

#include <stdbool.h>

#include "weft/image.h"
#include "weft/material.h"

/* The mean, least and greatest value of a channel of a texture, linear; kept for all inputs that read it. */
typedef struct TextureChannel {
    bool done;
    double mean, low, high;
} TextureChannel;

/* Returns a channel of a pixel, linear. With one channel or two, the first is grey and is used for all three colours; with
 * two or four, the last is alpha, which is 1 where there is none. color: integers are decoded from sRGB. */
double texture_value(const WeftImage *image, size_t pixel, int channel, bool color);

/* Measures a channel of a texture; 1 without pixels. */
TextureChannel texture_channel(const WeftImage *image, int channel, bool color);

/* Zero-initialise all but the scene, which has to outlive it and stay as it is. */
typedef struct Averages {
    const WeftScene *scene;
    TextureChannel (*means)[2][4]; /* [texture - 1][0: data, 1: sRGB colours][channel]; owned */
    int count;                     /* of textures that means has room for */
} Averages;

/* Fills in the mean of each number of an input's texture; 1 without one. Returns false where memory is short. */
bool averages_of(Averages *averages, const WeftMaterial *material, int input, double means[3]);

/* Multiplies the numbers of a material by the means of their textures, and takes out all textures, normal maps and
 * directions included. Returns false where memory is short. */
bool averages_take(Averages *averages, WeftMaterial *material);

void averages_free(Averages *averages);
