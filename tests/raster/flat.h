/* flat.h - the values of choices that have text for GPUs, and pictures by flat and by plain texts */
#ifndef WEFT_TEST_RASTER_FLAT_H
#define WEFT_TEST_RASTER_FLAT_H

#include "shading/cases.h"

#include "raster/gl.h"

#include "raster/frame/raster_state.h"
#include "scratch.h"
#include "shading/material/choice.h"
#include "weft/weft.h"

static char folder[SCRATCH_SIZE]; /* without files between tests */

static const ChoiceId choices[] = {
#define ONE_CHOICE(name, help) CHOICE_##name,
    SURFACE_CHOICES(ONE_CHOICE)};
static const char *const choice_names[] = {
#define ONE_NAME(name, help) #name,
    SURFACE_CHOICES(ONE_NAME)};
enum { CHOICES = sizeof choices / sizeof choices[0] };

/* Returns true if a value has text for GPUs: a lobe of the reference alone has none. */
static inline bool is_on_gpu(int choice, int value) {
    if (!choice_fits(choices[choice], value)) return false;
    const bool lobe = choices[choice] == CHOICE_sheen_lobe || choices[choice] == CHOICE_diffuse;
    return !lobe || !(weft_lobe_info(value)->traits & WEFT_LOBE_REFERENCE);
}

enum { WIDTH = 96, HEIGHT = 54 };

static inline void flat_set(WeftScene *scene, const char *target, const char *value) {
    WeftError error;
    if (weft_scene_set(scene, target, value, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
}

/* Spheres under a sun, a polygon and a coloured sky. */
static inline WeftScene *flat_spheres(void) {
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load("builtin:spheres", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    const WeftLight sun = {.direction = {-1.0f, -2.0f, -1.0f}, .color = {3.0f, 2.8f, 2.5f}};
    assert_int_equal(weft_scene_add_light(scene, &sun, &error), WEFT_OK);
    assert_int_equal(weft_scene_set_environment_color(scene, (const float[]){0.3f, 0.4f, 0.5f}, &error), WEFT_OK);
    return scene;
}

/* Draws a scene, by the texts as they are written if `plain`: a folder without files does that. */
static inline WeftImage flat_draw(const WeftScene *scene, WeftGl gl, bool plain) {
    WeftRaster *raster;
    WeftImage image = {0};
    WeftError error;
    const WeftRasterDesc desc = {.gl = gl, .shader_dir = plain ? folder : NULL, .occlusion = 8};
    const WeftRasterView view = {
        .width = WIDTH, .height = HEIGHT, .samples = 1, .background = WEFT_BACKGROUND_COLOR, .plain_textures = 1};
    if (weft_raster_create(scene, &desc, &raster, NULL, &error) != WEFT_OK ||
        weft_raster_draw(raster, &view, &error) != WEFT_OK || weft_raster_image(raster, &image, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    assert_string_equal(weft_raster_info(raster).complaint, "");
    for (const Program *p = raster->programs.first; p; p = p->next) assert_int_equal(p->text == 0, plain);
    weft_raster_free(raster);
    return image;
}

/* Asserts that both pictures are the same to 1e-4 of their light, and at each pixel to a step of their 16 bits. */
static inline void expect_same_pictures(const WeftScene *scene, WeftGl gl, const char *name) {
    WeftImage flat = flat_draw(scene, gl, false), plain = flat_draw(scene, gl, true);
    const float *a = flat.pixels, *b = plain.pixels;
    double difference = 0.0, sum = 0.0, worst = 0.0;
    for (int k = 0; k < 4 * WIDTH * HEIGHT; k++) {
        if (k % 4 == 3) continue;
        const double x = (double)a[k], y = (double)b[k];
        difference += fabs(x - y);
        sum += fabs(y);
        worst = fmax(worst, fabs(x - y) / (fabs(y) + 0.01));
    }
    print_message("%s: %.2g of the light, a pixel %.2g\n", name, difference / sum, worst);
    assert_true(sum > 20.0);
    assert_true(difference <= 1e-4 * sum);
    assert_true(worst < 4e-3);
    weft_image_free(&flat);
    weft_image_free(&plain);
}

/* Compares the pictures of every so manyth value of all choices. */
static inline void expect_same_pictures_of_choices(int step) {
    int count = 0;
    for (int choice = 0; choice < CHOICES; choice++)
        for (int value = 0; choice_id(choices[choice], value); value++) {
            char target[64], name[96];
            const char *id = choice_id(choices[choice], value);
            if (!is_on_gpu(choice, value) || strcmp(id, "stochastic") == 0 || count++ % step) continue;
            WeftScene *scene = flat_spheres();
            snprintf(target, sizeof target, "*.%s", choice_names[choice]);
            if (choices[choice] == CHOICE_convert)
                flat_set(scene, "*.workflow", strcmp(id, "metallic") == 0 ? "specular" : "metallic");
            flat_set(scene, target, id);
            snprintf(name, sizeof name, "%s %s", choice_names[choice], id);
            expect_same_pictures(scene, count % 2 ? WEFT_GL_DESKTOP : WEFT_GL_ES, name);
            weft_scene_free(scene);
        }
}

static inline int flat_begin(void **state) { return scratch_make(folder) ? gl_begin(state) : 1; }
static inline int flat_end(void **state) {
    (void)state;
    return scratch_remove(folder) ? 0 : 1;
}

#endif
