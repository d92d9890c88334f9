/* `weft match`: what it prints and writes, and how it ends.
 *
 * Labels: unsanitized */
#include "run.h"

#include <math.h>

#include <jansson.h>

#include "weft/weft.h"

static json_t *printed(const char *const *arguments) {
    Ran ran = run_with(NULL, arguments);
    if (ran.code != 0) fail_msg("%d: %s", ran.code, ran.err);
    json_error_t error;
    json_t *json = json_loads(ran.out, JSON_REJECT_DUPLICATES, &error);
    if (!json) fail_msg("%s: %.200s", error.text, ran.out);
    ran_free(&ran);
    return json;
}

static double number(const json_t *json, const char *key) {
    const json_t *value = json_object_get(json, key);
    if (!json_is_number(value)) fail_msg("\"%s\" is no number", key);
    return json_number_value(value);
}

static double value_of(const json_t *json, const char *side, const char *name) {
    return number(json_object_get(json_object_get(json, side), "values"), name);
}

static double error_of(const json_t *json, const char *side) { return number(json_object_get(json, side), "error"); }

static void match_of_a_lobe_with_itself_keeps_its_parameters(void **state) {
    (void)state;
    json_t *json = printed(
        LIST("match", "charlie-neubelt:alpha=0.37,color=0.9,0.4,0.2", "charlie-neubelt", "--json", "--metric", "log"));
    assert_string_equal(json_string_value(json_object_get(json, "metric")), "log");
    assert_true(fabs(value_of(json, "matched", "alpha") - 0.37) < 1e-3);
    assert_true(error_of(json, "matched") < 1e-6);
    json_decref(json);
}

