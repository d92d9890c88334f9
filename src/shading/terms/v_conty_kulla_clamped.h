/* v_conty_kulla_clamped - v_conty_kulla with its rim cut off, as the reference viewer of glTF shows it
 *
 *   V = min(v_conty_kulla, 1)
 *
 *   Khronos Group, glTF-Sample-Viewer, 2020 on: the sheen visibility of its shader is clamped to [0, 1],
 * which the text of KHR_materials_sheen does not require. */
#pragma once

#include "shading/terms/v_conty_kulla.h"

FN float conty_kulla_clamped_v(float alpha, float o, float i) { return min(conty_kulla_v(alpha, o, i), 1.0f); }
