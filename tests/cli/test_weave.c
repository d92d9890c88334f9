/* `weft weave`: what it prints and writes, and how it ends. */
#include "run.h"

#include <jansson.h>

#include "weft/weft.h"

static void assert_ends(const char *const *arguments, int code, const char *said) {
    Ran ran = run_with(NULL, arguments);
    if (ran.code != code || !ran.err || !strstr(ran.err, said)) fail_msg("%d: %s", ran.code, ran.err ? ran.err : "");
    ran_free(&ran);
}

static void wif_make(const char *path, const char *text) { file_make(path, text, strlen(text)); }

static void json_has_the_properties_of_the_draft(void **state) {
    (void)state;
    Ran ran = run_with(NULL, LIST("weave", "satin 8/3; sett 40 20", "--json"));
    assert_int_equal(ran.code, 0);
    json_t *json = json_loads(ran.out, JSON_REJECT_DUPLICATES, NULL);
    assert_non_null(json);
    assert_int_equal(json_integer_value(json_object_get(json, "shafts")), 8);
    const json_t *warp = json_object_get(json, "warp");
    assert_int_equal(json_integer_value(json_object_get(warp, "longest_float")), 7);
    json_decref(json);
    ran_free(&ran);
}

/* The words, the file they are written to, and the file turned over twice are one draft. */
static void draft_written_in_another_form_reads_as_the_same(void **state) {
    (void)state;
    static const char rows[] = "..##\n.##.\n##..\n#..#\n", back[] = "..##\n#..#\n##..\n.##.\n";
    size_t size;
    assert_ends(LIST("weave", "twill 2/2 z", "-o", "twill.wif"), 0, "");
    assert_ends(LIST("weave", "twill.wif", "-o", "twill.txt"), 0, "");
    char *text = file_bytes("twill.txt", &size);
    assert_string_equal(text, rows);
    free(text);
    assert_ends(LIST("weave", "twill.wif", "--back", "-o", "back.txt"), 0, "");
    text = file_bytes("back.txt", &size);
    assert_string_equal(text, back);
    free(text);
    assert_ends(LIST("weave", "twill.wif", "-o", "twill.png"), 0, "");
    assert_ends(LIST("weave", "twill.wif", "-o", "twill.svg"), 0, "");
    assert_ends(LIST("weave", "twill.wif", "--close", "6", "--size", "32", "--yarn", "silk,wool", "-o", "cloth.png"), 0,
                "");
}

static void impossible_weave_commands_are_errors_of_one_line(void **state) {
    (void)state;
    wif_make("broken.wif", "[WIF]\nVersion=1.1\n[THREADING]\n1=x\n");
    assert_ends(LIST("weave", "broken.wif"), 3, "line 4");
    assert_ends(LIST("weave", "none.wif"), 3, "none.wif: cannot be opened");
    file_make("cloth.png", "BM\x10\0\0\0 and more", 15);
    assert_ends(LIST("weave", "cloth.png"), 3,
                "neither a WIF nor a picture: it is BMP; convert it to .png, "
                "or to .exr if its numbers are floats\n");
    wif_make("notes.txt", "warp 24k\nweft 24w\n");
    assert_ends(LIST("weave", "notes.txt"), 3, "it is text that does not begin with [WIF]\n");
    wif_make("empty.wif", "[WIF]\n");
    assert_ends(LIST("weave", "empty.wif"), 3, "no section [WIF], or nothing in it\n");
    assert_ends(LIST("weave", "plain; sett 24.5"), 2, "one or two whole numbers");
    assert_ends(LIST("weave", "sett 24.5"), 2, "the weave is plain");
    assert_ends(LIST("weave", "plain; both 8000k 8000w"), 2, "threads are too many");
    assert_ends(LIST("weave", "twill 200/200; both 4001k 4000w"), 2, "threads are too many");
    assert_ends(LIST("weave", "velvet"), 2, "is not a weave");
    assert_ends(LIST("weave", "none.wif"), 3, "words such as twill 2/2 need no file");
    assert_ends(LIST("weave", "plain", "-o", "plain.jpg"), 2, ".wif, .png");
    assert_ends(LIST("weave", "plain", "--sett", "0"), 2, "sett");
    assert_ends(LIST("weave", "plain", "--yarn", "nettle"), 2, "nettle: is not a yarn");
    assert_ends(LIST("weave", "plain", "--yarn", "silk,"), 2, "is not a yarn");
    assert_ends(LIST("weave", "plain", "--close", "4", "-o", "plain.svg"), 2, "a cloth is drawn as .png");
    assert_ends(LIST("weave", "plain", "--close", "0", "-o", "plain.png"), 2, "--close");
    assert_ends(LIST("weave", "plain", "--close", "6"), 2, "needs a name");
    assert_ends(LIST("weave", "plain", "--bake", "none/there"), 4, "none/there");
    file_make("taken", "", 0);
    assert_ends(LIST("weave", "plain", "--bake", "taken"), 4, "taken: cannot be written: File exists");
    assert_ends(LIST("weave", "plain", "--sett", "a,b"), 2, "threads per centimetre");
    assert_ends(LIST("weave", "twill.wif", "-o", "twill.wif"), 2, "");
    wif_make("float.wif", "[WIF]\nVersion=1.1\n[THREADING]\n1=1\n[LIFTPLAN]\n1=1\n");
    assert_ends(LIST("weave", "float.wif"), 0, "never change sides");
}

