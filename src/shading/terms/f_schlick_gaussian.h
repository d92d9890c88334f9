/* f_schlick_gaussian - reflectance towards grazing, by an exponential in place of the fifth power
 *
 *   F = F0 (1 - s) + f90 s,  s = 2^((-5.55473 d - 6.98316) d),  d = wi . h
 *
 *   Sebastien Lagarde, "Spherical Gaussian approximation for Blinn-Phong, Phong and Fresnel", 2012; Brian
 * Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013 course, page 3. */
#pragma once

#include "shading/dialect/lang.h"

FN float schlick_gaussian_s(float d) { return exp2((-5.55473f * d - 6.98316f) * d); }
