/* disney-2012 - the principled BRDF as its authors' viewer has it: workflow disney with their luminance
 *
 *   As workflows/disney.h, but tint is base_color over 0.3 r + 0.6 g + 0.1 b.
 *
 *   wdas/brdf, src/brdfs/disney.brdf (0202adc). Its V does not widen the roughness to (0.5 + roughness /
 * 2)^2, which the course notes of 2012 do and their later addenda take back. Nothing dims the diffuse lobe;
 * the sheen has neither a roughness nor 1/pi.
 *   Inputs: sheen_color is not looked at: sheen and sheen_tint replace it. Where they are not given, specular is
 * 0.5 and sheen 0. Colours are linear, not gamma 2.2. The coat may have a normal of its own. */
#pragma once

#include "shading/workflows/disney.h"

FN Rgb disney_2012_tint(Rgb base) {
    float y = 0.3f * base.r + 0.6f * base.g + 0.1f * base.b;
    if (y > 0.0f) return rgb_scale(base, 1.0f / y);
    return rgb_grey(1.0f);
}

FN void disney_2012_stack(Stack *m, const Surface *s) { disney_tinted(m, s, disney_2012_tint(s->base_color)); }
