/* Sums of frames converge to the path tracer's direct light: pixels and means over 8 x 8 pixels, of balls under an
 * environment, a polygon and punctual lights; and what a caller sees of a sum
 *
 * Labels: slow unsanitized */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/steady_clock.h"
#include "raster/sums.h"

enum { FRAMES = 256, SPP = 2048 };

static const WeftRasterView view = {
    .width = WIDTH, .height = HEIGHT, .camera = "0,1.3,3.4;0,0.1,0;26", .background = WEFT_BACKGROUND_TRANSPARENT};

/* A ball of material 0 and a smaller, glossy one on a floor. */
static WeftScene *balls(void) {
    WeftScene *scene = test_scene();
    test_environment(scene, 0.0f);
    Material *ball = test_material(scene, 0.4f);
    ball->inputs[INPUT_specular].value[0] = 1.0f;
    test_ball(scene, vec3(-0.3f, 0.0f, 0.0f), 0.5f, 24);
    Material *metal = test_material(scene, 0.8f);
    metal->inputs[INPUT_metallic].value[0] = 1.0f;
    metal->inputs[INPUT_roughness].value[0] = 0.25f;
    test_ball(scene, vec3(0.5f, -0.2f, 0.3f), 0.3f, 24);
    test_material(scene, 0.5f);
    test_quad(scene, vec3(-2.0f, -0.5f, 2.0f), vec3(4.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -4.0f));
    scene_bounds(scene);
    return scene;
}

static void under_a_studio(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = balls();
    assert_int_equal(weft_scene_set_environment_studio(scene, NULL), WEFT_OK);
    agrees(scene, &view, FRAMES, SPP, "studio", 0.025, 0.005);
    /* Factors on the sky count where they are alike too. */
    scene = balls();
    assert_int_equal(weft_scene_set_environment_studio(scene, NULL), WEFT_OK);
    assert_int_equal(weft_scene_set_environment_parts(scene, 0.5f, 0.5f, NULL), WEFT_OK);
    agrees(scene, &view, 64, SPP, "studio, halved", 0.05, 0.01);
}

static void under_a_polygon(void **state) {
    (void)state;
    need_gl();
    static const WeftLight panel = {.kind = WEFT_LIGHT_POLYGON,
                                    .position = {-0.9f, 1.4f, 0.4f},
                                    .direction = {0.5f, -1.0f, -0.2f},
                                    .color = {6.0f, 5.0f, 4.0f},
                                    .size = {0.9f, 0.7f}};
    WeftScene *scene = balls();
    assert_int_equal(weft_scene_add_light(scene, &panel, NULL), WEFT_OK);
    agrees(scene, &view, FRAMES, SPP, "polygon", 0.02, 0.005);
}

static void under_punctual_lights(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = balls();
    static const Light lights[] = {{.name = "sun",
                                    .kind = LIGHT_DIRECTIONAL,
                                    .direction = {0.48f, -0.8f, -0.36f},
                                    .color = {1.0f, 0.9f, 0.8f},
                                    .intensity = 2.0f},
                                   {.name = "point",
                                    .kind = LIGHT_POINT,
                                    .position = {1.0f, 1.0f, 0.8f},
                                    .color = {0.5f, 0.7f, 1.0f},
                                    .intensity = 2.0f},
                                   {.name = "spot",
                                    .kind = LIGHT_SPOT,
                                    .position = {-1.0f, 2.0f, 0.6f},
                                    .direction = {0.42f, -0.88f, -0.22f},
                                    .color = {1.0f, 1.0f, 1.0f},
                                    .intensity = 6.0f,
                                    .cos_inner = 0.97f,
                                    .cos_outer = 0.92f}};
    for (size_t k = 0; k < sizeof lights / sizeof *lights; k++) scene->lights[scene->light_count++] = lights[k];
    agrees(scene, &view, FRAMES, SPP, "sun, point and spot", 0.03, 0.007);
}

static void half_transparent_and_single_sided(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = balls();
    test_environment(scene, 0.3f);
    test_sun(scene, vec3(0.48f, -0.8f, -0.36f), 2.0f);
    Material *veil = test_material(scene, 0.7f);
    veil->alpha_mode = WEFT_ALPHA_BLEND;
    veil->inputs[INPUT_opacity].value[0] = 0.4f;
    veil->inputs[INPUT_diffuse_transmission].value[0] = 0.5f;
    test_quad(scene, vec3(-1.1f, 0.7f, 0.7f), vec3(1.0f, 0.0f, 0.0f), vec3(0.0f, 0.3f, -0.6f));
    test_material(scene, 0.7f)->double_sided = false;
    test_quad(scene, vec3(0.1f, 0.5f, 0.6f), vec3(0.6f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -0.5f));
    agrees(scene, &view, FRAMES, SPP, "veil and single side", 0.025, 0.006);
}

