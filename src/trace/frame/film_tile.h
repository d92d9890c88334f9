/* film_tile.h - the sums of one tile as numbers, from which another process goes on
 *
 * First FILM_TILE_HEAD numbers: the samples of each half, and how many samples were not finite. Then, for each of the
 * STREAM_TILE * STREAM_TILE pixels row by row, film_pixel_numbers(film) sums; those of pixels beyond the picture are 0. */
#pragma once

#include "trace/frame/film.h"

enum { FILM_TILE_HEAD = 3 };

/* Returns how many sums a pixel has, by what the film records. */
int film_pixel_numbers(const Film *film);

/* Copies a tile's sums to `to`, and its number of samples that were not finite. */
void film_tile_get(const Film *film, int tile, long long non_finite, float *to);

/* Replaces a tile's sums. Returns false, and changes nothing, if a number is not finite, or no number of samples. */
bool film_tile_set(Film *film, int tile, const float *from, long long *non_finite);
