/* What lies under a pixel: the point, its frame and its place on the textures, and through holes what is
 * behind. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "scenes.h"

static const char camera[] = "0,0,4;0,0,0;30";

/* A square of 2 m facing +z, u to the right over it and v down, twice; behind it a larger one without. */
static WeftScene *two_squares(void) {
    static const float uv[8] = {0.0f, 2.0f, 1.0f, 2.0f, 1.0f, 0.0f, 0.0f, 0.0f};
    WeftScene *scene = test_scene();
    test_material(scene, 0.5f);
    Mesh *front = test_quad(scene, vec3(-1.0f, -1.0f, 0.0f), vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 2.0f, 0.0f));
    front->texcoord[0] = arena_array(&scene->arena, 1, sizeof uv);
    memcpy(front->texcoord[0], uv, sizeof uv);
    test_material(scene, 0.5f);
    test_quad(scene, vec3(3.0f, -3.0f, -1.0f), vec3(-6.0f, 0.0f, 0.0f), vec3(0.0f, 6.0f, 0.0f));
    scene_bounds(scene);
    return scene;
}

static WeftPicked at(const WeftPick *pick, float x, float y) {
    WeftPicked picked;
    assert_int_equal(weft_pick_at(pick, camera, 100, 100, x, y, &picked), 1);
    return picked;
}

static void is_about(const float v[3], float x, float y, float z) {
    assert_float_equal(v[0], x, 1e-4f);
    assert_float_equal(v[1], y, 1e-4f);
    assert_float_equal(v[2], z, 1e-4f);
}

static void picked_point_is_described(void **state) {
    (void)state;
    WeftScene *scene = two_squares();
    WeftPick *pick;
    WeftPicked none;
    assert_int_equal(weft_pick_create(scene, &pick, NULL), WEFT_OK);
    WeftPicked p = at(pick, 50.0f, 50.0f);
    assert_int_equal(p.mesh, 0);
    assert_int_equal(p.material, 0);
    is_about(p.position, 0.0f, 0.0f, 0.0f);
    is_about(p.normal, 0.0f, 0.0f, 1.0f);
    is_about(p.tangent, 1.0f, 0.0f, 0.0f);
    is_about(p.bitangent, 0.0f, -1.0f, 0.0f);
    assert_float_equal(p.texcoord[0][0], 0.5f, 1e-4f);
    assert_float_equal(p.texcoord[0][1], 1.0f, 1e-4f);
    assert_float_equal(p.distance, 4.0f, 1e-4f);
    assert_float_equal(p.uv_per_metre, sqrtf(0.5f), 1e-4f);
    p = at(pick, 2.0f, 98.0f); /* low on the left, beside the first; its back */
    assert_int_equal(p.mesh, 1);
    assert_true(p.position[0] < -1.0f && p.position[1] < -1.0f);
    is_about(p.normal, 0.0f, 0.0f, 1.0f);
    assert_float_equal(p.uv_per_metre, 0.0f, 0.0f);
    assert_float_equal(p.tangent[2], 0.0f, 1e-5f);
    assert_int_equal(weft_pick_at(pick, "9,9,9;20,20,20;30", 100, 100, 50.0f, 50.0f, &none), 0);
    assert_int_equal(weft_pick_at(pick, "no such", 100, 100, 50.0f, 50.0f, &none), 0);
    assert_int_equal(weft_pick_at(pick, camera, 0, 100, 50.0f, 50.0f, &none), 0);
    assert_int_equal(weft_pick_at(pick, camera, 100, 100, NAN, 50.0f, &none), 0);
    weft_pick_free(pick);
    weft_scene_free(scene);
}

/* Materials are read as they are now, and lights are not there. */
static void cut_out_surface_is_not_picked(void **state) {
    (void)state;
    const WeftLight panel = {.kind = WEFT_LIGHT_POLYGON,
                             .position = {0.0f, 0.0f, 1.0f},
                             .direction = {0.0f, 0.0f, 1.0f},
                             .size = {1.0f, 1.0f}};
    WeftScene *scene = two_squares();
    WeftPick *pick;
    assert_int_equal(weft_scene_add_light(scene, &panel, NULL), WEFT_OK);
    assert_int_equal(weft_pick_create(scene, &pick, NULL), WEFT_OK);
    for (int k = 0; k < 8; k++) assert_int_equal(weft_scene_add_light(scene, &panel, NULL), WEFT_OK);
    assert_int_equal(at(pick, 50.0f, 50.0f).mesh, 0);
    Material *front = &scene->materials[0];
    front->alpha_mode = WEFT_ALPHA_MASK;
    front->inputs[INPUT_opacity].value[0] = 0.3f;
    assert_int_equal(at(pick, 50.0f, 50.0f).mesh, 1);
    front->alpha_mode = WEFT_ALPHA_BLEND;
    assert_int_equal(at(pick, 50.0f, 50.0f).mesh, 0);
    front->inputs[INPUT_opacity].value[0] = 0.0f;
    assert_int_equal(at(pick, 50.0f, 50.0f).mesh, 1);
    scene->materials[1].double_sided = false;
    WeftPicked none;
    assert_int_equal(weft_pick_at(pick, camera, 100, 100, 50.0f, 50.0f, &none), 0);
    weft_pick_free(pick);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(picked_point_is_described),
                                       cmocka_unit_test(cut_out_surface_is_not_picked)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
