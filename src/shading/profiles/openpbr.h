/* openpbr - OpenPBR Surface: a fuzz with multiple scattering, over a base that it dims but does not tint
 *
 *   f      = w c f_fuzz + (1 - w E(cos_o)) (coat + (1 - coat_F) dark mix(dielectric, metal, metallic))
 *   f_fuzz = E(cos_o) D / cos_i,  alpha = sheen_roughness
 *   dielectric = (1 - max3 F_min) eon(base_color) + D_ggx V_ggx specular_color (F0 (1 - s) + s)
 *   glass  : transmission takes the place of as much of eon, and comes through the facets of the highlight times
 *            base_color (1 - F) (stack.h)
 *   metal  = specular D_ggx V_ggx (base_color (1 - s) + s),  s = (1 - wi . h)^5,  alpha = roughness^2
 *   dark   = mix(1, coat_color, coat) (1 - coat coat_darkening (1 - (1 - k) / (1 - base_color k)))
 *
 *   AcademySoftwareFoundation/OpenPBR, reference/open_pbr_surface.mtlx: nodes fuzz_bsdf, a sheen of mode
 * zeltner, dielectric_transmission, dielectric_substrate, fuzz_layer, coat_layer, diffuse_bsdf and metal_bsdf. E is
 * that of white fuzz, so that dark fuzz darkens (issue 176 there).
 *   IBL there: renderers choose; E c times the irradiance, or the transformed cosine itself.
 *   Inputs: fuzz; without it fuzz_weight is sheen, fuzz_color sheen_color, fuzz_roughness sheen_roughness.
 * base_diffuse_roughness is diffuse_roughness, coat_weight clearcoat, specular_weight min(specular, 1), F0 as in workflow
 * metallic. transmission_weight is transmission, transmission_color base_color. coat_darkening, there
 * 1 by default, is 0 by default. Anisotropy of the base is not looked at.
 *   Departures: D and E are those of lobe ltc-fibre, fitted to lobe fibre, where the
 * specification has the table of tizian/ltc-sheen; sheen_roughness is at least 0.05. F_min, which dims the
 * diffuse lobe, is that of workflow metallic, where the specification scales by the albedo of the highlight.
 * A metal has no F82 tint, the coat does not roughen what is below, and alpha is at least 0.001. */
#pragma once

#include "shading/workflows/metallic.h"

/* Makes the stack with another fuzz and interface rule: base_fresnel is one of the BASE_FRESNEL_... of stack.h. */
FN void openpbr_with(Stack *m, const Surface *s, Lobe fuzz, int base_fresnel) {
    workflow_coat(m, s);
    workflow_fuzz(m, s, fuzz);
    m->sheen_over_coat = true;
    float strength = clamp(s->specular, 0.0f, 1.0f), f0 = dielectric_f0(s) * strength;
    m->base_fresnel = base_fresnel;
    m->interface_f0 = rgb_grey(f0);
    m->interface_f90 = 1.0f;
    /* sums, since a mix of 1000 and 1 at its end keeps few digits of the 1 */
    float glass = 1.0f - s->metallic, metal = strength * s->metallic;
    Rgb first = rgb_add(rgb_scale(s->specular_color, f0 * glass), rgb_scale(s->base_color, metal));
    workflow_base(m, s, rgb_scale(s->base_color, 1.0f - s->metallic), first, 1.0f);
    m->specular.lobe = lobe_default(LOBE_GGX);
    m->specular.lobe.params[GGX_ALPHA] = clamp(s->roughness * s->roughness, 0.001f, 1.0f);
    m->specular.f90 = rgb_add(rgb_scale(s->specular_color, glass), rgb_grey(metal));
    workflow_glass(m, s, glass);
    workflow_coming(m, s);
}

FN void openpbr_stack(Stack *m, const Surface *s) {
    openpbr_with(m, s, lobe_default(LOBE_LTC_FIBRE), BASE_FRESNEL_LEAST);
}
