/* What a renderer on the GPU owes its user: pictures with holes, glass and background as told, both kinds of
 * OpenGL alike, polygon lights as the path tracer has them; steady frames that make nothing; texts that any
 * compiler takes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>
#include <epoxy/gl.h>

#include "raster/gl.h"
#include "raster/made.h"
#include "trace/scenes.h"

#include "raster/material/shader.h"
#include "scene/light/backdrop.h"
#include "scratch.h"
#include "shading/material/choice.h"

enum { SIDE = 96 };

static WeftRaster *raster_of(const WeftScene *scene, WeftGl gl) {
    WeftRaster *raster;
    WeftError error;
    if (weft_raster_create(scene, &(WeftRasterDesc){.gl = gl, .threads = 2}, &raster, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return raster;
}

static void draw(WeftRaster *raster, const WeftRasterView *view) {
    WeftError error;
    if (weft_raster_draw(raster, view, &error) != WEFT_OK) fail_msg("%s", error.text);
}

static WeftImage picture_of(const WeftScene *scene, WeftGl gl, const WeftRasterView *view) {
    WeftImage image;
    WeftError error;
    WeftRaster *raster = raster_of(scene, gl);
    draw(raster, view);
    if (weft_raster_image(raster, &image, &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_raster_free(raster);
    return image;
}

static const float *pixel(const WeftImage *image, int x, int y) {
    return (const float *)image->pixels + 4 * ((size_t)y * (size_t)image->width + (size_t)x);
}

/* A square of one unlit colour in the left half of the picture, one behind it that fills all of it. */
static WeftScene *two_squares(WeftAlphaMode mode, float opacity) {
    WeftScene *scene = test_scene();
    Material *front = test_material(scene, 1.0f);
    front->unlit = true;
    front->alpha_mode = mode;
    front->inputs[INPUT_opacity].value[0] = opacity;
    test_quad(scene, vec3(-1.0f, -1.0f, 0.5f), vec3(1.0f, 0.0f, 0.0f), vec3(0.0f, 2.0f, 0.0f));
    test_material(scene, 0.25f)->unlit = true;
    test_quad(scene, vec3(-3.0f, -3.0f, -1.0f), vec3(6.0f, 0.0f, 0.0f), vec3(0.0f, 6.0f, 0.0f));
    scene_bounds(scene);
    test_environment(scene, 0.0f);
    return scene;
}

static const WeftRasterView front_view = {.width = SIDE, .height = SIDE, .samples = 1, .camera = "0,0,3;0,0,0;30"};

static void alpha_mode_decides_the_coverage(void **state) {
    (void)state;
    need_gl();
    const struct {
        WeftAlphaMode mode;
        float opacity, left;
    } cases[] = {{WEFT_ALPHA_OPAQUE, 0.25f, 1.0f},
                 {WEFT_ALPHA_MASK, 0.25f, 0.25f},
                 {WEFT_ALPHA_MASK, 0.75f, 1.0f},
                 {WEFT_ALPHA_BLEND, 0.25f, 0.25f + 0.25f * 0.75f}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        WeftScene *scene = two_squares(cases[k].mode, cases[k].opacity);
        WeftImage image = picture_of(scene, k % 2 ? WEFT_GL_ES : WEFT_GL_DESKTOP, &front_view);
        assert_float_equal(pixel(&image, SIDE / 4, SIDE / 2)[1], cases[k].left, 2e-3f);
        assert_float_equal(pixel(&image, 3 * SIDE / 4, SIDE / 2)[1], 0.25f, 2e-3f);
        weft_image_free(&image);
        weft_scene_free(scene);
    }
}

/* A double-sided ball under a light from above, which meets its front in the upper half and the inside of its back in the
 * lower. */
