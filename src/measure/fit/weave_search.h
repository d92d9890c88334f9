/* weave_search.h - the two systems of threads of a woven cloth that come closest to samples, from afar
 *
 *   f = warp(alpha, crimp, twist, roundness, floats, cross_crimp; share) + weft(...; 1 - share)
 *
 * Both are lobe woven, the warp along the bitangent and the weft along the tangent, as materials have them. Free are the
 * six numbers of each, the share, and two colours of each, of which f is a sum. */
#ifndef WEFT_MEASURE_WEAVE_SEARCH_H
#define WEFT_MEASURE_WEAVE_SEARCH_H

#include "measure/fit/lobe_search.h"

/* Returns true if the samples lie in planes of more than one azimuth: else they do not tell warp from weft. */
bool weave_search_sees(const Samples *samples);

/* Sets out->lobe to the warp and out->base to the weft. The search has starts of its own. WEFT_RESOURCES where memory is
 * short, WEFT_INTERRUPTED where the progress says that it should end. */
WeftResult weave_search_run(const Samples *samples, ItemProgress *item_progress, LobeFound *out);

#endif
