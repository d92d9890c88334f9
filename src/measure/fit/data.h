/* data.h - measured reflectance (weft/fit.h) as the goal of a fit */
#pragma once

#include "measure/fit/samples.h"
#include "weft/fit.h"

/* Returns true if f does not change when both directions rotate about the normal. */
bool data_isotropic(const WeftData *data);

/* Makes finished samples of the data, each of weight 1. Returns false if memory is short; release with
 * samples_free in any case. */
bool data_samples(const WeftData *data, WeftBrdfMetric metric, Samples *out);
