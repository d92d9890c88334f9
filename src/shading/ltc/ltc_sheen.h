/* ltc_sheen.h - a sheen that is one linearly transformed cosine D times its albedo R:  f = R D / cos_i */
#pragma once

#include "shading/lobe/lobe.h"
#include "shading/ltc/ltc.h"

FN LobeValue ltc_sheen_value(Ltc m, float reflected, Angles a) {
    Dir v = ltc_inverse(m, a.o, a.i);
    float r2 = max(dir_dot(v, v), 1e-18f); /* keeps its square a normal number */
    return lobe_value_of(reflected * m.z * m.det / (PI * r2 * r2), 0.0f, ltc_pdf(m, a.o, a.i));
}
