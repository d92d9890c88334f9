/* axes.h - scales of axes, and their tick values */
#ifndef WEFT_PLOT_AXES_H
#define WEFT_PLOT_AXES_H

#include "plot/page.h"

/* Values low .. high lie at from .. to, pixels. */
typedef struct Scale {
    double low, high, from, to;
    bool logarithmic;
} Scale;

Scale scale_of(const WeftPlotAxis *axis, double from, double to);
double scale_place(const Scale *scale, double value);

typedef struct Tick {
    double value;
    char text[24]; /* "" of minor ones */
} Tick;

enum { TICKS_MAX = 96 };

/* Round values in the scale's range, at least `spacing` pixels from each other: of degrees what divides a right
 * angle, of logarithmic scales decades, with 2 .. 9 between them as minor ones where there is room. Returns
 * how many. */
int ticks_make(const Scale *scale, bool degrees, double spacing, Tick ticks[TICKS_MAX]);

/* A value in so many digits, short: "0.25", "1.3e5"; minus is U+2212. */
void value_text(double value, int digits, char text[24]);

/* "label [unit]". */
void axis_text(const WeftPlotAxis *axis, char text[96]);

bool axis_in_degrees(const WeftPlotAxis *axis);

/* Draws frame, ticks, labels and grid lines, and returns the rest of the box for the values. */
PageBox axes_draw(const Page *page, const WeftPlotPanel *panel, PageBox box);

#endif
