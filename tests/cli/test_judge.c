/* `weft judge`: the expected values that it prints, the causes that it names, and how it ends. */
#include "run.h"

#include <math.h>

#include <jansson.h>

#include "base/pi.h"
#include "weft/weft.h"

/* The light of all pictures here, and their size. */
#define SUN  "sun;-1,-1,-2;3.1415927,3.1415927,3.1415927"
#define SIZE "--width", "132", "--height", "88"

enum { RINGS = 20, SECTORS = 28, ACROSS = SECTORS + 1, BALLS = 6 };

/* Writes "grid.gltf" and "grid.bin": 3 x 2 balls of one dark base, sheen roughness .3, .6 and 1 from the left, white
 * above and blue below, and a camera. The same balls without sheens are in "bare.gltf", with fuzz of these numbers in
 * "fuzzy.gltf". */
static void grid_make(const char *path, const char *rim) {
    enum { VERTICES = (RINGS + 1) * ACROSS, INDICES = 6 * SECTORS * (RINGS - 1) };
    static float points[VERTICES][3];
    static uint16_t index[INDICES];
    size_t count = 0;
    for (int k = 0; k < VERTICES; k++) {
        const double theta = PI_DOUBLE * (k / ACROSS) / RINGS, phi = 2.0 * PI_DOUBLE * (k % ACROSS) / SECTORS;
        points[k][0] = (float)(sin(theta) * sin(phi));
        points[k][1] = (float)cos(theta);
        points[k][2] = (float)(sin(theta) * cos(phi));
    }
    for (int ring = 0; ring < RINGS; ring++)
        for (int sector = 0; sector < SECTORS; sector++) {
            const uint16_t a = (uint16_t)(ring * ACROSS + sector), b = (uint16_t)(a + ACROSS);
            if (ring > 0) index[count++] = a, index[count++] = b, index[count++] = (uint16_t)(a + 1);
            if (ring < RINGS - 1)
                index[count++] = (uint16_t)(a + 1), index[count++] = b, index[count++] = (uint16_t)(b + 1);
        }
    assert_int_equal(count, INDICES);
    FILE *bytes = fopen("grid.bin", "wb"), *text = fopen(path, "w");
    assert_true(bytes && text);
    assert_int_equal(fwrite(points, sizeof points, 1, bytes), 1);
    assert_int_equal(fwrite(index, sizeof index, 1, bytes), 1);
    assert_int_equal(fclose(bytes), 0);
    fprintf(text, "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1,2,3,4,5,6]}],"
                  "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.4,\"znear\":0.1}}],"
                  "\"extensionsUsed\":[\"KHR_materials_sheen\",\"KHR_materials_fuzz\"],\"nodes\":[");
    for (int k = 0; k < BALLS; k++)
        fprintf(text, "{\"mesh\":%d,\"translation\":[%g,%g,0]},", k, 2.4 * (k % 3 - 1), k < 3 ? 1.2 : -1.2);
    fprintf(text, "{\"camera\":0,\"translation\":[0,0,14]}],\"materials\":[");
    for (int k = 0; k < BALLS; k++) {
        fprintf(text,
                "%s{\"name\":\"cloth-%d\",\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.9,"
                "\"baseColorFactor\":[0.1,0.05,0.05,1]}",
                k ? "," : "", k);
        if (rim)
            fprintf(text, ",\"extensions\":{\"KHR_materials_%s\":{%s\"%sColorFactor\":%s,\"%sRoughnessFactor\":%g}}",
                    rim, strcmp(rim, "fuzz") == 0 ? "\"fuzzFactor\":1," : "", rim, k < 3 ? "[1,1,1]" : "[0.2,0.5,1]",
                    rim,
                    k % 3 == 0   ? 0.3
                    : k % 3 == 1 ? 0.6
                                 : 1.0);
        fprintf(text, "}");
    }
    fprintf(text, "],\"meshes\":[");
    for (int k = 0; k < BALLS; k++)
        fprintf(text,
                "%s{\"name\":\"ball-%d\",\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":0},"
                "\"indices\":1,\"material\":%d}]}",
                k ? "," : "", k, k);
    fprintf(text,
            "],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\","
            "\"min\":[-1,-1,-1],\"max\":[1,1,1]},{\"bufferView\":1,\"componentType\":5123,\"count\":%d,"
            "\"type\":\"SCALAR\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu},{\"buffer\":0,"
            "\"byteOffset\":%zu,\"byteLength\":%zu}],\"buffers\":[{\"byteLength\":%zu,\"uri\":\"grid.bin\"}]}",
            VERTICES, INDICES, sizeof points, sizeof points, sizeof index, sizeof points + sizeof index);
    assert_int_equal(fclose(text), 0);
}

