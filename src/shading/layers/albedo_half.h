/* albedo-half - a sheen that takes from the base what its table has at the half vector
 *
 *   f = sheen + (1 - c E(h)) base,  E(h) at the cosine n . h
 *
 *   Babylon.js, openpbrDirectLighting (packages/dev/core/src/Shaders/ShadersInclude, 9.35.0, 2026), which
 * reads E of its fuzz there. E belongs to wo, so that the rule says nothing of what the sheen reflects.
 *   energy: no. Light at grazing from opposite sides has h at the normal, where E is least: the base loses next to
 * nothing where the sheen is brightest.
 *   reciprocal: yes. */
#pragma once

#include "shading/dialect/lang.h"

/* Returns 1 - c E(h); e_i is E(h) for this rule. */
FN float albedo_half_base(float c, float e_o, float e_i, float e_avg) { return max(1.0f - c * e_i, 0.0f); }
