/* v_neumann - the least that keeps a metal bright at grazing without a pole there
 *
 *   V = 1 / (4 max(cos_o, cos_i)),   that is G = min(cos_o, cos_i)
 *
 *   Laszlo Neumann, Attila Neumann, Laszlo Szirmay-Kalos, "Compact Metallic Reflectance Models", Eurographics
 * 1999; as Brian Karis lists it, "Specular BRDF Reference", 2013.
 *   The floor 1e-12 is reached only below any cosine that counts, and keeps V finite at the horizon. */
#pragma once

#include "shading/dialect/lang.h"

FN float neumann_v(float o, float i) { return 0.25f / max(max(o, i), 1e-12f); }
