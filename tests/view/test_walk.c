/* The walk of somebody who has an asset: variants and a folder of TGA maps are put on, numbers changed, all
 * of it saved and opened again; and the first minute with an asset of several materials. In a real window;
 * what it looked like stays beside the tests.
 *
 * Labels: unsanitized */
#include "display.h"

/* Of the asset. */
enum { MANGO, BROWN, METAL, LABEL, PEACOCK, BLACK, MATERIALS };

static char chair[512];

/* False where the asset is not there. */
static bool find_chair(void) {
    const char *folder = getenv("WEFT_DATA");
    if (!folder || !*folder) folder = WEFT_SOURCE_DIR "/../shared/data";
    snprintf(chair, sizeof chair, "%s/gltf/SheenChair/SheenChair.gltf", folder);
    bool there = access(chair, R_OK) == 0;
    if (!there) print_message("there is no %s\n", chair);
    return there;
}

#define NEEDED()                                                                                                       \
    do {                                                                                                               \
        if (no_display || !find_chair()) skip();                                                                       \
        need_gl();                                                                                                     \
    } while (0)
#define SEEN "view", "--forget", "--json", "--width", "640", "--height", "420", "--occlusion", "0"

/* Uncompressed, from the top: squares of two colours. */
static void write_tga(const char *path, const unsigned char odd[3], const unsigned char even[3]) {
    enum { SIDE = 32 };
    unsigned char file[18 + 3 * SIDE * SIDE] = {0, 0, 2};
    file[12] = file[14] = SIDE, file[16] = 24, file[17] = 0x20;
    for (int k = 0; k < SIDE * SIDE; k++)
        for (int c = 0; c < 3; c++) file[18 + 3 * k + c] = (k % SIDE / 8 + k / SIDE / 8) % 2 ? odd[2 - c] : even[2 - c];
    file_make(path, (const char *)file, sizeof file);
}

static void keep(const char *window) {
    char path[512];
    WeftImage image = picture_read(window);
    snprintf(path, sizeof path, WEFT_BINARY_DIR "/walk-%s", window);
    assert_true(image.width == 640 && image.height == 420);
    assert_int_equal(weft_image_write(path, &image, NULL), WEFT_OK);
    weft_image_free(&image);
}

/* Numbers of all inputs, and which of them have maps. */
static void assert_same_material(const json_t *a, const json_t *b) {
    for (int k = 0; weft_material_input_name(k); k++) {
        const char *name = weft_material_input_name(k);
        const json_t *x = json_object_get(a, name), *y = json_object_get(b, name);
        for (size_t c = 0; c < 4; c++) {
            double p = json_number_value(json_array_get(x, c)), q = json_number_value(json_array_get(y, c));
            if (c == 3 ? (p > 0.0) != (q > 0.0) : fabs(p - q) > 1e-6 * fmax(1.0, fabs(p)))
                fail_msg("%s %s: %g, %g", word_of(a, "name"), name, p, q);
        }
    }
    for (int k = 0; weft_material_choice_name(k); k++)
        assert_string_equal(word_of(a, weft_material_choice_name(k)), word_of(b, weft_material_choice_name(k)));
}

