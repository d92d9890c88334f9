/* The window without a display, driven by scripts: what it does, says and leaves on disk.
 *
 * Labels: slow unsanitized */
#include "drive.h"

/* ---- materials ---- */

static void value_typed_into_a_slider_is_undone(void **state) {
    (void)state;
    need_gl();
    Drive drive = drive_start(
        "wait rest\nwindow window.png\npicture 0.png\nwait message wrote 0.png\nwait rest\n"
        "set \"Material/roughness\" 0.337\nwait rest\npicture 1.png\nwait message wrote 1.png\nwait rest\n"
        "key control+z\nwait message undone\nwait rest\npicture 2.png\nwait message wrote 2.png\nwait rest\n"
        "key control+z\nwait message nothing\n"
        "key control+shift+z\nwait message redone\nwait rest\npicture 3.png\nwait message wrote 3.png\nwait "
        "rest\n",
        LIST(UNSEEN, CHEAP));
    json_t *states[4];
    for (int k = 0; k < 4; k++) {
        char text[32];
        snprintf(text, sizeof text, "wrote %d.png", k);
        states[k] = drive_until(&drive, "message", text);
    }
    assert_true(json_equal(material_of(states[0], 0), material_of(states[2], 0)));
    assert_true(json_equal(material_of(states[1], 0), material_of(states[3], 0)));
    double rough = json_number_value(json_array_get(json_object_get(material_of(states[1], 0), "roughness"), 0));
    assert_true(fabs(rough - 0.337) < 1e-6);
    for (int k = 0; k < 4; k++) json_decref(states[k]);
    drive_finish(&drive);
    assert_true(pictures_most("1.png", "2.png") > 0.01);
    assert_true(pictures_most("1.png", "3.png") < 1.0 / 255.0);
    WeftImage window = picture_read("window.png");
    assert_true(window.width == 640 && window.height == 420);
    weft_image_free(&window);
}

/* A display of many small pixels: all is twice as large, in a window twice as large, and works. */
static void panels_are_scaled_by_the_scale_option(void **state) {
    (void)state;
    need_gl();
    static const char *const scales[2] = {"1", "2"};
    static const char *const sizes[2][2] = {{"480", "360"}, {"960", "720"}};
    double box[2][4];
    for (int k = 0; k < 2; k++) {
        Drive drive = drive_start("wait rest\nset Material/metallic 0.5\nwait rest\n",
                                  LIST("view", "--windowless", "--forget", "--json", "--width", sizes[k][0], "--height",
                                       sizes[k][1], "--scale", scales[k], CHEAP));
        json_t *now = drive_until(&drive, "command", ".metallic=0.5");
        const json_t *found = json_object_get(json_object_get(now, "controls"), "Material/metallic");
        assert_non_null(found);
        for (int c = 0; c < 4; c++) box[k][c] = json_number_value(json_array_get(found, (size_t)c));
        json_decref(now);
        drive_finish(&drive);
    }
    for (int c = 0; c < 4; c++) assert_true(fabs(box[1][c] - 2.0 * box[0][c]) < 0.05 * box[1][c] + 4.0);
}

/* Two sliders of the light from far away: the picture, and the command line that draws it. */
static void ambient_light_and_reflections_have_a_slider_each(void **state) {
    (void)state;
    need_gl();
    Drive drive = drive_start("wait rest\nclick \"Panel/Light\"\nwait rest\npicture 1.png\nwait message wrote 1.png\n"
                              "set \"Light/ambient\" 0.25\nset \"Light/reflections\" 2\nwait rest\n"
                              "picture 2.png\nwait message wrote 2.png\nwait rest\n",
                              LIST(UNSEEN, "builtin:spheres", "--env", "0.5", "--occlusion", "0"));
    json_t *now = drive_until(&drive, "message", "wrote 2.png");
    const char *command = json_string_value(json_object_get(now, "command"));
    assert_non_null(strstr(command, " --env-ambient 0.25 --env-reflection 2 "));
    json_decref(now);
    drive_finish(&drive);
    assert_true(pictures_most("1.png", "2.png") > 0.02);
}

/* ---- pictures ---- */

