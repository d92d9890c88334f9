/* v_smith_ggx_aniso_separate - shadowing and masking of brushed GGX as if the two were independent
 *
 *   V = 1 / ((cos_o + |A wo|) (cos_i + |A wi|)),   A = diag(ax, ay, 1)
 *
 *   v_smith_ggx with the two widths of d_ggx_aniso: Brent Burley, "Physically Based Shading at Disney",
 * SIGGRAPH 2012 course, appendix B.2; smithG_GGX_aniso of wdas/brdf, src/brdfs/disney.brdf. */
#pragma once

#include "shading/terms/d_ggx.h"

FN float smith_ggx_aniso_separate_v(float ax, float ay, Dir o, Dir i) {
    return 1.0f / ((o.z + ggx_length(ax, ay, o)) * (i.z + ggx_length(ax, ay, i)));
}
