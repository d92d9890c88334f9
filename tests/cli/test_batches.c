/* Several assets in one call: one after another, each with files of its own, and the gravest exit code.
 *
 * Labels: unsanitized */
#include "run.h"

#include <sys/stat.h>

static void asset_make(const char *name, const char *factor) {
    char text[512];
    snprintf(
        text, sizeof text,
        "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_materials_sheen\"],\"materials\":[{\"name\":\"m\","
        "\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"baseColorFactor\":[%s,0.4,0.4,1]},\"extensions\":{"
        "\"KHR_materials_sheen\":{\"sheenColorFactor\":[0.1,0.1,0.1],\"sheenRoughnessFactor\":0.8}}}]}",
        factor);
    file_make(name, text, strlen(text));
}

static int begin(void **state) {
    if (scene_begin(state) != 0) return -1;
    asset_make("sound.gltf", "0.4");
    asset_make("wrong.gltf", "1.5");
    return mkdir("out", 0700) || mkdir("twin", 0700) ? -1 : 0;
}

static bool is_file(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode);
}

static void assets_are_examined_one_after_another(void **state) {
    (void)state;
    Ran ran = RUN("doctor", "sound.gltf", "wrong.gltf");
    assert_int_equal(ran.code, 1);
    const char *first = strstr(ran.out, "sound.gltf: "), *second = strstr(ran.out, "wrong.gltf: ");
    assert_true(first && second && first < second);
    assert_non_null(strstr(second, "value-range"));
    ran_free(&ran);
    ran = RUN("doctor", "sound.gltf", "sound.gltf");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    /* An asset that fails is named, and the next is taken; the gravest code counts, wherever it is. */
    ran = RUN("doctor", "absent.gltf", "wrong.gltf", "sound.gltf");
    assert_int_equal(ran.code, 3);
    assert_non_null(strstr(ran.err, "absent.gltf: cannot be opened"));
    assert_non_null(strstr(ran.out, "wrong.gltf: "));
    assert_non_null(strstr(ran.out, "sound.gltf: "));
    ran_free(&ran);
}

static void each_asset_has_a_file_of_its_own(void **state) {
    (void)state;
    Ran ran = RUN("doctor", "sound.gltf", "wrong.gltf", "--fix", "-o", "out");
    assert_int_equal(ran.code, 0);
    assert_true(is_file("out/sound.gltf") && is_file("out/wrong.gltf"));
    ran_free(&ran);
    ran = RUN("match", "sound.gltf", "out/wrong.gltf", "--to", "three", "-o", "out/{}-three.glb");
    if (ran.code != 0) fail_msg("%s", ran.err);
    assert_true(is_file("out/sound-three.glb") && is_file("out/wrong-three.glb"));
    ran_free(&ran);
    ran = RUN("render", "builtin:ball", "scene.gltf", "-o", "out/", "-o", "{}.exr", "--width", "8", "--height", "8",
              "--spp", "1");
    if (ran.code != 0) fail_msg("%s", ran.err);
    assert_true(is_file("out/ball.png") && is_file("out/scene.png") && is_file("ball.exr") && is_file("scene.exr"));
    ran_free(&ran);
    ran = RUN("render", "scene.gltf", "--save", "{}-saved.glb");
    assert_int_equal(ran.code, 0);
    assert_true(is_file("scene-saved.glb"));
    ran_free(&ran);
}

static void one_file_for_several_assets_is_refused(void **state) {
    (void)state;
    assert_complaint(NULL, LIST("doctor", "sound.gltf", "wrong.gltf", "--fix", "-o", "a.gltf"), 2,
                     "-o: \"a.gltf\" is one file for 2 assets");
    assert_complaint(NULL, LIST("render", "scene.gltf", "sound.gltf", "-o", "a.png"), 2, "name a folder");
    assert_complaint(NULL, LIST("render", "scene.gltf", "twin/scene.gltf", "-o", "out/{}.png"), 2,
                     "\"out/scene.png\" would be written for scene.gltf and for twin/scene.gltf");
    assert_complaint(NULL, LIST("match", "a", "b", "c"), 2, "match needs two names");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(assets_are_examined_one_after_another),
        cmocka_unit_test(each_asset_has_a_file_of_its_own),
        cmocka_unit_test(one_file_for_several_assets_is_refused),
    };
    return cmocka_run_group_tests(tests, begin, work_end);
}
