/* v_neubelt_clamped - v_neubelt with its rim cut off, as three.js shows it
 *
 *   V = min(v_neubelt, 1)
 *
 *   V_Neubelt of mrdoob/three.js,
 * src/renderers/shaders/ShaderChunk/lights_physical_pars_fragment.glsl.js.
 *   Without the limit: David Neubelt, Matt Pettineo, SIGGRAPH 2013 course. */
#pragma once

#include "shading/terms/v_neubelt.h"

FN float neubelt_clamped_v(float o, float i) { return min(neubelt_v(o, i), 1.0f); }
