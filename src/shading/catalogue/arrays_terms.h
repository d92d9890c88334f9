/* arrays_terms.h - the loops of the composed lobe, in two files */
#ifndef WEFT_SHADING_ARRAYS_TERMS_H
#define WEFT_SHADING_ARRAYS_TERMS_H

#include "shading/catalogue/registry.h"
#include "shading/lobe/each_loop.h"

extern const LobeLoops cook_torrance_loops;
extern const EachLoops cook_torrance_each_loops;

#endif
