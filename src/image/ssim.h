/* ssim.h - the structural similarity of two images */
#pragma once

#include "image/pair.h"

/* The pixels at each edge of the picture whose windows reach beyond it. */
enum { SSIM_RADIUS = 5 };

/* Computes the map of SSIM, for pairs in [0, 1]. Returns false if memory is short. */
bool ssim_map(const Pair *pair, float *map);
