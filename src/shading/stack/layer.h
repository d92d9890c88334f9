/* layer.h - the rules by which a sheen sits on a base, and what the base loses */
#pragma once

#include "shading/layers/additive.h"
#include "shading/layers/albedo_half.h"
#include "shading/layers/albedo_max.h"
#include "shading/layers/albedo_min.h"
#include "shading/layers/albedo_view.h"
#include "shading/layers/multiplicative.h"
#include "shading/layers/reciprocal.h"
#include "shading/layers/seed.h"
#include "shading/layers/side_by_side.h"
#include "shading/layers/stochastic.h"

#define LAYER_ADDITIVE       0
#define LAYER_MULTIPLICATIVE 1
#define LAYER_SEED           2
#define LAYER_SIDE_BY_SIDE   3
#define LAYER_ALBEDO_VIEW    4
#define LAYER_ALBEDO_MIN     5
#define LAYER_ALBEDO_MAX     6
#define LAYER_RECIPROCAL     7
#define LAYER_STOCHASTIC     8
#define LAYER_ALBEDO_HALF    9
#define LAYER_COUNT          10

/* Which colour of the sheen a rule takes. */
#define LAYER_BY_MAX     0
#define LAYER_BY_CHANNEL 1

/* L(id, index, factor on the base, needs_wi, needs_average, conserves, by, help). c: the sheen's colour. e_o, e_i, e_avg:
 * its white albedo towards wo, towards wi (of rule albedo-half towards h), and on average. needs_wi, needs_average: the
 * factor reads e_i, e_avg.
 * conserves: with a sheen of E <= 1 the stack reflects no more light than it receives. by: the colour that the rule takes
 * where none is chosen. A rule that adds light adds it in the sheen's colour. */
#define WEFT_LAYERS(L)                                                                                                 \
    L("additive", LAYER_ADDITIVE, additive_base(c, e_o, e_i, e_avg), false, false, false, LAYER_BY_MAX,                \
      "the base loses nothing; gains energy")                                                                          \
    L("multiplicative", LAYER_MULTIPLICATIVE, multiplicative_base(c, e_o, e_i, e_avg), false, false, false,            \
      LAYER_BY_CHANNEL, "no sheen of its own: the base times 1 + c E(wo), c its colour; gains energy")                 \
    L("seed", LAYER_SEED, seed_base(c, e_o, e_i, e_avg), false, false, false, LAYER_BY_MAX,                            \
      "(1 - F)(1 - k) diffuse + specular + (1 - F) k sheen, k the amount of sheen")                                    \
    L("side-by-side", LAYER_SIDE_BY_SIDE, side_by_side_base(c, e_o, e_i, e_avg), false, false, true, LAYER_BY_MAX,     \
      "as seed, k the sheen's colour and F the most that conserves energy")                                            \
    L("albedo-view", LAYER_ALBEDO_VIEW, albedo_view_base(c, e_o, e_i, e_avg), false, false, true, LAYER_BY_MAX,        \
      "the base keeps 1 - c E(wo); exact energy, not reciprocal")                                                      \
    L("albedo-min", LAYER_ALBEDO_MIN, albedo_min_base(c, e_o, e_i, e_avg), true, false, false, LAYER_BY_MAX,           \
      "the base keeps 1 - c min(E(wo), E(wi)); gains energy")                                                          \
    L("albedo-max", LAYER_ALBEDO_MAX, albedo_max_base(c, e_o, e_i, e_avg), true, false, true, LAYER_BY_MAX,            \
      "the base keeps 1 - c max(E(wo), E(wi)); glTF's rule, loses energy")                                             \
    L("reciprocal", LAYER_RECIPROCAL, reciprocal_base(c, e_o, e_i, e_avg), true, true, true, LAYER_BY_MAX,             \
      "the base keeps (1 - c E(wo))(1 - c E(wi)) / (1 - c E_avg)")                                                     \
    L("stochastic", LAYER_STOCHASTIC, stochastic_base(c, e_o, e_i, e_avg), true, true, true, LAYER_BY_MAX,             \
      "light bounces between sheen and base; the path tracer's reference")                                             \
    L("albedo-half", LAYER_ALBEDO_HALF, albedo_half_base(c, e_o, e_i, e_avg), true, false, false, LAYER_BY_MAX,        \
      "the base keeps 1 - c E(h), h the half vector; gains energy")

/* Returns the factor that the layer rule leaves for the base at wo and wi. */
#define LAYER_CASE(id, index, base, needs_wi, needs_average, conserves, by, help)                                      \
    if (layer == index) return base;
FN float layer_base(int layer, float c, float e_o, float e_i, float e_avg) {
    WEFT_LAYERS(LAYER_CASE)
    return 1.0f;
}

#define LAYER_NEEDS_WI(id, index, base, needs_wi, needs_average, conserves, by, help) || (layer == index && needs_wi)
FN bool layer_needs_wi(int layer) { return false WEFT_LAYERS(LAYER_NEEDS_WI); }
#define LAYER_NEEDS_AVERAGE(id, index, base, needs_wi, needs_average, conserves, by, help)                             \
    || (layer == index && needs_average)
FN bool layer_needs_average(int layer) { return false WEFT_LAYERS(LAYER_NEEDS_AVERAGE); }

/* Returns which colour of the sheen the rule takes where none is chosen. */
#define LAYER_COMBINE(id, index, base, needs_wi, needs_average, conserves, by, help)                                   \
    if (layer == index) return by;
FN int layer_combine(int layer) {
    WEFT_LAYERS(LAYER_COMBINE)
    return LAYER_BY_MAX;
}