static WeftScene *lit_ball(WeftAlphaMode mode, float opacity) {
    WeftScene *scene = test_scene();
    Material *material = test_material(scene, 0.8f);
    material->alpha_mode = mode;
    material->inputs[INPUT_opacity].value[0] = opacity;
    test_ball(scene, vec3(0.0f, 0.0f, 0.0f), 0.7f, 24);
    scene->lights[scene->light_count++] = (Light){.name = "above",
                                                  .kind = LIGHT_DIRECTIONAL,
                                                  .direction = {0.0f, -0.9f, -0.436f},
                                                  .color = {1, 1, 1},
                                                  .intensity = PI_FLOAT};
    scene_bounds(scene);
    test_environment(scene, 0.0f);
    return scene;
}

/* Returns the mean of green over a square of 16 pixels on the vertical line through the middle. */
static double square_mean(const WeftImage *image, int y) {
    double sum = 0.0;
    for (int k = 0; k < 256; k++) sum += (double)pixel(image, SIDE / 2 - 8 + k % 16, y - 8 + k / 16)[1];
    return sum / 256.0;
}

static void blended_surfaces_hide_what_is_behind_them(void **state) {
    (void)state;
    need_gl();
    WeftRasterView view = front_view;
    view.background = WEFT_BACKGROUND_COLOR;
    view.no_shadows = 1;
    for (int gl = 0; gl < 2; gl++) {
        WeftScene *opaque = lit_ball(WEFT_ALPHA_OPAQUE, 1.0f), *blended = lit_ball(WEFT_ALPHA_BLEND, 1.0f);
        WeftImage expected = picture_of(opaque, (WeftGl)gl, &view), image = picture_of(blended, (WeftGl)gl, &view);
        assert_memory_equal(image.pixels, expected.pixels, (size_t)SIDE * SIDE * 4 * sizeof(float));
        weft_image_free(&image);
        weft_image_free(&expected);
        weft_scene_free(opaque);
        weft_scene_free(blended);
    }
    WeftScene *scene = lit_ball(WEFT_ALPHA_BLEND, 0.6f);
    WeftImage image = picture_of(scene, WEFT_GL_DESKTOP, &view);
    const WeftRenderDesc desc = {.width = SIDE,
                                 .height = SIDE,
                                 .max_depth = 1,
                                 .camera = front_view.camera,
                                 .background = WEFT_BACKGROUND_COLOR,
                                 .no_shadows = 1};
    WeftImage traced = test_render(scene, desc, 256);
    for (int half = 0; half < 2; half++) {
        const int y = half ? 2 * SIDE / 3 : SIDE / 3;
        double expected = square_mean(&traced, y);
        assert_true(expected > 0.05);
        assert_true(fabs(square_mean(&image, y) / expected - 1.0) < 0.02);
    }
    weft_image_free(&traced);
    weft_image_free(&image);
    weft_scene_free(scene);
}

/* One square alone: what is behind it has the alpha and the colour that were asked for. */
static void background_has_the_colour_and_alpha_of_its_kind(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = test_scene();
    test_material(scene, 0.5f)->unlit = true;
    test_quad(scene, vec3(-0.3f, -0.3f, 0.0f), vec3(0.6f, 0.0f, 0.0f), vec3(0.0f, 0.6f, 0.0f));
    scene_bounds(scene);
    test_environment(scene, 0.125f);
    WeftRasterView view = front_view;
    view.background = WEFT_BACKGROUND_TRANSPARENT;
    WeftImage image = picture_of(scene, WEFT_GL_DESKTOP, &view);
    assert_float_equal(pixel(&image, 2, 2)[3], 0.0f, 0.0f);
    assert_float_equal(pixel(&image, SIDE / 2, SIDE / 2)[3], 1.0f, 0.0f);
    assert_float_equal(pixel(&image, SIDE / 2, SIDE / 2)[0], 0.5f, 1e-3f);
    weft_image_free(&image);
    view.background = WEFT_BACKGROUND_COLOR;
    view.background_color[1] = 0.75f;
    image = picture_of(scene, WEFT_GL_ES, &view);
    assert_float_equal(pixel(&image, 2, 2)[1], 0.75f, 1e-3f);
    assert_float_equal(pixel(&image, 2, 2)[3], 1.0f, 0.0f);
    weft_image_free(&image);
    weft_scene_free(scene);
}