static void matched_lobe_is_closer_than_the_copied_one(void **state) {
    (void)state;
    json_t *json = printed(LIST("match", "khronos:sheen_roughness=0.4", "three", "--json", "-o", "m.json"));
    assert_true(fabs(value_of(json, "copied", "sheen_roughness") - 0.4) < 1e-6);
    assert_true(error_of(json, "matched") < 0.5 * error_of(json, "copied"));
    assert_true(json_array_size(json_object_get(json, "parts")) == 3);
    /* the material that was written is the match */
    WeftMaterial material;
    WeftError error;
    if (weft_material_read("m.json", &material, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    for (int k = 0; weft_material_input_name(k); k++)
        if (strcmp(weft_material_input_name(k), "sheen_roughness") == 0)
            assert_true(fabs((double)material.inputs[k].value[0] - value_of(json, "matched", "sheen_roughness")) <
                        1e-5);
    json_decref(json);
}

static void match_writes_its_comparison_sheet(void **state) {
    (void)state;
    Ran ran = RUN("match", "charlie-neubelt", "patry:density=2", "--hold", "density", "-o", "m.png");
    if (ran.code != 0) fail_msg("%s", ran.err);
    assert_non_null(strstr(ran.out, "cosine"));
    assert_non_null(strstr(ran.out, "matched"));
    WeftImage image;
    assert_int_equal(weft_image_read("m.png", &image, NULL, NULL), WEFT_OK);
    assert_true(image.width > 900 && image.height > 600);
    weft_image_free(&image);
    ran_free(&ran);
    json_t *json = printed(LIST("match", "charlie-neubelt", "patry:density=2", "--hold", "density", "--json"));
    assert_true(fabs(value_of(json, "matched", "density") - 2.0) < 1e-6);
    json_decref(json);
}

/* The sheen of a file, for another engine: only its factors change. */
static void matched_asset_is_written(void **state) {
    (void)state;
    json_t *json =
        printed(LIST("match", "scene.gltf", "--from", "khronos", "--to", "three", "-o", "out.gltf", "--json"));
    const json_t *cloth = json_array_get(json_object_get(json, "materials"), 0);
    assert_true(json_is_true(json_object_get(cloth, "changed")));
    assert_true(number(cloth, "matched") < number(cloth, "copied"));
    WeftScene *scenes[2];
    WeftMaterial materials[2];
    for (int k = 0; k < 2; k++) {
        WeftError error;
        if (weft_scene_load(k ? "out.gltf" : "scene.gltf", &scenes[k], NULL, &error) != WEFT_OK)
            fail_msg("%s", error.text);
        assert_int_equal(weft_scene_material(scenes[k], 0, &materials[k], NULL), WEFT_OK);
    }
    const json_t *factors = json_object_get(cloth, "factors");
    for (int n = 0; weft_material_input_name(n); n++) {
        const json_t *now = json_object_get(factors, weft_material_input_name(n));
        for (int c = 0; c < 3; c++) {
            double expected = now && (size_t)c < json_array_size(now)
                                  ? json_number_value(json_array_get(now, (size_t)c))
                                  : (double)materials[0].inputs[n].value[c];
            assert_true(fabs((double)materials[1].inputs[n].value[c] - expected) < 2e-6);
        }
    }
    assert_true(json_object_size(factors) >= 2);
    assert_int_equal(weft_scene_info(scenes[0]).triangle_count, weft_scene_info(scenes[1]).triangle_count);
    for (int k = 0; k < 2; k++) weft_scene_free(scenes[k]);
    json_decref(json);
    /* and to specular and back */
    json = printed(LIST("match", "scene.gltf", "--workflow", "specular", "-o", "specular.glb", "--json"));
    assert_true(json_is_true(json_object_get(json_array_get(json_object_get(json, "materials"), 0), "converted")));
    assert_true(number(json_array_get(json_object_get(json, "materials"), 0), "loss") < 0.01);
    json_decref(json);
    json = printed(LIST("match", "specular.glb", "--workflow", "metallic", "-o", "metallic.glb", "--json"));
    json_decref(json);
}

/* "many.gltf": materials with a sheen, each its own. */
static void many_make(int count) {
    FILE *stream = fopen("many.gltf", "w");
    assert_non_null(stream);
    fputs("{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_materials_sheen\"],\"materials\":[", stream);
    for (int k = 0; k < count; k++)
        fprintf(stream,
                "%s{\"extensions\":{\"KHR_materials_sheen\":{\"sheenColorFactor\":[1,0.9,%.4f],"
                "\"sheenRoughnessFactor\":%.4f}}}",
                k ? "," : "", 0.5 + 0.4 * k / count, 0.2 + 0.7 * k / count);
    fputs("]}", stream);
    fclose(stream);
}

/* Either would take minutes. */
static void interrupted_match_of_many_materials_ends(void **state) {
    (void)state;
    const char *const *const verbs[] = {
        LIST("match", "many.gltf", "--from", "khronos", "--to", "three", "-o", "never.gltf"),
        LIST("doctor", "many.gltf", "--fix", "-o", "never.gltf")};
    many_make(5000);
    for (int k = 0; k < 2; k++) {
        pid_t child = program_start(WEFT_PROGRAM, NULL, verbs[k]);
        await_handler(child);
        sleep_seconds(0.5);
        kill(child, SIGINT);
        Ran ran = program_end(child);
        if (ran.code != 130 || !one_complaint(ran.err) || !strstr(ran.err, "many.gltf: interrupted") || ran.out[0])
            fail_msg("%d: %s", ran.code, ran.err);
        assert_int_equal(access("never.gltf", F_OK), -1);
        ran_free(&ran);
    }
}

static WeftImage drawn(const char *scene, const char *profile) {
    Ran ran = RUN("render", scene, "--profile", profile, "--width", "160", "--height", "120", "--spp", "16", "-o",
                  "drawn.exr");
    if (ran.code != 0) fail_msg("%s", ran.err);
    ran_free(&ran);
    WeftImage image;
    assert_int_equal(weft_image_read("drawn.exr", &image, NULL, NULL), WEFT_OK);
    return image;
}

static double flip(const WeftImage *image, const WeftImage *reference) {
    WeftDiff found;
    const WeftDiffDesc desc = {.image = image, .reference = reference, .metric = WEFT_METRIC_FLIP, .exposed = 1};
    assert_int_equal(weft_diff(&desc, &found, NULL, NULL), WEFT_OK);
    return found.value;
}

/* Assets of Khronos: drawn by the other engine they are closer to what they were than with their own numbers.
 * SheenCloth has everything in textures. */
static void matched_assets_are_closer_in_the_other_engine_than_copied(void **state) {
    (void)state;
    static const struct {
        const char *path, *engine;
        double most; /* of the difference of the copy */
    } cases[] = {{"SheenChair/SheenChair.gltf", "three", 0.6},
                 {"SheenCloth/SheenCloth.gltf", "three", 0.7},
                 {"SheenChair/SheenChair.gltf", "filament-cloth", 1.0},
                 {"SheenChair/SheenChair.gltf", "filament-sheen", 1.0}};
    const char *folder = getenv("WEFT_DATA");
    if (!folder || !*folder) folder = WEFT_SOURCE_DIR "/../shared/data";
    int drawn_cases = 0;
    for (int k = 0; k < (getenv("WEFT_TEST_LONG") ? 4 : 2); k++) {
        char asset[512];
        snprintf(asset, sizeof asset, "%s/gltf/%s", folder, cases[k].path);
        if (access(asset, R_OK) != 0) continue;
        drawn_cases++;
        Ran ran = RUN("match", asset, "--from", "khronos", "--to", cases[k].engine, "-o", "matched.glb");
        if (ran.code != 0) fail_msg("%s", ran.err);
        ran_free(&ran);
        WeftImage original = drawn(asset, "khronos"), copied = drawn(asset, cases[k].engine),
                  matched = drawn("matched.glb", cases[k].engine);
        double before = flip(&copied, &original), after = flip(&matched, &original);
        print_message("%s, %s: flip %.4f copied, %.4f matched\n", cases[k].path, cases[k].engine, before, after);
        assert_true(after < cases[k].most * before);
        weft_image_free(&original);
        weft_image_free(&copied);
        weft_image_free(&matched);
    }
    if (drawn_cases == 0) {
        print_message("skipped: no assets at hand\n");
        skip();
    }
}

/* An asset looks in the viewers as it does in Blender 4, whatever one calls that. */
static void asset_of_blender_is_matched_under_any_of_its_names(void **state) {
    (void)state;
    static const char *const names[] = {"cycles-principled", "blender4", "blender-4"};
    double matched[3];
    for (int k = 0; k < 3; k++) {
        json_t *json =
            printed(LIST("match", "scene.gltf", "--from", names[k], "--to", "khronos", "-o", "b.gltf", "--json"));
        const json_t *cloth = json_array_get(json_object_get(json, "materials"), 0);
        assert_true(json_is_true(json_object_get(cloth, "changed")));
        matched[k] = number(cloth, "matched");
        assert_true(matched[k] < 0.7 * number(cloth, "copied"));
        json_decref(json);
    }
    assert_true(fabs(matched[1] - matched[0]) < 1e-9 && fabs(matched[2] - matched[0]) < 1e-9);
    assert_complaint(NULL, LIST("match", "scene.gltf", "--from", "blender", "--to", "three", "-o", "b.gltf"), 2,
                     "blender: is not a profile; several have this name: blender-3 (cycles-velvet), blender-4 "
                     "(cycles-principled)");
    assert_complaint(NULL, LIST("render", "scene.gltf", "--profile", "blender", "-o", "b.png"), 2,
                     "blender-4 (cycles-principled)");
    assert_complaint(NULL, LIST("render", "scene.gltf", "--profile", "cycles", "-o", "b.png"), 2,
                     "several have this name: cycles-velvet, cycles-principled");
}

static void match_options_without_sense_are_refused(void **state) {
    (void)state;
    assert_complaint(NULL, LIST("match", "ggx"), 2, "FROM and TO");
    assert_complaint(NULL, LIST("match", "--table", "ggx"), 2, "takes no names");
    assert_complaint(NULL, LIST("match", "--maps", "--table"), 2, "does not go with");
    assert_complaint(NULL, LIST("match", "--maps", "-o", "a.png"), 2, "does not go with");
    assert_complaint(NULL, LIST("match", "ggx", "silk", "--from", "three"), 2, "does not go with");
    assert_complaint(NULL, LIST("match", "scene.gltf", "--to", "three", "--hold", "x", "-o", "a.glb"), 2, "--hold");
    assert_complaint(NULL, LIST("match", "scene.gltf", "--to", "three", "-o", "a.json"), 2, ".gltf or .glb");
    assert_complaint(NULL, LIST("match", "scene.gltf", "--to", "three", "-o", "scene.gltf"), 2, "would be lost");
    assert_complaint(NULL, LIST("match", "ggx", "velours"), 2, "velours");
    assert_complaint(NULL, LIST("match", "ggx", "silk", "--metric", "l2"), 2, "l2");
    assert_complaint(NULL, LIST("match", "ggx", "silk", "--hold", "lustre"), 2, "lustre");
    assert_complaint(NULL, LIST("match", "ggx", "three", "--hold", "lustre"), 2, "lustre");
    assert_complaint(NULL, LIST("match", "ggx", "fibre-walk"), 2, "mean");
    assert_complaint(NULL, LIST("match", "ggx", "silk", "-o", "a.json"), 2, "not a material");
    assert_complaint(NULL, LIST("match", "ggx", "silk", "-o", "a.txt"), 2, ".png");
    assert_complaint(NULL, LIST("match", "scene.gltf", "--to", "three"), 2, "-o");
    assert_complaint(NULL, LIST("match", "scene.gltf", "--to", "two", "-o", "a.glb"), 2, "two");
    assert_complaint(NULL, LIST("match", "not-there.gltf", "--to", "three", "-o", "a.glb"), 3, "not-there");
    assert_complaint(NULL, LIST("match", "scene.gltf", "--to", "three", "--workflow", "metallic", "-o", "a.glb"), 2,
                     "--workflow");
    assert_complaint(NULL, LIST("match", "not-there.binary", "ggx"), 3, "not-there");
    assert_int_equal(access("a.glb", F_OK), -1);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(match_of_a_lobe_with_itself_keeps_its_parameters),
                                       cmocka_unit_test(matched_lobe_is_closer_than_the_copied_one),
                                       cmocka_unit_test(match_writes_its_comparison_sheet),
                                       cmocka_unit_test(matched_asset_is_written),
                                       cmocka_unit_test(interrupted_match_of_many_materials_ends),
                                       cmocka_unit_test(matched_assets_are_closer_in_the_other_engine_than_copied),
                                       cmocka_unit_test(asset_of_blender_is_matched_under_any_of_its_names),
                                       cmocka_unit_test(match_options_without_sense_are_refused)};
    return cmocka_run_group_tests(tests, scene_begin, work_end);
}
