/* A measurement as a material: the path tracer reflects by its table, whichever format, azimuth and strategy of
 * sampling; a material file keeps its name; names of no measurement are refused. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "brdf/merl.h"
#include "brdf/utia.h"
#include "scenes.h"
#include "scratch.h"
#include "weft/weft.h"

static char folder[SCRATCH_SIZE];

static void rgl_file(const char *id, const char *path) {
    WeftLobe lobe;
    WeftReflection *of;
    WeftError error;
    const WeftBsdfDesc desc = {.thetas = 12, .phis = 9, .side = 24};
    assert_int_equal(weft_lobe_init(id, &lobe, &error), WEFT_OK);
    lobe.f0[1] = 0.5f, lobe.f90[0] = 0.3f;
    assert_int_equal(weft_reflection_of_lobe(&lobe, &of, &error), WEFT_OK);
    if (weft_reflection_write(of, path, &desc, &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_reflection_free(of);
}

/* So many numbers, alike in each of three channels, behind a header. */
static void even_file(const char *path, const int32_t *header, size_t headers, size_t count, const double channel[3]) {
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    if (headers) fwrite(header, sizeof *header, headers, stream);
    for (int c = 0; c < 3; c++)
        for (size_t k = 0; k < count; k++) fwrite(&channel[c], sizeof channel[c], 1, stream);
    assert_int_equal(fclose(stream), 0);
}

static void files_make(void) {
    const int32_t shape[3] = {MERL_THETA_H, MERL_THETA_D, MERL_PHI_D};
    rgl_file("threads", "threads.bsdf");
    rgl_file("charlie-neubelt", "charlie.bsdf");
    even_file("even.binary", shape, 3, MERL_BINS, (const double[]){150.0, 120.0, 30.0});
    even_file("even.bin", NULL, 0, (size_t)UTIA_SIDE * UTIA_SIDE, (const double[]){0.2, 0.1, 0.05});
}
static const char *const files[] = {"threads.bsdf", "charlie.bsdf", "even.binary", "even.bin"};
enum { FILES = sizeof files / sizeof *files };