static int grids_begin(void **state) {
    if (scene_begin(state) != 0) return -1;
    grid_make("grid.gltf", "sheen");
    grid_make("bare.gltf", NULL);
    grid_make("fuzzy.gltf", "fuzz");
    return 0;
}

/* Renders the grid as a program with that option would, with noise of its own. */
static void picture_of_asset(const char *asset, const char *path, const char *option, const char *value) {
    Ran ran = RUN("render", asset, SIZE, "--camera", "0", "--env", "0", "--light", SUN, "--max-depth", "1", "--spp",
                  "16", "--seed", "7", "--quiet", option, value, "-o", path);
    if (ran.code != 0) fail_msg("%s", ran.err);
    ran_free(&ran);
}

static void picture_of(const char *path, const char *option, const char *value) {
    picture_of_asset("grid.gltf", path, option, value);
}

/* Runs the program, which must end with `code`, and reads the object that it prints; release with json_decref. */
static json_t *judged(int code, const char *const *arguments) {
    Ran ran = run_with(NULL, arguments);
    json_error_t error;
    json_t *json = json_loads(ran.out, JSON_REJECT_DUPLICATES, &error);
    if (ran.code != code || !json) fail_msg("%d, %s: %.200s%.200s", ran.code, error.text, ran.err, ran.out);
    ran_free(&ran);
    return json;
}

static double number_at(const json_t *json, const char *key, size_t index) {
    const json_t *value = json_array_get(json_object_get(json, key), index);
    if (!json_is_number(value)) fail_msg("\"%s\" has no number %zu", key, index);
    return json_number_value(value);
}

static const char *text_of(const json_t *json, const char *key) {
    const char *text = json_string_value(json_object_get(json, key));
    if (!text) fail_msg("\"%s\" is no text", key);
    return text;
}

/* Returns a picture of those that were judged. */
static const json_t *picture(const json_t *json, size_t index) {
    return json_array_get(json_object_get(json, "pictures"), index);
}

/* Returns the best cause of a kind (NULL: of any). */
static const json_t *best(const json_t *judged_picture, const char *kind) {
    size_t k;
    json_t *cause;
    json_array_foreach(json_object_get(judged_picture, "causes"), k, cause) {
        if (!kind || strcmp(text_of(cause, "kind"), kind) == 0) return cause;
    }
    fail_msg("there is no cause of kind %s", kind ? kind : "any");
    return NULL;
}

static void assert_cause(const json_t *judged_picture, const char *kind, const char *name, double share) {
    const json_t *cause = best(judged_picture, kind);
    const double found = json_number_value(json_object_get(cause, "share"));
    if (strcmp(text_of(cause, "name"), name) != 0 || found < share)
        fail_msg("expected %s of at least %g, found %s of %g", name, share, text_of(cause, "name"), found);
}

