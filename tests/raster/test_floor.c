/* The floor shows the same shadow and the same mirror image in both engines, over every background, and
 * lights can be looked through in both. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "gl.h"
#include "trace/scenes.h"

enum { WIDTH = 96, HEIGHT = 72, TILE = 12, TILES = WIDTH / TILE * (HEIGHT / TILE) };

/* A ball of one colour, whatever lights it, that stands on the floor. */
static WeftScene *ball(float sky) {
    WeftScene *scene = test_scene();
    test_material(scene, 0.8f)->unlit = true;
    test_sphere(scene, vec3(0.0f, 0.5f, 0.0f), 0.5f);
    scene_bounds(scene);
    test_environment(scene, sky);
    return scene;
}

static const WeftLight sun = {.direction = {-0.5f, -1.0f, -0.3f}, .color = {2.0f, 2.0f, 2.0f}};
static const WeftLight lamp = {.kind = WEFT_LIGHT_POLYGON,
                               .position = {1.0f, 2.5f, 0.5f},
                               .direction = {-0.4f, -1.0f, -0.2f},
                               .size = {0.6f, 0.6f},
                               .color = {8.0f, 8.0f, 8.0f}};
static const char camera[] = "0.6,1.6,3.6;0,0.3,0;40";

static WeftImage traced(const WeftScene *scene, const WeftRasterView *view) {
    WeftRenderDesc desc = {.width = view->width,
                           .height = view->height,
                           .camera = view->camera,
                           .background = view->background,
                           .floor = view->floor,
                           .hide_lights = view->hide_lights};
    memcpy(desc.background_color, view->background_color, sizeof desc.background_color);
    return test_render(scene, desc, 256);
}

static WeftImage drawn(const WeftScene *scene, WeftGl gl, const WeftRasterView *view) {
    WeftRaster *raster;
    WeftImage image = {0};
    WeftError error;
    if (weft_raster_create(scene, &(WeftRasterDesc){.gl = gl, .no_cache = 1}, &raster, NULL, &error) != WEFT_OK ||
        weft_raster_draw(raster, view, &error) != WEFT_OK || weft_raster_image(raster, &image, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    weft_raster_free(raster);
    return image;
}

/* Mean over a tile of a channel, times coverage where it is a colour. */
static float mean(const WeftImage *image, int tile, int channel) {
    const float *pixels = image->pixels;
    float sum = 0.0f;
    for (int k = 0; k < TILE * TILE; k++) {
        int x = tile % (WIDTH / TILE) * TILE + k % TILE, y = tile / (WIDTH / TILE) * TILE + k / TILE;
        const float *p = pixels + 4 * (y * WIDTH + x);
        sum += channel == 3 ? p[3] : p[channel] * p[3];
    }
    return sum / (TILE * TILE);
}

/* `slack` for a tile; a third of it for the picture. */
static void same(const char *what, WeftScene *scene, const WeftRasterView *view, float slack) {
    WeftImage truth = traced(scene, view);
    for (int gl = 0; gl < 2; gl++) {
        WeftImage image = drawn(scene, (WeftGl)gl, view);
        float off = 0.0f;
        for (int tile = 0; tile < TILES; tile++)
            for (int c = 2; c < 4; c++) {
                float a = mean(&truth, tile, c), b = mean(&image, tile, c);
                if (!(fabsf(a - b) <= slack))
                    fail_msg("%s, %s, tile %d, channel %d: %g, path traced %g", what, gl ? "ES" : "desktop", tile, c,
                             (double)b, (double)a);
                off += fabsf(a - b) / (2 * TILES);
            }
        if (!(off <= slack / 3.0f)) fail_msg("%s: off by %g in the mean", what, (double)off);
        weft_image_free(&image);
    }
    weft_image_free(&truth);
    weft_scene_free(scene);
}

static WeftRasterView floor_seen(WeftBackground background, float reflection, float roughness) {
    return (WeftRasterView){.width = WIDTH,
                            .height = HEIGHT,
                            .camera = camera,
                            .background = background,
                            .background_color = {0.4f, 0.4f, 0.4f},
                            .floor = {1, reflection, roughness}};
}

static void shadow_of_each_light_is_that_of_the_path_tracer(void **state) {
    (void)state;
    need_gl();
    WeftRasterView clear = floor_seen(WEFT_BACKGROUND_TRANSPARENT, 0.0f, 0.0f);
    same("sky", ball(1.0f), &clear, 0.03f);
    WeftScene *scene = ball(0.0f);
    weft_scene_add_light(scene, &sun, NULL);
    same("sun", scene, &clear, 0.03f);
    scene = ball(0.0f);
    weft_scene_add_light(scene, &lamp, NULL);
    clear.hide_lights = 1;
    same("polygon", scene, &clear, 0.05f);
}

static void mirror_image_in_the_floor_is_that_of_the_path_tracer(void **state) {
    (void)state;
    need_gl();
    WeftRasterView smooth = floor_seen(WEFT_BACKGROUND_COLOR, 0.6f, 0.0f),
                   rough = floor_seen(WEFT_BACKGROUND_TRANSPARENT, 0.1f, 0.3f);
    same("smooth mirror", ball(0.5f), &smooth, 0.03f);
    same("rough mirror", ball(0.5f), &rough, 0.03f);
}

static void floor_darkens_the_environment_behind_it(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = ball(0.5f);
    weft_scene_add_light(scene, &sun, NULL);
    WeftRasterView view = floor_seen(WEFT_BACKGROUND_ENVIRONMENT, 0.2f, 0.3f);
    same("environment", scene, &view, 0.03f);
}

static void hidden_light_is_looked_through_in_both(void **state) {
    (void)state;
    need_gl();
    for (int hide = 0; hide < 2; hide++) {
        WeftScene *scene = ball(0.0f);
        weft_scene_add_light(scene, &lamp, NULL);
        const WeftRasterView view = {.width = WIDTH,
                                     .height = HEIGHT,
                                     .camera = "0,1,5;0,1.5,0;45",
                                     .background = WEFT_BACKGROUND_TRANSPARENT,
                                     .hide_lights = hide};
        same(hide ? "hidden light" : "light", scene, &view, 0.1f);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shadow_of_each_light_is_that_of_the_path_tracer),
        cmocka_unit_test(mirror_image_in_the_floor_is_that_of_the_path_tracer),
        cmocka_unit_test(floor_darkens_the_environment_behind_it),
        cmocka_unit_test(hidden_light_is_looked_through_in_both),
    };
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
