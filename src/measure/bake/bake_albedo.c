/* bake_albedo.c - kind "albedo": E of a lobe over cos_o and its first parameter
 *
 *   E(cos_o) = integral over the hemisphere of f(wo, wi) cos_i dwi
 *
 * For a lobe of two colours, f0 and f90, these are the integrals of their two weights. */
#include <stdio.h>

#include "measure/bake/bake_texels.h"

WeftResult bake_albedo(const WeftBakeDesc *desc, WeftBakeInfo *info, WeftImage *out, WeftError *error) {
    Lobe lobe;
    lobe_of(desc->lobe, &lobe);
    const BakeLayer layer = bake_layer(&lobe, &desc->form);
    snprintf(info->words, sizeof info->words, "directional albedo E of %s", weft_lobe_info(lobe.id)->id);
    snprintf(info->channels, sizeof info->channels, "%s",
             layer.channels == 1 ? "E"
             : desc->form.total  ? "part of f90, E"
                                 : "part of f0, part of f90");
    return bake_layers(desc, &layer, 1, info, out, error);
}
