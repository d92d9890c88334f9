/* sheens.h - choosing the lobe of a scene's sheens, for the test and the bench of light among neighbours */
#ifndef WEFT_TEST_RASTER_SHEENS_H
#define WEFT_TEST_RASTER_SHEENS_H

#include <stdio.h>

#include "weft/weft.h"

/* Gives that lobe to the materials that have a sheen. Others, as the floor, would shine by the lobe's second colour. */
static inline WeftResult sheens_set_lobe(WeftScene *scene, const char *id, WeftError *error) {
    WeftMaterial material;
    WeftResult result = WEFT_OK;
    const int color = weft_material_input_find("sheen_color");
    for (int k = 0; result == WEFT_OK && weft_scene_material(scene, k, &material, NULL) == WEFT_OK; k++) {
        const float *c = material.inputs[color].value;
        char target[64];
        snprintf(target, sizeof target, "%d.sheen_lobe", k);
        if (c[0] + c[1] + c[2] > 0.0f) result = weft_scene_set(scene, target, id, NULL, error);
    }
    return result;
}

#endif
