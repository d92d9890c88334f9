/* side-by-side - a share k of the surface is sheen and the rest is not, under one interface that gains
 * nothing
 *
 *   f = specular + (1 - F) ((1 - k) diffuse + k sheen),  k = c
 *
 *   This function returns the factor 1 - k on the diffuse lobe. stack_value.h multiplies the sheen by k and both by
 * 1 - F, the transmittance of the interface: F of the highlight, a metal's too, at the least of
 * wi . h, cos_o and cos_i, so that nothing is gained at grazing. k is the strongest channel of the sheen's
 * colour or, by channel, each. E is not read. Own rule: seed, which has F at wi . h and a number for k, made
 * to conserve energy. The blend is what the OpenPBR Surface specification calls mixing (Academy Software
 * Foundation, 2024): threads side by side, none above another.
 *   energy: E <= 1 where it holds of sheen, diffuse and interface, as a mean of theirs.
 *   reciprocal: yes where F is. */
#pragma once

#include "shading/dialect/lang.h"

FN float side_by_side_base(float c, float e_o, float e_i, float e_avg) { return max(1.0f - c, 0.0f); }
