/* Light sampling, lobe sampling and MIS find the same picture; threads and tiles do not change a byte.
 *
 * Labels: unsanitized */
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#include "scenes.h"
#include "weft/weft.h"

/* A glossy coated floor with a sheen ball, lit by a quad, a bright spot in an image environment and a
 * constant part. */
static WeftScene *lit_scene(void) {
    WeftScene *scene = test_scene();
    WeftImage map;
    assert_int_equal(weft_image_create(64, 32, 3, WEFT_PIXEL_F32, &map, NULL), WEFT_OK);
    for (int k = 0; k < 64 * 32 * 3; k++) ((float *)map.pixels)[k] = 0.2f;
    for (int y = 8; y < 12; y++)
        for (int x = 20; x < 26; x++) ((float *)map.pixels)[3 * (64 * y + x)] = 12.0f;
    weft_image_free(&scene->environment.image);
    scene->environment.image = map;
    scene->environment.kind = ENVIRONMENT_IMAGE;
    scene->environment.rotation = 0.7f;

    Material *floor = test_material(scene, 0.4f);
    test_color(floor, INPUT_specular, 1.0f);
    test_color(floor, INPUT_roughness, 0.45f);
    test_color(floor, INPUT_clearcoat, 0.7f);
    test_color(floor, INPUT_clearcoat_roughness, 0.35f);
    test_quad(scene, vec3(-4, 0, 4), vec3(8, 0, 0), vec3(0, 0, -8));
    Material *ball = test_material(scene, 0.3f);
    test_color(ball, INPUT_sheen_color, 0.8f);
    test_color(ball, INPUT_sheen_roughness, 0.5f);
    test_color(ball, INPUT_anisotropy, 0.6f);
    test_color(ball, INPUT_specular, 1.0f);
    test_sphere(scene, vec3(0, 1, 0), 1.0f);
    Material *lamp = test_material(scene, 0.0f);
    lamp->double_sided = false;
    test_color(lamp, INPUT_emission, 6.0f);
    test_quad(scene, vec3(-2.2f, 2.6f, -1), vec3(1.2f, 0.4f, 0), vec3(0, 0, 1.4f));
    scene_bounds(scene);
    return scene;
}

/* A shade around a lamp, a curtain before the environment: what light they let through. */
static WeftScene *shaded_scene(void) {
    WeftScene *scene = lit_scene();
    Material *shade = test_material(scene, 0.6f);
    test_color(shade, INPUT_specular, 1.0f);
    test_color(shade, INPUT_sheen_color, 0.3f);
    test_color(shade, INPUT_sheen_roughness, 0.5f);
    test_color(shade, INPUT_diffuse_transmission, 0.6f);
    test_color(shade, INPUT_diffuse_transmission_color, 0.9f);
    test_quad(scene, vec3(-2.6f, 2.0f, -1.3f), vec3(2.0f, 0.4f, 0), vec3(0, 0, 2.0f)); /* under the lamp */
    test_quad(scene, vec3(0.6f, 0.1f, -1.5f), vec3(2.6f, 0, 0.4f), vec3(0, 2.4f, 0));
    scene_bounds(scene);
    return scene;
}

static const WeftRenderDesc small = {.width = 24, .height = 18, .camera = "0,2.4,6;0,0.8,0;32", .max_depth = 4};

enum { BATCHES = 12, BATCH_SPP = 96 };

/* Mean picture value of a strategy in each of BATCHES independent renders, over a left and a right half. */
static void batch_means(const WeftScene *scene, WeftSampling sampling, double means[2][BATCHES]) {
    for (int b = 0; b < BATCHES; b++) {
        WeftRenderDesc desc = small;
        desc.sampling = sampling;
        desc.seed = 1000u + (uint32_t)b;
        WeftImage image = test_render(scene, desc, BATCH_SPP);
        double sum[2] = {0};
        for (int k = 0; k < image.width * image.height; k++)
            for (int c = 0; c < 3; c++)
                sum[k % image.width >= image.width / 2] += (double)((float *)image.pixels)[4 * k + c];
        for (int half = 0; half < 2; half++) means[half][b] = sum[half] / (image.width * image.height * 1.5);
        weft_image_free(&image);
    }
}

static void moments(const double *x, double *mean, double *error) {
    double sum = 0.0, squares = 0.0;
    for (int b = 0; b < BATCHES; b++) sum += x[b];
    *mean = sum / BATCHES;
    for (int b = 0; b < BATCHES; b++) squares += (x[b] - *mean) * (x[b] - *mean);
    *error = sqrt(squares / (BATCHES - 1) / BATCHES);
}

