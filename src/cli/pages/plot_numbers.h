/* plot_numbers.h - the numbers of a figure on standard output */
#pragma once

#include "weft/weft.h"

/* Prints one JSON object with everything that is drawn. */
void plot_json(const WeftPlotData *data, WeftPlotKind kind);

/* Prints a heading and a line for each value: panel,series,x,y of curves; where there are none, panel,channel,x,y,value of
 * grids. */
void plot_csv(const WeftPlotData *data);
