/* The match of a textured asset: each texel reflects as the texel that it was made from does in the other engine,
 * what a factor does is left to it, and everything else in the file stays.
 *
 * Labels: unsanitized */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "scratch.h"
#include "weft/weft.h"

enum { SIDE = 16 };

static const char *const inputs[] = {"base_color", "roughness", "sheen_color", "sheen_roughness", "specular"};
enum { INPUTS = sizeof inputs / sizeof *inputs };

static int profile_named(const char *id) {
    int k = 0;
    while (weft_profile_name(k) && strcmp(weft_profile_name(k), id) != 0) k++;
    return k;
}

static int input_named(const char *name) {
    int k = 0;
    while (weft_material_input_name(k) && strcmp(weft_material_input_name(k), name) != 0) k++;
    assert_non_null(weft_material_input_name(k));
    return k;
}

static bool has_map(const WeftAssetMatch *match, const char *input) { return match->maps >> input_named(input) & 1; }

/* A triangle with coordinates, in the material given. */
static void asset_write(const char *path, const char *materials, const char *images) {
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    fprintf(
        stream,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],"
        "\"nodes\":[{\"mesh\":0},{\"mesh\":1}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":0}]},"
        "{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":1}]}],"
        "\"extensionsUsed\":[\"KHR_materials_sheen\",\"KHR_texture_transform\"],\"materials\":[%s],"
        "\"samplers\":[{\"magFilter\":9728}],"
        "%s,\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
        "\"min\":[-1,-1,0],\"max\":[1,1,0]},{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":"
        "\"data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA\"}]}\n",
        materials, images);
    fclose(stream);
}

