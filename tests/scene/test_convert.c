/* Conversion between workflows: what is lossless is, what is not is measured, and pictures agree. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "scene/record/material_at.h"
#include "scene/record/scene.h"
#include "shading/material/compose.h"
#include "weft/weft.h"

typedef struct Colors {
    double d[3], f[3];
} Colors;

static double channel(Rgb color, int c) { return (double)(c == 0 ? color.r : c == 1 ? color.g : color.b); }

/* Diffuse colour and reflectance at normal incidence, from the definitions of glTF, in double. */
static Colors metallic_colors(const Surface *s) {
    Colors colors;
    double r = ((double)s->ior - 1.0) / ((double)s->ior + 1.0), m = (double)s->metallic;
    for (int c = 0; c < 3; c++) {
        double base = channel(s->base_color, c);
        double dielectric = fmin(r * r * channel(s->specular_color, c), 1.0) * (double)s->specular;
        colors.d[c] = base * (1.0 - m);
        colors.f[c] = dielectric * (1.0 - m) + base * m;
    }
    return colors;
}

static Colors specular_colors(const Surface *s) {
    Colors colors;
    double most = 0.0;
    for (int c = 0; c < 3; c++) {
        colors.f[c] = fmin(channel(s->specular_color, c) * (double)s->specular, 1.0);
        most = fmax(most, colors.f[c]);
    }
    for (int c = 0; c < 3; c++) colors.d[c] = channel(s->base_color, c) * (1.0 - most);
    return colors;
}

static double apart(Colors a, Colors b) {
    double most = 0.0;
    for (int c = 0; c < 3; c++) most = fmax(most, fmax(fabs(a.d[c] - b.d[c]), fabs(a.f[c] - b.f[c])));
    return most;
}

static uint32_t counter;
static float uniform(void) { return unit_float(hash32(++counter)); }
static Rgb random_color(void) { return rgb(uniform(), uniform(), uniform()); }

static Surface random_surface(void) {
    Material material = material_default();
    Surface s = material_plain(&material);
    s.base_color = random_color();
    s.metallic = uniform();
    s.ior = 1.2f + uniform();
    return s;
}

static const Choices to_specular = {.workflow = CHOICE_AUTO, .convert = CONVERT_SPECULAR},
                     to_metallic = {.workflow = WORKFLOW_SPECULAR, .convert = CONVERT_METALLIC};

static void conversion_to_specular_loses_nothing(void **state) {
    (void)state;
    for (int k = 0; k < 20000; k++) {
        Surface s = random_surface();
        s.specular = uniform();
        s.specular_color = random_color();
        if (k % 10 == 0) s.metallic = k % 20 ? 1.0f : 0.0f;
        Surface t = convert_surface(s, to_specular);
        double loss = apart(metallic_colors(&s), specular_colors(&t));
        if (!(loss < 2e-6) || !(convert_loss(s, to_specular) < 2e-6f)) fail_msg("%g", loss);
        assert_int_equal(convert_choices(to_specular).workflow, WORKFLOW_SPECULAR);
    }
}

/* What was metallic comes back as it was, unless its base is darker than the dielectric reflects: such an f
 * is none of a metal in part. */
static void conversion_there_and_back_is_the_same(void **state) {
    (void)state;
    for (int k = 0; k < 20000; k++) {
        Surface s = random_surface(), t = convert_surface(convert_surface(s, to_specular), to_metallic);
        if (rgb_mean(s.base_color) <= dielectric_f0(&s)) continue;
        double loss = apart(metallic_colors(&s), metallic_colors(&t));
        if (!(loss < 2e-5)) fail_msg("%g at metallic %g", loss, (double)s.metallic);
    }
}

/* Any pair of colours: the loss that is told is the one that is there, and no input leaves its range. */
static void conversion_loss_is_the_one_reported(void **state) {
    (void)state;
    double greatest = 0.0;
    for (int k = 0; k < 20000; k++) {
        Surface s = random_surface();
        s.specular_color = random_color();
        s.specular = 1.0f;
        Surface t = convert_surface(s, to_metallic);
        double loss = apart(specular_colors(&s), metallic_colors(&t));
        assert_true(fabs(loss - (double)convert_loss(s, to_metallic)) < 1e-5);
        assert_true(t.metallic >= 0.0f && t.metallic <= 1.0f);
        for (int c = 0; c < 3; c++) assert_true(channel(t.base_color, c) >= 0.0 && channel(t.base_color, c) <= 1.0);
        greatest = fmax(greatest, loss);
    }
    assert_true(greatest > 0.1); /* a cyan matt under a red mirror is no metal */
}

static WeftImage picture(const WeftScene *scene) {
    WeftRender *render = NULL;
    WeftImage image;
    WeftError error;
    WeftRenderDesc desc = {.camera = "0", .width = 32, .height = 24};
    if (weft_render_create(scene, &desc, &render, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_render_run(render, 4, 0.0, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_render_image(render, &image, &error), WEFT_OK);
    weft_render_free(render);
    return image;
}

static WeftScene *load(void) {
    WeftScene *scene = NULL;
    WeftError error;
    if (weft_scene_load("builtin:cloth", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

static void converted_scene_looks_as_before(void **state) {
    (void)state;
    WeftScene *scene = load();
    WeftError error;
    float losses[16];
    assert_in_range(scene->material_count, 2, 16);
    WeftImage before = picture(scene);
    assert_int_equal(weft_scene_convert(scene, "specular", losses, &error), WEFT_OK);
    for (int k = 0; k < scene->material_count; k++) assert_true(losses[k] >= 0.0f && losses[k] < 2e-6f);
    WeftImage after = picture(scene);
    WeftDifference found;
    assert_int_equal(weft_difference(&after, &before, &found, NULL), WEFT_OK);
    if (!(found.mean < 1e-3)) fail_msg("mean difference %g", found.mean);
    weft_image_free(&before);
    weft_image_free(&after);
    weft_scene_free(scene);
}

static void materials_of_other_workflows_are_not_converted(void **state) {
    (void)state;
    WeftScene *scene = load();
    WeftError error;
    float losses[16];
    assert_int_equal(weft_scene_set(scene, "0.workflow", "disney", NULL, &error), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "1.workflow", "specular", NULL, &error), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "1.specular_color", "0.5,0,0", NULL, &error), WEFT_OK);
    assert_int_equal(weft_scene_convert(scene, "metallic", losses, &error), WEFT_OK);
    assert_true(losses[0] == -1.0f && losses[1] > 0.01f && losses[2] == -2.0f);
    assert_int_equal(weft_scene_convert(scene, "disney", NULL, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_PARAM_VALUE);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(conversion_to_specular_loses_nothing),
        cmocka_unit_test(conversion_there_and_back_is_the_same),
        cmocka_unit_test(conversion_loss_is_the_one_reported),
        cmocka_unit_test(converted_scene_looks_as_before),
        cmocka_unit_test(materials_of_other_workflows_are_not_converted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