static void strategies_agree(WeftScene *scene) {
    static const char *const names[] = {"mis", "light", "lobe"};
    double means[3][2][BATCHES], m[3][2], e[3][2];
    for (int s = 0; s < 3; s++) {
        batch_means(scene, (WeftSampling)s, means[s]);
        for (int half = 0; half < 2; half++) moments(means[s][half], &m[s][half], &e[s][half]);
        printf("  %-5s %.5f +- %.5f | %.5f +- %.5f\n", names[s], m[s][0], e[s][0], m[s][1], e[s][1]);
    }
    for (int s = 1; s < 3; s++)
        for (int half = 0; half < 2; half++) {
            /* Student's t with about 11 degrees of freedom a side, four comparisons, 1 % together: 3.7 */
            double z = (m[s][half] - m[0][half]) / hypot(e[s][half], e[0][half]);
            if (!(fabs(z) < 3.7)) fail_msg("%s differs from mis by %.2f standard errors", names[s], z);
        }
    for (int half = 0; half < 2; half++) {
        assert_true(e[0][half] < e[1][half] * 1.5); /* MIS is never much worse than either */
        assert_true(e[0][half] < e[2][half] * 1.5);
        assert_true(e[0][half] < 0.02 * m[0][half]); /* else the comparison above could not fail */
    }
    weft_scene_free(scene);
}

static void sampling_strategies_agree(void **state) {
    (void)state;
    strategies_agree(lit_scene());
}

static void sampling_strategies_agree_on_light_through_cloth(void **state) {
    (void)state;
    strategies_agree(shaded_scene());
}

/* An emitter that is half there shines half as much, by whichever way it is found. */
static void transparent_emitter_shines_less(void **state) {
    (void)state;
    double mean[3];
    for (int s = 0; s < 3; s++) {
        WeftScene *scene = test_scene();
        test_environment(scene, 0.0f);
        test_material(scene, 0.8f);
        test_quad(scene, vec3(-2, 0, 2), vec3(4, 0, 0), vec3(0, 0, -4));
        Material *lamp = test_material(scene, 0.0f);
        test_color(lamp, INPUT_emission, 5.0f);
        lamp->alpha_mode = WEFT_ALPHA_BLEND;
        lamp->inputs[INPUT_opacity].value[0] = 0.25f;
        test_quad(scene, vec3(-1, 1.5f, -1), vec3(2, 0, 0), vec3(0, 0, 2));
        scene_bounds(scene);
        WeftRenderDesc desc = {.width = 16, .height = 16, .camera = "0,0.7,3;0,0,0;20", .max_depth = 1};
        desc.sampling = (WeftSampling)s;
        WeftImage image = test_render(scene, desc, 512);
        mean[s] = 0.0;
        for (int k = 0; k < 256; k++) mean[s] += (double)((float *)image.pixels)[4 * k] / 256.0;
        weft_image_free(&image);
        weft_scene_free(scene);
    }
    assert_true(mean[0] > 0.05);
    for (int s = 1; s < 3; s++) assert_true(fabs(mean[s] / mean[0] - 1.0) < 0.02);
}

/* A surface whose normal map leans to +x: from behind the bumps are dents, so that light from -x finds it
 * leaning its way. */
static void normal_map_is_mirrored_on_the_back(void **state) {
    (void)state;
    double lit[2][2]; /* seen from the front or from behind, lit from +x or from -x */
    for (int behind = 0; behind < 2; behind++)
        for (int from = 0; from < 2; from++) {
            WeftScene *scene = test_scene();
            test_environment(scene, 0.0f);
            scene->images = arena_array(&scene->arena, 1, sizeof(WeftImage));
            scene->textures = arena_array(&scene->arena, 1, sizeof(Texture));
            assert_int_equal(weft_image_create(1, 1, 3, WEFT_PIXEL_F32, &scene->images[0], NULL), WEFT_OK);
            memcpy(scene->images[0].pixels, (float[3]){0.8f, 0.5f, 0.9f}, 3 * sizeof(float));
            scene->image_count = scene->texture_count = 1;
            test_material(scene, 0.8f)->inputs[INPUT_normal].texture = 1;
            Mesh *mesh = test_quad(scene, vec3(-2, -2, 0), vec3(4, 0, 0), vec3(0, 4, 0)); /* faces +z */
            mesh->tangent = arena_array(&scene->arena, 4, 4 * sizeof(float));
            for (int k = 0; k < 4; k++) mesh->tangent[4 * k] = mesh->tangent[4 * k + 3] = 1.0f;
            float z = behind ? 0.7071f : -0.7071f;
            scene->lights[scene->light_count++] = (Light){.kind = LIGHT_DIRECTIONAL,
                                                          .direction = {from ? 0.7071f : -0.7071f, 0, z},
                                                          .color = {1, 1, 1},
                                                          .intensity = 1.0f};
            scene_bounds(scene);
            WeftRenderDesc desc = {.width = 4, .height = 4, .max_depth = 1};
            desc.camera = behind ? "0,0,-3;0,0,0;20" : "0,0,3;0,0,0;20";
            WeftImage image = test_render(scene, desc, 4);
            lit[behind][from] = (double)((float *)image.pixels)[0];
            weft_image_free(&image);
            weft_scene_free(scene);
        }
    assert_true(lit[0][0] > 1.5 * lit[0][1]);
    assert_true(lit[1][1] > 1.5 * lit[1][0]);
    assert_true(fabs(lit[0][0] - lit[1][1]) < 1e-3 && fabs(lit[0][1] - lit[1][0]) < 1e-3);
}

