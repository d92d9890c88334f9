/* scale.h - the colours of signed differences */
#ifndef WEFT_PLOT_SCALE_H
#define WEFT_PLOT_SCALE_H

/* The sRGB-encoded colour, 0 .. 1, of t in [-1, 1]: darker is blue, brighter is red, none is black. */
void scale_color(float t, float rgb[3]);

#endif
