/* plot_numbers.h - the numbers of a figure on standard output */
#ifndef WEFT_CLI_PLOT_NUMBERS_H
#define WEFT_CLI_PLOT_NUMBERS_H

#include "weft/weft.h"

/* One JSON object with everything that is drawn. */
void plot_json(const WeftPlotData *data, WeftPlotKind kind);

/* A line a value, with a heading: panel,series,x,y of curves, panel,channel,x,y,value of grids. */
void plot_csv(const WeftPlotData *data);

#endif
