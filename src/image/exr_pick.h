/* exr_pick.h - which channels of an OpenEXR file are its picture */
#pragma once

#include <stdbool.h>

#include <openexr.h>

typedef struct ExrPick {
    int from[4];     /* the file's channel for each channel of the image, -1: all 0 */
    int count;       /* channels of the image: 1 to 4 */
    bool xyz;        /* the colours are CIE X Y Z */
    char words[160]; /* what was taken, where the file alone does not say it: "channel V as grey"; else empty */
} ExrPick;

/* Picks the colours without a layer, else those of the first layer that has any, and alpha beside them: R G B, red
 * green blue, X Y Z, or one of Y, V, luminance, grey or a lone R, in any case. Returns false if there are none. */
bool exr_pick(const exr_attr_chlist_t *channels, ExrPick *pick);

/* Returns the length of "layer." in "layer.R"; 0 without a layer. */
size_t exr_layer_length(const char *channel);
