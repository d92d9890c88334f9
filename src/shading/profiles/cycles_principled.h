/* cycles-principled - Blender 4 and later, the Principled BSDF: a fuzz with multiple scattering over glTF's base
 *
 *   f      = coat + (1 - coat_F) (c f_fuzz + keep base),  c = sheen_color sheen
 *   f_fuzz = R(cos_o) D / cos_i, of ltc-fibre-published at alpha = sheen_roughness, not squared
 *   keep   = 1 - max3(c) R(cos_o)
 *   base   = that of workflow metallic
 *
 *   blender/blender, intern/cycles/kernel: closure/bsdf_sheen.h, svm/closure (the node Principled BSDF, its sheen
 * of distribution Microfiber), 4.0 of 2023 and later. Its table is that of tizian/ltc-sheen: Tizian Zeltner, Brent
 * Burley, Matt Jen-Yuan Chiang, "Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines", SIGGRAPH Talks
 * 2022. Written from that code as it is known, not from a stored revision.
 *   Inputs: as Blender's reader of glTF sets them: Sheen Weight 1, Sheen Tint c, Sheen Roughness sheen_roughness, IOR
 * Level half of specular. Files written for viewers square the roughness: alpha there is sheen_roughness^2.
 *   Departures: sheen_roughness is at least 0.05 (there 0.001); the texels of the table are weft's own. The highlight is
 * one bounce of ggx in Schlick's F, there all bounces in the F of the ior; F_min dims the diffuse lobe, there the albedo
 * of the highlight. F90 is specular. Glass is left out, whose light bounces often between facets there.
 * The coat lies above the fuzz, and takes no tint; anisotropy is glTF's. */
#pragma once

#include "shading/workflows/metallic.h"

FN void cycles_principled_stack(Stack *m, const Surface *s) {
    Lobe fuzz = lobe_default(LOBE_LTC_FIBRE_PUBLISHED);
    fuzz.params[LTC_FIBRE_PUBLISHED_ALPHA] = clamp(s->sheen_roughness, 0.05f, 1.0f);
    metallic_with(m, s, fuzz, LAYER_ALBEDO_VIEW, BASE_FRESNEL_LEAST);
    m->transmission = 0.0f; /* Blender's reader of glTF knows no diffuse transmission */
    m->transmitted = rgb_grey(0.0f);
    stack_without_glass(m); /* many bounces between facets are not part of this stack */
}
