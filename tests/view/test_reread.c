/* Files that change while the window runs: textures, folders of maps, shader text.
 *
 * Labels: slow unsanitized */
#include "drive.h"

static void write_texture(const char *path, int red, int green) {
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_image_create(8, 8, 3, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
    unsigned char *p = image.pixels;
    for (int k = 0; k < 64; k++, p += 3) p[0] = (unsigned char)red, p[1] = (unsigned char)green, p[2] = 20;
    if (weft_image_write(path, &image, &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_image_free(&image);
}

static void pass_by(Drive *drive, const char *message) { json_decref(drive_until(drive, "message", message)); }

static void changed_texture_is_read_again(void **state) {
    (void)state;
    need_gl();
    write_texture("map.png", 220, 60);
    script_begin();
    say_picture("1.png");
    say("wait message reloaded\n");
    say_picture("2.png");
    say("wait message map.png\n");
    say_picture("3.png");
    say("wait message reloaded\n");
    say_picture("4.png");
    say("wait rest\n");
    Drive drive = drive_start(script, LIST(UNSEEN, CHEAP, "--texture", "Cloth.base_color=map.png"));
    pass_by(&drive, "wrote 1.png");
    write_texture("map.png", 60, 220);
    pass_by(&drive, "wrote 2.png");
    file_make("map.png", "\x89PNG\r\n\x1a\nnonsense", 16);
    pass_by(&drive, "wrote 3.png");
    write_texture("map.png", 220, 60);
    pass_by(&drive, "wrote 4.png");
    drive_finish(&drive);
    assert_true(pictures_most("1.png", "2.png") > 0.05);
    assert_true(pictures_most("2.png", "3.png") < 0.5 / 255.0);
    assert_true(pictures_most("1.png", "4.png") < 0.5 / 255.0);
}

/* The number by which a map is multiplied stays as it was set. */
static void map_added_to_a_used_folder_is_bound(void **state) {
    (void)state;
    need_gl();
    if (mkdir("maps", 0700) != 0) assert_int_equal(access("maps", F_OK), 0);
    write_texture("maps/cloth_roughness.png", 200, 200);
    script_begin();
    say("wait rest\ndrop maps\nwait message 1 maps of maps\nwait rest\n");
    say("set \"Material/roughness\" 0.5\nwait rest\n");
    say_picture("1.png");
    say("wait message 2 maps of maps\n");
    say_picture("2.png");
    say("wait rest\n");
    Drive drive = drive_start(script, LIST(UNSEEN, CHEAP));
    json_t *before = drive_until(&drive, "message", "wrote 1.png");
    write_texture("maps/cloth_basecolor.png", 60, 220);
    json_t *after = drive_until(&drive, "message", "wrote 2.png");
    drive_finish(&drive);
    assert_true(fabs(input_of(before, 0, "roughness", 0) - 0.5) < 1e-6 &&
                fabs(input_of(after, 0, "roughness", 0) - 0.5) < 1e-6);
    assert_true(pictures_most("1.png", "2.png") > 0.05);
    json_decref(before);
    json_decref(after);
    unlink("maps/cloth_roughness.png");
    unlink("maps/cloth_basecolor.png");
    rmdir("maps");
}

/* tests/lobes/toy.h under another name, with another first factor of f. */
static void write_toy(const char *file, const char *id, const char *factor) {
    char line[600];
    snprintf(line, sizeof line,
             "sed 's/toy_/%s_/g; s/Toy/%c%s/g; s/TOY_/\\U%s_/g; s/lobe_value_of(/lobe_value_of(%s * /' "
             "'" WEFT_SOURCE_DIR "/tests/lobes/toy.h' >%s",
             id, id[0] - 'a' + 'A', id + 1, id, factor, file);
    assert_int_equal(system(line), 0);
}

static void changed_lobe_file_is_read_again(void **state) {
    (void)state;
    need_gl();
    write_toy("toy.h", "toy", "1.0f");
    write_toy("felt.h", "felt", "1.0f");
    script_begin();
    say("wait rest\n");
    say_picture("1.png");
    say("wait message toy.h: read\nwait rest\n");
    say_picture("2.png");
    say("wait message toy.h:40: does not compile\n");
    say_picture("3.png");
    say("drop felt.h\nwait message felt.h: read\nwait rest\ncommand line.txt\nwait rest\n");
    Drive drive = drive_start(
        script, LIST(UNSEEN, CHEAP, "--preset", "velvet", "--lobe", "toy.h", "--sheen", "toy", "--layer", "additive"));
    pass_by(&drive, "wrote 1.png");
    write_toy("toy.h", "toy", "0.0f");
    pass_by(&drive, "wrote 2.png");
    write_toy("toy.h", "toy", "no_such_number");
    pass_by(&drive, "wrote 3.png");
    drive_finish(&drive);
    assert_true(pictures_most("1.png", "2.png") > 0.05);
    assert_true(pictures_most("2.png", "3.png") < 0.5 / 255.0);
    size_t size;
    char *line = file_bytes("line.txt", &size);
    assert_non_null(line);
    assert_non_null(strstr(line, " --lobe toy.h --lobe felt.h"));
    free(line);
}

/* Neither the scene nor the first of two lobes is lost to what is dropped behind them. */
static void files_dropped_together_are_all_opened(void **state) {
    (void)state;
    need_gl();
    scene_make();
    write_toy("toy.h", "toy", "0.75f");
    write_toy("felt.h", "felt", "0.75f");
    script_begin();
    say("wait rest\ndrop scene.gltf\ndrop felt.h\ndrop toy.h\nwait message toy.h: read\nwait rest\n");
    say("command line.txt\nwait rest\n");
    Drive drive = drive_start(script, LIST(UNSEEN, CHEAP));
    drive_finish(&drive);
    size_t size;
    char *line = file_bytes("line.txt", &size);
    assert_non_null(line);
    assert_non_null(strstr(line, "weft render scene.gltf"));
    if (!strstr(line, " --lobe felt.h") || !strstr(line, " --lobe toy.h")) fail_msg("%s", line);
    free(line);
}

static void write_lobe(const char *with) {
    static const char from[] = "1.0f / PI";
    const char *text = weft_catalogue_text("lobes/lambert.h"), *at = text ? strstr(text, from) : NULL;
    char *edited = at ? calloc(strlen(text) + strlen(with) + 1, 1) : NULL;
    assert_non_null(edited);
    int length = sprintf(edited, "%.*s%s%s", (int)(at - text), text, with, at + strlen(from));
    file_make("text/shading/lobes/lambert.h", edited, (size_t)length);
    free(edited);
}

static void changed_shader_text_is_compiled_again(void **state) {
    (void)state;
    need_gl();
    assert_int_equal(mkdir("text", 0700) | mkdir("text/shading", 0700) | mkdir("text/shading/lobes", 0700), 0);
    write_lobe("1.0f / PI");
    script_begin();
    say_picture("1.png");
    say("wait message shader:\n");
    say_picture("2.png");
    say("wait message compile again\n");
    say_picture("3.png");
    say("wait message shader:\n");
    say_picture("4.png");
    say("wait message compile again\n");
    say_picture("5.png");
    say("wait rest\n");
    Drive drive = drive_start(script, LIST(UNSEEN, CHEAP, "--shader-dir", "text"));
    json_t *now = drive_until(&drive, "message", "wrote 1.png");
    assert_string_equal(word_of(now, "complaint"), "");
    json_decref(now);
    write_lobe("1.0f / / PI");
    now = drive_until(&drive, "message", "wrote 2.png");
    assert_non_null(strstr(word_of(now, "complaint"), "lambert.h:"));
    json_decref(now);
    write_lobe("3.0f / PI");
    now = drive_until(&drive, "message", "wrote 3.png");
    assert_string_equal(word_of(now, "complaint"), "");
    json_decref(now);
    write_lobe("nothing(a) / PI");
    pass_by(&drive, "wrote 4.png");
    write_lobe("1.0f / PI /* mended */");
    now = drive_until(&drive, "message", "wrote 5.png");
    assert_string_equal(word_of(now, "complaint"), "");
    json_decref(now);
    drive_finish(&drive);
    assert_true(pictures_most("1.png", "2.png") < 0.5 / 255.0); /* broken text leaves what there was */
    assert_true(pictures_most("1.png", "3.png") > 0.1);
    assert_true(pictures_most("3.png", "4.png") < 0.5 / 255.0);
    assert_true(pictures_most("1.png", "5.png") < 0.5 / 255.0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(changed_texture_is_read_again), cmocka_unit_test(map_added_to_a_used_folder_is_bound),
        cmocka_unit_test(changed_lobe_file_is_read_again), cmocka_unit_test(files_dropped_together_are_all_opened),
        cmocka_unit_test(changed_shader_text_is_compiled_again)};
    return cmocka_run_group_tests(tests, drive_begin, drive_end);
}
