/* film.h - sums over the samples of every pixel, and the images made of them
 *
 * With two halves, the samples of one are independent of the other's, so that their difference estimates the error. If
 * A is the mean of n samples of one half and B that of m samples of the other, the variance of the mean of all has the
 * unbiased estimate
 *
 *   (A - B)^2 n m / (n + m)^2 */
#pragma once

#include "trace/frame/matte.h"
#include "trace/path/catcher.h"
#include "trace/path/first_hit.h"
#include "trace/path/stream.h"

enum { FILM_BOTH = 2 };
enum { FILM_OBJECTS, FILM_MATERIALS, FILM_MATTES };

typedef struct FilmHalf {
    int *samples;   /* of each pixel, by tile of STREAM_TILE pixels a side, row by row */
    float *sums;    /* RGBA by pixel: radiance times coverage, coverage */
    Caught *caught; /* shadow and reflection of the floor by pixel; NULL without a floor */
    float *hits;    /* sums, FIRST_NUMBERS a pixel; NULL if first hits are not recorded */
} FilmHalf;

typedef struct Film {
    int width, height, tiles_across, tile_count;
    int halves; /* 1 or 2 */
    FilmHalf half[2];
    bool hits;                          /* first hits are recorded */
    float *slots;                       /* sums over both halves, RGB of each slot; NULL if not recorded */
    float *places;                      /* sums over both halves, PLACE_NUMBERS a pixel; NULL if not recorded */
    Matte *matte[FILM_MATTES];          /* of both halves, by pixel; NULL if not recorded */
    const uint32_t *names[FILM_MATTES]; /* ids of the meshes' objects and materials; not owned */
} Film;

/* The records of a film beside the picture. */
typedef struct FilmRecords {
    bool halves, hits, places, mattes, slots, floor;
} FilmRecords;

/* Makes an empty film; returns false if memory is short. The film is to be freed either way. */
bool film_create(Film *film, int width, int height, FilmRecords records);
void film_free(Film *film);

/* Adds the samples of a pixel, ids from first_id on, in their order; returns how many were not finite. Those count as
 * black. */
int film_add(Film *film, int half, size_t pixel, const Stream *stream, int first_id, int count);

/* Gives the means of a pixel's samples in one half or FILM_BOTH: radiance times coverage, and coverage; 0 without
 * samples. Returns how many samples there are. */
int film_pixel(const Film *film, int half, int x, int y, float rgba[4]);

/* Gives the means of a pixel's first hits over the samples of one half or FILM_BOTH, so that FIRST_SEEN is the fraction
 * that met a surface; 0 without samples. Returns how many samples there are. */
int film_hits(const Film *film, int half, int x, int y, float numbers[FIRST_NUMBERS]);

/* Gives the channels of ranks 2 * pair and 2 * pair + 1 of a matte: id and coverage of each. */
void film_matte(const Film *film, int matte, int pair, int x, int y, float rgba[4]);

/* Makes the picture, with straight alpha. */
WeftResult film_image(const Film *film, WeftImage *out, WeftError *error);

/* Makes an AOV. Fails with WEFT_MESSAGE_DESC if the film does not record it. */
WeftResult film_aov(const Film *film, WeftAov aov, WeftImage *out, WeftError *error);

/* Returns the relMSE of the picture, estimated from its halves; below 0 without two halves of at least one sample. */
double film_noise(const Film *film);

/* Makes the denoised picture; needs two halves and first hits. */
WeftResult film_denoise(const Film *film, WeftDenoiser denoiser, int threads, WeftImage *out, WeftError *error);
