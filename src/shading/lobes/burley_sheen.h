/* burley-sheen - a faint brightening at the rim, strongest against the light, of the width it always has
 *
 *   f = color (1 - wi . h)^5                                                                    [1/sr]
 *
 *   Brent Burley, "Physically Based Shading at Disney", SIGGRAPH 2012 course, section 5 (sheen). In its
 *     text, disney.brdf of the BRDF Explorer, Fsheen = FH sheen Csheen is added to (1/pi) diffuse baseColor
 *     and is not itself divided by pi; nor is it here. There it is also scaled by 1 - metallic and tinted:
 *     here color does both.
 *   reciprocal: yes.
 *   energy: E <= 0.09; it is 0.0836 at cos_o 0.02, 0.0156 at 0.5 and 0.0003 at the normal.
 *   sampling: half by (1 - d)^5 about wo, half uniform.
 *   Not for: a sheen whose width matters; it has no parameter.
 *   measured by weft check burley-sheen: E at most 0.09 (cos_o 0.001);
 *     reciprocal to 1e-3; weight variance 0.29 of the cosine's;
 *     half precision: finite for any cosines. */
#pragma once

#include "shading/dialect/warp.h"
#include "shading/lobe/lobe.h"
#include "shading/terms/f_schlick.h"

#define BURLEY_SHEEN_PARAMS(P)
#define BURLEY_SHEEN_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES)

STRUCT(BurleySheen) { float none; };
PREPARED_AS_IT_IS(burley_sheen, BurleySheen)
SEEN_AS_IT_IS(burley_sheen, BurleySheen)

/* Returns the density of wi for half angles from q(d) = 6 (1 - d)^5 and uniform azimuths about wo; dwi = 4 d dd dphi.
 * Directions below the horizon are mirrored up, since f peaks opposite to wo. */
FN float burley_sheen_pdf_d(float d) { return 6.0f * schlick_s(d) / (8.0f * PI * max(d, 1e-6f)); }

FN LobeValue burley_sheen_value(const BurleySheenPrepared *p, const BurleySheenView *w, Angles a) {
    float x = a.o.x + a.i.x, y = a.o.y + a.i.y, z = a.o.z - a.i.z;
    float below = 0.5f * sqrt(x * x + y * y + z * z);
    float pdf = 0.5f * (burley_sheen_pdf_d(a.d) + burley_sheen_pdf_d(below)) + 0.5f * warp_uniform_pdf(a.i);
    return lobe_value_of(schlick_s(a.d), 0.0f, pdf);
}

FN Dir burley_sheen_sample(const BurleySheenPrepared *p, const BurleySheenView *w, Dir o, float u, float v) {
    Dir i = warp_uniform(2.0f * u - 1.0f, v);
    if (u < 0.5f) {
        float d = 1.0f - pow(max(2.0f * u, 1e-30f), 1.0f / 6.0f);
        float c = 2.0f * d * d - 1.0f, s = 2.0f * d * sqrt(max(1.0f - d * d, 0.0f)), phi = 2.0f * PI * v;
        /* a frame about wo: Tom Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017 */
        float a = -1.0f / (1.0f + o.z), b = o.x * o.y * a, x = s * cos(phi), y = s * sin(phi);
        float z = c * o.z - o.x * x - o.y * y;
        i = dir(c * o.x + (1.0f + o.x * o.x * a) * x + b * y, c * o.y + b * x + (1.0f + o.y * o.y * a) * y, abs(z));
    }
    return i;
}