/* A sheet that faces a sun of irradiance pi: a diffuse face has its own colour, by hand. */
static void face_towards_the_sun_has_its_colour(void **state) {
    (void)state;
    static const double color[3] = {0.5, 0.25, 0.8};
    json_t *json =
        judged(0, LIST("judge", "scene.gltf", "--json", SIZE, "--spp", "8", "--light",
                       "sun;0,0,-1;3.1415927,3.1415927,3.1415927", "--set", "cloth.sheen=0", "--set",
                       "cloth.specular=0", "--set", "cloth.metallic=0", "--set", "cloth.base_color=0.5,0.25,0.8"));
    const json_t *object = json_array_get(json_object_get(json, "objects"), 0);
    assert_string_equal(text_of(object, "material"), "cloth");
    for (size_t c = 0; c < 3; c++) assert_true(fabs(number_at(object, "expected", c) - color[c]) < 1e-3);
    assert_string_equal(text_of(json, "environment"), "none");
    json_decref(json);
}

/* All six balls have a value, which is that of the reference where they are; the light is stated as it is typed. */
static void ball_has_the_values_of_the_reference(void **state) {
    (void)state;
    WeftImage reference;
    json_t *json = judged(0, LIST("judge", "grid.gltf", "--json", SIZE, "--spp", "16", "-o", "reference.exr"));
    const json_t *objects = json_object_get(json, "objects");
    assert_int_equal(json_array_size(objects), BALLS);
    assert_int_equal(weft_image_read("reference.exr", &reference, NULL, NULL), WEFT_OK);
    assert_int_equal(reference.width, 132);
    for (size_t k = 0; k < BALLS; k++) {
        char name[16];
        const json_t *object = json_array_get(objects, k);
        const int x = (int)number_at(object, "middle", 0), y = (int)number_at(object, "middle", 1);
        const float *pixel = (const float *)reference.pixels + 4 * (y * reference.width + x);
        snprintf(name, sizeof name, "ball-%zu", k);
        assert_string_equal(text_of(object, "name"), name);
        for (size_t c = 0; c < 3; c++) {
            const double ratio = number_at(object, "expected", c) / (double)pixel[c];
            assert_true(ratio > 0.4 && ratio < 2.5);
            assert_true(number_at(object, "noise", c) < 1e-3);
        }
    }
    weft_image_free(&reference);
    json_decref(json);
    Ran ran = RUN("judge", "grid.gltf", SIZE, "--spp", "2");
    assert_int_equal(ran.code, 0);
    assert_non_null(strstr(ran.out, "sun;-0.408248,-0.408248,-0.816497;3.14159,3.14159,3.14159"));
    assert_non_null(strstr(ran.out, "ball-5"));
    ran_free(&ran);
}

/* Pictures of two engines: the engine is named, and the term in which both depart from glTF's text. */
static void picture_of_an_engine_has_its_name_and_term(void **state) {
    (void)state;
    static const char *const engines[] = {"three", "babylon"};
    picture_of("three.exr", "--profile", "three");
    picture_of("babylon.exr", "--profile", "babylon");
    json_t *json = judged(1, LIST("judge", "grid.gltf", "three.exr", "babylon.exr", "--json", "--spp", "16"));
    for (size_t k = 0; k < 2; k++) {
        const json_t *of = picture(json, k);
        assert_cause(of, NULL, engines[k], 0.99);
        assert_cause(of, "term", "sheen-v-neubelt", 0.9);
        assert_true(json_is_true(json_object_get(of, "explained")));
        /* the smooth white ball is brighter in both than glTF has it */
        assert_true(number_at(json_array_get(json_object_get(of, "objects"), 0), "off", 1) > 0.01);
    }
    json_decref(json);
}

/* Fuzz as Babylon.js draws it: the profile is named, and the term that reads the table at the half vector. As the
 * extension is written it is nearly as weft draws it, and no fault. */
static void picture_of_fuzz_has_its_engine_and_term(void **state) {
    (void)state;
    picture_of_asset("fuzzy.gltf", "half.exr", "--profile", "babylon-openpbr");
    picture_of_asset("fuzzy.gltf", "written.exr", "--profile", "khr-fuzz");
    json_t *json = judged(1, LIST("judge", "fuzzy.gltf", "half.exr", "written.exr", "--json", "--spp", "16"));
    assert_cause(picture(json, 0), NULL, "babylon-openpbr", 0.99);
    assert_cause(picture(json, 0), "term", "fuzz-at-half", 0.9);
    assert_int_equal(json_integer_value(json_object_get(picture(json, 1), "failed")), 0);
    json_decref(json);
}

