/* spheres.h - a floor of builtin:spheres that has as many inputs as the spheres, so that one program draws all of it */
#ifndef WEFT_TEST_RASTER_SPHERES_H
#define WEFT_TEST_RASTER_SPHERES_H

#include "weft/weft.h"

static inline void spheres_cover_floor(WeftScene *scene) {
    static const char *const inputs[][2] = {
        {"floor.roughness", "0.9"}, {"floor.sheen_color", "0.5,0.4,0.3"}, {"floor.sheen_roughness", "0.5"}};
    for (size_t k = 0; k < sizeof inputs / sizeof *inputs; k++)
        assert_int_equal(weft_scene_set(scene, inputs[k][0], inputs[k][1], NULL, NULL), WEFT_OK);
}

#endif
