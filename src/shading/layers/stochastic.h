/* stochastic - the reference: light that passes the sheen, meets the base, and may bounce between both
 *
 *   f = sheen + (1 - c E(wo)) (1 - c E(wi)) base + more bounces
 *
 *   This function returns the first pass alone: in through the sheen, one reflection by the base, and out. The path
 * tracer adds the bounces, which over a Lambert base of colour rho sum up to 1 / (1 - rho c Eavg): at rho 1 that is
 * the rule reciprocal. Bounces of that kind by random walk: Yu Guo, Milos Hasan, Shuang Zhao,
 * "Position-Free Monte Carlo Simulation for Arbitrary Layered BSDFs", SIGGRAPH Asia 2018.
 *   energy: loses, without the bounces, what the sheen reflects back to the base; with them E <= 1 where the
 * sheen's own E is.
 *   reciprocal: yes. */
#pragma once

#include "shading/dialect/lang.h"

FN float stochastic_base(float c, float e_o, float e_i, float e_avg) {
    return max(1.0f - c * e_o, 0.0f) * max(1.0f - c * e_i, 0.0f);
}
