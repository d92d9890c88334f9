/* multiplicative - a rim that brightens the base itself: a black base stays black
 *
 *   f = (1 + c E(wo)) base in each channel, and no sheen lobe beside it
 *
 *   The form of the exponential sheen and of the rim lights before it, which scale what is already shaded. No
 * paper states it; c and E are the colour and the albedo of KHR_materials_sheen, Khronos Group, 2020. Each channel takes
 * its own c, so that the rim has the colour of the sheen; with layer_by=max all take that of the strongest.
 *   energy: gains c E(wo) times what the base reflects.
 *   reciprocal: no, the factor depends on wo only. */
#pragma once

#include "shading/dialect/lang.h"

FN float multiplicative_base(float c, float e_o, float e_i, float e_avg) { return max(1.0f + c * e_o, 0.0f); }