/* An sRGB colour of 200 in RGB, and in alpha, or else in green, a ramp from 40 to 250. */
static void ramp_write(const char *path, int channel) {
    WeftImage image;
    WeftError error;
    if (weft_image_create(SIDE, SIDE, channel == 3 ? 4 : 3, WEFT_PIXEL_U8, &image, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    for (int k = 0; k < SIDE * SIDE; k++)
        for (int c = 0; c < image.channels; c++)
            ((uint8_t *)image.pixels)[k * image.channels + c] =
                (uint8_t)(c == channel ? 40 + 210 * (k % SIDE) / (SIDE - 1) : 200);
    if (weft_image_write(path, &image, &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_image_free(&image);
}

static WeftResult match_files(const char *in, const char *out, WeftProgress progress, void *user,
                              WeftAssetMatch **report, WeftError *error) {
    int count;
    return weft_match_asset(in, out, profile_named("khronos"), profile_named("three"), WEFT_BRDF_METRIC_COSINE,
                            progress, user, report, &count, NULL, error);
}

static WeftAssetMatch *matched(const char *in, const char *out) {
    WeftAssetMatch *report;
    WeftError error;
    if (match_files(in, out, NULL, NULL, &report, &error) != WEFT_OK) fail_msg("%s", error.text);
    return report;
}

static WeftScene *loaded(const char *path) {
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load(path, &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

static double linear_of(double x) { return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4); }

/* The material of a column of texels, without textures, under a profile. */
static WeftMaterial texel_material(const WeftScene *scene, int index, int column, const char *profile) {
    WeftMaterial material;
    WeftError error;
    assert_int_equal(weft_scene_material(scene, index, &material, &error), WEFT_OK);
    for (int n = 0; n < INPUTS; n++) {
        WeftInput *input = &material.inputs[input_named(inputs[n])];
        if (!input->texture) continue;
        const WeftImage image = weft_scene_texture(scene, input->texture);
        const bool color = strstr(inputs[n], "color") != NULL;
        for (int c = 0; c < (color ? 3 : 1); c++) {
            const int at = column * image.channels + (color ? c : input->channel);
            const double x = ((const uint8_t *)image.pixels)[at] / 255.0;
            input->value[c] = (float)((double)input->value[c] * (color ? linear_of(x) : x));
        }
    }
    for (int k = 0; k < WEFT_INPUTS_MAX; k++) material.inputs[k].texture = 0;
    assert_int_equal(weft_material_set(&material, "profile", profile, NULL, &error), WEFT_OK);
    return material;
}

static WeftReflection *texel_of(const WeftScene *scene, int index, int column, const char *profile) {
    const WeftMaterial material = texel_material(scene, index, column, profile);
    WeftReflection *reflection;
    WeftError error;
    if (weft_reflection_create(&material, &reflection, &error) != WEFT_OK) fail_msg("%s", error.text);
    return reflection;
}

static double apart(const WeftReflection *to, const WeftReflection *from) {
    double distance;
    assert_int_equal(weft_brdf_distance(to, from, WEFT_PART_ALL, WEFT_BRDF_METRIC_COSINE, &distance, NULL), WEFT_OK);
    return distance;
}

/* The greatest difference of E over angles and channels. */
static double albedo_apart(const WeftReflection *to, const WeftReflection *from) {
    static const float cosines[] = {0.3f, 0.6f, 0.95f};
    double most = 0.0;
    for (int k = 0; k < 3; k++) {
        float a[3], b[3];
        weft_reflection_albedo(to, WEFT_PART_ALL, cosines[k], a);
        weft_reflection_albedo(from, WEFT_PART_ALL, cosines[k], b);
        for (int c = 0; c < 3; c++) most = fmax(most, fabs((double)a[c] - (double)b[c]));
    }
    return most;
}

/* A cloth whose sheen has its colour and its roughness, 0.16 to 0.98, in one picture. */
static const char ramp_cloth[] =
    "{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.8,\"baseColorFactor\":[0.5,0.3,0.2,1]},"
    "\"extensions\":{\"KHR_materials_sheen\":{\"sheenColorFactor\":[1,0.9,0.8],\"sheenColorTexture\":{\"index\":0,"
    "\"extensions\":{\"KHR_texture_transform\":{\"scale\":[3,2]}}},"
    "\"sheenRoughnessFactor\":1,\"sheenRoughnessTexture\":{\"index\":0,"
    "\"extensions\":{\"KHR_texture_transform\":{\"scale\":[3,2]}}}}}}";
static const char one_image[] = "\"textures\":[{\"source\":0,\"sampler\":0}],\"images\":[{\"uri\":\"ramp.png\"}]";

static void each_texel_of_a_ramp_is_matched(void **state) {
    (void)state;
    char materials[2 * sizeof ramp_cloth + 2];
    ramp_write("ramp.png", 3);
    snprintf(materials, sizeof materials, "%s,%s", ramp_cloth, ramp_cloth);
    asset_write("ramp.gltf", materials, one_image);
    WeftAssetMatch *report = matched("ramp.gltf", "ramp-three.gltf");
    assert_true(has_map(report, "sheen_roughness") && has_map(report, "sheen_color") && has_map(report, "base_color"));
    WeftScene *before = loaded("ramp.gltf"), *after = loaded("ramp-three.gltf");
    double sums[2] = {0.0}, worst = 0.0;
    for (int column = 0; column < SIDE; column++) {
        WeftReflection *source = texel_of(before, 0, column, "khronos"), *copy = texel_of(before, 0, column, "three"),
                       *match = texel_of(after, 0, column, "three");
        const double copied = apart(copy, source), now = apart(match, source), albedo = albedo_apart(match, source);
        print_message("%2d: error %.4f copied, %.4f matched; E off by %.4f, %.4f\n", column, copied, now,
                      albedo_apart(copy, source), albedo);
        assert_true(now < copied);
        sums[0] += copied;
        sums[1] += now;
        worst = fmax(worst, albedo);
        weft_reflection_free(source);
        weft_reflection_free(copy);
        weft_reflection_free(match);
    }
    assert_true(sums[1] < 0.4 * sums[0]);
    assert_true(worst < 0.03);
    /* two materials that are equal share what was made, and the placement stays */
    WeftMaterial materials_after[2];
    for (int k = 0; k < 2; k++) assert_int_equal(weft_scene_material(after, k, &materials_after[k], NULL), WEFT_OK);
    for (int n = 0; n < 4; n++) {
        const WeftInput *a = &materials_after[0].inputs[input_named(inputs[n])],
                        *b = &materials_after[1].inputs[input_named(inputs[n])];
        assert_int_equal(a->texture, b->texture);
        if (a->texture) assert_true(fabsf(a->transform[0] - 3.0f) < 1e-6f && fabsf(a->transform[4] - 2.0f) < 1e-6f);
    }
    /* the colour and the roughness of the sheen are still one picture */
    assert_int_equal(materials_after[0].inputs[input_named("sheen_color")].texture,
                     materials_after[0].inputs[input_named("sheen_roughness")].texture);
    weft_scene_free(before);
    weft_scene_free(after);
    weft_match_report_free(report);
}

static size_t file_bytes(const char *path, char *bytes, size_t room) {
    FILE *stream = fopen(path, "rb");
    if (!stream) fail_msg("%s is not there", path);
    size_t size = fread(bytes, 1, room, stream);
    fclose(stream);
    return size;
}

/* A sheen that is the same everywhere, on a base with a picture. */
static void where_factors_do_textures_stay(void **state) {
    (void)state;
    static const char plain[] =
        "{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.8,\"baseColorFactor\":[0.5,0.3,0.2,1],"
        "\"baseColorTexture\":{\"index\":0}},\"extensions\":{\"KHR_materials_sheen\":{\"sheenColorFactor\":[1,0.9,0.8],"
        "\"sheenRoughnessFactor\":0.6}}},{}";
    static char text[8192];
    ramp_write("ramp.png", 1);
    asset_write("plain.gltf", plain, one_image);
    assert_int_equal(mkdir("plain-out", 0777), 0);
    WeftAssetMatch *report = matched("plain.gltf", "plain-out/plain.gltf");
    assert_true(report[0].changed && report[0].maps == 0 && !report[1].changed);
    static char was[4096], now[4096];
    const size_t size = file_bytes("ramp.png", was, sizeof was);
    assert_int_equal(file_bytes("plain-out/ramp.png", now, sizeof now), size);
    assert_memory_equal(was, now, size);
    text[file_bytes("plain-out/plain.gltf", text, sizeof text - 1)] = '\0';
    assert_non_null(strstr(text, one_image));
    weft_match_report_free(report);
}

/* With two placements no texel of one texture belongs to one of the other: the colour keeps its picture. */
static void colour_at_another_place_is_left_to_its_factor(void **state) {
    (void)state;
    char cloth[sizeof ramp_cloth + 8];
    snprintf(cloth, sizeof cloth, "%s,{}", ramp_cloth);
    strstr(cloth, "[3,2]")[1] = '5'; /* of the colour */
    ramp_write("ramp.png", 3);
    asset_write("apart.gltf", cloth, one_image);
    WeftAssetMatch *report = matched("apart.gltf", "apart-three.gltf");
    assert_true(has_map(report, "sheen_roughness") && !has_map(report, "sheen_color") && has_map(report, "base_color"));
    weft_match_report_free(report);
}

/* A factor above 1 is not cut off where texels can take it. */
static void dark_texture_takes_what_a_factor_cannot(void **state) {
    (void)state;
    static const char cloth[] =
        "{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.8,\"baseColorFactor\":[0.5,0.3,0.2,1]},"
        "\"extensions\":{\"KHR_materials_sheen\":{\"sheenColorFactor\":[1,1,1],\"sheenColorTexture\":{\"index\":0},"
        "\"sheenRoughnessFactor\":0.9}}},{}";
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_image_create(4, 4, 3, WEFT_PIXEL_U8, &image, &error), WEFT_OK);
    memset(image.pixels, 180, 48);
    assert_int_equal(weft_image_write("ramp.png", &image, &error), WEFT_OK);
    weft_image_free(&image);
    asset_write("dark.gltf", cloth, one_image);
    WeftAssetMatch *report = matched("dark.gltf", "dark-three.gltf");
    assert_true(has_map(report, "sheen_color") && !report[0].clipped);
    WeftScene *before = loaded("dark.gltf"), *after = loaded("dark-three.gltf");
    WeftReflection *source = texel_of(before, 0, 0, "khronos"), *match = texel_of(after, 0, 0, "three");
    const double now = apart(match, source);
    print_message("dark: error %.4f, of the search %.4f\n", now, report[0].found.matched);
    assert_true(now < report[0].found.matched + 0.003);
    weft_reflection_free(source);
    weft_reflection_free(match);
    weft_scene_free(before);
    weft_scene_free(after);
    weft_match_report_free(report);
}

/* A stop while texels are made writes nothing, and neither does a match whose picture cannot be written. */
static int stop_at_the_end(void *user, double fraction) {
    (void)user;
    return fraction >= 1.0;
}

static void stopped_or_refused_match_writes_nothing(void **state) {
    (void)state;
    char materials[sizeof ramp_cloth + 8];
    WeftAssetMatch *report;
    WeftError error;
    ramp_write("ramp.png", 3);
    snprintf(materials, sizeof materials, "%s,{}", ramp_cloth);
    asset_write("ramp.gltf", materials, one_image);
    assert_int_equal(match_files("ramp.gltf", "never.gltf", stop_at_the_end, NULL, &report, &error), WEFT_INTERRUPTED);
    assert_int_equal(access("never.gltf", F_OK), -1);
    assert_int_equal(mkdir("never-1.png", 0777), 0);
    assert_int_not_equal(match_files("ramp.gltf", "never.gltf", NULL, NULL, &report, &error), WEFT_OK);
    assert_non_null(strstr(error.text, "never-1.png"));
    assert_int_equal(access("never.gltf", F_OK), -1);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_texel_of_a_ramp_is_matched),
                                       cmocka_unit_test(where_factors_do_textures_stay),
                                       cmocka_unit_test(colour_at_another_place_is_left_to_its_factor),
                                       cmocka_unit_test(dark_texture_takes_what_a_factor_cannot),
                                       cmocka_unit_test(stopped_or_refused_match_writes_nothing)};
    char folder[SCRATCH_SIZE];
    if (!scratch_enter(folder)) return 1;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    if (chdir("/") != 0 || !scratch_remove(folder)) return 1;
    return failed;
}