/* The studio out of focus: as the path tracer has it, and what backdrop.h says it is. */
static void blurred_background_is_smooth(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = test_scene();
    WeftImage traced, blurred;
    WeftRender *render;
    WeftError error;
    test_material(scene, 0.5f)->unlit = true;
    test_quad(scene, vec3(-0.1f, -0.1f, 0.0f), vec3(0.2f, 0.0f, 0.0f), vec3(0.0f, 0.2f, 0.0f));
    scene_bounds(scene);
    assert_int_equal(weft_scene_set_environment_studio(scene, &error), WEFT_OK);
    assert_int_equal(weft_scene_set_environment_placement(scene, 70.0f, 0.5f, &error), WEFT_OK);
    WeftRasterView view = front_view;
    view.background = WEFT_BACKGROUND_BLURRED;
    WeftImage drawn = picture_of(scene, WEFT_GL_DESKTOP, &view);
    const WeftRenderDesc desc = {.width = SIDE,
                                 .height = SIDE,
                                 .camera = front_view.camera,
                                 .pixel_centre = 1,
                                 .background = WEFT_BACKGROUND_BLURRED};
    assert_int_equal(weft_render_create(scene, &desc, &render, &error), WEFT_OK);
    assert_int_equal(weft_render_run(render, 1, 0.0, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_render_image(render, &traced, &error), WEFT_OK);
    weft_render_free(render);
    float most = 0.0f, least = 1e9f;
    for (int y = 0; y < SIDE; y += 5)
        for (int x = 0; x < SIDE; x += 5) {
            int dx = x - SIDE / 2, dy = y - SIDE / 2;
            if (dx * dx + dy * dy < SIDE * SIDE / 32) continue; /* the square */
            float value = pixel(&drawn, x, y)[1];
            assert_float_equal(value, pixel(&traced, x, y)[1], 2e-3f);
            most = value > most ? value : most, least = value < least ? value : least;
        }
    assert_true(most > 1.02f * least);
    assert_int_equal(backdrop_blurred(&scene->environment, &blurred, &error), WEFT_OK);
    const float *p = scene->environment.image.pixels, *q = blurred.pixels;
    float sharp = 0.0f, soft = 0.0f;
    for (int k = 0; k < 3 * scene->environment.image.width * scene->environment.image.height; k++)
        sharp = p[k] > sharp ? p[k] : sharp;
    for (int k = 0; k < 3 * blurred.width * blurred.height; k++) soft = q[k] > soft ? q[k] : soft;
    assert_true(soft < 0.999f * sharp && soft > 0.5f * sharp); /* soft boxes are wider than the blur */
    weft_image_free(&blurred);
    weft_image_free(&traced);
    weft_image_free(&drawn);
    weft_scene_free(scene);
}

/* Row 0 is the top and column 0 the left, as in every image. */
static void picture_is_upright(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = test_scene();
    test_material(scene, 0.5f)->unlit = true;
    test_quad(scene, vec3(-0.7f, 0.2f, 0.0f), vec3(0.3f, 0.0f, 0.0f), vec3(0.0f, 0.4f, 0.0f));
    scene_bounds(scene);
    WeftRasterView view = front_view;
    view.background = WEFT_BACKGROUND_TRANSPARENT;
    WeftImage image = picture_of(scene, WEFT_GL_DESKTOP, &view);
    assert_float_equal(pixel(&image, SIDE / 5, SIDE / 4)[3], 1.0f, 0.0f);
    assert_float_equal(pixel(&image, SIDE / 5, 3 * SIDE / 4)[3], 0.0f, 0.0f);
    assert_float_equal(pixel(&image, 4 * SIDE / 5, SIDE / 4)[3], 0.0f, 0.0f);
    weft_image_free(&image);
    weft_scene_free(scene);
}

/* A sphere and a floor under a quad that shines, without shadows. */
static WeftScene *under_a_lamp(void) {
    WeftScene *scene = test_scene();
    Material *ball = test_material(scene, 0.4f);
    test_color(ball, INPUT_sheen_color, 0.6f);
    ball->inputs[INPUT_sheen_roughness].value[0] = 0.5f;
    ball->inputs[INPUT_specular].value[0] = 1.0f;
    test_sphere(scene, vec3(0.0f, 0.0f, 0.0f), 0.5f);
    test_material(scene, 0.5f);
    test_quad(scene, vec3(-2.0f, -0.5f, 2.0f), vec3(4.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -4.0f));
    Material *lamp = test_material(scene, 0.0f);
    lamp->double_sided = false;
    test_color(lamp, INPUT_emission, 5.0f);
    test_quad(scene, vec3(-0.9f, 1.2f, -0.5f), vec3(0.8f, 0.0f, 0.0f), vec3(0.0f, 0.3f, 0.9f));
    scene_bounds(scene);
    test_environment(scene, 0.0f);
    return scene;
}

static void polygon_light_agrees_with_the_path_tracer(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = under_a_lamp();
    WeftRasterView view = {.width = SIDE,
                           .height = SIDE,
                           .samples = 1,
                           .camera = "0,0.9,3;0,0,0;32",
                           .background = WEFT_BACKGROUND_COLOR,
                           .no_shadows = 1};
    WeftImage image = picture_of(scene, WEFT_GL_DESKTOP, &view), reference;
    WeftRender *render;
    WeftError error;
    WeftRenderDesc desc = {.width = SIDE,
                           .height = SIDE,
                           .max_depth = 1,
                           .camera = view.camera,
                           .background = WEFT_BACKGROUND_COLOR,
                           .sampling = WEFT_SAMPLING_LIGHT,
                           .pixel_centre = 1,
                           .no_shadows = 1,
                           .no_roulette = 1};
    assert_int_equal(weft_render_create(scene, &desc, &render, &error), WEFT_OK);
    assert_int_equal(weft_render_run(render, 256, 0.0, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_render_image(render, &reference, &error), WEFT_OK);
    weft_render_free(render);
    double off = 0.0, sum = 0.0;
    const float *a = image.pixels, *b = reference.pixels;
    for (int k = 0; k < SIDE * SIDE; k++)
        for (int c = 0; c < 3; c++) {
            double x = (double)a[4 * k + c], y = (double)b[4 * k + c];
            assert_true(isfinite(x) && x >= 0.0);
            if (y > 4.0) continue; /* the lamp itself */
            off += fabs(x - y);
            sum += y;
        }
    print_message("polygon light: %.2f %% from the path tracer, noise and outlines among it\n", 100.0 * off / sum);
    assert_true(sum > 100.0);
    assert_true(off < 0.04 * sum);
    weft_image_free(&image);
    weft_image_free(&reference);
    weft_scene_free(scene);
}

/* Draws frames under a camera that moves, each with so many pixels along the side of a shading point. */
static void draw_steady_frames(int rate) {
    WeftScene *scene = under_a_lamp();
    WeftError error;
    const WeftLight light = {.direction = {0.0f, -1.0f, -0.5f}, .color = {1.0f, 1.0f, 1.0f}};
    assert_int_equal(weft_scene_add_light(scene, &light, &error), WEFT_OK);
    WeftRaster *raster = raster_of(scene, WEFT_GL_DESKTOP);
    WeftRasterView moving = front_view;
    moving.shading_rate = rate;
    COUNTED(COUNT)
    draw(raster, &moving);
    int first = made;
    made = 0;
    for (int k = 0; k < 20; k++) {
        char camera[64];
        snprintf(camera, sizeof camera, "%g,0.5,3;0,0,0;30", 0.1 * k);
        WeftRasterView view = moving;
        view.camera = camera;
        draw(raster, &view);
    }
    COUNTED(STOP_COUNTING)
    assert_true(first > 3); /* the first picture made its target and programs: the counters count */
    assert_int_equal(made, 0);
    assert_true(weft_raster_info(raster).samplers <= 16);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

static void steady_frames_create_no_objects(void **state) {
    (void)state;
    need_gl();
    draw_steady_frames(1);
    draw_steady_frames(3);
}

static void steady_frames_of_a_sum_create_no_objects(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = under_a_lamp();
    WeftRaster *raster = raster_of(scene, WEFT_GL_DESKTOP);
    WeftError error;
    int done = 0;
    WeftRasterView view = front_view;
    view.samples = 4;
    draw(raster, &view);
    COUNTED(COUNT)
    made = 0;
    assert_int_equal(weft_raster_accumulate_begin(raster, &view, 6, &error), WEFT_OK);
    while (done < 1) assert_int_equal(weft_raster_accumulate(raster, 0.0, &done, &error), WEFT_OK);
    const int first = made;
    made = 0;
    while (done < 6) assert_int_equal(weft_raster_accumulate(raster, 0.0, &done, &error), WEFT_OK);
    COUNTED(STOP_COUNTING)
    assert_true(first > 3);
    assert_int_equal(made, 0);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

static void raster_descriptors_without_sense_are_refused(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = two_squares(WEFT_ALPHA_OPAQUE, 1.0f);
    WeftRaster *raster = raster_of(scene, WEFT_GL_DESKTOP), *none;
    WeftError error;
    WeftImage image;
    const WeftRasterView wrong[] = {{.width = -1}, {.height = 100000}, {.samples = -4}, {.background = 77}};
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++)
        assert_int_equal(weft_raster_draw(raster, &wrong[k], &error), WEFT_USAGE);
    assert_int_equal(weft_raster_draw(raster, &(WeftRasterView){.camera = "nobody"}, &error), WEFT_USAGE);
    assert_int_equal(weft_raster_image(raster, &image, &error), WEFT_USAGE); /* nothing was drawn */
    assert_int_equal(weft_raster_create(scene, &(WeftRasterDesc){.gl = 9}, &none, NULL, &error), WEFT_USAGE);
    assert_null(none);
    weft_raster_free(raster);
    weft_raster_free(NULL);
    weft_scene_free(scene);
    scene = test_scene();
    assert_int_equal(weft_raster_create(scene, &(WeftRasterDesc){0}, &none, NULL, &error), WEFT_INPUT);
    weft_scene_free(scene);
}

/* Whole shaders, of every workflow, profile and sheen, with all kinds of light, by a compiler that knows
 * these versions and nothing newer. */
static Fits fits;

static void put_shader(const char *folder, int number, const ShaderKey *key, TextLanguage language) {
    char path[96];
    Text text;
    WeftError error;
    shader_text(key, &(TextDesc){.language = language, .tables = true}, &fits, &text);
    if (text_end(&text, &error) != WEFT_OK) fail_msg("%s", error.text);
    snprintf(path, sizeof path, "%s/%03d-%d.frag", folder, number, (int)language);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_true(fputs(text.bytes, stream) >= 0);
    assert_int_equal(fclose(stream), 0);
    text_free(&text);
}

static ShaderKey whole_key(void) {
    ShaderKey key;
    memset(&key, 0, sizeof key);
    key.choices = choices_unmade();
    for (int k = 0; k < INPUT_COUNT; k++) key.inputs[k].like = -1;
    key.inputs[INPUT_base_color].state = key.inputs[INPUT_normal].state = INPUT_MAP;
    key.inputs[INPUT_normal].slot = 1;
    key.shadowed = key.lights = key.colored = key.ambient = 1;
    key.polygons = 3;
    for (int k = 0; k < 3; k++) key.polygon_corners[k] = (int16_t)(k < 2 ? 4 : 8);
    key.light_kind[0] = 2;
    return key;
}

static void shaders_compile_as_their_version(void **state) {
    (void)state;
    if (system("command -v glslangValidator >/dev/null 2>&1") != 0) {
        print_message("glslangValidator is not installed\n");
        skip();
    }
    char folder[SCRATCH_SIZE], command[256];
    assert_true(scratch_make(folder));
    static const ChoiceId kinds[] = {CHOICE_workflow, CHOICE_profile, CHOICE_sheen_lobe};
    bool all = getenv("WEFT_TEST_LONG") != NULL;
    int number = 0;
    for (size_t kind = 0; kind < sizeof kinds / sizeof kinds[0]; kind++)
        for (int k = 0; choice_id(kinds[kind], k); k += all ? 1 : 3) {
            ShaderKey key = whole_key();
            if (kinds[kind] == CHOICE_sheen_lobe && weft_lobe_info(k)->traits & WEFT_LOBE_REFERENCE) continue;
            if (kinds[kind] == CHOICE_workflow) key.choices.workflow = k;
            if (kinds[kind] == CHOICE_profile) key.choices.profile = k;
            if (kinds[kind] == CHOICE_sheen_lobe) key.choices.sheen_lobe = k;
            put_shader(folder, number, &key, TEXT_GLSL_330);
            put_shader(folder, number++, &key, TEXT_GLSL_ES_300);
        }
    snprintf(command, sizeof command,
             "cd %s && s=0; for f in *.frag; do glslangValidator -S frag $f >log 2>&1 || { s=1; echo $f; grep -v "
             "'^$' log | head -5; }; done; exit $s",
             folder);
    int status = system(command);
    assert_true(scratch_remove(folder));
    fits_destroy(&fits);
    assert_int_equal(status, 0);
}

/* The facets of a coarse ball do not shade themselves where its smooth surface faces a grazing sun. */
static void facets_at_the_terminator_are_not_black(void **state) {
    (void)state;
    need_gl();
    for (uint32_t rings = 6; rings <= 24; rings *= 2) {
        WeftScene *scene = test_grazed_ball(rings, 1.0f, 0.0f);
        const WeftRasterView view = {.width = SIDE, .height = SIDE, .samples = 1, .camera = "0,0,10;0,0,0;8"};
        WeftImage image = picture_of(scene, WEFT_GL_DESKTOP, &view);
        WeftImage traced = test_render(
            scene,
            (WeftRenderDesc){.width = SIDE, .height = SIDE, .camera = view.camera, .max_depth = 1, .pixel_centre = 1},
            1);
        double off = 0.0, sum = 0.0;
        int black = 0, lit = 0;
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                const float a = pixel(&image, x, y)[1], b = pixel(&traced, x, y)[1];
                off += fabs((double)(a - b));
                sum += (double)b;
                lit += b > 0.01f;
                black += b > 0.01f && a <= 0.0f;
            }
        print_message("%u rings: %d of %d lit pixels black, %.2f %% off\n", (unsigned)rings, black, lit,
                      100.0 * off / sum);
        assert_true(lit > 1000 && black < lit / 200 && off < 0.02 * sum);
        weft_image_free(&image);
        weft_image_free(&traced);
        weft_scene_free(scene);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(alpha_mode_decides_the_coverage),
                                       cmocka_unit_test(blended_surfaces_hide_what_is_behind_them),
                                       cmocka_unit_test(background_has_the_colour_and_alpha_of_its_kind),
                                       cmocka_unit_test(blurred_background_is_smooth),
                                       cmocka_unit_test(picture_is_upright),
                                       cmocka_unit_test(facets_at_the_terminator_are_not_black),
                                       cmocka_unit_test(polygon_light_agrees_with_the_path_tracer),
                                       cmocka_unit_test(steady_frames_create_no_objects),
                                       cmocka_unit_test(steady_frames_of_a_sum_create_no_objects),
                                       cmocka_unit_test(raster_descriptors_without_sense_are_refused),
                                       cmocka_unit_test(shaders_compile_as_their_version)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
