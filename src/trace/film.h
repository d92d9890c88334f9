/* film.h - sums over the samples of every pixel, and what is made of them
 *
 * With two halves, each has samples of its own, independent of the other's, so that their difference shows
 * the error. The mean of n samples of one half and m of the other has the variance that
 *
 *   (A - B)^2 n m / (n + m)^2
 *
 * has as its mean, with A and B the means of the halves. */
#ifndef WEFT_TRACE_FILM_H
#define WEFT_TRACE_FILM_H

#include "trace/catcher.h"
#include "trace/first_hit.h"
#include "trace/stream.h"

enum { FILM_BOTH = 2 };

typedef struct FilmHalf {
    int *samples;   /* of every pixel of a tile; one a tile of STREAM_TILE pixels a side, row by row */
    float *sums;    /* RGBA a pixel: radiance times coverage, coverage */
    Caught *caught; /* one a pixel, by the floor; NULL where there is none */
} FilmHalf;

typedef struct Film {
    int width, height, tiles_across, tile_count;
    int halves; /* 1 or 2 */
    FilmHalf half[2];
    float *hits; /* FIRST_NUMBERS a pixel, of both halves; NULL where they are not asked for */
} Film;

/* An empty film; false where memory is short, and it is then to be freed all the same. */
bool film_create(Film *film, int width, int height, bool halves, bool hits, bool floor);
void film_free(Film *film);

/* Adds the samples of a pixel in their order; returns how many were not finite, which are black. */
int film_add(Film *film, int half, size_t pixel, const Stream *stream, int first_id, int count);

/* Means of a pixel's samples, of one half or FILM_BOTH: radiance times coverage, and coverage; returns how
 * many samples there are, and zeros where there is none. */
int film_pixel(const Film *film, int half, int x, int y, float rgba[4]);

/* Means of a pixel's first hits, over all samples, so that SEEN is the share that met a surface. */
void film_hits(const Film *film, int x, int y, float numbers[FIRST_NUMBERS]);

/* The picture: straight alpha. */
WeftResult film_image(const Film *film, WeftImage *out, WeftError *error);

/* One of the others. Fails with WEFT_MESSAGE_DESC where the film does not have it. */
WeftResult film_aov(const Film *film, WeftAov aov, WeftImage *out, WeftError *error);

/* The relMSE of the picture as the halves show it; below 0: not known. */
double film_noise(const Film *film);

/* The picture without most of its noise. */
WeftResult film_denoise(const Film *film, WeftDenoiser denoiser, int threads, WeftImage *out,
                        WeftError *error);

#endif
