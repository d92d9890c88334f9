/* weave_cell.h - one crossing of a woven cloth, by its draft */
#pragma once

#include "shading/dialect/lang.h"

/* A run is the crossings in a row at which a thread stays on top, or below. */
STRUCT(WeaveCell) {
    float warp_since; /* crossings since the run of the warp thread began */
    float warp_run;   /* length of that run, in crossings; negative: the thread is below; 0: the run never ends */
    float weft_since; /* the same of the weft thread */
    float weft_run;
};
