/* spectrum.h - conversion of spectral reflectances to linear Rec. 709 colours
 *
 *   r = sum over k of weight[k] value[k],   weight[k] ~ step_k r(wavelength_k), sum 1; g and b likewise
 *
 * r, g, b are the colour-matching functions of the 1931 observer in the primaries of Rec. 709, in the form of
 * Chris Wyman, Peter-Pike Sloan, Peter Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching
 * Functions", Journal of Computer Graphics Techniques 2(2), 2013, table 1. The illuminant is uniform over
 * wavelengths, so a uniform reflectance is grey. */
#pragma once

#include <stdbool.h>

/* Fills weights[channel * count + k] for count ascending wavelengths, nm. Returns false if these do not cover the range
 * of a channel. */
bool spectrum_weights(const float *wavelength, int count, double *weights);
