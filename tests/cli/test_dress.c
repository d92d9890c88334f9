/* What the materials of a render are to be: which option wins, what is refused, sheets of several. */
#include "run.h"

#include <jansson.h>

#include "weft/weft.h"

#define TINY "--width=32", "--height=24", "--spp=2", "--quiet"

/* The bytes of the picture that these options make of the test scene. */
static char *picture(size_t *size, const char *const *options) {
    const char *arguments[32] = {"render", "scene.gltf", TINY, "-o", "out.exr"};
    int count = 8;
    for (int k = 0; options[k]; k++) arguments[count++] = options[k];
    Ran ran = run_with(NULL, arguments);
    if (ran.code != 0) fail_msg("%s ...: %d: %s", options[0], ran.code, ran.err);
    ran_free(&ran);
    return file_bytes("out.exr", size);
}

static bool same(const char *const *a, const char *const *b) {
    size_t size_a, size_b;
    char *one = picture(&size_a, a), *two = picture(&size_b, b);
    bool equal = size_a == size_b && memcmp(one, two, size_a) == 0;
    free(one);
    free(two);
    return equal;
}

#define CHOICES "\"sheen_lobe\":\"charlie-neubelt\",\"layer\":\"additive\""
#define INPUTS  "\"base_color\":0.2,\"sheen_color\":[0.9,0.5,0.2],\"sheen_roughness\":0.4"

static int begin(void **state) {
    if (scene_begin(state) != 0) return -1;
    static const char with[] = "{" INPUTS "," CHOICES "}", without[] = "{" INPUTS "}",
                      red[] = "{\"base_color\":[1,0,0]}";
    file_make("with.json", with, sizeof with - 1);
    file_make("without.json", without, sizeof without - 1);
    file_make("a=red.json", red, sizeof red - 1);
    file_make("red.json", red, sizeof red - 1);
    file_make("bad.json", "{\"layer\":1,\"layer\":2}", 21);
    return 0;
}

static void set_overrides_shorthand_and_shorthand_overrides_profile(void **state) {
    (void)state;
    /* --set over --sheen and --layer, in either order */
    assert_true(same(LIST("--sheen=charlie-neubelt", "--set", "cloth.sheen_lobe=ashikhmin-neubelt"),
                     LIST("--sheen=ashikhmin-neubelt")));
    assert_true(same(LIST("--set", "*.layer=additive", "--layer", "seed"), LIST("--layer=additive")));
    assert_false(same(LIST("--layer=additive"), LIST("--layer=seed")));
    /* --sheen and --layer over --profile */
    assert_true(same(LIST("--layer=additive", "--profile=khronos"), LIST("--profile=khronos", "--layer=additive")));
    assert_false(same(LIST("--layer=additive", "--profile=khronos"), LIST("--profile=khronos")));
    assert_false(same(LIST("--sheen=ashikhmin-neubelt", "--profile=khronos"), LIST("--profile=khronos")));
    /* a profile keeps the inputs of a material and drops its choices */
    assert_true(
        same(LIST("--profile=three", "--material=with.json"), LIST("--material=without.json", "--profile=three")));
    assert_false(same(LIST("--material=with.json"), LIST("--material=without.json")));
    assert_false(same(LIST("--profile=three", "--material=with.json"), LIST("--profile=three")));
    /* --sheen and --layer over a material, a material over a preset, a preset over the asset */
    assert_true(same(LIST("--material=with.json", "--sheen=charlie-conty-kulla", "--layer=albedo-view"),
                     LIST("--material=without.json", "--sheen=charlie-conty-kulla", "--layer=albedo-view")));
    assert_true(same(LIST("--material=with.json", "--preset=velvet"), LIST("--material=with.json")));
    assert_false(same(LIST("--preset=velvet"), LIST("--preset=denim")));
    assert_true(same(LIST("--preset=velvet"), LIST("--preset=cloth=velvet")));
    assert_true(same(LIST("--preset=velvet"), LIST("--preset=0=velvet")));
    /* a workflow in place of a profile that the material has */
    assert_true(same(LIST("--set=*.profile=three"), LIST("--profile=three")));
    assert_false(same(LIST("--workflow=cloth"), LIST("--workflow=metallic")));
    assert_true(same(LIST("--diffuse=burley"), LIST("--set=*.diffuse=burley")));
}