/* A random number decides whether a frame shows a veil: each has its own, else what is behind a veil as thin would never
 * be seen. */
static void veils_behind_one_another(void **state) {
    static const float colors[3][3] = {{0.8f, 0.1f, 0.1f}, {0.1f, 0.8f, 0.1f}, {0.1f, 0.1f, 0.8f}};
    (void)state;
    need_gl();
    WeftScene *scene = balls();
    test_environment(scene, 1.0f);
    for (int k = 0; k < 3; k++) {
        const float z = 0.7f + 0.2f * (float)k;
        Material *veil = test_material(scene, 0.7f);
        memcpy(veil->inputs[INPUT_base_color].value, colors[k], sizeof colors[k]);
        veil->alpha_mode = WEFT_ALPHA_BLEND;
        veil->inputs[INPUT_opacity].value[0] = 0.5f;
        test_quad(scene, vec3(-0.7f, -0.2f, z), vec3(1.2f, 0.0f, 0.0f), vec3(0.0f, 0.9f, 0.0f));
    }
    agrees(scene, &view, FRAMES, SPP, "three veils", 0.04, 0.008);
}

/* A pane of rough glass before the balls, which neither engine shows through it at depth 1, and a sun that it lets pass. */
static void a_pane_of_thin_glass_agrees(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = balls();
    assert_int_equal(weft_scene_set_environment_studio(scene, NULL), WEFT_OK);
    Material *pane = test_material(scene, 0.9f);
    pane->inputs[INPUT_specular].value[0] = 1.0f;
    pane->inputs[INPUT_roughness].value[0] = 0.5f;
    pane->inputs[INPUT_transmission].value[0] = 0.8f;
    pane->inputs[INPUT_fuzz].value[0] = 0.5f;
    test_quad(scene, vec3(-0.6f, -0.3f, 0.8f), vec3(0.9f, 0.0f, 0.1f), vec3(0.0f, 0.9f, -0.1f));
    agrees(scene, &view, FRAMES, SPP, "pane of glass", 0.03, 0.006);
}

/* A lattice of holes above the floor: a map of opacity of 4 x 4 texels, repeated and mirrored, whose edges lie between
 * texels. */
static void holes_of_a_map(void **state) {
    (void)state;
    need_gl();
    enum { SIDE = 4 };
    WeftScene *scene = balls();
    test_environment(scene, 0.3f);
    test_sun(scene, vec3(0.3f, -0.9f, -0.3f), 3.0f);
    scene->images = arena_array(&scene->arena, 1, sizeof *scene->images);
    scene->textures = arena_array(&scene->arena, 1, sizeof *scene->textures);
    assert_true(scene->images && scene->textures);
    assert_int_equal(weft_image_create(SIDE, SIDE, 4, WEFT_PIXEL_U8, &scene->images[0], NULL), WEFT_OK);
    for (int k = 0; k < SIDE * SIDE; k++)
        ((unsigned char *)scene->images[0].pixels)[4 * k + 3] = k % SIDE < 2 && k / SIDE < 3 ? 255 : 20;
    scene->textures[0] = (Texture){.wrap_u = WRAP_REPEAT, .wrap_v = WRAP_MIRROR};
    scene->image_count = scene->texture_count = 1;
    Material *lattice = test_material(scene, 0.7f);
    lattice->alpha_mode = WEFT_ALPHA_MASK;
    lattice->alpha_cutoff = 0.5f;
    lattice->inputs[INPUT_opacity].texture = 1;
    lattice->inputs[INPUT_opacity].channel = 3;
    Mesh *mesh = test_quad(scene, vec3(-1.1f, 0.6f, 0.9f), vec3(1.6f, 0.0f, 0.0f), vec3(0.0f, 0.2f, -0.9f));
    static const float uv[8] = {0.0f, 0.0f, 5.0f, 0.0f, 5.0f, 3.0f, 0.0f, 3.0f};
    mesh->texcoord[0] = arena_array(&scene->arena, 4, 2 * sizeof(float));
    memcpy(mesh->texcoord[0], uv, sizeof uv);
    agrees(scene, &view, FRAMES, SPP, "holes of a map", 0.025, 0.006);
}

