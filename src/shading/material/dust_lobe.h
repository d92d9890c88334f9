/* dust_lobe.h - scattering of dust: slabs of lobe ltc-fibre, whose flakes of alpha 1 are grains
 *
 *   E = E_1 R(t) / R(1),  R(t) = (3 t + (2 - 3 mu) (1 - exp(-t / mu))) / (4 + 3 t)
 *
 * E_1 is that of one slab, t the number of slabs, mu the cosine to the normal. R is the reflectance of grains that
 * absorb nothing and scatter in all directions. E. P. Shettle, J. A. Weinman, "The Transfer of Solar
 * Irradiance Through Inhomogeneous Turbid Atmospheres Evaluated by Eddington's Approximation", Journal of
 * the Atmospheric Sciences 27, 1970. How the light spreads stays that of one slab. Of the lobe fibre with the
 * density t and alpha 1, E is within 0.03, t from 1/4 to 4 (tests/shading/test_dust).
 *
 * E needs no table of the material's own. A text for a GPU has this file only if it has that lobe; otherwise there
 * is no dust (text/assemble/dispatch.h). */
#pragma once

#include "shading/catalogue/registry.h"
#include "shading/lobes/ltc_fibre.h"
#include "shading/media/fibre_medium.h"

/* The number of slabs if dust is 1. */
#define DUST_SLABS 8.0f

/* Returns R of the opening comment. */
FN float dust_eddington(float t, float mu) {
    return (3.0f * t + (2.0f - 3.0f * mu) * flake_visibility(t, 1.0f, mu)) / (4.0f + 3.0f * t);
}

/* Returns E / E_1 for that amount of dust. */
FN float dust_weight(float dust, float e_1, float cos_o) {
    float mu = max(cos_o, 1e-4f);
    return min(dust_eddington(DUST_SLABS * dust, mu) / dust_eddington(1.0f, mu), 1.0f / max(e_1, 1e-6f));
}

/* Returns E_1. */
FN float dust_albedo(const Lobe *m, float cos_o) {
    return min(ltc_table_level(lobe_table_ltc_fibre(), cos_o, m->params[LTC_FIBRE_ALPHA]).f0, 1.0f);
}