/* A profile reads the inputs as they are. */
static void profile_ignores_convert(void **state) {
    (void)state;
    assert_true(same(LIST("--profile=three", "--convert=specular"), LIST("--profile=three")));
    assert_false(same(LIST("--workflow=specular", "--set=*.specular_color=0.5,0,0", "--convert=metallic"),
                      LIST("--workflow=specular", "--set=*.specular_color=0.5,0,0")));
}

static void texture_option_changes_the_picture(void **state) {
    (void)state;
    Ran ran = run_shell("mkdir -p maps && \"$0\" render builtin:cloth --width 8 --height 8 --spp 1 --quiet "
                        "-o maps/Cloth_Albedo.png && cp maps/Cloth_Albedo.png =odd.png");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    assert_true(same(LIST("--texture=cloth.base_color=maps/Cloth_Albedo.png"), LIST("--materials=maps")));
    assert_true(same(LIST("--materials=cloth=maps"), LIST("--materials=maps")));
    assert_true(same(LIST("--texture=cloth.base_color==odd.png"), LIST("--materials=maps")));
    assert_false(same(LIST("--materials=maps"), LIST("--material=with.json")));
    /* over a material, under --set */
    assert_true(
        same(LIST("--materials=maps", "--material=with.json"), LIST("--material=with.json", "--materials=maps")));
    assert_true(same(LIST("--set=cloth.base_color=0.2", "--texture=cloth.base_color=maps/Cloth_Albedo.png"),
                     LIST("--set=cloth.base_color=0.2")));
    ran = run_shell("rm -r maps");
    ran_free(&ran);
}

static void material_file_may_have_an_equals_sign_in_its_name(void **state) {
    (void)state;
    assert_true(same(LIST("--material=a=red.json"), LIST("--material=cloth=a=red.json")));
    assert_false(same(LIST("--material=a=red.json"), LIST("--material=with.json")));
}

static void refused(const char *const *options, int code, const char *part) {
    const char *arguments[32] = {"render", "scene.gltf", TINY, "-o", "out.png"};
    int count = 8;
    for (int k = 0; options[k]; k++) arguments[count++] = options[k];
    assert_complaint(NULL, arguments, code, part);
}

/* Names of materials may hold '='; one that is cut off would be another's. */
static void material_of_any_name_can_be_set(void **state) {
    (void)state;
    refused(LIST("--preset=wool=2=velvet"), 2, "wool=2");
    refused(LIST("--material=wool=2=red.json"), 2, "wool=2");
    refused(LIST("--material=wool=2=none.json"), 3, "none.json: ");
    char w[600], text[700];
    memset(w, 'w', sizeof w);
    snprintf(text, sizeof text, "--preset=%.255s=velvet", w); /* the longest */
    refused(LIST(text), 2, "is not a material of this scene");
    snprintf(text, sizeof text, "--preset=%.256s=velvet", w);
    refused(LIST(text), 2, "too long for the name of a material");
    snprintf(text, sizeof text, "--material=%.256s=red.json", w);
    refused(LIST(text), 2, "too long for the name of a material");
    snprintf(text, sizeof text, "--set=%.510s.layer=seed", w);
    refused(LIST(text), 2, "too long for the name of a material");
}

static void alias_of_an_id_is_accepted(void **state) {
    (void)state;
    assert_true(same(LIST("--set=*.v=charlie-v", "--workflow=free"), LIST("--set=*.v=conty-kulla", "--workflow=free")));
    assert_true(same(LIST("--set=*.d=ashikhmin-d", "--workflow=free"), LIST("--set=*.d=ashikhmin", "--workflow=free")));
    assert_false(same(LIST("--set=*.d=ashikhmin-d", "--workflow=free"), LIST("--workflow=free")));
}

