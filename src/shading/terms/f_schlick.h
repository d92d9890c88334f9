/* f_schlick - reflectance towards grazing
 *
 *   F = F0 (1 - s) + f90 s,   s = (1 - d)^5,  d = wi . h
 *
 *   Christophe Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", Eurographics 1994,
 * Equation 15. f90 other than 1: Sebastien Lagarde, Charles de Rousiers, "Moving Frostbite to PBR", SIGGRAPH
 * 2014 course. */
#pragma once

#include "shading/dialect/lang.h"

/* Returns s, the scalar part; colours are applied outside. */
FN float schlick_s(float d) {
    float m = clamp(1.0f - d, 0.0f, 1.0f), m2 = m * m;
    return m2 * m2 * m;
}