static double number_of(const json_t *json, const char *a, const char *b, const char *c) {
    json = json_object_get(json_object_get(json, a), b);
    return json_number_value(c ? json_object_get(json, c) : json);
}

/* A denim is blue in front and pale behind, and its maps have the millimetres of their sixteen threads. */
static void bake_writes_a_u3m_of_both_faces(void **state) {
    (void)state;
    size_t size;
    assert_ends(LIST("weave", "twill 3/1; warp 1#26375c; weft 1#d8d4c8; sett 26 18", "--yarn", "cotton,linen", "--bake",
                     "denim", "--size", "64"),
                0, "");
    char *text = file_bytes("denim/cloth.u3m", &size);
    assert_non_null(text);
    json_t *root = json_loads(text, JSON_REJECT_DUPLICATES, NULL), *material = json_object_get(root, "material");
    const json_t *front = json_object_get(json_object_get(material, "front"), "basecolor"),
                 *back = json_object_get(json_object_get(material, "back"), "basecolor"),
                 *physics = json_object_get(material, "physics");
    assert_true(number_of(front, "constant", "b", NULL) > 1.05 * number_of(front, "constant", "r", NULL));
    assert_true(number_of(back, "constant", "r", NULL) > 1.3 * number_of(front, "constant", "r", NULL));
    assert_true(number_of(front, "texture", "image", "width") - 160.0 / 26.0 < 1e-4 &&
                160.0 / 26.0 - number_of(front, "texture", "image", "width") < 1e-4);
    assert_true(number_of(back, "texture", "image", "height") - 160.0 / 18.0 < 1e-4 &&
                160.0 / 18.0 - number_of(back, "texture", "image", "height") < 1e-4);
    const json_t *parts = json_object_get(json_object_get(physics, "composition"), "parts");
    assert_int_equal(json_array_size(parts), 2);
    assert_string_equal(json_string_value(json_object_get(json_object_get(physics, "construction"), "type")),
                        "Twill - right hand (Z)");
    assert_string_equal(json_string_value(json_object_get(json_array_get(parts, 0), "type")), "Cotton");
    const double ratio = json_number_value(json_object_get(json_array_get(parts, 0), "ratio"));
    assert_true(ratio > 0.590 && ratio < 0.592); /* 26 of 44 threads */
    json_decref(root);
    free(text);
    assert_int_equal(system("rm -r denim"), 0);
}

