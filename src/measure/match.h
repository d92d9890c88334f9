/* match.h - weft_match_material inside a loop that is watched */
#ifndef WEFT_MEASURE_MATCH_H
#define WEFT_MEASURE_MATCH_H

#include "measure/watch.h"
#include "weft/match.h"

/* The same, which tells share (may be NULL) how far it is, and ends early where that says so:
 * WEFT_INTERRUPTED. */
WeftResult match_material(const WeftReflection *from, WeftApart metric, const int *held, Share *share,
                          WeftMaterial *material, WeftMatch *out, WeftError *error);

#endif