/* The mean difference of the stage of two pictures of the window, of which the panels beside it are left out. */
static double stage_difference(const char *a, const char *b) {
    WeftImage x = picture_read(a), y = picture_read(b);
    double sum = 0.0;
    for (int k = 0; k < x.width * x.height * x.channels; k++)
        if (k / x.channels % x.width < x.width / 2)
            sum += fabs((double)((const unsigned char *)x.pixels)[k] - (double)((const unsigned char *)y.pixels)[k]);
    const double mean = sum / ((double)x.width * (double)x.height);
    weft_image_free(&x);
    weft_image_free(&y);
    return mean;
}

/* Frames after a turn of the camera, every third of them: the last that is in motion, then finer ones. No step is
 * nearly all that changes, which one step was before. */
static void a_picture_that_comes_to_rest_glides(void **state) {
    (void)state;
    need_gl();
    enum { SHOTS = 40 };
    char names[SHOTS + 1][16];
    double steps[SHOTS];
    int moved = 0;
    script_begin();
    say("wait rest\ndrag left 0.3 0.5 0.62 0.5\n");
    for (int k = 0; k <= SHOTS; k++) {
        snprintf(names[k], sizeof names[k], "glide%02d.png", k);
        if (k == SHOTS) say("wait rest\n");
        say("window %s\n", names[k]);
    }
    drive_through(script, LIST(UNSEEN, "builtin:cloth", "--occlusion", "0"));
    for (int k = 0; k < SHOTS; k++) steps[k] = stage_difference(names[k], names[k + 1]);
    for (int k = 0; k < SHOTS; k++)
        if (steps[k] > steps[moved]) moved = k;
    const double all = stage_difference(names[moved + 1], names[SHOTS]);
    double most = 0.0;
    for (int k = moved + 1; k < SHOTS; k++) most = fmax(most, steps[k]);
    print_message("from motion to rest: %.3f of 255, in one step at most %.3f\n", all, most);
    assert_true(all > 0.05);
    assert_true(most < 0.85 * all);
}

/* ---- scenes ---- */

static void a_broken_scene_leaves_the_one_before(void **state) {
    (void)state;
    need_gl();
    file_make("broken.glb", "glTF....nonsense", 16);
    file_make("broken.gltf", "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[7]}]}", 52);
    file_make("strange.xyz", "?", 1);
    script_begin();
    say_picture("before.png");
    say("drop broken.glb\nwait message broken.glb\ndrop broken.gltf\nwait message broken.gltf\n");
    say("open nowhere.gltf\nwait message nowhere.gltf\ndrop strange.xyz\nwait message strange.xyz\nwait "
        "rest\n");
    say_picture("after.png");
    say("wait rest\n");
    Drive drive = drive_start(script, LIST(UNSEEN, CHEAP));
    json_t *now = drive_until(&drive, "message", "after.png");
    assert_string_equal(word_of(now, "scene"), "builtin:cloth");
    json_decref(now);
    drive_finish(&drive);
    assert_true(pictures_most("before.png", "after.png") < 0.5 / 255.0);
}

static void a_saved_scene_looks_the_same(void **state) {
    (void)state;
    need_gl();
    script_begin();
    say("wait rest\nchoose \"Material/sheen lobe\" charlie-neubelt\nset \"Material/sheen roughness\" "
        "0.5\nwait "
        "rest\n");
    say_picture("own.png");
    say("save saved.glb\nwait message wrote saved.glb\nsave saved.gltf\nwait message wrote saved.gltf\n");
    drive_through(script, LIST(UNSEEN, CHEAP));
    static const char *const files[] = {"saved.glb", "saved.gltf"};
    script_begin();
    say_picture("again.png");
    for (int k = 0; k < 2; k++) {
        drive_through(script, LIST(UNSEEN, files[k], "--env", "0,0,0", "--camera", "0", "--occlusion", "0"));
        double most = pictures_most("own.png", "again.png");
        if (!(most < 1.5 / 255.0)) fail_msg("%s: %.1f / 255", files[k], 255.0 * most);
    }
}

