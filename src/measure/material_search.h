/* material_search.h - the inputs of a material that come closest to samples */
#ifndef WEFT_MEASURE_MATERIAL_SEARCH_H
#define WEFT_MEASURE_MATERIAL_SEARCH_H

#include "measure/samples.h"

/* As weft_match_material, from where material is; error is that of what it leaves in material. False where
 * memory is short. */
bool material_search_run(const Samples *samples, const int *held, WeftMaterial *material, double *error,
                         long long *evaluations);

#endif
