/* survey.h - the coverage of a picture by each material */
#ifndef WEFT_VIEW_SURVEY_H
#define WEFT_VIEW_SURVEY_H

#include "weft/pick.h"

/* Shares of a picture from that camera, of width / height `aspect`, one a material: -1 where nothing wears
 * it. Release with free; NULL where memory is short. */
float *survey_take(const WeftPick *pick, const WeftScene *scene, const char *camera, float aspect);

/* Returns the material with the largest share among those for which `of` is not 0 (NULL: all); -1 if none of them is
 * visible. */
int survey_largest(const float *coverage, int count, const char *of);

#endif
