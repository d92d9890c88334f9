/* `weft doctor`: what it prints and writes, and how it ends.
 *
 * Labels: unsanitized */
#include "run.h"

#include <jansson.h>

#include "weft/weft.h"

/* "sick.gltf": the triangle of scene.gltf with a metal under its sheen, whose extension is not declared, and
 * an animation that is nothing of weft's. */
static void sick_make(void) {
    size_t size;
    char *text = file_bytes("scene.gltf", &size), sick[4096];
    static const char used[] = "\"extensionsUsed\":[\"KHR_materials_sheen\"],";
    char *place = strstr(text, used);
    assert_non_null(place);
    snprintf(sick, sizeof sick, "%.*s\"animations\":[{\"name\":\"wave\",\"channels\":[],\"samplers\":[]}],%s",
             (int)(place - text), text, place + strlen(used));
    file_make("sick.gltf", sick, strlen(sick));
    free(text);
}

static int begin(void **state) {
    if (scene_begin(state) != 0) return -1;
    sick_make();
    return 0;
}

static json_t *report_of(const char *const *arguments, int code) {
    Ran ran = run_with(NULL, arguments);
    if (ran.code != code) fail_msg("exit %d: %s%s", ran.code, ran.err, ran.out);
    assert_string_equal(ran.err, "");
    json_error_t error;
    json_t *json = json_loads(ran.out, JSON_REJECT_DUPLICATES, &error);
    if (!json) fail_msg("%s: %.200s", error.text, ran.out);
    ran_free(&ran);
    return json;
}

static json_int_t whole(const json_t *json, const char *key) {
    const json_t *value = json_object_get(json, key);
    if (!json_is_integer(value)) fail_msg("\"%s\" is no integer", key);
    return json_integer_value(value);
}

/* Whether a finding of that id is in the report. */
static bool finds(const json_t *report, const char *id) {
    size_t k;
    json_t *finding;
    json_array_foreach(json_object_get(report, "findings"), k, finding) {
        if (strcmp(json_string_value(json_object_get(finding, "id")), id) == 0) return true;
    }
    return false;
}

static void asset_with_faults_prints_each_finding(void **state) {
    (void)state;
    Ran ran = RUN("doctor", "sick.gltf");
    assert_int_equal(ran.code, 1);
    assert_string_equal(ran.err, "");
    assert_non_null(strstr(ran.out, "sick.gltf: 1 material (1 with a sheen), 1 mesh, 0 images\n"));
    assert_non_null(strstr(ran.out, "\nasset\n  error    extension-undeclared: KHR_materials_sheen is used"));
    assert_non_null(strstr(ran.out, "\nmaterial cloth\n"));
    assert_non_null(strstr(ran.out, "sheen-on-metal: "));
    assert_non_null(strstr(ran.out, "           --fix: write metallicFactor 0\n"));
    assert_non_null(strstr(ran.out, "\n1 error, "));
    for (const char *line = ran.out; *line; line += strcspn(line, "\n") + 1) assert_true(strcspn(line, "\n") <= 80);
    ran_free(&ran);

    json_t *report = report_of(LIST("doctor", "sick.gltf", "--json"), 1);
    assert_int_equal(whole(report, "errors"), 1);
    assert_int_equal(whole(report, "sheens"), 1);
    assert_true(finds(report, "sheen-on-metal"));
    assert_int_equal(whole(report, "errors") + whole(report, "warnings") + whole(report, "notes"),
                     json_array_size(json_object_get(report, "findings")));
    assert_int_equal(whole(report, "left"), whole(report, "errors") + whole(report, "warnings"));
    json_decref(report);
}

/* A scene of weft's own, which has notes at the most, and none of them with --no-notes. */
static void asset_without_findings_is_reported_as_healthy(void **state) {
    (void)state;
    WeftScene *scene;
    WeftError error;
    assert_int_equal(weft_scene_load("builtin:cloth", &scene, NULL, &error), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "*.ior", "1.4", NULL, &error), WEFT_OK); /* of which there is a note */
    assert_int_equal(weft_scene_save(scene, "cloth.glb", &error), WEFT_OK);
    weft_scene_free(scene);
    json_t *report = report_of(LIST("doctor", "cloth.glb", "--json", "--no-notes"), 0);
    assert_int_equal(whole(report, "left"), 0);
    assert_true(whole(report, "notes") > 0);
    assert_int_equal(json_array_size(json_object_get(report, "findings")), 0);
    json_decref(report);
}

