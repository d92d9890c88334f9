/* match.h - weft_match_material that reports progress and can be stopped, for use in watch_loop */
#ifndef WEFT_MEASURE_MATCH_H
#define WEFT_MEASURE_MATCH_H

#include "measure/progress_loop.h"
#include "weft/match.h"

/* Works as weft_match_material, but reports to item_progress (may be NULL) and ends early if that asks for it:
 * WEFT_INTERRUPTED. */
WeftResult match_material(const WeftReflection *from, WeftBrdfMetric metric, const int *held,
                          ItemProgress *item_progress, WeftMaterial *material, WeftMatch *out,
                          WeftError *error);

#endif