/* A sum goes on over many calls, ends as in one, stops when something else is drawn, and refuses what is no number. */
static void a_sum_in_pieces(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = balls();
    test_environment(scene, 1.0f);
    WeftRaster *raster = raster_of(scene);
    WeftError error;
    int done = 0, calls = 0;
    WeftImage whole = summed(raster, &view, 6), pieces;
    assert_int_equal(weft_raster_accumulate_begin(raster, &view, 6, &error), WEFT_OK);
    for (; done < 6; calls++) assert_int_equal(weft_raster_accumulate(raster, 0.0, &done, &error), WEFT_OK);
    assert_true(calls >= 6);
    assert_int_equal(weft_raster_image(raster, &pieces, &error), WEFT_OK);
    assert_memory_equal(whole.pixels, pieces.pixels, (size_t)WIDTH * HEIGHT * 4 * sizeof(float));
    assert_int_equal(weft_raster_draw(raster, &view, &error), WEFT_OK);
    assert_int_not_equal(weft_raster_accumulate(raster, 0.0, &done, &error), WEFT_OK);
    assert_int_equal(done, 0);
    assert_int_not_equal(weft_raster_accumulate_begin(raster, &view, 0, &error), WEFT_OK);
    weft_image_free(&whole);
    weft_image_free(&pieces);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

/* The first frame differs little from the picture before it, which in the end has no weight. */
static void begins_without_a_jump(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = balls();
    test_environment(scene, 1.0f);
    WeftRaster *raster = raster_of(scene);
    WeftError error;
    WeftImage before, first, after = summed(raster, &view, 64), alone;
    int done = 0;
    assert_int_equal(weft_raster_draw(raster, &view, &error), WEFT_OK);
    assert_int_equal(weft_raster_image(raster, &before, &error), WEFT_OK);
    assert_int_equal(weft_raster_accumulate_begin(raster, &view, 64, &error), WEFT_OK);
    while (done < 1) assert_int_equal(weft_raster_accumulate(raster, 0.0, &done, &error), WEFT_OK);
    assert_int_equal(weft_raster_image(raster, &first, &error), WEFT_OK);
    while (done < 64) assert_int_equal(weft_raster_accumulate(raster, 1.0, &done, &error), WEFT_OK);
    assert_int_equal(weft_raster_image(raster, &alone, &error), WEFT_OK);
    const Off jump = compare(&first, &before);
    print_message("first frame: %.2f %% from the picture before\n", 100.0 * jump.pixels);
    assert_true(jump.pixels > 0.0 && jump.pixels < 0.1);
    assert_memory_equal(alone.pixels, after.pixels, (size_t)WIDTH * HEIGHT * 4 * sizeof(float));
    weft_image_free(&before);
    weft_image_free(&first);
    weft_image_free(&after);
    weft_image_free(&alone);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

/* Whoever turns the camera while frames add up waits for the strip that is being drawn and then for one picture.
 * The quickest of some turns counts, since other work may stop the others. */
static void turning_is_answered_at_once(void **state) {
    (void)state;
    need_gl();
    enum { TURNS = 5, WIDE = 640, HIGH = 420 };
    WeftScene *scene = balls();
    test_environment(scene, 1.0f);
    WeftRaster *raster = raster_of(scene);
    WeftError error;
    WeftRasterView turned = {.width = WIDE, .height = HIGH, .background = WEFT_BACKGROUND_TRANSPARENT};
    double quickest = 1e30, plain = 1e30;
    for (int k = 0; k < TURNS; k++) {
        char from[64], to[64];
        int done = 0;
        snprintf(from, sizeof from, "%g,1.3,3.4;0,0.1,0;26", 0.2 * k);
        snprintf(to, sizeof to, "%g,1.3,3.4;0,0.1,0;26", 0.2 * k + 0.1);
        turned.camera = from;
        for (int again = 0; again < 2; again++) {
            const double start = clock_now();
            assert_int_equal(weft_raster_draw(raster, &turned, &error), WEFT_OK);
            weft_raster_finish(raster);
            plain = fmin(plain, clock_now() - start);
        }
        assert_int_equal(weft_raster_accumulate_begin(raster, &turned, 64, &error), WEFT_OK);
        for (int strip = 0; strip < 8; strip++)
            assert_int_equal(weft_raster_accumulate(raster, 0.0, &done, &error), WEFT_OK);
        turned.camera = to;
        const double start = clock_now();
        assert_int_equal(weft_raster_accumulate(raster, 0.0, &done, &error),
                         WEFT_OK); /* had begun when the turn came */
        assert_int_equal(weft_raster_draw(raster, &turned, &error), WEFT_OK);
        weft_raster_finish(raster);
        quickest = fmin(quickest, clock_now() - start);
    }
    print_message("a picture takes %.0f ms, after a turn while frames add up %.0f ms\n", 1e3 * plain, 1e3 * quickest);
    assert_true(quickest < 0.1 + 2.0 * plain);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(under_a_studio),           cmocka_unit_test(under_a_polygon),
        cmocka_unit_test(under_punctual_lights),    cmocka_unit_test(half_transparent_and_single_sided),
        cmocka_unit_test(veils_behind_one_another), cmocka_unit_test(a_pane_of_thin_glass_agrees),
        cmocka_unit_test(holes_of_a_map),           cmocka_unit_test(a_sum_in_pieces),
        cmocka_unit_test(begins_without_a_jump),    cmocka_unit_test(turning_is_answered_at_once),
    };
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
