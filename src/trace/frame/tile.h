/* tile.h - one tile of a picture: its camera rays, the floor and the background that they meet, and their paths */
#pragma once

#include "trace/frame/film.h"
#include "trace/path/lens.h"

/* A picture that is rendered tile by tile. */
typedef struct TracedPicture {
    WeftRenderDesc desc; /* defaults are filled in */
    PathContext context;
    Lens lens;
    Floor floor;
    WeftImage blurred; /* of backdrop.h, where it is the background */
    Film film;         /* of the crop; tile_count 0: there is nothing to render */
} TracedPicture;

/* Adds so many samples of a half, <= STREAM_SAMPLES, to each pixel of a tile; returns how many were not finite.
 * stream->rays becomes the number of rays that this took. One thread at a time may render a tile. */
int tile_render(TracedPicture *picture, Stream *stream, int tile, int half, int samples);
