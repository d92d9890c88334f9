/* arrays_terms.h - the loops of the composed lobe, in two files */
#pragma once

#include "shading/catalogue/registry.h"
#include "shading/lobe/each_loop.h"

extern const LobeLoops cook_torrance_loops;
extern const EachLoops cook_torrance_each_loops;
