/* map_names.h - the use of a picture of a folder, told by its name */
#pragma once

#include <stdbool.h>

#include "shading/stack/input_ids.h"

/* An input that a picture holds in a channel: 0 r, 1 g, 2 b, 3 a. */
typedef struct MapUse {
    InputId input;
    int channel;
    bool inverted; /* the picture holds 1 - the input, as one of gloss does */
} MapUse;

/* The direction of green in a picture of normals. */
typedef enum MapGreen { GREEN_UNSAID = 0, GREEN_UP, GREEN_DOWN } MapGreen;

enum { MAP_USES = 4 };

typedef struct MapName {
    MapUse uses[MAP_USES]; /* none for a name without a meaning, and for one that no input takes, as height */
    int count;
    MapGreen green;
    char
        stem[64]; /* the words before the use, in small letters and joined: the name of the set, cut where it is long */
} MapName;

/* Returns what the picture of this name, with its suffix, is for. Case is ignored, and so are sizes, numbers of
 * variants and formats between its words; words are separated by '_', '-', '.', a blank or a capital letter. The use
 * is the last word, or as many of the last words as have one together. */
MapName map_name(const char *file);
