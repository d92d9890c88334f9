/* survey.h - the fraction of a picture that each material covers */
#pragma once

#include "weft/pick.h"

/* Returns the share of each material in a picture from that camera, of width / height `aspect`; -1 if nothing uses the
 * material. Release with free; NULL where memory is short. */
float *survey_take(const WeftPick *pick, const WeftScene *scene, const char *camera, float aspect);

/* Returns the material with the largest share among those for which `of` is not 0 (NULL: all); -1 if none of them is
 * visible. */
int survey_largest(const float *coverage, int count, const char *of);