/* A coat whose normal map leans along the tangent is brighter in light from there, whichever way the tangent runs. */
static void normal_map_of_a_coat_leans_along_the_tangent(void **state) {
    (void)state;
    for (int along = 0; along < 2; along++) {
        double lit[2]; /* from -x, from +x */
        for (int from = 0; from < 2; from++) {
            WeftScene *scene = test_scene();
            test_environment(scene, 0.0f);
            scene->images = arena_array(&scene->arena, 1, sizeof(WeftImage));
            scene->textures = arena_array(&scene->arena, 1, sizeof(Texture));
            assert_int_equal(weft_image_create(1, 1, 3, WEFT_PIXEL_F32, &scene->images[0], NULL), WEFT_OK);
            memcpy(scene->images[0].pixels, (float[3]){0.8f, 0.5f, 0.9f}, 3 * sizeof(float));
            scene->image_count = scene->texture_count = 1;
            Material *coated = test_material(scene, 0.0f);
            test_color(coated, INPUT_sheen_color, 0.01f);
            coated->inputs[INPUT_clearcoat].value[0] = 1.0f;
            coated->inputs[INPUT_clearcoat_roughness].value[0] = 0.6f;
            coated->inputs[INPUT_clearcoat_normal].texture = 1;
            Mesh *mesh = test_quad(scene, vec3(-2, -2, 0), vec3(4, 0, 0), vec3(0, 4, 0)); /* faces +z */
            mesh->tangent = arena_array(&scene->arena, 4, 4 * sizeof(float));
            for (int k = 0; k < 4; k++) mesh->tangent[4 * k] = along ? 1.0f : -1.0f, mesh->tangent[4 * k + 3] = 1.0f;
            scene->lights[scene->light_count++] = (Light){.kind = LIGHT_DIRECTIONAL,
                                                          .direction = {from ? -0.7071f : 0.7071f, 0, -0.7071f},
                                                          .color = {1, 1, 1},
                                                          .intensity = 1.0f};
            scene_bounds(scene);
            WeftRenderDesc desc = {.width = 4, .height = 4, .max_depth = 1, .camera = "0,0,3;0,0,0;20"};
            WeftImage image = test_render(scene, desc, 4);
            lit[from] = (double)((float *)image.pixels)[0];
            weft_image_free(&image);
            weft_scene_free(scene);
        }
        assert_true(lit[along] > 1.5 * lit[1 - along]);
    }
}

/* Texels below zero, which EXR files may hold, do not darken the other lights. */
static void negative_texels_of_an_environment_count_as_zero(void **state) {
    (void)state;
    WeftScene *scene = lit_scene();
    float *p = scene->environment.image.pixels;
    for (int k = 0; k < 64 * 32 * 3; k++) p[k] = -1e-3f;
    scene->lights[scene->light_count++] =
        (Light){.kind = LIGHT_POINT, .position = {0, 4, 3}, .color = {1, 1, 1}, .intensity = 20.0f};
    WeftImage image = test_render(scene, small, 8);
    int bright = 0;
    for (int k = 0; k < image.width * image.height; k++) bright += ((float *)image.pixels)[4 * k] > 0.05f;
    assert_true(bright > 20);
    weft_image_free(&image);
    weft_scene_free(scene);
}

