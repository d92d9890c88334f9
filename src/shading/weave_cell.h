/* weave_cell.h - what a woven cloth's draft says of one crossing */
#ifndef WEFT_SHADING_WEAVE_CELL_H
#define WEFT_SHADING_WEAVE_CELL_H

#include "shading/lang.h"

/* Of the warp and of the weft there: the crossings since their runs began, and their lengths, negative where they lie
 * below; a run that never ends has length 0. */
STRUCT(WeaveCell) { float warp_since, warp_run, weft_since, weft_run; };

#endif
