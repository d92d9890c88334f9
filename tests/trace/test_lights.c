/* Every light's samples, radiance and pdf agree, and are where the conventions say. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/pi.h"
#include "base/random.h"
#include "scenes.h"
#include "trace/light/lights.h"

#undef sin /* of the dialect, which is single precision */
#undef cos

static WeftImage map(int width, int height) {
    WeftImage image;
    assert_int_equal(weft_image_create(width, height, 3, WEFT_PIXEL_F32, &image, NULL), WEFT_OK);
    return image;
}

static void set_map(WeftScene *scene, WeftImage image) {
    weft_image_free(&scene->environment.image);
    scene->environment.image = image;
    scene->environment.kind = ENVIRONMENT_IMAGE;
}

static Lights *build(WeftScene *scene) {
    Lights *lights = NULL;
    scene_bounds(scene);
    assert_int_equal(lights_create(scene, &lights, NULL), WEFT_OK);
    return lights;
}

/* Row 0 is +y, the middle column is -z, columns run towards +x; rotation is counter-clockwise seen from
 * above. */
static void environment_has_the_stated_orientation(void **state) {
    (void)state;
    WeftScene *scene = test_scene();
    WeftImage image = map(8, 5);
    for (int k = 0; k < 8 * 5; k++) ((float *)image.pixels)[3 * k] = (float)k;
    set_map(scene, image);
    static const struct {
        Vec3 direction;
        float column, row; /* in texels, as texture coordinates times the size */
    } cases[] = {{{0, 0, -1}, 4.0f, 2.5f},
                 {{1, 0, 0}, 6.0f, 2.5f},
                 {{-1, 0, 0}, 2.0f, 2.5f},
                 {{0, 0.9999f, 0.0141f}, 0.0f, 0.0f}};
    for (int turn = 0; turn < 2; turn++) {
        scene->environment.rotation = turn ? 1.57079633f : 0.0f;
        Lights *lights = build(scene);
        for (int k = 0; k < 3; k++) {
            Vec3 d = cases[k].direction;
            if (turn) d = vec3(d.z, d.y, -d.x); /* a quarter turn counter-clockwise about +y */
            float found = lights_environment(lights, d).radiance.r;
            float expected = 8.0f * 2.0f + cases[k].column - 0.5f; /* bilinear between columns of row 2 */
            assert_true(fabsf(found - expected) < 1e-3f);
        }
        assert_true(lights_environment(lights, vec3(0, 1, 0)).radiance.r < 8.0f);
        assert_true(lights_environment(lights, vec3(0, -1, 0)).radiance.r >= 32.0f);
        lights_free(lights);
    }
    weft_scene_free(scene);
}

/* Samples of the environment: radiance and pdf are those of the direction; the mean of radiance / pdf is the
 * integral. */
static void environment_samples_agree_with_its_pdf(void **state) {
    (void)state;
    WeftScene *scene = test_scene();
    WeftImage image = map(96, 48);
    double integral = 0.0;
    for (int y = 0; y < 48; y++)
        for (int x = 0; x < 96; x++) {
            float value = 0.1f + (x > 60 && x < 64 && y > 10 && y < 15 ? 50.0f : 0.0f) +
                          0.3f * unit_float(hash32((uint32_t)(y * 96 + x)));
            for (int c = 0; c < 3; c++) ((float *)image.pixels)[3 * (96 * y + x) + c] = value;
            double top = PI_DOUBLE * y / 48, bottom = PI_DOUBLE * (y + 1) / 48;
            integral += (double)value * (cos(top) - cos(bottom)) * 2.0 * PI_DOUBLE / 96;
        }
    set_map(scene, image);
    Lights *lights = build(scene);
    enum { N = 40000 };
    double sum = 0.0, total_pdf = 0.0;
    for (uint32_t k = 0; k < N; k++) {
        LightSample s = lights_sample(lights, LIGHTS_SKY, vec3(0, 0, 0), vec3(0, 1, 0), unit_float(hash32(3 * k)),
                                      unit_float(hash32(3 * k + 1)));
        assert_true(s.pdf > 0.0f && fabsf(vec3_length(s.wi) - 1.0f) < 1e-4f);
        float pdf = lights_environment(lights, s.wi).pdf;
        if (fabsf(pdf - s.pdf) > 0.02f * s.pdf) total_pdf += 1.0; /* may differ on cell edges only */
        sum += (double)(s.radiance.r / s.pdf);
    }
    assert_true(total_pdf < 0.005 * N);
    assert_true(fabs(sum / N / integral - 1.0) < 0.02);
    double mass = 0.0; /* the pdf integrates to 1 */
    for (uint32_t k = 0; k < N; k++) {
        float z = 1.0f - 2.0f * unit_float(hash32(7 * k + 1)), phi = 6.2831853f * unit_float(hash32(7 * k + 5)),
              r = sqrtf(1.0f - z * z);
        mass += (double)lights_environment(lights, vec3(r * cosf(phi), z, r * sinf(phi))).pdf * 4.0 * PI_DOUBLE / N;
    }
    assert_true(fabs(mass - 1.0) < 0.08);
    lights_free(lights);
    weft_scene_free(scene);
}

/* A lamp over a point: the mean of radiance / pdf is radiance times solid angle (closed form of a centred
 * square). */
