/* hdrp-cotton - Unity's cotton and wool: dull, darker the rougher, with a rim that is simply added
 *
 *   f     = base_color (1 - alpha / 2) / pi + c D V
 *   D     = charlie at alpha (1 + anisotropy),  V = V_neubelt,  alpha = sheen_roughness^2
 *
 *   Unity-Technologies/Graphics, com.unity.render-pipelines.high-definition,
 * Runtime/Material/Fabric/Fabric.hlsl (2a67652); BSDF.hlsl and CommonMaterial.hlsl of
 * com.unity.render-pipelines.core (05639b3). No Fresnel, no highlight, nothing taken from anything.
 *   IBL there differs: a table with the V of Conty and Kulla and with Schlick's rise to white; the rim is a
 * blurred mirror image.
 *   Inputs: its specular colour c is sheen_color sheen, and 1 - smoothness is sheen_roughness; the base has
 * no highlight whose roughness it could be. metallic, ior and specular are not looked at. The authoring
 * graph is said to press smoothness into 0 .. 0.6: not done.
 *   Departures: alpha of D is at least 0.005 (there 1/1024); cos_o has no floor of 1e-4. */
#pragma once

#include "shading/stack/workflow.h"

FN void hdrp_cotton_stack(Stack *m, const Surface *s) {
    float r = clamp(s->sheen_roughness, 0.0f, 1.0f), alpha = r * r;
    Lobe sheen = lobe_default(LOBE_CHARLIE_NEUBELT);
    sheen.params[CHARLIE_NEUBELT_ALPHA] = max(alpha * (1.0f + s->anisotropy), 0.005f);
    workflow_sheen(m, sheen, rgb_scale(s->sheen_color, s->sheen), s->sheen_second, LAYER_ADDITIVE);
    Lobe diffuse = lobe_default(LOBE_FABRIC_LAMBERT);
    diffuse.params[FABRIC_LAMBERT_ROUGHNESS] = alpha;
    slot_even(&m->diffuse, diffuse, s->base_color, s->base_color, 1.0f);
}
