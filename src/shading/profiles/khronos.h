/* khronos - glTF as its own renderer shows it: a thin rim, over a base that gives up a little too much
 *
 *   f      = coat + (1 - coat_F) (c D V + keep base),  c = sheen_color sheen
 *   base   = (1 - metallic) (1 - F) base_color / pi + D_ggx V_ggx F_mixed,  F each channel, at wi . h
 *   V      = min(V_conty_kulla, 1),  alpha = sheen_roughness^2
 *   keep   = min(1 - max3(c) E(cos_o), 1 - max3(c) E(cos_i))
 *   coat_F = clearcoat (0.04 + 0.96 (1 - cos_o)^5)
 *
 *   KhronosGroup/glTF-Sample-Renderer, source/Renderer/shaders/pbr.frag (9dfbb82), material_info.glsl,
 * punctual.glsl; brdf.glsl of KhronosGroup/glTF-Sample-Viewer (00536c7). There is no multiple scattering between
 * facets.
 *   IBL there differs: keep looks at cos_o alone; the sheen is a blurred mirror image times a table whose
 * Charlie has roughness unsquared, which is up to 1.7 times its own integral at roughness 0.5; the base has
 * Fdez-Aguera's scattering.
 *   Substitute: E, there the picture lut_sheen_E.png of unknown making, is here the integral of the
 * profile's own lobe, at most 1. If the picture does not include the clamp on V, as the extension's text does not,
 * it is up to 0.16 more at cos_o 0.02 and up to 0.06 from cos_o 0.1 on
 * (tests/shading/test_profiles).
 *   Departures: alpha of the base is at least 0.001, of the sheen 0.005; keep at least 0. F0 without an ior
 * is weft's. */
#pragma once

#include "shading/workflows/metallic.h"

FN float khronos_albedo(const Stack *m, float cosine) {
    if (!SHEEN_IS_OWN(m->table)) return min(table_engine(m->table, cosine, m->albedo_coord), 1.0f);
    return min(table_sheen_at(m->table, table_place(m->table, cosine, m->rows)).e, 1.0f);
}

FN void khronos_stack(Stack *m, const Surface *s) {
    metallic_with(m, s, lobe_rough(LOBE_CHARLIE_KHRONOS, s->sheen_roughness), LAYER_ALBEDO_MAX, BASE_FRESNEL_HALF);
    m->albedo = ALBEDO_KHRONOS;
}
