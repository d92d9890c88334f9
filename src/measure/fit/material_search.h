/* material_search.h - the inputs of a material that come closest to samples */
#pragma once

#include "measure/bsdf/progress_loop.h"
#include "measure/fit/samples.h"

/* Searches as weft_match_material does, starting from `material`. locked (may be NULL): one flag for each
 * input. found->matched is the error of the result. Fails as weft_reflection_create does, or with
 * WEFT_INTERRUPTED if item_progress (may be NULL) stops it. */
WeftResult material_search_run(const Samples *samples, const int *locked, ItemProgress *item_progress,
                               WeftMaterial *material, WeftMatch *found, WeftError *error);
