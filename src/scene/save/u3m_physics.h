/* u3m_physics.h - the physics of a U3M that follow from a draft and its yarns */
#pragma once

#include <jansson.h>

#include "weft/weave.h"

/* Returns the member "physics": construction, and composition by the yarns' names (NULL: not known) and how many threads
 * there are of each. Thickness and weight are not known. NULL if memory is short. */
json_t *u3m_physics(const WeftDraft *draft, const char *const yarns[2]);
