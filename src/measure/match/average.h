/* average.h - materials of a scene with the means of their textures in the place of the textures */
#pragma once

#include <stdbool.h>

#include "weft/material.h"

/* A mean of a channel of a texture, kept for all inputs that read it. */
typedef struct TextureMean {
    bool done;
    double mean;
} TextureMean;

/* Zero-initialise all but the scene, which has to outlive it and stay as it is. */
typedef struct Averages {
    const WeftScene *scene;
    TextureMean (*means)[2][4]; /* [texture - 1][0: data, 1: sRGB colours][channel]; owned */
    int count;                  /* of textures that means has room for */
} Averages;

/* Fills in the mean of each number of an input's texture; 1 without one. Returns false where memory is short. */
bool averages_of(Averages *averages, const WeftMaterial *material, int input, double means[3]);

/* Multiplies the numbers of a material by the means of their textures, and takes out all textures, normal maps and
 * directions included. Returns false where memory is short. */
bool averages_take(Averages *averages, WeftMaterial *material);

void averages_free(Averages *averages);