static void saved_changes_are_there_after_opening_again(void **state) {
    (void)state;
    NEEDED();
    static const unsigned char blue[3] = {60, 90, 160}, gold[3] = {200, 180, 60}, flat[3] = {128, 128, 255},
                               tilted[3] = {168, 128, 240}, smooth[3] = {60, 60, 60}, rough[3] = {220, 220, 220};
    assert_int_equal(mkdir("maps", 0700), 0);
    write_tga("maps/Velvet_BaseColor.tga", blue, gold);
    write_tga("maps/Velvet_Normal.tga", flat, tilted);
    write_tga("maps/Velvet_Roughness.tga", smooth, rough);
    script_begin();
    say("wait rest\nchoose Material/variant \"Peacock Velvet\"\nwait 5\nwait rest\ndrop maps\n");
    say("wait message 3 maps of maps\nwait rest\nset Material/metallic 0\nset \"Material/sheen roughness\" "
        "0.45\n");
    say_rested_picture("own.png");
    say("window saved.png\nsave saved.glb\nwait message wrote saved.glb\nsave saved.gltf\n");
    say("wait message wrote saved.gltf\nwait rest\n");
    Drive drive = drive_start(script, LIST(SEEN, chair));
    json_t *own = drive_picture(&drive, "own.png");
    drive_finish(&drive);
    const json_t *peacock = material_of(own, PEACOCK);
    assert_string_equal(word_of(peacock, "name"), "fabric Mystere Peacock Velvet");
    assert_int_equal(number_of(own, "material"), PEACOCK);
    static const char *const mapped[] = {"base_color", "normal", "roughness"};
    for (int k = 0; k < 3; k++) assert_true(input_of(own, PEACOCK, mapped[k], 3) > 0.0);
    assert_true(fabs(input_of(own, PEACOCK, "sheen_roughness", 0) - 0.45) < 1e-6);
    static const char *const files[] = {"saved.glb", "saved.gltf"};
    for (int f = 0; f < 2; f++) {
        script_begin();
        say_rested_picture("again.png");
        say("window reopened.png\nwait 3\n");
        drive = drive_start(script, LIST(SEEN, files[f]));
        json_t *again = drive_picture(&drive, "again.png");
        drive_finish(&drive);
        assert_int_equal(json_array_size(json_object_get(again, "materials")), MATERIALS);
        assert_int_equal(number_of(again, "material"), PEACOCK); /* what it wore is what it wears */
        for (int k = 0; k < MATERIALS; k++) assert_same_material(material_of(own, k), material_of(again, k));
        assert_non_null(json_object_get(json_object_get(again, "controls"), "Material/variant"));
        json_decref(again);
        double most = pictures_most("own.png", "again.png");
        if (!(most < 2.5 / 255.0)) fail_msg("%s: %.1f / 255", files[f], 255.0 * most);
    }
    json_decref(own);
    keep("saved.png");
    keep("reopened.png");
}

static double top_of(const json_t *state, const char *control) {
    const json_t *box = json_object_get(json_object_get(state, "controls"), control);
    if (!box) fail_msg("there is no %s", control);
    return json_number_value(json_array_get(box, 1));
}

static void first_minute_of_use_ends_with_the_expected_pictures(void **state) {
    (void)state;
    NEEDED();
    file_make("broken.glb", "glTF\2\0\0\0nonsense", 16);
    script_begin();
    say_rested_picture("opened.png");
    say("window first.png\nopen broken.glb\nwait message broken.glb: \n");
    say_rested_picture("still.png");
    say("move 0.679 0.706\npress left\nrelease left\nwait message wood Brown\nwait rest\n"); /* a leg */
    say("key m\nwait message metal\nkey shift+m\nwait message wood Brown\nwait rest\nkey g\n");
    say_rested_picture("floor.png");
    say("window floor-drawn.png\nkey tab\nwait samples 8\nwindow floor-traced.png\n");
    say("key g\nwait 1\nwait samples 2\nwindow plain-traced.png\nkey tab\n"); /* samples without the floor */
    say_rested_picture("plain.png");
    Drive drive = drive_start(script, LIST(SEEN, chair));
    json_t *now = drive_picture(&drive, "opened.png");
    assert_int_equal(number_of(now, "material"), MANGO); /* the other fabric only a variant wears */
    static const char *const below[] = {"Material/metallic", "Material/roughness", "Material/normal"};
    for (int k = 0; k < 3; k++) assert_true(top_of(now, "Material/base color") < top_of(now, below[k]));
    json_t *still = drive_picture(&drive, "still.png");
    assert_true(json_equal(json_object_get(still, "materials"), json_object_get(now, "materials")));
    assert_string_equal(word_of(still, "scene"), chair);
    json_decref(still);
    json_decref(now);
    now = drive_until(&drive, "message", "wood Brown");
    assert_int_equal(number_of(now, "material"), BROWN);
    json_decref(now);
    drive_finish(&drive);
    assert_true(pictures_most("opened.png", "still.png") < 0.5 / 255.0);
    assert_true(pictures_most("opened.png", "plain.png") < 0.5 / 255.0);
    assert_true(pictures_most("opened.png", "floor.png") > 0.1);
    assert_true(pictures_most("floor-traced.png", "plain-traced.png") > 0.1);
    keep("first.png");
    keep("floor-drawn.png");
    keep("floor-traced.png");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(saved_changes_are_there_after_opening_again),
                                       cmocka_unit_test(first_minute_of_use_ends_with_the_expected_pictures)};
    return cmocka_run_group_tests(tests, display_begin, display_end);
}
