/* A render that is begun again gives the bytes of a new one, whatever was changed since. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "scenes.h"

static const WeftLight panel = {.kind = WEFT_LIGHT_POLYGON,
                                .position = {-1.0f, 2.0f, 1.0f},
                                .direction = {0.5f, -1.0f, -0.5f},
                                .color = {6.0f, 5.0f, 4.0f},
                                .size = {1.0f, 1.0f}};
static const WeftLight sun = {.direction = {-0.4f, -1.0f, -0.3f}, .color = {1.0f, 0.9f, 0.8f}};

static WeftScene *ball_scene(void) {
    WeftScene *scene = test_scene();
    Material *ball = test_material(scene, 0.4f);
    test_color(ball, INPUT_sheen_color, 0.6f);
    ball->inputs[INPUT_sheen_roughness].value[0] = 0.5f;
    test_sphere(scene, vec3(0.0f, 0.5f, 0.0f), 0.5f);
    test_material(scene, 0.5f);
    Mesh *floor = test_quad(scene, vec3(-2.0f, 0.0f, 2.0f), vec3(4.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -4.0f));
    static const float corners[8] = {0.0f, 0.3f, 0.7f, 1.0f, 1.0f, 0.7f, 0.3f, 0.0f};
    floor->texcoord[0] = arena_array(&scene->arena, 1, sizeof corners);
    memcpy(floor->texcoord[0], corners, sizeof corners);
    scene_bounds(scene);
    test_environment(scene, 0.2f);
    return scene;
}

static void put_texture(WeftScene *scene, unsigned char step) {
    if (!scene->images) {
        scene->images = arena_array(&scene->arena, 1, sizeof *scene->images);
        scene->textures = arena_array(&scene->arena, 1, sizeof *scene->textures);
        scene->image_count = scene->texture_count = 1;
        assert_int_equal(weft_image_create(4, 4, 4, WEFT_PIXEL_U8, &scene->images[0], NULL), WEFT_OK);
    }
    unsigned char *p = scene->images[0].pixels;
    for (int k = 0; k < 64; k++) p[k] = (unsigned char)(k % 4 == 3 ? 255 : (k * step) % 256);
    scene->materials[1].inputs[INPUT_base_color].texture = 1;
}

/* What is changed in each step, and what is said of it. */
enum { MATERIALS = WEFT_CHANGED_MATERIALS, LIGHTS = WEFT_CHANGED_LIGHTS, SHAPES = WEFT_CHANGED_SHAPES };

static unsigned change(WeftScene *scene, int step, WeftRenderDesc *desc) {
    WeftLight light = panel;
    switch (step) {
    case 0: desc->camera = "1,1,3;0,0.5,0;30"; return 0;
    case 1: desc->width = 40, desc->crop[2] = 20, desc->crop[3] = 15, desc->crop[0] = 5; return 0;
    case 2: assert_int_equal(weft_scene_set(scene, "0.sheen_roughness", "0.3", NULL, NULL), WEFT_OK); return MATERIALS;
    case 3:
        assert_int_equal(weft_scene_set(scene, "0.sheen_lobe", "ashikhmin-neubelt", NULL, NULL), WEFT_OK);
        return MATERIALS;
    case 4: put_texture(scene, 37); return MATERIALS;
    case 5: put_texture(scene, 91); return MATERIALS;
    case 6: assert_int_equal(weft_scene_set(scene, "0.opacity", "0.4", NULL, NULL), WEFT_OK); return MATERIALS;
    case 7: assert_int_equal(weft_scene_set(scene, "0.emission", "2", NULL, NULL), WEFT_OK); return MATERIALS;
    case 8: assert_int_equal(weft_scene_set(scene, "0.emission", "0", NULL, NULL), WEFT_OK); return MATERIALS;
    case 9: assert_int_equal(weft_scene_add_light(scene, &sun, NULL), WEFT_OK); return LIGHTS;
    case 10: assert_int_equal(weft_scene_set_environment_placement(scene, 30.0f, 3.0f, NULL), WEFT_OK); return LIGHTS;
    case 11: assert_int_equal(weft_scene_add_light(scene, &panel, NULL), WEFT_OK); return LIGHTS | SHAPES;
    case 12:
        light.position[0] = 1.0f;
        light.corners = 6;
        assert_int_equal(weft_scene_put_light(scene, 1, &light, NULL), WEFT_OK);
        return LIGHTS | SHAPES;
    default: assert_int_equal(weft_scene_remove_light(scene, 1, NULL), WEFT_OK); return LIGHTS | SHAPES;
    }
}

static WeftImage run(WeftRender *render) {
    WeftImage image;
    assert_int_equal(weft_render_run(render, 4, 0.0, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_render_image(render, &image, NULL), WEFT_OK);
    return image;
}

static void restarted_render_has_the_bytes_of_a_new_one(void **state) {
    (void)state;
    WeftScene *scene = ball_scene();
    WeftRenderDesc desc = {.width = 32, .height = 24, .camera = "0,1,3;0,0.5,0;32"};
    WeftRender *render;
    WeftError error;
    assert_int_equal(weft_render_create(scene, &desc, &render, &error), WEFT_OK);
    WeftImage before = run(render);
    for (int step = 0; step < 14; step++) {
        unsigned changed = change(scene, step, &desc);
        if (weft_render_restart(render, &desc, changed, &error) != WEFT_OK) fail_msg("%s", error.text);
        WeftImage is = run(render), should = test_render(scene, desc, 4);
        size_t size = (size_t)is.width * (size_t)is.height * 4 * sizeof(float);
        assert_int_equal(is.width, should.width);
        if (memcmp(is.pixels, should.pixels, size) != 0) fail_msg("step %d: not as a new one", step);
        if (is.width == before.width && memcmp(is.pixels, before.pixels, size) == 0)
            fail_msg("step %d: nothing has changed", step);
        weft_image_free(&before);
        weft_image_free(&should);
        before = is;
    }
    weft_image_free(&before);
    weft_render_free(render);
    weft_scene_free(scene);
}

static void render_continues_after_a_failed_restart(void **state) {
    (void)state;
    WeftScene *scene = ball_scene();
    WeftRenderDesc desc = {.width = 16, .height = 12}, wrong = desc;
    WeftRender *render;
    WeftError error;
    assert_int_equal(weft_render_create(scene, &desc, &render, &error), WEFT_OK);
    wrong.camera = "no such";
    assert_int_equal(weft_render_restart(render, &wrong, 0, &error), WEFT_USAGE);
    wrong.max_depth = -1;
    assert_int_equal(weft_render_restart(render, &wrong, 7, &error), WEFT_USAGE);
    assert_int_equal(weft_render_restart(render, &desc, 7, &error), WEFT_OK);
    WeftImage is = run(render), should = test_render(scene, desc, 4);
    assert_memory_equal(is.pixels, should.pixels, 16 * 12 * 4 * sizeof(float));
    weft_image_free(&is);
    weft_image_free(&should);
    weft_render_free(render);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(restarted_render_has_the_bytes_of_a_new_one),
                                       cmocka_unit_test(render_continues_after_a_failed_restart)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
