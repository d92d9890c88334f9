/* Whatever can be chosen, and every preset, makes a picture; the parameters of the principled BRDF all show.
 *
 * Labels: unsanitized */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "scenes.h"

enum { WIDTH = 24, HEIGHT = 18, SAMPLES = 1 };

static WeftScene *load(void) {
    WeftScene *scene = NULL;
    WeftError error;
    if (weft_scene_load("builtin:cloth", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

static void set(WeftScene *scene, const char *input, const char *value) {
    WeftError error;
    char target[64];
    snprintf(target, sizeof target, "*.%s", input);
    if (weft_scene_set(scene, target, value, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
}

static WeftImage picture(const WeftScene *scene) {
    return test_render(scene, (WeftRenderDesc){.camera = "0", .width = WIDTH, .height = HEIGHT}, SAMPLES);
}

/* All finite, none below 0, and not the same everywhere. */
static void check(const WeftScene *scene, const char *what, const char *value) {
    WeftImage image = picture(scene);
    const float *v = image.pixels;
    float low = INFINITY, high = -INFINITY;
    for (int k = 0; k < WIDTH * HEIGHT * image.channels; k++) {
        if (!isfinite(v[k]) || v[k] < 0.0f) fail_msg("%s %s: pixel %d is %g", what, value, k, (double)v[k]);
        if (image.channels == 4 && k % 4 == 3) continue;
        low = fminf(low, v[k]);
        high = fmaxf(high, v[k]);
    }
    if (!(high > 2.0f * low)) fail_msg("%s %s: all is in %g .. %g", what, value, (double)low, (double)high);
    weft_image_free(&image);
}

static void every_choice_makes_a_picture(void **state) {
    (void)state;
    WeftScene *scene = load();
    int pictures = 0;
    for (int c = 0; weft_material_choice_name(c); c++) {
        const char *name = weft_material_choice_name(c), *id;
        for (int k = 0; (id = weft_material_choice_value(c, k)); k++) {
            char target[64];
            snprintf(target, sizeof target, "*.%s", name);
            if (weft_scene_set(scene, target, id, NULL, NULL) != WEFT_OK) continue; /* no lobe for a base */
            check(scene, name, id);
            pictures++;
        }
        set(scene, name, "auto");
    }
    assert_true(pictures > 80);
    weft_scene_free(scene);
}

static void every_preset_makes_a_picture(void **state) {
    (void)state;
    WeftError error;
    for (int k = 0; weft_preset_name(k); k++) {
        char path[64];
        WeftScene *scene = load();
        snprintf(path, sizeof path, "preset:%s", weft_preset_name(k));
        if (weft_scene_assign_material(scene, NULL, path, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        check(scene, "preset", weft_preset_name(k));
        weft_scene_free(scene);
    }
}

/* The mean difference that one input makes. */
static double difference(const WeftScene *scene, const WeftImage *before) {
    WeftImage after = picture(scene);
    WeftDifference found;
    assert_int_equal(weft_difference(&after, before, &found, NULL), WEFT_OK);
    weft_image_free(&after);
    return found.mean;
}

static void every_disney_parameter_changes_the_picture(void **state) {
    (void)state;
    static const char *const from[][2] = {
        {"base_color", "0.6,0.3,0.1"}, {"subsurface", "0.2"}, {"metallic", "0.2"},       {"specular", "0.5"},
        {"specular_tint", "0.2"},      {"roughness", "0.4"},  {"anisotropy", "0.2"},     {"sheen", "0.5"},
        {"sheen_tint", "0.2"},         {"clearcoat", "0.5"},  {"clearcoat_gloss", "0.9"}};
    static const char *const to[] = {"0.1,0.3,0.6", "0.9", "0.8", "0.9", "0.9", "0.7", "0.9", "1", "0.9", "1", "0.3"};
    WeftScene *scene = load();
    set(scene, "workflow", "disney");
    for (size_t k = 0; k < sizeof from / sizeof *from; k++) set(scene, from[k][0], from[k][1]);
    WeftImage before = picture(scene);
    for (size_t k = 0; k < sizeof from / sizeof *from; k++) {
        set(scene, from[k][0], to[k]);
        double made = difference(scene, &before);
        if (!(made > 1e-4)) fail_msg("%s: from %s to %s changes %g", from[k][0], from[k][1], to[k], made);
        set(scene, from[k][0], from[k][1]);
    }
    assert_true(difference(scene, &before) <= 0.0);
    /* and one that means nothing there does not */
    set(scene, "sheen_roughness", "0.9");
    assert_true(difference(scene, &before) <= 0.0);
    weft_image_free(&before);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_choice_makes_a_picture),
        cmocka_unit_test(every_preset_makes_a_picture),
        cmocka_unit_test(every_disney_parameter_changes_the_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
