/* A woven material of a scene that is baked in its place: it gets textures, what lies over its threads stays, and its other
 * materials too; what cannot be baked is refused */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "scratch.h"
#include "weft/weft.h"

static WeftMaterial material_of(const WeftScene *scene) {
    WeftMaterial material;
    assert_int_equal(weft_scene_material(scene, 0, &material, NULL), WEFT_OK);
    return material;
}

static WeftScene *scene_of(const char *preset) {
    WeftScene *scene;
    WeftError error;
    WeftResult result = weft_scene_load("builtin:bend", &scene, NULL, &error);
    if (result == WEFT_OK) result = weft_scene_assign_material(scene, NULL, preset, NULL, &error);
    if (result == WEFT_OK) result = weft_scene_set(scene, "0.fuzz", "0.25", NULL, &error);
    if (result != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

static const WeftBaking small = {.pixels = 48};

static void textures_take_the_place_of_threads_below_the_fuzz(void **state) {
    (void)state;
    WeftScene *scene = scene_of("preset:woven-poplin");
    WeftBaked found = {0};
    WeftError error;
    assert_int_not_equal(material_of(scene).cloth, 0);
    if (weft_scene_bake(scene, 0, &small, "maps", &found, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(system("rm -r maps"), 0); /* the scene has read them */
    const WeftMaterial baked = material_of(scene);
    assert_int_equal(baked.cloth, 0);
    assert_int_not_equal(baked.inputs[weft_material_input_find("base_color")].texture, 0);
    assert_int_not_equal(baked.inputs[weft_material_input_find("normal")].texture, 0);
    assert_float_equal(baked.inputs[weft_material_input_find("fuzz")].value[0], 0.25f, 1e-6f);
    assert_true(found.fitted > 0.0 && found.fitted < 0.3);
    if (weft_scene_save(scene, "baked.glb", &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_scene_free(scene);
}

static int input(const char *name) { return weft_material_input_find(name); }

/* Bakes poplin below what is given. Returns what the fit found. */
static WeftBaked bake_below(float emission, float dust, const char *to, WeftMaterial *baked, WeftLosses *losses) {
    WeftBaking baking = small;
    WeftBaked found = {0};
    WeftError error;
    WeftScene *scene = scene_of("preset:woven-poplin");
    WeftMaterial material = material_of(scene);
    baking.losses = losses;
    material.inputs[input("emission")].value[0] = emission;
    material.inputs[input("emission_strength")].value[0] = 2.0f;
    material.inputs[input("dust")].value[0] = dust;
    assert_int_equal(weft_scene_put_material(scene, 0, &material, &error), WEFT_OK);
    if (weft_scene_bake(scene, 0, &baking, to, &found, &error) != WEFT_OK) fail_msg("%s", error.text);
    *baked = material_of(scene);
    weft_scene_free(scene);
    return found;
}

/* Emission stays; dust changes nothing of the textures and their numbers, and is said to be lost. */
static void inputs_over_threads_are_kept_or_said_to_be_lost(void **state) {
    (void)state;
    WeftMaterial glowing, dusty;
    WeftLosses none = {0}, lost = {0};
    const WeftBaked without = bake_below(1.0f, 0.0f, "glowing", &glowing, &none);
    assert_float_equal(glowing.inputs[input("emission")].value[0], 1.0f, 1e-6f);
    assert_float_equal(glowing.inputs[input("emission_strength")].value[0], 2.0f, 1e-6f);
    assert_int_equal(none.count, 0);
    const WeftBaked with = bake_below(0.0f, 0.8f, "dusty", &dusty, &lost);
    assert_true(with.sky <= without.sky && with.sky >= without.sky);
    assert_float_equal(dusty.inputs[input("dust")].value[0], 0.0f, 0.0f);
    assert_int_equal(system("cmp glowing/base_color.png dusty/base_color.png"), 0);
    assert_int_equal(lost.count, 1);
    assert_int_equal(lost.items[0].material, 0);
    assert_string_equal(lost.items[0].name, "cloth");
    assert_string_equal(lost.items[0].what, "dust");
    assert_string_equal(lost.items[0].why, "0.8 of it is not baked");
    weft_losses_free(&lost);
}

/* A triangle in a material named "a", and one in a material named after the number of the first; the first is poplin, with its
 * coordinates in an attribute of that name. */
static WeftScene *scene_with_a_number_for_a_name(const char *coordinates) {
    static const char text[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"%s\":1},\"material\":0},"
        "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":1}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[-1,-1,0],"
        "\"max\":[1,1,0]},{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":"
        "\"data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA\"}],"
        "\"materials\":[{\"name\":\"a\"},{\"name\":\"0\"}]}";
    FILE *file = fopen("two.gltf", "wb");
    WeftScene *scene;
    WeftError error;
    assert_non_null(file);
    assert_true(fprintf(file, text, coordinates) > 0);
    assert_int_equal(fclose(file), 0);
    WeftResult result = weft_scene_load("two.gltf", &scene, NULL, &error);
    if (result == WEFT_OK) result = weft_scene_assign_material(scene, "a", "preset:woven-poplin", NULL, &error);
    if (result != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

/* Only the material of that index is baked, whatever others are called, and its rotation is said to be lost. */
static void a_name_that_is_a_number_is_another_material(void **state) {
    (void)state;
    WeftLosses losses = {0};
    WeftBaking baking = small;
    WeftMaterial second;
    WeftError error;
    WeftScene *scene = scene_with_a_number_for_a_name("TEXCOORD_0");
    baking.losses = &losses;
    assert_int_equal(weft_scene_weave(scene, "a", "rotation", "30", NULL, &error), WEFT_OK);
    if (weft_scene_bake(scene, 0, &baking, "maps-two", NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_not_equal(material_of(scene).inputs[input("base_color")].texture, 0);
    assert_int_equal(weft_scene_material(scene, 1, &second, &error), WEFT_OK);
    assert_int_equal(second.inputs[input("base_color")].texture, 0);
    assert_int_equal(losses.count, 1);
    assert_string_equal(losses.items[0].what, "rotation");
    assert_string_equal(losses.items[0].name, "a");
    if (!strstr(losses.items[0].why, "rotated by 30 degrees")) fail_msg("%s", losses.items[0].why);
    weft_losses_free(&losses);
    weft_scene_free(scene);
}

/* A baked cloth that has no place on its mesh is told. */
static void threads_without_coordinates_are_said_to_be_lost(void **state) {
    (void)state;
    WeftLosses losses = {0};
    WeftBaking baking = small;
    WeftError error;
    WeftScene *scene = scene_with_a_number_for_a_name("_OTHER");
    baking.losses = &losses;
    if (weft_scene_bake(scene, 0, &baking, "maps-none", NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(losses.count, 1);
    assert_string_equal(losses.items[0].what, "threads");
    if (!strstr(losses.items[0].why, "no texture coordinates")) fail_msg("%s", losses.items[0].why);
    weft_losses_free(&losses);
    weft_scene_free(scene);
}

/* Returns the mean of the base colour of a white plain weave baked to so many texels. */
static double mean_of_maps(int pixels, const char *folder) {
    char path[64];
    WeftImage map = {0};
    WeftError error;
    WeftScene *scene = scene_of("preset:woven-poplin");
    const WeftBaking baking = {.pixels = pixels, .profile = "three", .one_face = 1};
    WeftDraft *draft;
    WeftYarn cotton;
    assert_int_equal(weft_draft_parse("plain", &draft, &error), WEFT_OK);
    assert_int_equal(weft_yarn_find("cotton", &cotton, &error), WEFT_OK);
    WeftResult result = weft_scene_set_weave(scene, 0, draft, (WeftYarn[2]){cotton, cotton}, &error);
    weft_draft_free(draft);
    if (result == WEFT_OK) result = weft_scene_bake(scene, 0, &baking, folder, NULL, &error);
    snprintf(path, sizeof path, "%s/base_color.png", folder);
    if (result == WEFT_OK) result = weft_image_read(path, &map, NULL, &error);
    if (result != WEFT_OK) fail_msg("%s", error.text);
    const int count = map.width * map.height;
    double sum = 0.0;
    for (int k = 0; k < count; k++)
        sum += pow(((const unsigned char *)map.pixels)[(ptrdiff_t)map.channels * k] / 255.0, 2.2) / count;
    weft_image_free(&map);
    weft_scene_free(scene);
    return sum;
}

/* Where a texel is a quarter or a fifth of a thread, many would be more than white. */
static void white_cloth_is_as_bright_at_any_size(void **state) {
    (void)state;
    const double large = mean_of_maps(128, "large"), small_one = mean_of_maps(64, "quarter");
    print_message("mean base colour %.3f of 128 texels, %.3f of 64\n", large, small_one);
    assert_true(fabs(small_one / large - 1.0) < 0.05);
}

static int stop_soon(void *user, double fraction) {
    int *calls = user;
    assert_true(fraction >= 0.0 && fraction <= 1.0);
    return ++*calls > 1;
}

/* The search ends soon, the material keeps its threads, and no folder is made for maps that do not come. */
static void a_stopped_search_leaves_no_maps(void **state) {
    (void)state;
    WeftBaking baking = {.pixels = 256, .levels = 1, .progress = stop_soon};
    WeftError error;
    WeftScene *scene = scene_of("preset:woven-poplin");
    int calls = 0;
    baking.user = &calls;
    assert_int_equal(weft_scene_bake(scene, 0, &baking, "stopped", NULL, &error), WEFT_INTERRUPTED);
    assert_int_not_equal(access("stopped", F_OK), 0);
    assert_int_not_equal(material_of(scene).cloth, 0);
    weft_scene_free(scene);
}

static void an_unwoven_material_is_refused(void **state) {
    (void)state;
    WeftError error;
    WeftScene *scene = scene_of("preset:velvet");
    assert_int_not_equal(weft_scene_bake(scene, 0, &small, "maps", NULL, &error), WEFT_OK);
    assert_non_null(strstr(error.text, "not woven"));
    assert_int_not_equal(weft_scene_bake(scene, 7, &small, "maps", NULL, &error), WEFT_OK);
    assert_int_not_equal(access("maps", F_OK), 0);
    weft_scene_free(scene);
    scene = scene_of("preset:woven-poplin");
    assert_int_not_equal(weft_scene_bake(scene, 0, &(WeftBaking){.pixels = 3}, "maps", NULL, &error), WEFT_OK);
    assert_int_not_equal(material_of(scene).cloth, 0);
    assert_int_not_equal(access("maps", F_OK), 0);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(textures_take_the_place_of_threads_below_the_fuzz),
                                       cmocka_unit_test(inputs_over_threads_are_kept_or_said_to_be_lost),
                                       cmocka_unit_test(a_name_that_is_a_number_is_another_material),
                                       cmocka_unit_test(threads_without_coordinates_are_said_to_be_lost),
                                       cmocka_unit_test(white_cloth_is_as_bright_at_any_size),
                                       cmocka_unit_test(a_stopped_search_leaves_no_maps),
                                       cmocka_unit_test(an_unwoven_material_is_refused)};
    return cmocka_run_group_tests_name("measure/scene_bake", tests, scratch_group_begin, scratch_group_end);
}
