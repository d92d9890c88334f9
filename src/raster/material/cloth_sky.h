/* cloth_sky.h - the light of a sky that a woven cloth reflects: what each system reflects of an even one, and from where */
#pragma once

#include "shading/ambient/ambient_fit.h"
#include "weave/weft_cloth.h"

/* E, the part of an even sky's light that comes back, depends on the azimuth of wo in the frame of the cloth. Turned by
 * 180 degrees a cloth looks the same, so E is a sum of waves: 1, the cosine and the sine of twice the azimuth, the cosine
 * and the sine of four times it. Each wave has a polynomial in t = 2 y - 1, with cos_o = (1 - (1 - y)^2)^2 as in
 * ambient_table.h. */
enum { CLOTH_SKY_WAVES = 5, CLOTH_SKY_TERMS = 8, CLOTH_SKY = CLOTH_SKY_WAVES * CLOTH_SKY_TERMS };

/* Sets `albedo` to the coefficients, those of a wave one after the other, of E of four kinds of light: a of the warp's
 * that met one fibre, b of its other light, c and d of the weft's. They are for white threads that cover all: the colours
 * from afar (ClothFar) contain what a system covers. Fills the table of the cloth, whose E is 1: it has the division
 * among the look-ups alone. Returns false if memory is short. */
bool cloth_sky_fit(const WeftCloth *cloth, int threads, AmbientFit *fit, AmbientWeights albedo[CLOTH_SKY]);
