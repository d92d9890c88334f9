/* axes.h - scales of axes, and their tick values */
#pragma once

#include "plot/page.h"

/* A map from values low .. high to pixels from .. to. */
typedef struct Scale {
    double low, high, from, to;
    bool logarithmic;
} Scale;

Scale scale_of(const WeftPlotAxis *axis, double from, double to);
double scale_place(const Scale *scale, double value);

typedef struct Tick {
    double value;
    char text[24]; /* "" for a minor tick */
} Tick;

enum { TICKS_MAX = 96 };

/* Makes ticks at round values in the scale's range, at least `spacing` pixels from each other: for degrees divisors of
 * a right angle, for logarithmic scales decades, with minor ticks at 2 .. 9 if every decade has a label. Returns their
 * number. */
int ticks_make(const Scale *scale, bool degrees, double spacing, Tick ticks[TICKS_MAX]);

/* Writes a value in short form with so many digits: "0.25", "1.3e5"; the minus is U+2212. */
void value_text(double value, int digits, char text[24]);

/* Writes "label [unit]". */
void axis_text(const WeftPlotAxis *axis, char text[96]);

bool axis_in_degrees(const WeftPlotAxis *axis);

/* Draws frame, ticks, labels and grid lines, and returns the part of the box inside the frame. */
PageBox axes_draw(const Page *page, const WeftPlotPanel *panel, PageBox box);