static void render_with_any_number_of_threads_is_the_same(void **state) {
    (void)state;
    WeftScene *scene = lit_scene();
    WeftRenderDesc desc = small;
    desc.width = 70, desc.height = 50;
    desc.threads = 1;
    WeftImage one = test_render(scene, desc, 20);
    static const int counts[] = {2, 7};
    for (int k = 0; k < 2; k++) {
        desc.threads = counts[k];
        WeftImage many = test_render(scene, desc, 20);
        assert_memory_equal(one.pixels, many.pixels, 70 * 50 * 4 * sizeof(float));
        weft_image_free(&many);
    }
    desc.seed = 5; /* and another seed does change them */
    WeftImage other = test_render(scene, desc, 20);
    assert_memory_not_equal(one.pixels, other.pixels, 70 * 50 * 4 * sizeof(float));
    weft_image_free(&other);
    weft_image_free(&one);
    weft_scene_free(scene);
}

static void crop_is_a_part_of_the_picture(void **state) {
    (void)state;
    WeftScene *scene = lit_scene();
    WeftRenderDesc desc = small;
    desc.width = 60, desc.height = 40;
    WeftImage whole = test_render(scene, desc, 3);
    memcpy(desc.crop, (int[4]){13, 7, 21, 19}, sizeof desc.crop);
    WeftImage part = test_render(scene, desc, 3);
    assert_int_equal(part.width, 21);
    assert_int_equal(part.height, 19);
    for (int y = 0; y < 19; y++)
        assert_memory_equal((float *)part.pixels + 4 * 21 * y, (float *)whole.pixels + 4 * (60 * (y + 7) + 13),
                            21 * 4 * sizeof(float));
    weft_image_free(&whole);
    weft_image_free(&part);
    weft_scene_free(scene);
}

static int stop_at_half(void *user, double fraction) {
    *(double *)user = fraction;
    return fraction > 0.5;
}

static void render_runs_accumulate_and_stop(void **state) {
    (void)state;
    WeftScene *scene = lit_scene();
    WeftRenderDesc desc = small;
    WeftRender *r;
    assert_int_equal(weft_render_create(scene, &desc, &r, NULL), WEFT_OK);
    assert_int_equal(weft_render_run(r, 3, 0.0, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_render_run(r, 4, 0.0, NULL, NULL), WEFT_OK);
    assert_true(weft_render_info(r).samples_per_pixel == 7.0);
    double fraction = 0.0;
    assert_int_equal(weft_render_run(r, 16, 0.0, stop_at_half, &fraction), WEFT_INTERRUPTED);
    assert_true(fraction > 0.5 && fraction <= 1.0);
    weft_render_free(r);

    assert_int_equal(weft_render_create(scene, &desc, &r, NULL), WEFT_OK);
    assert_int_equal(weft_render_run(r, 1 << 28, 0.2, NULL, NULL), WEFT_OK); /* the time limit is no failure */
    assert_true(weft_render_info(r).samples_per_pixel >= 1.0);
    assert_true(weft_render_info(r).render_seconds < 5.0);
    weft_render_free(r);
    weft_scene_free(scene);
}

static void render_descriptors_without_sense_are_refused(void **state) {
    (void)state;
    WeftScene *scene = lit_scene();
    static const WeftRenderDesc wrong[] = {{.width = -1},
                                           {.width = 70000},
                                           {.height = 1, .width = 1, .crop = {0, 0, 2, 1}},
                                           {.max_depth = -2},
                                           {.threads = -1},
                                           {.sampling = (WeftSampling)7},
                                           {.background = (WeftBackground)9},
                                           {.background_color = {NAN}}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        WeftRender *r;
        WeftError error;
        assert_int_equal(weft_render_create(scene, &wrong[k], &r, &error), WEFT_USAGE);
        assert_int_equal(error.message, WEFT_MESSAGE_DESC);
        assert_null(r);
    }
    WeftRender *r;
    WeftError error;
    assert_int_equal(weft_render_create(scene, &(WeftRenderDesc){.camera = "nowhere"}, &r, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_CAMERA_NAME);
    WeftScene *empty = test_scene();
    scene_bounds(empty);
    assert_int_equal(weft_render_create(empty, &(WeftRenderDesc){0}, &r, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_SCENE_EMPTY);
    weft_scene_free(empty);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sampling_strategies_agree),
        cmocka_unit_test(sampling_strategies_agree_on_light_through_cloth),
        cmocka_unit_test(transparent_emitter_shines_less),
        cmocka_unit_test(normal_map_is_mirrored_on_the_back),
        cmocka_unit_test(normal_map_of_a_coat_leans_along_the_tangent),
        cmocka_unit_test(negative_texels_of_an_environment_count_as_zero),
        cmocka_unit_test(render_with_any_number_of_threads_is_the_same),
        cmocka_unit_test(crop_is_a_part_of_the_picture),
        cmocka_unit_test(render_runs_accumulate_and_stop),
        cmocka_unit_test(render_descriptors_without_sense_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