static void mistyped_material_option_is_named_in_its_error(void **state) {
    (void)state;
    static const char several[] = "charlie-neubelt, charlie-conty-kulla";
    refused(LIST("--sheen=charlie"), 2, several);
    refused(LIST("--sheen=ggx,charlie"), 2, several);
    refused(LIST("--set=*.sheen_lobe=charlie"), 2, several);
    refused(LIST("--texture=base_color"), 2, "is not MATERIAL.INPUT=FILE");
    refused(LIST("--texture=*.base_colour=red.json"), 2, "base_colour");
    refused(LIST("--texture=*.base_color=none.png"), 3, "none.png");
    refused(LIST("--materials=nowhere"), 3, "nowhere");
    refused(LIST("--profile=filament"), 2, "filament-cloth, filament-sheen");
    refused(LIST("--profile=kronos"), 2, "did you mean khronos?");
    refused(LIST("--profile=khronos,"), 2, "--profile: \"\" is not a profile");
    refused(LIST("--profile="), 2, "--profile: \"\"");
    refused(LIST("--sheen=ggx,patry, ggx"), 2, "--sheen: ggx is listed twice");
    refused(LIST("--set=*.layer=reciprocal,by=channel"), 2, "layer_by");
    refused(LIST("--set=*.rougness=1"), 2, "did you mean roughness?");
    refused(LIST("--set=*.=1"), 2, "\"\" is not a parameter");
    refused(LIST("--set=.ior=1.5"), 2, "weft: \"\": is not a material");
    refused(LIST("--workflow=metal"), 2, "did you mean metallic?");
    refused(LIST("--diffuse=ggx"), 2, "is not a diffuse term");
    refused(LIST("--layer=seed,by=both"), 2, "by=both");
    refused(LIST("--sheen=ggx,by=max"), 2, "by=max");
    refused(LIST("--workflow=cloth", "--profile=three"), 2, "--workflow or --profile");
    refused(LIST("--sheen=ggx,patry", "--layer=seed,additive", "--set=*.roughness=0,1"), 2,
            "--set: has several values, and so have --sheen and --layer");
    refused(LIST("--set=*.roughness=0,1,0"), 2, "--set: 0 is listed twice");
    refused(LIST("--set=*.roughness=0,,1"), 2, "value 2 of 3 is empty");
    refused(LIST("--set=*.roughness=0,x"), 2, "x: is not a value");
    refused(LIST("--set=*.roughness=0,0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8", "--set=*.metallic=0,1,2,3,4,5,6,7,8"), 2,
            "--set: makes more than 64 pictures");
    refused(LIST("--set=*.base_color=1,0,0,1"), 2, "a number, r,g,b (linear) or #rrggbb");
    refused(LIST("--preset=velvt"), 2, "did you mean velvet?");
    refused(LIST("--preset=wool=velvet"), 2, "available: cloth");
    refused(LIST("--material=none.json"), 3, "none.json: ");
    refused(LIST("--material=bad.json"), 3, "bad.json: is not a valid material file: line 1: duplicate");
    refused(LIST("--convert=disney"), 2, "metallic");
    assert_complaint(NULL, LIST("render", "scene.gltf", "--sheen=ggx,patry", "-o", "a.exr"), 2, ".png");
}

static void blanks_around_an_id_are_ignored(void **state) {
    (void)state;
    assert_true(same(LIST("--sheen= ashikhmin-neubelt "), LIST("--sheen=ashikhmin-neubelt")));
    assert_true(same(LIST("--layer=seed , by=channel"), LIST("--layer=seed,by=channel")));
}

/* What the options leave in the picture besides its summary: warnings of what they came to. */
static void warns(const char *const *options, const char *part) {
    const char *arguments[32] = {"render", "scene.gltf", "--width=8", "--height=6", "--spp=1", "-o", "out.png"};
    int count = 7;
    for (int k = 0; options[k]; k++) arguments[count++] = options[k];
    Ran ran = run_with(NULL, arguments);
    assert_int_equal(ran.code, 0);
    if (part ? !strstr(ran.err, part) : strstr(ran.err, "warning") != NULL) fail_msg("%s ...: %s", options[0], ran.err);
    ran_free(&ran);
}

static void choice_without_effect_is_a_warning(void **state) {
    (void)state;
    static const char idle[] = "weft: warning: *.sheen_lobe: is not plausible: it changes nothing";
    warns(LIST("--sheen=ggx", "--set=*.sheen_color=0"), idle);
    warns(LIST("--sheen=ggx", "--set=*.sheen=0"), idle);
    warns(LIST("--sheen=ggx", "--workflow=disney"), idle);
    warns(LIST("--layer=additive", "--set=*.sheen_color=0"), "*.layer: is not plausible: it changes nothing");
    warns(LIST("--sheen=patry"), NULL);
    warns(LIST("--sheen=patry", "--set=*.sheen_color=0", "--set=*.sheen_color=1"), NULL);
    warns(LIST("--sheen=patry", "--workflow=disney", "--set=*.metallic=0", "--set=*.sheen=1"), NULL);
    warns(LIST("--sheen=patry", "--profile=unreal4"), NULL);
    warns(LIST("--layer=seed", "--set=*.sheen_color=0"), "*.layer: is not plausible: it changes nothing");
    warns(LIST("--set=*.sheen_d=charlie", "--set=*.sheen_color=0"), "*.sheen_d: is not plausible: it changes");
    warns(LIST("--set=*.sheen_d=inverse-ggx", "--set=*.sheen_v=implicit"), NULL);
}