static void full_disk_is_a_message(void **state) {
    (void)state;
    need_gl();
    file_make("script",
              "wait rest\nsave full.glb\nwait message full.glb\nwait rest\npicture full.exr\n"
              "wait message full.exr\nwait rest\nset \"Material/roughness\" 0.5\nwait rest\n",
              strlen("wait rest\nsave full.glb\nwait message full.glb\nwait rest\npicture full.exr\n"
                     "wait message full.exr\nwait rest\nset \"Material/roughness\" 0.5\nwait rest\n"));
    Ran ran = run_shell("( ulimit -f 40; trap '' XFSZ; \"$0\" view builtin:cloth --set Softbox.emission=0 --env 0,0,0"
                        " --light 'sun;-1,-2,-1;3,3,3' --occlusion 0 --windowless --forget --json --width 640"
                        " --height 420 --script script || echo failed >&2 ) | cat > said");
    size_t size;
    char *said = file_bytes("said", &size);
    assert_string_equal(ran.err, "");
    assert_non_null(strstr(said, "\"message\":\"full.glb: "));
    assert_non_null(strstr(said, "\"message\":\"full.exr: "));
    assert_null(strstr(said, "wrote full"));
    assert_int_equal(access("full.glb", F_OK), -1);
    assert_int_equal(access("full.exr", F_OK), -1);
    free(said);
    ran_free(&ran);
}

/* ---- the command line ---- */

/* Runs the line that the window wrote, with another name for its picture. */
static void render_as(const char *line_path, const char *picture) {
    size_t size;
    char *line = file_bytes(line_path, &size), shell[4096];
    assert_non_null(line);
    char *tail = strstr(line, " -o picture.png");
    assert_true(strncmp(line, "weft render ", 12) == 0 && tail);
    *tail = '\0';
    snprintf(shell, sizeof shell, "\"$0\" %s --quiet --occlusion 0 -o %s", line + 5, picture);
    Ran ran = run_shell(shell);
    if (ran.code != 0) fail_msg("%s: %d: %s", shell, ran.code, ran.err);
    ran_free(&ran);
    free(line);
}

/* The maps in Models/Materials/0 are put on the cloth without being asked for. */
static void copied_command_line_has_the_folder_of_maps(void **state) {
    (void)state;
    need_gl();
    Ran ran = run_shell("mkdir -p Models/Materials/0 && \"$0\" render builtin:spheres --width 16 --height 16 --spp 1"
                        " --quiet -o Models/Materials/0/Albedo.png");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    script_begin();
    say("wait rest\nwait message maps of\nwait rest\ncommand w.txt\n");
    drive_through(script, LIST(UNSEEN, CHEAP));
    size_t size;
    char *line = file_bytes("w.txt", &size);
    assert_non_null(line);
    assert_non_null(strstr(line, " --materials Models/Materials/0 "));
    free(line);
    ran = run_shell("rm -r Models");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
}

static void copied_command_line_makes_the_shown_picture(void **state) {
    (void)state;
    need_gl();
    script_begin();
    say("wait rest\nchoose \"Material/sheen lobe\" charlie-neubelt\nset \"Material/sheen roughness\" 0.47\n");
    say("drag left 0.5 0.5 0.6 0.45\nwheel 1\n");
    say_picture("0.exr");
    say("command 0.txt\nclick Panel/Light\nset Light/intensity 5.5\nset Light/rotation 20\nclick \"Light/+ "
        "point\"\n");
    say("click Panel/View\nset View/exposure 0.5\nchoose View/show sheen\n");
    say_picture("1.exr");
    say("command 1.txt\nkey tab\nwait samples 64\npicture 2.exr\nwait message wrote 2.exr\ncommand 2.txt\n");
    drive_through(script, LIST(UNSEEN, CHEAP));
    render_as("0.txt", "r0.exr");
    render_as("1.txt", "r1.exr");
    render_as("2.txt", "r2.exr");
    assert_true(pictures_differ("0.exr", "r0.exr") < 1e-5);
    assert_true(pictures_differ("1.exr", "r1.exr") < 1e-5);
    double traced = pictures_differ("2.exr", "r2.exr");
    if (!(traced < 0.01)) fail_msg("path traced: %g", traced);
    assert_true(pictures_differ("0.exr", "1.exr") > 0.01);
}

