/* weave_cell.h - one crossing of a woven cloth, by its draft */
#ifndef WEFT_SHADING_WEAVE_CELL_H
#define WEFT_SHADING_WEAVE_CELL_H

#include "shading/dialect/lang.h"

/* Counts the crossings since the runs of the warp and of the weft there began, and those of the runs, negative where they
 * lie below; a run that never ends has length 0. */
STRUCT(WeaveCell) { float warp_since, warp_run, weft_since, weft_run; };

#endif
