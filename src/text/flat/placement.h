/* placement.h - which nodes a shader needs, where each is computed, and which are variables
 *
 * A node is computed as late as possible, in the innermost region that has all its uses, but never inside a loop that
 * it does not depend on. Cliff Click, "Global Code Motion, Global ShaderValue Numbering", PLDI 1995. */
#pragma once

#include "text/flat/graph.h"

void placement_of(Graph *graph);

/* Returns true if a phi's value after the second branch of its if is set before the if. */
bool placement_before(const GraphNode *phi);
