/* Halves, what they say of the error, the other pictures of a render, and the denoised one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "trace/scenes.h"

/* A ball and a wall under the sky and a lamp, which make noise. */
static WeftScene *noisy_scene(void) {
    WeftScene *scene = test_scene();
    test_material(scene, 0.6f);
    test_sphere(scene, vec3(0, 0, 0), 1);
    test_material(scene, 0.3f);
    test_quad(scene, vec3(-4, -4, -1.5f), vec3(8, 0, 0), vec3(0, 8, 0));
    Material *lamp = test_material(scene, 0.0f);
    test_color(lamp, INPUT_emission, 8.0f);
    test_quad(scene, vec3(-1, 4.5f, -1), vec3(0, 0, 2), vec3(2, 0, 0)); /* above what the camera sees */
    test_environment(scene, 0.2f);
    scene_bounds(scene);
    return scene;
}

static const WeftRenderDesc halved = {
    .width = 60, .height = 44, .camera = "0,0,8;0,0,0;40", .halves = 1, .first_hits = 1};

static WeftRender *rendered(const WeftScene *scene, WeftRenderDesc desc, int spp) {
    WeftRender *r = NULL;
    WeftError error;
    if (weft_render_create(scene, &desc, &r, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_render_run(r, spp, 0.0, NULL, NULL), WEFT_OK);
    return r;
}

static WeftImage aov_of(const WeftRender *r, WeftAov aov) {
    WeftImage image;
    WeftError error;
    if (weft_render_aov(r, aov, &image, &error) != WEFT_OK) fail_msg("%s", error.text);
    return image;
}

static double relmse(const WeftImage *image, const WeftImage *reference) {
    WeftDiff found;
    assert_int_equal(weft_diff(&(WeftDiffDesc){.image = image, .reference = reference}, &found, NULL, NULL), WEFT_OK);
    return found.value;
}

/* The error that the halves show is the error, to what 7,920 squares of normal numbers scatter and a little more; and it
 * is the mean of the variance over the square of the picture. */
static void estimated_noise_is_the_error(void **state) {
    (void)state;
    WeftScene *scene = noisy_scene();
    WeftRenderDesc plain = halved;
    plain.halves = plain.first_hits = 0, plain.seed = 9;
    WeftImage reference = test_render(scene, plain, 2048);
    for (int spp = 16; spp <= 64; spp *= 4) {
        WeftRender *r = rendered(scene, halved, spp);
        WeftImage image, variance = aov_of(r, WEFT_AOV_VARIANCE);
        assert_int_equal(weft_render_image(r, &image, NULL), WEFT_OK);
        double noise = weft_render_noise(r), error = relmse(&image, &reference), sum = 0.0;
        if (!(noise > 0.75 * error && noise < 1.33 * error))
            fail_msg("at %d samples the halves show a relMSE of %g, and it is %g", spp, noise, error);
        for (int k = 0; k < image.width * image.height; k++)
            for (int c = 0; c < 3; c++) {
                double mean = (double)((const float *)image.pixels)[4 * k + c];
                sum += (double)((const float *)variance.pixels)[3 * k + c] / (mean * mean + 1e-2);
            }
        assert_true(fabs(sum / (3.0 * image.width * image.height) / noise - 1.0) < 1e-3);
        weft_image_free(&image);
        weft_image_free(&variance);
        weft_render_free(r);
    }
    weft_image_free(&reference);
    weft_scene_free(scene);
}

/* A render stops where its noise is as asked for, no earlier, on any number of threads with the same bytes,
 * and --spp remains the most. */
static void noise_level_ends_a_render_on_any_threads(void **state) {
    (void)state;
    WeftScene *scene = noisy_scene();
    WeftRenderDesc desc = halved;
    desc.noise = 2e-3f;
    WeftImage first = {0};
    for (int threads = 1; threads <= 7; threads += 3) {
        desc.threads = threads;
        WeftRender *r = rendered(scene, desc, 4096);
        WeftImage image;
        assert_int_equal(weft_render_image(r, &image, NULL), WEFT_OK);
        double samples = weft_render_info(r).samples_per_pixel;
        assert_true(samples >= 16.0 && samples < 4096.0);
        assert_true(weft_render_noise(r) <= 2e-3);
        if (first.pixels)
            assert_memory_equal(first.pixels, image.pixels, 60 * 44 * 4 * sizeof(float));
        else
            first = image;
        if (image.pixels != first.pixels) weft_image_free(&image);
        assert_int_equal(weft_render_run(r, 64, 0.0, NULL, NULL), WEFT_OK); /* it is reached already */
        assert_true(weft_render_info(r).samples_per_pixel == samples);
        weft_render_free(r);
    }
    weft_image_free(&first);
    desc.noise = 1e-9f;
    WeftRender *r = rendered(scene, desc, 21);
    assert_true(weft_render_info(r).samples_per_pixel == 21.0);
    assert_true(weft_render_noise(r) > 1e-9);
    weft_render_free(r);
    weft_scene_free(scene);
}

/* Shared halves are those of a picture without halves, added in another order; and they show no unbiased error. */
static void shared_halves_are_the_plain_picture(void **state) {
    (void)state;
    WeftScene *scene = noisy_scene();
    WeftRenderDesc desc = halved;
    desc.halves = 0;
    WeftImage plain = test_render(scene, desc, 64);
    desc.halves = WEFT_HALVES_SHARED;
    WeftImage shared = test_render(scene, desc, 64);
    for (int k = 0; k < 60 * 44 * 4; k++)
        if (fabsf(((const float *)plain.pixels)[k] - ((const float *)shared.pixels)[k]) > 1e-5f)
            fail_msg("number %d is %g of shared halves", k, (double)((const float *)shared.pixels)[k]);
    WeftRender *r = rendered(scene, desc, 64), *none = NULL;
    assert_true(weft_render_noise(r) > 0.0);
    desc.noise = 0.1f;
    assert_int_equal(weft_render_create(scene, &desc, &none, NULL), WEFT_USAGE);
    desc.noise = 0.0f, desc.halves = 3;
    assert_int_equal(weft_render_create(scene, &desc, &none, NULL), WEFT_USAGE);
    weft_render_free(r);
    weft_image_free(&plain);
    weft_image_free(&shared);
    weft_scene_free(scene);
}

static const float *at(const WeftImage *image, int x, int y) {
    return (const float *)image->pixels + (y * image->width + x) * image->channels;
}

static void aovs_hold_what_the_camera_sees(void **state) {
    (void)state;
    WeftScene *scene = test_scene();
    Material *wall = test_material(scene, 0.0f);
    memcpy(wall->inputs[INPUT_base_color].value, (float[3]){0.2f, 0.4f, 0.6f}, 3 * sizeof(float));
    test_quad(scene, vec3(-1, -1, 0), vec3(2, 0, 0), vec3(0, 2, 0));
    test_environment(scene, 1.0f);
    scene_bounds(scene);
    WeftRenderDesc desc = halved;
    desc.camera = "0,0,5;0,0,0;60";
    WeftRender *r = rendered(scene, desc, 9);
    WeftImage albedo = aov_of(r, WEFT_AOV_ALBEDO), normal = aov_of(r, WEFT_AOV_NORMAL),
              depth = aov_of(r, WEFT_AOV_DEPTH), samples = aov_of(r, WEFT_AOV_SAMPLES);
    for (int c = 0; c < 3; c++) {
        assert_true(fabsf(at(&albedo, 30, 22)[c] - wall->inputs[INPUT_base_color].value[c]) < 1e-5f);
        assert_true(fabsf(at(&normal, 30, 22)[c] - (c == 2 ? 1.0f : 0.0f)) < 1e-5f);
        assert_true(at(&albedo, 0, 0)[c] == 0.0f && at(&normal, 0, 0)[c] == 0.0f);
    }
    assert_true(fabsf(*at(&depth, 30, 22) - 5.0f) < 1e-4f);
    assert_true(fabsf(*at(&depth, 24, 18) - 5.0f) < 1e-4f); /* along the axis, not the ray */
    assert_true(*at(&depth, 0, 0) == 1e10f && *at(&samples, 7, 7) == 9.0f);
    weft_image_free(&albedo);
    weft_image_free(&normal);
    weft_image_free(&depth);
    weft_image_free(&samples);
    weft_render_free(r);
    weft_scene_free(scene);
}

/* First hits are seen beside the picture, which is the same with them and without. */
static void first_hits_change_no_byte_of_the_picture(void **state) {
    (void)state;
    WeftScene *scene = noisy_scene();
    WeftRenderDesc desc = halved;
    desc.halves = 0;
    WeftImage with = test_render(scene, desc, 5);
    desc.first_hits = 0;
    WeftImage without = test_render(scene, desc, 5);
    assert_memory_equal(with.pixels, without.pixels, 60 * 44 * 4 * sizeof(float));
    weft_image_free(&with);
    weft_image_free(&without);
    weft_scene_free(scene);
}

static void aovs_that_were_not_gathered_are_refused(void **state) {
    (void)state;
    WeftScene *scene = noisy_scene();
    WeftRenderDesc desc = halved;
    WeftError error;
    WeftImage image = {.width = 1};
    desc.halves = desc.first_hits = 0;
    WeftRender *r = rendered(scene, desc, 1);
    for (int aov = 0; aov <= WEFT_AOV_COUNT; aov++) {
        if (aov == WEFT_AOV_SAMPLES) continue;
        assert_int_equal(weft_render_aov(r, (WeftAov)aov, &image, &error), WEFT_USAGE);
        assert_int_equal(error.message, WEFT_MESSAGE_DESC);
        assert_null(image.pixels);
    }
    assert_int_equal(weft_render_denoised(r, WEFT_DENOISER_REGRESSION, &image, &error), WEFT_USAGE);
    assert_true(weft_render_noise(r) < 0.0);
    weft_render_free(r);
    desc.noise = 0.1f; /* without halves */
    assert_int_equal(weft_render_create(scene, &desc, &r, &error), WEFT_USAGE);
    desc = halved, desc.noise = -1.0f;
    assert_int_equal(weft_render_create(scene, &desc, &r, &error), WEFT_USAGE);
    r = rendered(scene, halved, 2);
    assert_int_equal(weft_render_denoised(r, WEFT_DENOISER_COUNT, &image, &error), WEFT_USAGE);
    weft_render_free(r);
    weft_scene_free(scene);
}

static WeftImage denoised(const WeftScene *scene, int threads, int spp) {
    WeftRenderDesc desc = halved;
    WeftError error;
    WeftImage image;
    desc.threads = threads;
    desc.width = 170; /* more than a tile of the denoiser */
    desc.halves = WEFT_HALVES_SHARED;
    WeftRender *r = rendered(scene, desc, spp);
    if (weft_render_denoised(r, WEFT_DENOISER_REGRESSION, &image, &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_render_free(r);
    return image;
}

static void denoising_takes_most_of_the_noise_away(void **state) {
    (void)state;
    WeftScene *scene = noisy_scene();
    WeftRenderDesc desc = halved;
    desc.halves = desc.first_hits = 0, desc.width = 170;
    WeftImage raw = test_render(scene, desc, 4);
    desc.seed = 9;
    WeftImage reference = test_render(scene, desc, 1024), image = denoised(scene, 1, 4);
    double left = relmse(&image, &reference), before = relmse(&raw, &reference);
    if (!(left < 0.4 * before)) fail_msg("relMSE %g of %g is left", left, before);
    double sum = 0.0, all = 0.0;
    for (int k = 0; k < 170 * 44 * 4; k++)
        sum += (double)((const float *)image.pixels)[k], all += (double)((const float *)reference.pixels)[k];
    assert_true(fabs(sum / all - 1.0) < 5e-3);
    for (int threads = 2; threads <= 7; threads += 5) {
        WeftImage other = denoised(scene, threads, 4);
        assert_memory_equal(image.pixels, other.pixels, 170 * 44 * 4 * sizeof(float));
        weft_image_free(&other);
    }
    weft_image_free(&raw);
    weft_image_free(&image);
    weft_image_free(&reference);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(estimated_noise_is_the_error),
        cmocka_unit_test(noise_level_ends_a_render_on_any_threads),
        cmocka_unit_test(shared_halves_are_the_plain_picture),
        cmocka_unit_test(aovs_hold_what_the_camera_sees),
        cmocka_unit_test(first_hits_change_no_byte_of_the_picture),
        cmocka_unit_test(aovs_that_were_not_gathered_are_refused),
        cmocka_unit_test(denoising_takes_most_of_the_noise_away),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