/* Of two materials with a coloured reflectance the first has no sheen, which makes of it a note. */
static void warning_is_printed_beside_a_note_of_the_same_text(void **state) {
    (void)state;
    static const char colored[] = "\"KHR_materials_specular\":{\"specularColorFactor\":[1,0.2,0.2]}",
                      pbr[] = "\"pbrMetallicRoughness\":{\"metallicFactor\":0}";
    char text[1024];
    snprintf(text, sizeof text,
             "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_materials_sheen\","
             "\"KHR_materials_specular\"],\"materials\":[{\"name\":\"plain\",%s,\"extensions\":{%s}},"
             "{\"name\":\"cloth\",%s,\"extensions\":{%s,\"KHR_materials_sheen\":{\"sheenColorFactor\":"
             "[0.1,0.1,0.1],\"sheenRoughnessFactor\":0.8}}}]}",
             pbr, colored, pbr, colored);
    file_make("colored.gltf", text, strlen(text));
    Ran ran = RUN("doctor", "colored.gltf", "--no-notes");
    const char *cloth = strstr(ran.out, "\nmaterial cloth\n");
    if (!cloth || !strstr(cloth, "implausible: coloured reflectance")) fail_msg("%s%s", ran.out, ran.err);
    ran_free(&ran);
}

/* A picture that is not there, and one whose name is escaped and which is BMP, each in its place; the
 * material is examined as ever. */
static void missing_image_is_a_finding(void **state) {
    (void)state;
    static const char text[] = "{\"asset\":{\"version\":\"2.0\"},\"images\":[{\"uri\":\"not%20there.png\"},{"
                               "\"uri\":\"dark%20wool.png\"}],"
                               "\"textures\":[{\"source\":0},{\"source\":1}],\"materials\":[{"
                               "\"pbrMetallicRoughness\":{\"metallicFactor\":"
                               "3,\"baseColorTexture\":{\"index\":0}},\"normalTexture\":{\"index\":1}}]}";
    file_make("missing.gltf", text, sizeof text - 1);
    file_make("dark wool.png", "BM and more", 11);
    json_t *report = report_of(LIST("doctor", "missing.gltf", "--json"), 1),
           *findings = json_object_get(report, "findings");
    assert_int_equal(json_array_size(findings), 3);
    static const char *const ids[] = {"value-range", "image-unread", "image-unread"},
                             *const words[] = {"metallicFactor", "not there.png: cannot be opened",
                                               "dark wool.png: is not an image"},
                             *const places[] = {"/materials/0/pbrMetallicRoughness/metallicFactor", "/images/0",
                                                "/images/1"};
    for (size_t k = 0; k < 3; k++) {
        const json_t *finding = json_array_get(findings, k);
        assert_string_equal(json_string_value(json_object_get(finding, "id")), ids[k]);
        assert_string_equal(json_string_value(json_object_get(finding, "place")), places[k]);
        assert_non_null(strstr(json_string_value(json_object_get(finding, "words")), words[k]));
    }
    json_decref(report);
}

/* Names of an asset reach neither the text nor the JSON with characters that a terminal obeys. */
static void hostile_names_are_printed_harmlessly(void **state) {
    (void)state;
    static const char text[] = "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"X\xc2\x9b"
                               "5m\"],\"materials\":[{\"name\":"
                               "\"red\xc2\x9b"
                               "31m\xe2\x80\xae\",\"pbrMetallicRoughness\":{\"metallicFactor\":3}}]}";
    file_make("hostile.gltf", text, sizeof text - 1);
    for (int json = 0; json < 2; json++) {
        Ran ran = json ? RUN("doctor", "hostile.gltf", "--json") : RUN("doctor", "hostile.gltf");
        assert_int_equal(ran.code, 1);
        assert_non_null(strstr(ran.out, "31m"));
        assert_null(strstr(ran.out, "\xc2\x9b"));
        assert_null(strstr(ran.out, "\xe2\x80\xae"));
        ran_free(&ran);
    }
}

