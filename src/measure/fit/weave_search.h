/* weave_search.h - the two systems of threads of a woven cloth, seen from afar, that come closest to samples
 *
 *   f = warp(alpha, crimp, twist, roundness, floats, cross_crimp; share) + weft(...; 1 - share)
 *
 * Both are lobe woven, the warp along the bitangent and the weft along the tangent, as in materials. The six
 * parameters of each, the share, and two colours of each, of which f is a sum, are free. */
#pragma once

#include "measure/fit/lobe_search.h"

/* Returns true if the samples lie in planes of more than one azimuth, without which warp and weft cannot be
 * told apart. */
bool weave_search_sees(const Samples *samples);

/* Sets out->lobe to the warp and out->base to the weft; the starts of the search are its own. Fails with
 * WEFT_RESOURCES if memory is short, WEFT_INTERRUPTED if item_progress stops it. */
WeftResult weave_search_run(const Samples *samples, ItemProgress *item_progress, LobeFound *out);
