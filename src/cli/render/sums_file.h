/* sums_file.h - the sums of a render as layers of an .exr, from which another process goes on
 *
 * Three channels have the head of a tile at each of its pixels, weft/render.h, and one channel each sum of a pixel. */
#pragma once

#include "cli/render/job.h"

enum { SUMS_LAYERS = 1 + (WEFT_RENDER_NUMBERS + 3) / 4, SUMS_NAME = 16 };

/* The sums of a render as layers of a file. All zero: none. */
typedef struct TileSums {
    int count;
    WeftImage images[SUMS_LAYERS]; /* owned */
    char names[SUMS_LAYERS][4][SUMS_NAME];
} TileSums;

/* Makes the layers of a render whose picture is width x height pixels. Release with sums_free. */
WeftResult sums_make(const WeftRender *render, int width, int height, TileSums *sums, WeftError *error);
void sums_free(TileSums *sums);

/* Lists them as an .exr has them; returns their number. */
int sums_layers(const TileSums *sums, WeftImageLayer layers[SUMS_LAYERS]);

/* Adds to a render the tiles of a file that have more samples than it has. wanted: a byte for each tile, 0 if it is left
 * as it is; NULL: all. `block`: a tile must have a multiple of so many samples; 0: any number. Fails with one line that
 * names the file where it has no such sums, or a size other than width x height. */
WeftResult sums_read(const char *path, int width, int height, const unsigned char *wanted, int block,
                     WeftRender *render, WeftError *error);