/* A square in the plane y = 0 whose tangent is x and bitangent -z. Its own colour is that of the lobes beside. */
static WeftScene *square_of(const char *path, float color) {
    WeftScene *scene = test_scene();
    WeftError error;
    test_material(scene, color);
    (void)test_sheet(scene, vec3(-1, 0, 1), vec3(2, 0, 0), vec3(0, 0, -2));
    scene_bounds(scene);
    test_environment(scene, 0.0f);
    if (weft_scene_put_measured(scene, 0, path, &error) != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

/* The mean of a few pixels in the middle, seen from far along a direction, local to the square. */
static void seen(const WeftScene *scene, const float wo[3], WeftSampling sampling, int spp, double mean[3]) {
    char camera[96];
    snprintf(camera, sizeof camera, "%g,%g,%g;0,0,0;0.3", 100.0 * (double)wo[0], 100.0 * (double)wo[2],
             -100.0 * (double)wo[1]);
    WeftImage image = test_render(scene,
                                  (WeftRenderDesc){.width = 8,
                                                   .height = 8,
                                                   .camera = camera,
                                                   .max_depth = 1,
                                                   .sampling = sampling,
                                                   .background = WEFT_BACKGROUND_TRANSPARENT},
                                  spp);
    const float *pixels = image.pixels;
    for (int c = 0; c < 3; c++) {
        mean[c] = 0.0;
        for (int k = 0; k < 64; k++) mean[c] += (double)pixels[4 * k + c] / 64.0;
    }
    weft_image_free(&image);
}

static WeftReflection *read_back(const char *path) {
    WeftReflection *of;
    WeftError error;
    if (weft_reflection_read(path, &of, &error) != WEFT_OK) fail_msg("%s", error.text);
    return of;
}

/* Under a sun, a pixel is f cos_i times what that sends; directions turn about the normal. */
static void a_sun_shows_f(void **state) {
    (void)state;
    for (int n = 0; n < FILES; n++) {
        WeftReflection *of = read_back(files[n]);
        for (int turn = 0; turn < 4; turn++) {
            const float phi = 0.3f + 1.4f * (float)turn, psi = phi + 2.2f;
            const float wo[3] = {0.6f * cosf(phi), 0.6f * sinf(phi), 0.8f},
                        wi[1][3] = {{0.5f * cosf(psi), 0.5f * sinf(psi), 0.8660254f}};
            float f[1][3];
            double mean[3];
            weft_reflection_eval(of, WEFT_PART_ALL, wo, 1, wi, f);
            WeftScene *scene = square_of(files[n], 0.9f);
            const WeftLight sun = {.direction = {-wi[0][0], -wi[0][2], wi[0][1]}, .color = {2.0f, 2.0f, 2.0f}};
            assert_int_equal(weft_scene_add_light(scene, &sun, NULL), WEFT_OK);
            seen(scene, wo, WEFT_SAMPLING_MIS, 4, mean);
            for (int c = 0; c < 3; c++) {
                const double due = 2.0 * (double)f[0][c] * (double)wi[0][2];
                if (!(fabs(mean[c] - due) <= 0.01 * due + 1e-5))
                    fail_msg("%s, turn %d: %g, not %g", files[n], turn, mean[c], due);
            }
            weft_scene_free(scene);
        }
        weft_reflection_free(of);
    }
}

/* Under an even sky it is E, however light is found, and whatever the lobes beside it are. */
static void an_even_sky_shows_e(void **state) {
    (void)state;
    static const WeftSampling all[] = {WEFT_SAMPLING_MIS, WEFT_SAMPLING_LIGHT, WEFT_SAMPLING_LOBE};
    for (int n = 0; n < FILES; n++) {
        WeftReflection *of = read_back(files[n]);
        const float wo[3] = {0.6f, 0.0f, 0.8f};
        float e[3];
        weft_reflection_albedo(of, WEFT_PART_ALL, wo[2], e);
        for (int k = 0; k < 6; k++) {
            double mean[3];
            WeftScene *scene = square_of(files[n], k < 3 ? 0.8f : 0.0f);
            test_environment(scene, 1.0f);
            seen(scene, wo, all[k % 3], 400, mean);
            for (int c = 0; c < 3; c++)
                if (!(fabs(mean[c] - (double)e[c]) <= 0.02 * (double)e[c] + 1e-4))
                    fail_msg("%s, way %d: %g, not %g", files[n], k, mean[c], (double)e[c]);
            weft_scene_free(scene);
        }
        weft_reflection_free(of);
    }
}

/* Its light counts as reflection where the sky's parts are scaled. */
static void parts_of_the_sky_scale_it(void **state) {
    (void)state;
    const float wo[3] = {0.6f, 0.0f, 0.8f};
    double mean[2][3];
    WeftScene *scene = square_of("even.bin", 0.8f);
    test_environment(scene, 1.0f);
    seen(scene, wo, WEFT_SAMPLING_MIS, 16, mean[0]);
    assert_int_equal(weft_scene_set_environment_parts(scene, 0.0f, 0.5f, NULL), WEFT_OK);
    seen(scene, wo, WEFT_SAMPLING_MIS, 16, mean[1]);
    for (int c = 0; c < 3; c++) assert_true(fabs(mean[1][c] - 0.5 * mean[0][c]) < 1e-5);
    weft_scene_free(scene);
}

static void file_text(const char *path, const char *text) {
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    fputs(text, stream);
    assert_int_equal(fclose(stream), 0);
}

/* A material file names a measurement beside it; saved again, from elsewhere, it still does. A scene reads it once. */
static void material_files_keep_it(void **state) {
    (void)state;
    WeftError error;
    WeftScene *scene = square_of("even.bin", 0.5f);
    file_text("cloth.json", "{\"base_color\": 0.3, \"measured\": \"charlie.bsdf\"}");
    for (int k = 0; k < 2; k++) {
        if (weft_scene_assign_material(scene, "matt", "cloth.json", NULL, &error) != WEFT_OK)
            fail_msg("%s", error.text);
        assert_int_equal(scene->measured_count, 2);
        assert_int_equal(scene->materials[0].measured, 2);
    }
    assert_int_equal(mkdir("else", 0777), 0);
    assert_int_equal(weft_scene_save_material(scene, 0, "else/saved.json", &error), WEFT_OK);
    assert_int_equal(weft_scene_put_measured(scene, 0, "even.bin", &error), WEFT_OK);
    assert_int_equal(scene->materials[0].measured, 1);
    if (weft_scene_assign_material(scene, "matt", "else/saved.json", NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    assert_int_equal(scene->materials[0].measured, 2);
    assert_int_equal(scene->measured_count, 2);
    weft_scene_free(scene);
}

static void refused(const char *text, const char *words) {
    WeftError error;
    WeftScene *scene = square_of("even.bin", 0.5f);
    file_text("bad.json", text);
    const WeftResult result = weft_scene_assign_material(scene, "matt", "bad.json", NULL, &error);
    assert_true(result == WEFT_INPUT || result == WEFT_RESOURCES);
    if (!strstr(error.text, words)) fail_msg("%s: not \"%s\"", error.text, words);
    assert_int_equal(scene->materials[0].measured, 1);
    weft_scene_free(scene);
}

static void bad_names_are_refused(void **state) {
    (void)state;
    WeftError error;
    file_text("short.bsdf", "tensor_file");
    refused("{\"measured\": 3}", "expected the name of a file");
    refused("{\"measured\": \"\"}", "expected the name of a file");
    refused("{\"measured\": \"cloth.json\"}", "ends with none of");
    refused("{\"measured\": \"none.bsdf\"}", "none.bsdf");
    refused("{\"measured\": \"short.bsdf\"}", "RGL's format");
    WeftScene *scene = square_of("even.bin", 0.5f);
    const char text[] = "{\"measured\": \"even.bin\"}";
    assert_int_equal(weft_scene_assign_material_memory(scene, "matt", text, sizeof text - 1, "text", NULL, &error),
                     WEFT_INPUT);
    assert_non_null(strstr(error.text, "only by a material in a file"));
    WeftMaterial material = scene->materials[0];
    material.measured = 7;
    assert_int_equal(weft_scene_put_material(scene, 0, &material, &error), WEFT_USAGE);
    weft_scene_free(scene);
}

static int begin(void **state) {
    (void)state;
    if (!scratch_enter(folder)) return 1;
    files_make();
    return 0;
}
static int end(void **state) {
    (void)state;
    return chdir("/") == 0 && scratch_remove(folder) ? 0 : 1;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sun_shows_f),
        cmocka_unit_test(an_even_sky_shows_e),
        cmocka_unit_test(parts_of_the_sky_scale_it),
        cmocka_unit_test(material_files_keep_it),
        cmocka_unit_test(bad_names_are_refused),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