/* Tone curve, white and metered exposure go along, and the picture of a lamp of 4000 K becomes bluer. */
static void copied_command_line_shows_the_same_tone(void **state) {
    (void)state;
    need_gl();
    script_begin();
    say("wait rest\nclick Panel/View\nset View/exposure -3\n");
    say_picture("dark.png");
    say("wait rest\nclick \"View/Automatic exposure\"\nset View/white 4000\nchoose \"View/tone map\" agx\nwait 300\n"
        "wait rest\n");
    say_picture("tone.png");
    say("command tone.txt\n");
    drive_through(script, LIST(UNSEEN, CHEAP));
    size_t size;
    char *line = file_bytes("tone.txt", &size);
    assert_non_null(line);
    const char *exposure = strstr(line, " --exposure ");
    if (!exposure || !strstr(line, " --tonemap agx") || !strstr(line, " --white-balance 4000,0")) fail_msg("%s", line);
    assert_true(strtod(exposure + strlen(" --exposure "), NULL) > -1.5);
    free(line);
    render_as("tone.txt", "same.png");
    assert_true(pictures_most("tone.png", "same.png") < 1.1 / 255.0);
    assert_true(pictures_most("tone.png", "dark.png") > 0.15);
}

/* An automatic white makes a picture of a lamp of 3000 K greyer, as the copied command does, until a slider ends it. */
static void automatic_white_is_that_of_the_command(void **state) {
    (void)state;
    need_gl();
    script_begin();
    say("wait rest\nclick Panel/View\n");
    say_picture("warm.png");
    say("wait rest\nclick \"View/Automatic white\"\nwait 300\nwait rest\n");
    say_picture("white.png");
    say("command white.txt\nset View/white 6504\nwait 20\nwait rest\n");
    say_picture("ended.png");
    say("command ended.txt\n");
    drive_through(script, LIST("view", "--windowless", "--forget", "--json", "--width", "640", "--height", "420",
                               "builtin:cloth", "--set", "Softbox.emission=0", "--env", "0,0,0", "--light",
                               "sun;-1,-2,-1;3,1.6,0.6", "--occlusion", "0"));
    Ran ran = run_shell("grep -q -- '--white-balance auto' white.txt && ! grep -q -- --white-balance ended.txt");
    if (ran.code != 0) fail_msg("%d %s", ran.code, ran.err);
    ran_free(&ran);
    render_as("white.txt", "same.png");
    assert_true(pictures_most("white.png", "same.png") < 2.5 / 255.0);
    assert_true(pictures_most("white.png", "warm.png") > 0.1);
    assert_true(pictures_most("ended.png", "warm.png") < 1.1 / 255.0);
}

/* ---- comparing ---- */

static void a_b_comparison_shows_two_settings_and_their_difference(void **state) {
    (void)state;
    need_gl();
    script_begin();
    say("wait rest\nkey c\nset \"Material/roughness\" 0.25\n");
    say_picture("a.png");
    say("wait rest\nkey x\n");
    say_picture("b.png");
    say("wait rest\nkey x\nkey c\n");
    say_picture("c.png");
    say("wait rest\nkey shift+tab\nwait samples 8\nwait 200\npicture d.png\nwait message wrote d.png\nwait "
        "samples 9\n");
    Drive drive = drive_start(script, LIST(UNSEEN, CHEAP));
    json_t *a = drive_until(&drive, "message", "wrote a.png"), *b = drive_until(&drive, "message", "wrote b.png"),
           *c = drive_until(&drive, "message", "wrote c.png");
    assert_int_equal(number_of(a, "split"), 1);
    assert_int_equal(number_of(b, "split"), 1);
    assert_int_equal(number_of(c, "split"), 0);
    assert_true(fabs(input_of(a, 0, "roughness", 0) - 0.25) < 1e-6);
    assert_true(fabs(input_of(b, 0, "roughness", 0) - 0.9) < 1e-6);
    assert_true(fabs(input_of(c, 0, "roughness", 0) - 0.25) < 1e-6);
    assert_true(number_of(c, "relmse") < 0.0);
    json_decref(a);
    json_decref(b);
    json_decref(c);
    double relmse = -1.0;
    for (bool ended = false; !ended;) {
        ended = drive_ended(&drive);
        for (json_t *now; (now = drive_next(&drive)); json_decref(now)) {
            if (strcmp(word_of(now, "mode"), "difference") != 0) continue;
            relmse = fmax(relmse, number_of(now, "relmse"));
        }
        if (!ended) sleep_seconds(0.02);
    }
    drive_finish(&drive);
    assert_true(relmse >= 0.0 && relmse < 1.0);
}

/* ---- keys ---- */

