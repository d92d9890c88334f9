/* thumbs.h - pictures of materials, path traced in a thread of a lower priority and kept in the user's cache
 *
 * Each is builtin:swatch with the material on its cloth. The name of a file in the cache is a hash of the material's
 * text and weft's version. Only pictures that were requested are made, in the order of their numbers. */
#pragma once

#include "view/ui/window.h"

enum { THUMB_SIDE = 176, THUMB_SAMPLES = 48 };

typedef struct Thumbs Thumbs;

/* A picture, or the reason why there is none. */
typedef struct Thumb {
    int index;
    WeftImage image; /* U8 RGB or RGBA, THUMB_SIDE a side; owned */
    char failure[512];
} Thumb;

/* Starts the thread, which wakes the window (may be NULL) for each picture. paths, which are copied, are material files
 * or "preset:NAME". Returns NULL where memory is short. */
Thumbs *thumbs_start(Window *window, const char *const *paths, int count);

/* Requests a picture; a second request for it changes nothing. */
void thumbs_want(Thumbs *thumbs, int index);

/* Forgets the requests on which no work has begun. */
void thumbs_forget(Thumbs *thumbs);

/* Takes a finished picture; returns false if there is none. */
bool thumbs_take(Thumbs *thumbs, Thumb *out);

/* Returns true if a requested picture was not taken yet. */
bool thumbs_busy(Thumbs *thumbs);

/* Gives up what is not done. */
void thumbs_stop(Thumbs *thumbs);