/* What a viewer shows is a .png: the same name is found, and the line on standard error has it. */
static void displayed_picture_has_the_same_cause(void **state) {
    (void)state;
    picture_of("engine.png", "--profile", "three");
    Ran ran = RUN("judge", "grid.gltf", "engine.png", "--spp", "16");
    assert_int_equal(ran.code, 1);
    assert_true(one_complaint(ran.err));
    assert_non_null(strstr(ran.err, "the likely cause is three"));
    assert_non_null(strstr(ran.out, "sRGB, shown through pbr-neutral"));
    ran_free(&ran);
}

/* Pictures with one fault each, judged together. */
static void single_fault_is_named(void **state) {
    (void)state;
    static const struct {
        const char *file, *option, *value, *cause;
    } faults[] = {
        {"a.exr", "--set", "*.sheen=0", "sheen-left-out"},
        {"b.exr", "--layer", "additive", "base-not-dimmed"},
        {"c.exr", "--sheen", "ashikhmin-neubelt", "sheen-d-ashikhmin"},
        {"d.exr", "--light", "sun;-1,-1,-2;6.728,6.728,6.728", "light-times-pi"}, /* 1 + 2.1416 of the first one */
    };
    for (size_t k = 0; k < 4; k++) picture_of(faults[k].file, faults[k].option, faults[k].value);
    json_t *json = judged(1, LIST("judge", "grid.gltf", "a.exr", "b.exr", "c.exr", "d.exr", "--json", "--spp", "16",
                                  "--tolerance", "0.01"));
    for (size_t k = 0; k < 4; k++) assert_cause(picture(json, k), NULL, faults[k].cause, 0.95);
    json_decref(json);
}

static void good_picture_passes(void **state) {
    (void)state;
    picture_of("good.exr", "--profile", "none");
    json_t *json = judged(0, LIST("judge", "grid.gltf", "good.exr", "--json", "--spp", "16"));
    assert_int_equal(json_array_size(json_object_get(picture(json, 0), "causes")), 0);
    json_decref(json);
}

/* A checked pattern, which no engine draws. */
static void strange_picture_has_no_cause(void **state) {
    (void)state;
    WeftImage image;
    assert_int_equal(weft_image_create(132, 88, 3, WEFT_PIXEL_F32, &image, NULL), WEFT_OK);
    for (int k = 0; k < 132 * 88; k++)
        for (int c = 0; c < 3; c++) ((float *)image.pixels)[3 * k + c] = k % 132 / 8 % 2 ? 1.0f : 0.0f;
    assert_int_equal(weft_image_write("strange.exr", &image, NULL), WEFT_OK);
    weft_image_free(&image);
    Ran ran = RUN("judge", "grid.gltf", "strange.exr", "--spp", "4");
    assert_int_equal(ran.code, 1);
    assert_non_null(strstr(ran.err, "no cause explains it"));
    assert_non_null(strstr(ran.out, "none explains it"));
    ran_free(&ran);
}

/* Without a sheen no term of a sheen is tried. */
static void asset_without_sheen_has_no_cause_of_one(void **state) {
    (void)state;
    size_t k;
    json_t *cause;
    picture_of("three.exr", "--profile", "three");
    json_t *json = judged(1, LIST("judge", "bare.gltf", "three.exr", "--json", "--spp", "4"));
    json_array_foreach(json_object_get(picture(json, 0), "causes"), k, cause) {
        if (strncmp(text_of(cause, "name"), "sheen", 5) == 0) fail_msg("%s was tried", text_of(cause, "name"));
    }
    json_decref(json);
}

