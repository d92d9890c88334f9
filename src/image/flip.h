/* flip.h - the difference that an eye sees when two images alternate */
#pragma once

#include "image/pair.h"

/* Computes the map of FLIP, for pairs in [0, 1]. With `bright` the pair is any radiance, and the map is the largest
 * over a range of exposures, which *out receives. map must contain width * height zeros. Returns false if memory is
 * short. */
bool flip_map(const Pair *pair, float pixels_per_degree, bool bright, WeftDiff *out, float *map);
