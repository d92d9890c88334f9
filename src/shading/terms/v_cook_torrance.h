/* v_cook_torrance - shadows between the two walls of long V-shaped grooves, the same for every roughness
 *
 *   V = min(1, 2 cos_h cos_o / d, 2 cos_h cos_i / d) / (4 cos_o cos_i),  d = wi . h
 *     = min(1 / (4 cos_o cos_i), cos_h / (2 d max(cos_o, cos_i)))
 *
 *   Robert L. Cook, Kenneth E. Torrance, "A Reflectance Model for Computer Graphics", ACM Transactions on
 * Graphics 1(1), 1982, after Kenneth E. Torrance, Ephraim M. Sparrow, 1967. The second line is the
 * same without a quotient of small numbers.
 *   The floors 1e-12 are reached where both cosines are below 1e-6; they keep V finite. */
#pragma once

#include "shading/dialect/angles.h"

FN float cook_torrance_v(Angles a) {
    float open = 0.25f / max(a.o.z * a.i.z, 1e-12f);
    return min(open, 0.5f * a.h.z / max(a.d * max(a.o.z, a.i.z), 1e-12f));
}
