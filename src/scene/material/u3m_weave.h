/* u3m_weave.h - the weave of a U3M that has no picture of its cloth */
#pragma once

#include <jansson.h>

#include "scene/material/material_file.h"

/* Weaves the cloth that a file's physics name, a draft by construction and yarns by the fibre with the greatest part, in
 * the base colour of out, and says so. Leaves out as it is for a construction that is no weave. Fails with
 * WEFT_MESSAGE_MEMORY. */
WeftResult u3m_weave(const json_t *physics, const char *name, MaterialFile *out, const WeftLog *log, WeftError *error);

/* Returns the weave that those words mean, as cloth_from_json reads it; NULL if memory is short, or with *draft NULL if the
 * construction is no weave. *draft and *yarn are constants. The caller owns the weave. */
json_t *u3m_words_weave(const json_t *physics, const float color[3], const char **draft, const char **yarn);