/* Glass that a profile draws as an opaque base: the picture says so, once for each such profile. */
static void glass_left_out_is_a_warning(void **state) {
    (void)state;
    static const char line[] = "weft: warning: material cloth: has a part that is ignored: its transmission: profile "
                               "unreal4 shows no glass";
    warns(LIST("--profile=unreal4", "--set=*.transmission=0.5", "--set=*.metallic=0"), line);
    warns(LIST("--set=*.metallic=0", "--set=*.transmission=0.5", "--profile=unreal4", "--engine=raster"), line);
    warns(LIST("--profile=khronos,unreal4", "--set=*.transmission=0.5", "--set=*.metallic=0"), line);
    warns(LIST("--profile=unreal4"), NULL);
    warns(LIST("--profile=khronos,three,babylon", "--set=*.transmission=0.5", "--set=*.metallic=0"), NULL);
}

/* A metal by three settings is none after the first. */
static void plausibility_is_judged_after_all_settings(void **state) {
    (void)state;
    warns(LIST("--workflow=specular", "--set=*.specular_color=0.9", "--set=*.base_color=0"), NULL);
    warns(LIST("--workflow=specular", "--set=*.specular_color=0.9"), "diffuse colour of a metal");
}

/* Three inputs make one reflectance. */
static void warning_about_several_inputs_is_printed_once(void **state) {
    (void)state;
    static const char text[] = "{\"metallic\": 0, \"ior\": 1.1, \"specular\": 0.9}";
    file_make("dim.json", text, sizeof text - 1);
    static const char *const dressed[][3] = {{"--set=*.metallic=0", "--set=*.ior=1.1", "--set=*.specular=0.9"},
                                             {"--material=dim.json"}};
    for (int k = 0; k < 2; k++) {
        Ran ran = RUN("render", "scene.gltf", "--width=8", "--height=6", "--spp=1", "-o", "out.png", dressed[k][0],
                      dressed[k][1], dressed[k][2]);
        const char *first = strstr(ran.err, "reflectance of a dielectric");
        if (ran.code != 0 || !first || strstr(first + 1, "reflectance of a dielectric"))
            fail_msg("exit %d: %s", ran.code, ran.err);
        ran_free(&ran);
    }
}

static void conversion_prints_its_loss(void **state) {
    (void)state;
    Ran ran = RUN("render", "scene.gltf", "--width=8", "--height=6", "--spp=1", "-o", "out.png", "--convert=specular");
    assert_int_equal(ran.code, 0);
    assert_non_null(strstr(ran.err, "material cloth: conversion to specular loses 0.000\n"));
    assert_null(strstr(ran.err, "warning"));
    ran_free(&ran);
    ran = RUN("render", "scene.gltf", "--width=8", "--height=6", "--spp=1", "-o", "out.png", "--workflow=specular",
              "--set=*.specular_color=0.5,0,0", "--convert=metallic", "--json");
    assert_int_equal(ran.code, 0);
    const char *loses = strstr(ran.err, "material cloth: conversion to metallic loses 0.");
    assert_non_null(loses);
    assert_true(strtod(strstr(loses, "loses ") + 6, NULL) > 0.01);
    assert_non_null(strstr(ran.out, "conversion to metallic loses"));
    ran_free(&ran);
    ran = RUN("render", "scene.gltf", "--width=8", "--height=6", "--spp=1", "-o", "out.png", "--workflow=disney",
              "--convert=metallic");
    assert_non_null(strstr(ran.err, "--convert metallic: there is nothing to convert: 1 of 1 materials are of "
                                    "another workflow or a profile and stay\n"));
    ran_free(&ran);
    ran = RUN("render", "scene.gltf", "--width=8", "--height=6", "--spp=1", "-o", "out.png", "--convert=metallic");
    assert_non_null(strstr(ran.err, "--convert metallic: there is nothing to convert\n"));
    assert_null(strstr(ran.err, "material cloth"));
    ran_free(&ran);
    ran = RUN("render", "builtin:cloth", "--width=8", "--height=6", "--spp=1", "-o", "out.png", "--convert=specular",
              "--set=1.workflow=specular", "--set=2.workflow=disney");
    assert_non_null(strstr(ran.err, "material Cloth: conversion to specular loses 0.000\n"));
    assert_null(strstr(ran.err, "material Plinth"));
    assert_non_null(strstr(ran.err, "--convert specular: 1 of 4 materials are of another workflow"));
    ran_free(&ran);
}