static void fix_changes_only_what_a_finding_names(void **state) {
    (void)state;
    Ran ran = RUN("doctor", "sick.gltf", "--fix", "-o", "mended.gltf");
    assert_int_equal(ran.code, 1); /* it has no normals still */
    assert_non_null(strstr(ran.out, " fixed in mended.gltf, where 1 error or warning is left\n"));
    ran_free(&ran);
    json_t *was = json_load_file("sick.gltf", 0, NULL), *now = json_load_file("mended.gltf", 0, NULL);
    json_t *used = json_object_get(now, "extensionsUsed"),
           *material = json_array_get(json_object_get(now, "materials"), 0);
    assert_string_equal(json_string_value(json_array_get(used, 0)), "KHR_materials_sheen");
    assert_int_equal(
        json_integer_value(json_object_get(json_object_get(material, "pbrMetallicRoughness"), "metallicFactor")), 0);
    json_object_del(now, "extensionsUsed");
    json_object_set(now, "materials", json_object_get(was, "materials"));
    assert_true(json_equal(was, now));
    json_decref(was);
    json_decref(now);
}

static void list_option_prints_every_finding(void **state) {
    (void)state;
    Ran ran = RUN("doctor", "--list");
    assert_int_equal(ran.code, 0);
    json_t *list = report_of(LIST("doctor", "--list", "--json"), 0);
    assert_int_equal(json_array_size(list), WEFT_FINDING_COUNT);
    for (int k = 0; k < WEFT_FINDING_COUNT; k++) {
        assert_non_null(strstr(ran.out, weft_finding_name(k)));
        assert_string_equal(json_string_value(json_object_get(json_array_get(list, (size_t)k), "id")),
                            weft_finding_name(k));
    }
    json_decref(list);
    ran_free(&ran);
}

/* Every finding has its paragraph in the page. */
static void docs_page_has_a_paragraph_for_every_finding(void **state) {
    (void)state;
    size_t size;
    char *page = file_bytes(WEFT_SOURCE_DIR "/docs/doctor.md", &size), heading[96];
    assert_non_null(page);
    for (int k = 0; k < WEFT_FINDING_COUNT; k++) {
        snprintf(heading, sizeof heading, "\n**%s**", weft_finding_name(k));
        if (!strstr(page, heading)) fail_msg("docs/doctor.md: nothing of %s", weft_finding_name(k));
    }
    free(page);
}

static void doctor_commands_without_sense_are_refused(void **state) {
    (void)state;
    assert_complaint(NULL, LIST("doctor"), 2, "lacks an operand");
    assert_complaint(NULL, LIST("doctor", "sick.gltf", "--fix"), 2, "-o FILE");
    assert_complaint(NULL, LIST("doctor", "sick.gltf", "-o", "a.glb"), 2, "--fix");
    assert_complaint(NULL, LIST("doctor", "sick.gltf", "--fix", "-o", "a.obj"), 2, "a.obj");
    assert_complaint(NULL, LIST("doctor", "--list", "sick.gltf"), 2, "--list");
    assert_complaint(NULL, LIST("doctor", "nothing.gltf"), 3, "nothing.gltf: cannot be opened");
    assert_complaint(NULL, LIST("doctor", "builtin:cloth"), 3, "--save");
    assert_complaint(NULL, LIST("doctor", "cloth.u3m", "--fix", "-o", "a.glb"), 2, "examined and not repaired");
    assert_complaint(NULL, LIST("doctor", "cloth.u3m"), 3, "cloth.u3m: cannot be opened");
    assert_complaint(NULL, LIST("doctor", "sick.gltf", "--fix", "-o", "nowhere/a.glb"), 4, "nowhere/a.glb");
    file_make("broken.glb", "glTF\2\0\0\0", 8);
    assert_complaint(NULL, LIST("doctor", "broken.glb"), 3, "broken.glb: is not a valid GLB container");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(asset_with_faults_prints_each_finding),
        cmocka_unit_test(asset_without_findings_is_reported_as_healthy),
        cmocka_unit_test(warning_is_printed_beside_a_note_of_the_same_text),
        cmocka_unit_test(missing_image_is_a_finding),
        cmocka_unit_test(hostile_names_are_printed_harmlessly),
        cmocka_unit_test(fix_changes_only_what_a_finding_names),
        cmocka_unit_test(list_option_prints_every_finding),
        cmocka_unit_test(docs_page_has_a_paragraph_for_every_finding),
        cmocka_unit_test(doctor_commands_without_sense_are_refused),
    };
    return cmocka_run_group_tests(tests, begin, work_end);
}
