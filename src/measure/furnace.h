/* furnace.h - what a white cloth returns of uniform light: a white lobe as the sheen of a white Lambert base
 */
#ifndef WEFT_MEASURE_FURNACE_H
#define WEFT_MEASURE_FURNACE_H

#include "measure/subject.h"

/* For the lobe with parameter 0 from an artist's roughness, under a layer rule, towards o. e is the table of
 * the lobe at that roughness. */
double furnace_measure(const Lobe *lobe, float roughness, int layer, const AlbedoTable *e, Dir o, int cells);

#endif
