/* swatches.h - swatches of reference materials, beside the inputs that they are for */
#ifndef WEFT_VIEW_SWATCHES_H
#define WEFT_VIEW_SWATCHES_H

#include "weft/material.h"

/* Below an input that has a base colour or an F0, as the workflow reads it: a click on a swatch makes the
 * material's what the chart says. */
void chart_swatches(WeftMaterial *material, const char *input);

#endif