static void panels_and_menus_are_reached_by_keys(void **state) {
    (void)state;
    need_gl();
    Drive drive = drive_start("wait rest\nkey f6\nkey f6\nkey f6\nwait 3\nkey space\nwait 4\nkey down\nkey space\nwait "
                              "4\nwait rest\n"
                              "picture 1.png\nwait message wrote 1.png\nwait rest\nkey escape\nkey g\nwait 3\n"
                              "key f10\nwait 3\nkey down\nwait 6\nwait seconds 1\nkey escape\nkey escape\nwait rest\n",
                              LIST(UNSEEN, CHEAP));
    json_t *now = drive_until(&drive, "message", "wrote 1.png");
    assert_int_equal(number_of(now, "material"), 1);
    json_decref(now);
    bool opened = false, floor = false;
    for (bool ended = false; !ended;) {
        ended = drive_ended(&drive);
        for (json_t *next; (next = drive_next(&drive)); json_decref(next)) {
            opened |= json_object_get(json_object_get(next, "controls"), "Menu/File/Open ...") != NULL;
            floor |= strstr(word_of(next, "command"), " --floor ") != NULL;
        }
        if (!ended) sleep_seconds(0.02);
    }
    drive_finish(&drive);
    assert_true(opened);
    assert_true(floor);
}

/* ---- what cannot be done ---- */

static void wrong_script_ends_the_window_with_its_line(void **state) {
    (void)state;
    need_gl();
    static const char *const wrong[][2] = {{"wait rest\nclick \"Material/nonsense\"\n", "script:2: "},
                                           {"# one\n\nwait rest\nsing a song\n", "script:4: "},
                                           {"key nonsense\n", "script:1: "},
                                           {"drag left 0.5\n", "script:1: "},
                                           {"drag left 0 0 1 1 1\n", "script:1: \"drag left 0 0 1 1 1\" is not"},
                                           {"wait 2garbage\n", "script:1: \"wait 2garbage\" is nothing to wait for"},
                                           {"wait 2\nwait 1 2 3\n", "script:2: \"wait 1 2 3\""},
                                           {"wait\n", "script:1: "},
                                           {"wait samples few\n", "script:1: "},
                                           {"wait shows it\n", "script:1: "},
                                           {"wheel up\n", "script:1: "},
                                           {"press hard\n", "script:1: "},
                                           {"quit now\n", "script:1: "}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        file_make("script", wrong[k][0], strlen(wrong[k][0]));
        assert_complaint(NULL, LIST("view", "--windowless", "--forget", CHEAP, "--script", "script"), WEFT_INPUT,
                         wrong[k][1]);
    }
    assert_complaint(NULL, LIST("view", "--windowless", "--forget", CHEAP, "--script", "absent"), WEFT_INPUT, "absent");
}

static void window_without_a_display_names_commands_that_need_none(void **state) {
    (void)state;
    Ran ran = run_shell("unset DISPLAY WAYLAND_DISPLAY; exec \"$0\" view builtin:cloth --forget");
    assert_int_equal(ran.code, 4);
    assert_true(one_complaint(ran.err));
    assert_non_null(strstr(ran.err, "weft render"));
    assert_string_equal(ran.out, "");
    ran_free(&ran);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(value_typed_into_a_slider_is_undone),
                                       cmocka_unit_test(panels_are_scaled_by_the_scale_option),
                                       cmocka_unit_test(ambient_light_and_reflections_have_a_slider_each),
                                       cmocka_unit_test(a_picture_that_comes_to_rest_glides),
                                       cmocka_unit_test(a_broken_scene_leaves_the_one_before),
                                       cmocka_unit_test(a_saved_scene_looks_the_same),
                                       cmocka_unit_test(full_disk_is_a_message),
                                       cmocka_unit_test(copied_command_line_makes_the_shown_picture),
                                       cmocka_unit_test(copied_command_line_shows_the_same_tone),
                                       cmocka_unit_test(automatic_white_is_that_of_the_command),
                                       cmocka_unit_test(copied_command_line_has_the_folder_of_maps),
                                       cmocka_unit_test(a_b_comparison_shows_two_settings_and_their_difference),
                                       cmocka_unit_test(panels_and_menus_are_reached_by_keys),
                                       cmocka_unit_test(wrong_script_ends_the_window_with_its_line),
                                       cmocka_unit_test(window_without_a_display_names_commands_that_need_none)};
    return cmocka_run_group_tests(tests, drive_begin, drive_end);
}
