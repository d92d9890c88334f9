/* bake_dfg.c - kind "dfg": the split sum of ggx, and E of a sheen beside it
 *
 *   E = f0 A + f90 B,   A = integral of D V (1 - s) cos_i dwi,  B = integral of D V s cos_i dwi,
 *   s = (1 - wi . h)^5
 *
 *   Brian Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013 course, "Environment BRDF". A form with
 * `total` has B and A + B, from which E = mix(B, A + B, f0) where f90 is 1: Filament's way. */
#include <stdio.h>

#include "measure/bake/bake_texels.h"

WeftResult bake_dfg(const WeftBakeDesc *desc, WeftBakeInfo *info, WeftImage *out, WeftError *error) {
    const Lobe ggx = lobe_default(LOBE_GGX);
    BakeLayer layers[2] = {bake_layer(&ggx, &desc->form)};
    int count = 1;
    const char *sheen = NULL;
    if (desc->lobe) {
        Lobe lobe;
        lobe_of(desc->lobe, &lobe);
        sheen = weft_lobe_info(lobe.id)->id;
        layers[count++] = (BakeLayer){lobe, 1, {WEFT_TABLE_SUM, WEFT_TABLE_SUM}};
    }
    snprintf(info->words, sizeof info->words, "split sum of ggx%s%s", sheen ? " and E of " : "", sheen ? sheen : "");
    snprintf(info->channels, sizeof info->channels, "%s%s",
             desc->form.total ? "bias of f90, sum" : "scale of f0, bias of f90", sheen ? ", E" : "");
    return bake_layers(desc, layers, count, info, out, error);
}
