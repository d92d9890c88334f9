/* khr-fuzz-exact - glTF's coming fuzz with a table that has no bias: the rim of smooth fibres as bright as it is
 *
 *   f      = as in profile khr-fuzz, R and D of lobe ltc-fibre
 *
 *   Khronos Group, KHR_materials_fuzz (pull request 2538 of KhronosGroup/glTF), with R of the fibres that its table
 * means: the walks of that table end at the 16th flake, so that its R is up to 0.232 too small (docs/fuzz.md).
 *   IBL there: R c times the irradiance, or the transformed cosine itself.
 *   Inputs and departures: those of profile khr-fuzz but for the table, which is fitted to lobe fibre. */
#pragma once

#include "shading/profiles/khr_fuzz.h"

FN void khr_fuzz_exact_stack(Stack *m, const Surface *s) { khr_fuzz_with(m, s, lobe_default(LOBE_LTC_FIBRE)); }
