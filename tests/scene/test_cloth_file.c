/* The weave of a material file: what it may say, what is refused, and how it comes back. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "scene/scene.h"
#include "weave/weft_cloth.h"
#include "weft/weft.h"

static WeftScene *scene_of_cloth(void) {
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load("builtin:cloth", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

static WeftResult put(WeftScene *scene, const char *text, WeftError *error) {
    return weft_scene_assign_material_memory(scene, NULL, text, strlen(text), "mine.json", NULL, error);
}

static const char *const denim = "{\"weave\": {\"draft\": \"twill 3/1; warp 1k; weft 1w; sett 20 10\", "
                                 "\"warp\": {\"yarn\": \"wool\", \"alpha\": 0.45, \"twist\": 30}, \"weft\": "
                                 "{\"color\": \"#808080\"}, \"metres\": 0.5, \"seed\": 7}}";

static void a_weave_is_a_cloth_of_the_scene(void **state) {
    (void)state;
    WeftScene *scene = scene_of_cloth();
    WeftError error;
    if (put(scene, denim, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(scene->cloth_count, 1);
    assert_int_equal(scene->materials[0].cloth, 1);
    assert_int_equal(scene->materials[1].cloth, 0);
    const WeftCloth *cloth = scene->cloths[0];
    assert_int_equal(cloth->weave.warps, 4);
    assert_float_equal(cloth->per_uv[WEFT_WARP], 1000.0f, 1.0f); /* 20 per cm, half a metre */
    assert_float_equal(cloth->per_uv[WEFT_WEFT], 500.0f, 1.0f);
    assert_float_equal(cloth->yarns[WEFT_WARP].alpha, 0.45f, 1e-6f);
    assert_float_equal(cloth->yarns[WEFT_WARP].twist, 0.5236f, 1e-4f);
    assert_float_equal(cloth->weave.seed, 7.0f, 0.0f);
    assert_true(cloth->albedos[0] < 0.1f);     /* black warp */
    assert_true(cloth->albedos[4 * 3] > 0.5f); /* grey weft, where the draft had white */
    for (int k = 0; k < scene->mesh_count; k++)
        if (scene->meshes[k].material == 0) assert_non_null(scene->meshes[k].tangent);
    assert_int_equal(put(scene, "{}", &error), WEFT_OK); /* and off again */
    assert_int_equal(scene->materials[0].cloth, 0);
    weft_scene_free(scene);
}

static void broken_weaves_are_refused_in_one_line(void **state) {
    (void)state;
    static const char *const bad[] = {
        "3",
        "{}",
        "[]",
        "{\"draft\": 3}",
        "{\"draft\": \"velvet\"}",
        "{\"draft\": \"plain\", \"weird\": 1}",
        "{\"draft\": \"plain\", \"metres\": 0}",
        "{\"draft\": \"plain\", \"metres\": \"1\"}",
        "{\"draft\": \"plain\", \"metres\": -1}",
        "{\"draft\": \"plain\", \"seed\": 1e9}",
        "{\"draft\": \"plain\", \"warp\": \"nettle\"}",
        "{\"draft\": \"plain\", \"warp\": 3}",
        "{\"draft\": \"plain\", \"warp\": {\"color\": \"#-00001\"}}",
        "{\"draft\": \"plain\", \"warp\": {\"color\": \"#0x1234\"}}",
        "{\"draft\": \"plain\", \"warp\": []}",
        "{\"draft\": \"plain\", \"warp\": {\"yarn\": 3}}",
        "{\"draft\": \"plain\", \"weft\": {\"alpha\": \"1\"}}",
        "{\"draft\": \"plain\", \"weft\": {\"alpha\": 7}}",
        "{\"draft\": \"plain\", \"weft\": {\"crimp\": 90}}",
        "{\"draft\": \"plain\", \"weft\": {\"beauty\": 1}}",
        "{\"draft\": \"plain\", \"weft\": {\"color\": \"red\"}}",
        "{\"draft\": \"plain\", \"weft\": {\"color\": \"#12345z\"}}",
        "{\"draft\": \"satin 4001/2\"}",
    };
    WeftScene *scene = scene_of_cloth();
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        char text[256];
        WeftError error;
        snprintf(text, sizeof text, "{\"weave\": %s}", bad[k]);
        if (put(scene, text, &error) == WEFT_OK) fail_msg("%s was taken", bad[k]);
        assert_true(error.text[0] && !strchr(error.text, '\n'));
        assert_int_equal(scene->cloth_count, 0);
        assert_int_equal(scene->materials[0].cloth, 0);
    }
    weft_scene_free(scene);
}

static void a_saved_material_is_woven_again(void **state) {
    (void)state;
    WeftScene *scene = scene_of_cloth();
    WeftError error;
    char path[64];
    snprintf(path, sizeof path, "/tmp/weft-woven-%ld.json", (long)getpid());
    assert_int_equal(put(scene, denim, &error), WEFT_OK);
    if (weft_scene_save_material(scene, 0, path, &error) != WEFT_OK) fail_msg("%s", error.text);
    if (weft_scene_assign_material(scene, NULL, path, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(scene->materials[0].cloth, 2);
    const Weave *a = &scene->cloths[0]->weave, *b = &scene->cloths[1]->weave;
    for (int k = 0; k < 100; k++) {
        const float x = 0.61f * (float)k, y = 0.37f * (float)k;
        assert_float_equal(weave_point(a, x, y).height, weave_point(b, x, y).height, 0.0f);
    }
    assert_int_equal(unlink(path), 0);
    weft_scene_free(scene);
}

/* A number of a cloth that the scene lacks is refused, one that it has is taken. */
static void numbers_name_cloths_of_the_scene(void **state) {
    (void)state;
    WeftScene *scene = scene_of_cloth();
    WeftMaterial material;
    WeftError error;
    assert_int_equal(weft_scene_material(scene, 1, &material, &error), WEFT_OK);
    material.cloth = 1;
    assert_int_not_equal(weft_scene_put_material(scene, 1, &material, &error), WEFT_OK);
    assert_int_equal(put(scene, denim, &error), WEFT_OK);
    assert_int_equal(weft_scene_put_material(scene, 1, &material, &error), WEFT_OK);
    material.cloth = -1;
    assert_int_not_equal(weft_scene_put_material(scene, 1, &material, &error), WEFT_OK);
    weft_scene_free(scene);
}

static void every_file_of_weaves_is_a_cloth(void **state) {
    (void)state;
    static const char *const names[] = {"denim",    "charmeuse", "gabardine", "linen",
                                        "shantung", "shot-silk", "tartan"};
    WeftScene *scene = scene_of_cloth();
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char path[512];
        WeftError error;
        snprintf(path, sizeof path, "%s/scenes/weaves/%s.json", WEFT_SOURCE_DIR, names[k]);
        if (weft_scene_assign_material(scene, NULL, path, NULL, &error) != WEFT_OK)
            fail_msg("%s", error.text);
        assert_int_equal(scene->materials[0].cloth, (int)k + 1);
        const WeftClothInfo info = weft_cloth_info(scene->cloths[k]);
        assert_true(info.share[0] + info.share[1] > 0.95f);
    }
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_weave_is_a_cloth_of_the_scene),
        cmocka_unit_test(broken_weaves_are_refused_in_one_line),
        cmocka_unit_test(a_saved_material_is_woven_again),
        cmocka_unit_test(numbers_name_cloths_of_the_scene),
        cmocka_unit_test(every_file_of_weaves_is_a_cloth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
