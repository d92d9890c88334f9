/* sums.h - sums of frames of the rasteriser, and how far they are from the path tracer's light of as many bounces */
#ifndef WEFT_TEST_RASTER_SUMS_H
#define WEFT_TEST_RASTER_SUMS_H

#include <stdlib.h>

#include "raster/gl.h"
#include "trace/scenes.h"

/* Pixels, whole blocks of 8; a file may ask for fewer before it includes this one. */
#ifndef SUMS_WIDTH
#define SUMS_WIDTH  96
#define SUMS_HEIGHT 64
#endif
enum { WIDTH = SUMS_WIDTH, HEIGHT = SUMS_HEIGHT };

/* The sums of the absolute differences over the sum of the path traced picture. */
typedef struct Off {
    double pixels, blocks, mean;
} Off;

static inline Off compare(const WeftImage *a, const WeftImage *b) {
    double sum = 0.0, pixels = 0.0, blocks = 0.0, all = 0.0;
    const float *p = a->pixels, *q = b->pixels;
    for (int by = 0; by < HEIGHT / 8; by++)
        for (int bx = 0; bx < WIDTH / 8; bx++)
            for (int c = 0; c < 3; c++) {
                double block = 0.0;
                for (int k = 0; k < 64; k++) {
                    const int at = 4 * ((8 * by + k / 8) * WIDTH + 8 * bx + k % 8);
                    const double x = (double)(p[at + c] * p[at + 3]), y = (double)(q[at + c] * q[at + 3]);
                    sum += y;
                    pixels += fabs(x - y);
                    block += x - y;
                }
                blocks += fabs(block);
                all += block;
            }
    return (Off){pixels / sum, blocks / sum, all / sum};
}

static inline WeftImage summed(WeftRaster *raster, const WeftRasterView *how, int frames) {
    WeftImage image;
    WeftError error;
    int done = 0;
    if (weft_raster_accumulate_begin(raster, how, frames, &error) != WEFT_OK) fail_msg("%s", error.text);
    while (done < frames)
        if (weft_raster_accumulate(raster, 1.0, &done, &error) != WEFT_OK) fail_msg("%s", error.text);
    if (weft_raster_image(raster, &image, &error) != WEFT_OK) fail_msg("%s", error.text);
    return image;
}

static inline WeftRaster *raster_of(const WeftScene *scene) {
    WeftRaster *raster;
    WeftError error;
    const WeftRasterDesc desc = {.threads = 1, .no_cache = 1};
    if (weft_raster_create(scene, &desc, &raster, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return raster;
}

/* Compares a scene, which it frees, and prints how far off it is. */
static inline void agrees(WeftScene *scene, const WeftRasterView *how, int frames, int spp, const char *what,
                          double pixels, double blocks) {
    WeftRaster *raster = raster_of(scene);
    const WeftRenderDesc desc = {.width = WIDTH,
                                 .height = HEIGHT,
                                 .max_depth = 1 + how->bounces,
                                 .camera = how->camera,
                                 .background = how->background};
    WeftImage image = summed(raster, how, frames), reference = test_render(scene, desc, spp);
    const Off off = compare(&image, &reference);
    print_message("%-24s pixels %.2f %%, means of 8 x 8 %.2f %%, mean %+.2f %%\n", what, 100.0 * off.pixels,
                  100.0 * off.blocks, 100.0 * off.mean);
    if (!(off.pixels < pixels && off.blocks < blocks && fabs(off.mean) < 0.5 * blocks))
        fail_msg("%s: too far off", what);
    weft_image_free(&image);
    weft_image_free(&reference);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

#endif
