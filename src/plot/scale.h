/* scale.h - the colours of signed differences */
#pragma once

/* Returns the sRGB-encoded colour, 0 .. 1, of t in [-1, 1]: blue below 0, black at 0, red above. */
void scale_color(float t, float rgb[3]);
