/* data.h - measured reflectance (weft/fit.h) as what something is to come close to */
#ifndef WEFT_MEASURE_DATA_H
#define WEFT_MEASURE_DATA_H

#include "measure/fit/samples.h"
#include "weft/fit.h"

/* Returns true if f stays the same however both directions turn about the normal. */
bool data_isotropic(const WeftData *data);

/* Its samples, each of which counts alike, settled. False where memory is short; release with samples_free in
 * any case. */
bool data_samples(const WeftData *data, WeftBrdfMetric metric, Samples *out);

#endif