static void bad_input_is_one_line(void **state) {
    (void)state;
    picture_of("whole.exr", "--profile", "none");
    file_make("text.png", "no picture", 10);
    assert_complaint(NULL, LIST("judge", "grid.gltf", "whole.exr", "--width", "64"), 2,
                     "whole.exr: is 132 x 88 pixels, but the reference 64 x 88");
    assert_complaint(NULL, LIST("judge", "grid.gltf", "text.png"), 3, "text.png: is not an image");
    assert_complaint(NULL, LIST("judge", "grid.gltf", "none.exr"), 3, "none.exr: cannot be opened");
    assert_complaint(NULL, LIST("judge", "none.gltf", "whole.exr"), 3, "none.gltf");
    assert_complaint(NULL, LIST("judge"), 2, "needs an ASSET");
    assert_complaint(NULL, LIST("judge", "--write", "grid.gltf"), 4,
                     "grid.gltf: the folder cannot be made: File exists");
    assert_complaint(NULL, LIST("judge", "grid.gltf", "--write", "sweeps"), 2, "--write: goes with neither");
    assert_complaint(NULL, LIST("judge", "grid.gltf", "--profile", "three,babylon"), 2,
                     "--profile: has several values");
    assert_complaint(NULL, LIST("judge", "grid.gltf", "--exposure", "auto"), 2, "--exposure: auto depends on");
    assert_complaint(NULL, LIST("judge", "grid.gltf", "--env-strength", "2"), 2, "--env-strength: needs --env");
    assert_complaint(NULL, LIST("judge", "grid.gltf", "-o", "reference.txt"), 2, "reference.txt: has no suffix");
    assert_complaint(NULL, LIST("judge", "grid.gltf", SIZE, "--camera", "0,0,50;0,0,99;20"), 2, "no object covers 16");
}

/* The sweeps are files whose numbers another run finds again. */
static void sweeps_have_their_own_values(void **state) {
    (void)state;
    static const char *const names[] = {"nap-1", "weave-1", "weave-2", "measured-1"};
    Ran ran = RUN("judge", "--write", ".", "--width", "96", "--height", "64", "--spp", "4", "--quiet");
    if (ran.code != 0) fail_msg("%s", ran.err);
    ran_free(&ran);
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char path[32];
        json_error_t error;
        snprintf(path, sizeof path, "%s.json", names[k]);
        json_t *kept = json_load_file(path, 0, &error);
        assert_non_null(kept);
        assert_string_equal(text_of(json_array_get(json_object_get(kept, "objects"), 0), "is"),
                            k == 0   ? "velvet, nap 0, nap_direction 0 degrees"
                            : k == 3 ? "beige-fabric"
                            : k == 2 ? "woven-velvet"
                                     : "woven-charmeuse");
        snprintf(path, sizeof path, "%s.glb", names[k]);
        json_t *found = judged(0, LIST("judge", path, "--json", "--width", "96", "--height", "64", "--spp", "4"));
        for (size_t ball = 0; ball < 10; ball++)
            for (size_t c = 0; c < 3; c++) {
                const json_t *a = json_array_get(json_object_get(kept, "objects"), ball);
                const json_t *b = json_array_get(json_object_get(found, "objects"), ball);
                assert_true(fabs(number_at(a, "expected", c) - number_at(b, "expected", c)) < 1e-6);
            }
        json_decref(kept);
        json_decref(found);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(face_towards_the_sun_has_its_colour),
        cmocka_unit_test(ball_has_the_values_of_the_reference),
        cmocka_unit_test(picture_of_an_engine_has_its_name_and_term),
        cmocka_unit_test(picture_of_fuzz_has_its_engine_and_term),
        cmocka_unit_test(displayed_picture_has_the_same_cause),
        cmocka_unit_test(single_fault_is_named),
        cmocka_unit_test(good_picture_passes),
        cmocka_unit_test(strange_picture_has_no_cause),
        cmocka_unit_test(asset_without_sheen_has_no_cause_of_one),
        cmocka_unit_test(bad_input_is_one_line),
        cmocka_unit_test(sweeps_have_their_own_values),
    };
    return cmocka_run_group_tests(tests, grids_begin, work_end);
}
