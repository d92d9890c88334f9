/* square.h - square pictures of a scene by either engine, without shadows or bounces */
#ifndef WEFT_TEST_RASTER_SQUARE_H
#define WEFT_TEST_RASTER_SQUARE_H

#include "trace/scenes.h"
#include "weft/raster.h"

static inline WeftImage square_traced(const WeftScene *scene, int side, const char *camera, int spp) {
    return test_render(
        scene, (WeftRenderDesc){.width = side, .height = side, .camera = camera, .max_depth = 1, .threads = 2}, spp);
}

static inline WeftImage square_drawn(const WeftScene *scene, int side, const char *camera) {
    const WeftRasterView view = {.width = side, .height = side, .samples = 4, .camera = camera, .no_shadows = 1};
    WeftRaster *raster;
    WeftImage image;
    assert_int_equal(weft_raster_create(scene, &(WeftRasterDesc){.no_cache = 1}, &raster, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_raster_draw(raster, &view, NULL), WEFT_OK);
    assert_int_equal(weft_raster_image(raster, &image, NULL), WEFT_OK);
    weft_raster_free(raster);
    return image;
}

#endif