static void emitters_subtend_their_solid_angle(void **state) {
    (void)state;
    WeftScene *scene = test_scene();
    test_environment(scene, 0.0f);
    Material *lamp = test_material(scene, 0.0f);
    lamp->double_sided = false;
    test_color(lamp, INPUT_emission, 2.0f);
    test_quad(scene, vec3(-0.5f, 1, -0.5f), vec3(1, 0, 0), vec3(0, 0, 1)); /* faces down */
    Lights *lights = build(scene);
    enum { N = 1 << 14 };
    double sum = 0.0;
    for (uint32_t k = 0; k < N; k++) {
        LightSample s = lights_sample(lights, LIGHTS_EMITTERS, vec3(0, 0, 0), vec3(0, 1, 0), unit_float(hash32(3 * k)),
                                      unit_float(hash32(3 * k + 1)));
        assert_true(s.pdf > 0.0f && s.distance >= 0.999f && s.distance < 1.3f && !s.punctual);
        sum += (double)(s.radiance.r / s.pdf) / N;
    }
    double expected = 2.0 * 4.0 * asin(0.25 / 1.25); /* 4 asin(a^2 / (a^2 + h^2)) with a = 1/2, h = 1 */
    assert_true(fabs(sum / expected - 1.0) < 0.01);
    LightSample above = lights_sample(lights, LIGHTS_EMITTERS, vec3(0, 2, 0), vec3(0, -1, 0), 0.3f, 0.4f);
    assert_true(!(above.pdf > 0.0f) || above.radiance.r <= 0.0f); /* nothing from its back */
    lights_free(lights);
    weft_scene_free(scene);
}

static void punctual_lights_follow_their_extension(void **state) {
    (void)state;
    WeftScene *scene = test_scene();
    test_environment(scene, 0.0f);
    scene->lights[0] =
        (Light){.name = "p", .kind = LIGHT_POINT, .position = {0, 2, 0}, .color = {1, 0.5f, 0}, .intensity = 8.0f};
    scene->light_count = 1;
    Lights *lights = build(scene);
    LightSample s = lights_sample(lights, LIGHTS_PUNCTUAL, vec3(0, 0, 0), vec3(0, 1, 0), 0.1f, 0.2f);
    assert_true(s.punctual && fabsf(s.pdf - 1.0f) < 1e-6f && fabsf(s.distance - 2.0f) < 1e-6f);
    assert_true(fabsf(s.radiance.r - 2.0f) < 1e-5f && fabsf(s.radiance.g - 1.0f) < 1e-5f); /* I / d^2 */
    lights_free(lights);

    scene->lights[0].range = 4.0f; /* window (1 - (d / range)^4) */
    lights = build(scene);
    s = lights_sample(lights, LIGHTS_PUNCTUAL, vec3(0, 0, 0), vec3(0, 1, 0), 0.1f, 0.2f);
    assert_true(fabsf(s.radiance.r - 2.0f * (1.0f - 1.0f / 16.0f)) < 1e-5f);
    s = lights_sample(lights, LIGHTS_PUNCTUAL, vec3(0, -3, 0), vec3(0, 1, 0), 0.1f, 0.2f);
    assert_true(s.radiance.r == 0.0f);
    lights_free(lights);

    scene->lights[0] = (Light){.name = "s",
                               .kind = LIGHT_SPOT,
                               .position = {0, 1, 0},
                               .direction = {0, -1, 0},
                               .color = {1, 1, 1},
                               .intensity = 1.0f,
                               .cos_inner = cosf(0.2f),
                               .cos_outer = cosf(0.6f)};
    lights = build(scene);
    assert_true(fabsf(lights_sample(lights, LIGHTS_PUNCTUAL, vec3(0, 0, 0), vec3(0, 1, 0), 0, 0).radiance.r - 1.0f) <
                1e-5f);
    assert_true(lights_sample(lights, LIGHTS_PUNCTUAL, vec3(tanf(0.7f), 0, 0), vec3(0, 1, 0), 0, 0).radiance.r == 0.0f);
    float between = lights_sample(lights, LIGHTS_PUNCTUAL, vec3(tanf(0.4f), 0, 0), vec3(0, 1, 0), 0, 0).radiance.r *
                    (1.0f + tanf(0.4f) * tanf(0.4f));
    assert_true(between > 0.1f && between < 0.9f);
    lights_free(lights);
    weft_scene_free(scene);
}

static void scene_without_light_gives_no_sample(void **state) {
    (void)state;
    WeftScene *scene = test_scene();
    test_environment(scene, 0.0f);
    test_material(scene, 0.5f);
    test_quad(scene, vec3(-1, 0, -1), vec3(2, 0, 0), vec3(0, 0, 2));
    Lights *lights = build(scene);
    for (int g = 0; g < LIGHT_GROUPS; g++) assert_false(lights_has_group(lights, (LightGroup)g));
    assert_true(lights_environment(lights, vec3(0, 1, 0)).pdf <= 0.0f);
    lights_free(lights);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(environment_has_the_stated_orientation),
        cmocka_unit_test(environment_samples_agree_with_its_pdf),
        cmocka_unit_test(emitters_subtend_their_solid_angle),
        cmocka_unit_test(punctual_lights_follow_their_extension),
        cmocka_unit_test(scene_without_light_gives_no_sample),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