/* The picture alone, as bytes of three channels. */
static WeftImage png(const char *path) {
    WeftImage image;
    WeftError error;
    if (weft_image_read(path, &image, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(image.type, WEFT_PIXEL_U8);
    return image;
}

/* Whether the picture lies somewhere on the sheet, to the byte. */
static bool holds(const WeftImage *sheet, const WeftImage *image) {
    const uint8_t *s = sheet->pixels, *p = image->pixels;
    for (int y = 0; y + image->height <= sheet->height; y++)
        for (int x = 0; x + image->width <= sheet->width; x++) {
            int row = 0;
            for (; row < image->height; row++)
                for (int c = 0; c < image->width; c++)
                    if (memcmp(s + sheet->channels * ((y + row) * sheet->width + x + c),
                               p + image->channels * (row * image->width + c), 3) != 0)
                        goto next;
            return true;
        next:;
        }
    return false;
}

/* A sheet holds the very pictures that single renders make. */
static void sheet_holds_the_pictures_of_its_settings(void **state) {
    (void)state;
    static const char *const ids[] = {"ashikhmin-neubelt", "charlie-neubelt"};
    Ran ran = RUN("render", "scene.gltf", "--width=64", "--height=48", "--spp=2", "--background=environment", "-o",
                  "sheet.png", "--sheen", "ashikhmin-neubelt,charlie-neubelt", "--json");
    assert_int_equal(ran.code, 0);
    assert_non_null(strstr(ran.err, "2 pictures in "));
    assert_non_null(strstr(ran.err, "wrote sheet.png\n"));
    json_t *shots = json_loads(ran.out, 0, NULL);
    assert_int_equal(json_array_size(shots), 2);
    for (size_t k = 0; k < 2; k++) {
        json_t *shot = json_array_get(shots, k), *difference = json_object_get(shot, "difference");
        assert_string_equal(json_string_value(json_object_get(shot, "sheen_lobe")), ids[k]);
        double mean = json_number_value(json_object_get(difference, "mean")),
               relmse = json_number_value(json_object_get(difference, "relmse"));
        assert_true(k == 0 ? mean <= 0.0 && relmse <= 0.0 : mean > 1e-4 && relmse > 1e-6);
    }
    json_decref(shots);
    ran_free(&ran);
    WeftImage sheet = png("sheet.png");
    for (int k = 0; k < 2; k++) {
        ran = RUN("render", "scene.gltf", "--width=64", "--height=48", "--spp=2", "--background=environment", "--quiet",
                  "-o", "one.png", "--sheen", ids[k]);
        assert_int_equal(ran.code, 0);
        ran_free(&ran);
        WeftImage one = png("one.png");
        assert_true(holds(&sheet, &one));
        ((uint8_t *)one.pixels)[one.channels * (64 * 24 + 32)] ^= 64;
        assert_false(holds(&sheet, &one));
        weft_image_free(&one);
    }
    weft_image_free(&sheet);
}

/* The values that the pictures of a sheet have of `name`, "a b c", as --json tells them. */
static void assert_values(const char *const *options, const char *name, const char *wanted) {
    const char *arguments[32] = {"render", "scene.gltf", TINY, "-o", "sheet.png", "--json"};
    char values[256] = "";
    int count = 9;
    for (int k = 0; options[k]; k++) arguments[count++] = options[k];
    Ran ran = run_with(NULL, arguments);
    if (ran.code != 0) fail_msg("%s ...: %d: %s", options[0], ran.code, ran.err);
    json_t *shots = json_loads(ran.out, 0, NULL);
    for (size_t k = 0; k < json_array_size(shots); k++) {
        const char *value = json_string_value(json_object_get(json_array_get(shots, k), name));
        snprintf(values + strlen(values), sizeof values - strlen(values), "%s%s", k ? " " : "", value ? value : "-");
    }
    assert_string_equal(values, wanted);
    json_decref(shots);
    ran_free(&ran);
}

static void sweep_has_a_picture_for_each_value(void **state) {
    (void)state;
    assert_values(LIST("--set=*.roughness=0, 0.25,1"), "*.roughness", "0 0.25 1");
    assert_values(LIST("--set=*.roughness=0;1"), "*.roughness", "0 1");
    assert_values(LIST("--set=*.base_color=0.2;1,0,0"), "*.base_color", "0.2 1,0,0");
    assert_values(LIST("--set=*.layer=albedo-max,reciprocal"), "*.layer", "albedo-max reciprocal");
    assert_values(LIST("--set=*.nap_direction=0,90", "--set=*.roughness=0.3"), "*.nap_direction", "0 90");
    assert_true(same(LIST("--set=*.base_color=1,0,0"), LIST("--set=*.base_color=1, 0, 0"))); /* one picture */
}

/* A row for each value of the first option, a column for each of the second. */
static void two_sweeps_make_rows_and_columns(void **state) {
    (void)state;
    assert_values(LIST("--set=*.roughness=0.2,0.9", "--set=*.base_color=1,0,0;0,1,0;0,0,1"), "*.roughness",
                  "0.2 0.2 0.2 0.9 0.9 0.9");
    WeftImage sheet = png("sheet.png");
    const char *const color[] = {"1,0,0", "0,1,0", "0,0,1"};
    for (int k = 0; k < 6; k++) {
        char roughness[64], base[64];
        snprintf(roughness, sizeof roughness, "--set=*.roughness=%s", k < 3 ? "0.2" : "0.9");
        snprintf(base, sizeof base, "--set=*.base_color=%s", color[k % 3]);
        Ran ran = RUN("render", "scene.gltf", TINY, "-o", "one.png", roughness, base);
        assert_int_equal(ran.code, 0);
        ran_free(&ran);
        WeftImage one = png("one.png");
        assert_true(holds(&sheet, &one));
        weft_image_free(&one);
    }
    weft_image_free(&sheet);
    assert_values(LIST("--profile=khronos,three", "--set=*.roughness=0.2,0.9"), "profile",
                  "khronos khronos three three");
}

static void every_axis_makes_a_sheet(void **state) {
    (void)state;
    static const char *const axes[] = {"--workflow=metallic,cloth,free",
                                       "--profile=khronos,none,filament-sheen,three,babylon,urp",
                                       "--diffuse=lambert,eon", "--layer=additive,reciprocal,by=channel,albedo-max"};
    static const size_t counts[] = {3, 6, 2, 3};
    for (size_t k = 0; k < 4; k++) {
        Ran ran = RUN("render", "scene.gltf", TINY, "-o", "sheet.png", axes[k], "--json");
        assert_int_equal(ran.code, 0);
        assert_string_equal(ran.err, "");
        json_t *shots = json_loads(ran.out, 0, NULL);
        assert_int_equal(json_array_size(shots), counts[k]);
        json_decref(shots);
        ran_free(&ran);
        WeftImage sheet = png("sheet.png");
        assert_true(sheet.width > 480 && sheet.height > 120);
        weft_image_free(&sheet);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(material_of_any_name_can_be_set),
        cmocka_unit_test(set_overrides_shorthand_and_shorthand_overrides_profile),
        cmocka_unit_test(material_file_may_have_an_equals_sign_in_its_name),
        cmocka_unit_test(texture_option_changes_the_picture),
        cmocka_unit_test(profile_ignores_convert),
        cmocka_unit_test(alias_of_an_id_is_accepted),
        cmocka_unit_test(mistyped_material_option_is_named_in_its_error),
        cmocka_unit_test(warning_about_several_inputs_is_printed_once),
        cmocka_unit_test(conversion_prints_its_loss),
        cmocka_unit_test(sheet_holds_the_pictures_of_its_settings),
        cmocka_unit_test(sweep_has_a_picture_for_each_value),
        cmocka_unit_test(two_sweeps_make_rows_and_columns),
        cmocka_unit_test(every_axis_makes_a_sheet),
        cmocka_unit_test(blanks_around_an_id_are_ignored),
        cmocka_unit_test(choice_without_effect_is_a_warning),
        cmocka_unit_test(glass_left_out_is_a_warning),
        cmocka_unit_test(plausibility_is_judged_after_all_settings),
    };
    return cmocka_run_group_tests(tests, begin, work_end);
}
