/* swatches.h - swatches of reference materials below an input */
#pragma once

#include "weft/material.h"

/* Draws swatches below an input that is a base colour or an F0 in the workflow; a click sets the material's value from
 * the chart. */
void chart_swatches(WeftMaterial *material, const char *input);
