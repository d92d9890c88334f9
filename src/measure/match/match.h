/* match.h - a variant of weft_match_material for the items of a watch_loop, which reports progress and can be
 * stopped */
#pragma once

#include "measure/bsdf/progress_loop.h"
#include "weft/match.h"

/* Works as weft_match_material, but reports to item_progress (may be NULL) and returns WEFT_INTERRUPTED if the loop was
 * stopped. locked (may be NULL): one flag for each input; not 0 for an input that keeps its value. */
WeftResult match_material(const WeftReflection *from, WeftBrdfMetric metric, const int *locked,
                          ItemProgress *item_progress, WeftMaterial *material, WeftMatch *out, WeftError *error);