/* Returns the mean of a channel of the colours, in bytes. */
static double color_mean(int channel) {
    WeftImage image;
    WeftError error;
    double sum = 0.0;
    if (weft_image_read("maps/base_color.png", &image, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    const int count = image.width * image.height;
    for (int k = 0; k < count; k++) sum += ((const uint8_t *)image.pixels)[k * image.channels + channel];
    weft_image_free(&image);
    return sum / count;
}

/* A material is baked with its own draft, yarns and colours, and without a word; what comes of it is a material. */
static void a_material_is_baked_as_its_weave(void **state) {
    (void)state;
    static const char red[] =
        "{\"weave\": {\"draft\": \"satin 8/3; sett 90 45\", \"warp\": {\"yarn\": \"silk\", \"color\": "
        "\"#c01818\"}, \"weft\": \"silk\", \"seed\": 3, \"metres\": 0.25}}";
    file_make("red.json", red, sizeof red - 1);
    Ran ran = run_with(NULL, LIST("weave", "red.json", "--bake", "maps", "--size", "64", "--json"));
    if (ran.code != 0 || ran.err[0]) fail_msg("%d: %s", ran.code, ran.err);
    json_t *json = json_loads(ran.out, JSON_REJECT_DUPLICATES, NULL);
    assert_non_null(json);
    const json_t *textures = json_object_get(json, "textures");
    const double fitted = json_real_value(json_object_get(textures, "fitted")),
                 copied = json_real_value(json_object_get(textures, "copied"));
    assert_true(fitted > 0.0 && fitted < 0.25 && fitted < 0.75 * copied);
    assert_int_equal(json_integer_value(json_object_get(json, "shafts")), 8);
    json_decref(json);
    ran_free(&ran);
    assert_true(color_mean(0) > 1.8 * color_mean(2));
    const double metres = 0.25; /* over 16 threads of 90 per cm */
    size_t size;
    char *text = file_bytes("maps/material.json", &size), scale[32];
    assert_non_null(text);
    snprintf(scale, sizeof scale, "[%.5g", metres / (16.0 / 9000.0));
    if (!strstr(text, scale)) fail_msg("%s is not in %s", scale, text);
    free(text);
    assert_ends(LIST("weave", "preset:velvet", "--bake", "other"), 3, "not woven");
    assert_ends(LIST("weave", "red.json", "--yarn", "wool"), 2, "--yarn: red.json is a material");
    assert_ends(LIST("weave", "red.json", "--profile", "three"), 2, "--bake");
    assert_ends(LIST("weave", "red.json", "--bake", "other", "--profile", "treacle"), 2, "no profile treacle");
    assert_ends(LIST("weave", "red.json", "--textures", "ktx2"), 2, "--bake");
    assert_ends(LIST("weave", "red.json", "--bake", "other", "--textures", "jpg"), 2, "not one of png, ktx2");
    assert_int_equal(access("other", F_OK), -1);
    assert_true(scratch_remove("maps"));
}

/* Ctrl-C while the numbers of the maps are searched. */
static void an_interrupted_bake_leaves_nothing(void **state) {
    (void)state;
    pid_t child =
        program_start(WEFT_PROGRAM, NULL, LIST("weave", "preset:woven-denim", "--bake", "half", "--size", "1024"));
    await_handler(child);
    sleep_seconds(0.2);
    kill(child, SIGINT);
    Ran ran = program_end(child);
    assert_int_equal(ran.code, 130);
    assert_true(one_complaint(ran.err) && strstr(ran.err, "half: interrupted; no maps were written"));
    ran_free(&ran);
    assert_int_not_equal(access("half", F_OK), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bake_writes_a_u3m_of_both_faces),
        cmocka_unit_test(json_has_the_properties_of_the_draft),
        cmocka_unit_test(draft_written_in_another_form_reads_as_the_same),
        cmocka_unit_test(a_material_is_baked_as_its_weave),
        cmocka_unit_test(an_interrupted_bake_leaves_nothing),
        cmocka_unit_test(impossible_weave_commands_are_errors_of_one_line),
    };
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
