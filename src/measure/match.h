/* match.h - weft_match_material inside a loop that is watched */
#ifndef WEFT_MEASURE_MATCH_H
#define WEFT_MEASURE_MATCH_H

#include "measure/progress_loop.h"
#include "weft/match.h"

/* The same, which tells item_progress (may be NULL) how far it is, and ends early where that says so:
 * WEFT_INTERRUPTED. */
WeftResult match_material(const WeftReflection *from, WeftBrdfMetric metric, const int *held,
                          ItemProgress *item_progress, WeftMaterial *material, WeftMatch *out,
                          WeftError *error);

#endif
