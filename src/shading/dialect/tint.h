/* tint.h - colour that is not a factor: multiple scattering by coloured flakes
 *
 *   f(w) = f(1) c(w),  c(w) = (1 - s) w + s w^2 min(r_o r_i exp((1 - w) e), 1),  r = (1 - q) / (1 - w q)
 *
 * w is the albedo of a flake in one channel. Of the light that white flakes scatter between a pair of directions,
 * the share s met more than one. q is the probability that light of that direction which met two flakes meets one
 * more: so r is the sum over (w q)^n divided by that over q^n. e corrects the rest; whatever it is, light that met
 * two flakes or more has at most the factor w^2. So c(w) <= w, c(1) = 1, c(0) = 0.
 *
 *   Own fit to the solved slab of fibres. Each direction has its own factor and w is in no coefficient, so f
 * is as reciprocal as f(1) where e is the same in both directions. Departures: w is clamped to [0, 1], q is at most
 * 0.999. */
#pragma once

#include "shading/dialect/lang.h"

STRUCT(Tint) {
    float s;        /* [0, 1] */
    float q_o, q_i; /* of wo and wi, [0, 1) */
    float e;
};

/* Tests whether colour is more than a factor. A shader without a lobe of TRAIT_TINTED defines this as
 * false. */
#ifndef IS_TINTED
#define IS_TINTED(t) ((t).s > 0.0f)
#endif

/* Returns the tint of light that meets one flake: colour is a factor. */
FN Tint tint_none(void) {
    Tint t;
    t.s = 0.0f;
    t.q_o = 0.0f;
    t.q_i = 0.0f;
    t.e = 0.0f;
    return t;
}

/* Returns r. The form 1 - w q = (1 - q) + (1 - w) q is not rounded to 0: white stays white in 16 bits too. */
FN float tint_by_order(float q, float w) {
    float rest = max(1.0f - q, 1e-3f);
    return rest / (rest + (1.0f - w) * q);
}

FN float tint_color(Tint t, float w) {
    float a = clamp(w, 0.0f, 1.0f);
    float r = tint_by_order(t.q_o, a) * tint_by_order(t.q_i, a);
    float more = a * a * min(r * exp((1.0f - a) * t.e), 1.0f);
    return (1.0f - t.s) * a + t.s * more;
}
