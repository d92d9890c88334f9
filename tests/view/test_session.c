/* The session of a window: it comes back after the window was killed, and is asked about before it is lost.
 *
 * Labels: slow unsanitized */
#include "drive.h"

/* A window that remembers: its folders are those of the test. */
#define REMEMBERS "view", "--windowless", "--json", "--width", "640", "--height", "420"

static int session_begin(void **state) {
    char path[SCRATCH_SIZE + 16];
    if (drive_begin(state) != 0) return -1;
    snprintf(path, sizeof path, "%s/state", work_folder);
    setenv("XDG_STATE_HOME", path, 1);
    snprintf(path, sizeof path, "%s/config", work_folder);
    setenv("XDG_CONFIG_HOME", path, 1);
    return 0;
}

static int forget_sessions(void **state) {
    Ran ran = run_shell("rm -rf state config");
    ran_free(&ran);
    return 0;
}

/* Returns the number of files of sessions; path (may be NULL) receives one that ends in `end`. */
static int sessions_kept(const char *end, char path[512]) {
    DIR *folder = opendir("state/weft");
    int count = 0;
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        const size_t length = strlen(entry->d_name), tail = strlen(end);
        if (length < tail || strcmp(entry->d_name + length - tail, end) != 0) continue;
        count++;
        if (path) snprintf(path, 512, "state/weft/%s", entry->d_name);
    }
    if (folder) closedir(folder);
    return count;
}

static void await_session(Drive *drive) {
    for (double start = clock_now(); !sessions_kept(".json", NULL);) {
        if (drive_ended(drive) || clock_now() - start > 60.0) drive_give_up(drive, "no session was kept");
        sleep_seconds(0.05);
    }
}

static void kill_now(Drive *drive) {
    kill(drive->child, SIGKILL);
    Ran ran = program_end(drive->child);
    assert_int_equal(ran.code, 128 + SIGKILL);
    ran_free(&ran);
}

/* What a state tells of the scene and the view. */
static void assert_same(const json_t *is, const json_t *was) {
    static const char *const keys[] = {"scene",    "camera",    "mode",       "split",         "part",
                                       "material", "materials", "lights",     "rotation",      "variant",
                                       "command",  "unsaid",    "photograph", "photograph_box"};
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
        const json_t *a = json_object_get(is, keys[k]), *b = json_object_get(was, keys[k]);
        assert_non_null(a);
        if (json_equal(a, b)) continue;
        char *now = json_dumps(a, JSON_ENCODE_ANY), *before = json_dumps(b, JSON_ENCODE_ANY);
        print_message("%s is %s\nand was %s\n", keys[k], now, before);
        fail_msg("%s", keys[k]);
    }
}

/* Writes a picture of 2 x 2 texels. */
static void map_make(const char *path) {
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_image_create(2, 2, 3, WEFT_PIXEL_U8, &image, &error), WEFT_OK);
    memset(image.pixels, 0x60, 12);
    assert_int_equal(weft_image_write(path, &image, &error), WEFT_OK);
    weft_image_free(&image);
}

/* Takes an option and an input at their defaults out of the session, as if an earlier version had kept it. */
static void make_older(void) {
    char path[512];
    assert_int_equal(sessions_kept(".json", path), 1);
    json_t *session = json_load_file(path, 0, NULL), *material;
    size_t k;
    assert_int_equal(json_object_del(json_object_get(session, "options"), "kelvin"), 0);
    json_array_foreach(json_object_get(json_object_get(session, "state"), "materials"), k, material) {
        assert_int_equal(json_object_del(json_object_get(material, "inputs"), "retroreflection"), 0);
    }
    assert_int_equal(json_dump_file(session, path, 0), 0);
    json_decref(session);
}

static void a_killed_window_comes_back_with_its_state(void **state) {
    (void)state;
    need_gl();
    map_make("rough.png");
    script_begin();
    say("wait rest\nset \"Material/sheen roughness\" 0.7\nchoose \"Material/sheen lobe\" fibre\nwait rest\n");
    say("drop rough.png\nwait 3\nclick \"Use a picture/Use\"\nwait rest\n"); /* a map that was added */
    say("key b\ndrag left 0.45 0.45 0.55 0.5\nwait rest\nkey b\n");          /* a nap that was brushed */
    say("drag left 0.8 0.8 0.9 0.85\nwait rest\n");
    say("click Panel/View\nwait 3\nset View/exposure 1.25\nclick View/Floor\nwait 2\n");
    say("drop rough.png\nwait 3\nclick \"Use a picture/As photograph\"\nwait rest\n");
    say("click View/place/Over\nwait rest\n");
    say("key c\nwait rest\nclick Panel/Light\nwait rest\nwait session\n");
    say_picture("kept.png");
    say("stay\n");
    Drive drive = drive_start(script, LIST(REMEMBERS, CHEAP));
    json_t *was = drive_picture(&drive, "kept.png"), *later;
    kill_now(&drive);
    assert_int_equal(number_of(was, "split"), 1);
    assert_non_null(strstr(word_of(was, "unsaid"), "the brushed nap of Cloth\n"));
    assert_non_null(strstr(word_of(was, "unsaid"), "B of A and B"));
    assert_non_null(strstr(word_of(was, "command"), "--texture 0.roughness=rough.png"));
    assert_non_null(strstr(word_of(was, "command"), "--exposure 1.25"));

    make_older();
    drive = drive_start("wait rest\nwindow restored.png\nwait rest\nstay\n", LIST(REMEMBERS, CHEAP));
    json_decref(drive_until(&drive, "message", "restored what was not saved"));
    later = drive_rest(&drive);
    assert_same(later, was);
    json_decref(later);
    kill_now(&drive); /* a session that was restored is still there */

    drive = drive_start("wait rest\nkey x\nwait rest\nkey x\nkey control+z\nwait rest\nstay\n", LIST(REMEMBERS, CHEAP));
    later = drive_until(&drive, "message", "undone");
    assert_null(strstr(word_of(later, "unsaid"), "nap"));
    assert_int_equal(number_of(later, "split"), 1);
    json_decref(later);
    kill_now(&drive);
    json_decref(was);
}

static void a_cloth_and_the_last_scene_come_back_without_an_argument(void **state) {
    (void)state;
    need_gl();
    scene_make();
    script_begin();
    say("wait rest\nclick Material/Weave\nwait 3\nclick Material/draft\n");
    say("type twill 3/1 z; warp 1#26375c; weft 1#d8d4c8\nwait 2\nclick \"Material/Weave it\"\nwait 5\nwait "
        "rest\nwait session\nclick Panel/View\nwait 3\nset View/exposure 1.25\nwait rest\nstay\n");
    Drive drive = drive_start(script, LIST(REMEMBERS, "scene.gltf"));
    json_t *was = drive_until(&drive, "command", "--exposure 1.25");
    assert_non_null(strstr(word_of(was, "command"), "26375c"));
    kill(drive.child, SIGTERM); /* it is told to end: that keeps the session too, with what has just changed */
    Ran ran = program_end(drive.child);
    if (ran.code != WEFT_INTERRUPTED || !one_complaint(ran.err) || !strstr(ran.err, "the session is kept"))
        fail_msg("%d: \"%s\"", ran.code, ran.err);
    ran_free(&ran);

    drive = drive_start("wait rest\nstay\n", LIST(REMEMBERS));
    json_t *later = drive_rest(&drive);
    assert_non_null(strstr(word_of(later, "scene"), "/scene.gltf"));
    assert_string_equal(json_string_value(json_object_get(material_of(later, 0), "name")), "cloth");
    assert_int_equal(number_of(material_of(later, 0), "cloth"), 1);
    const char *weave = strstr(word_of(was, "command"), "--set"), *again = strstr(word_of(later, "command"), "--set");
    assert_non_null(weave);
    assert_string_equal(again, weave);
    kill_now(&drive);

    /* A scene that can no longer be read is said, and another is shown. */
    file_make("scene.gltf", "{", 1);
    drive = drive_start("wait rest\nstay\n", LIST(REMEMBERS));
    json_decref(later);
    later = drive_until(&drive, "scene", "builtin:cloth");
    assert_string_equal(word_of(later, "scene"), "builtin:cloth");
    kill_now(&drive);

    /* With a scene or --forget on the command line it is not there. */
    drive = drive_start("wait rest\nstay\n", LIST(UNSEEN));
    json_decref(later);
    later = drive_rest(&drive);
    assert_string_equal(word_of(later, "scene"), "builtin:cloth");
    kill_now(&drive);
    json_decref(later);
    json_decref(was);
}

static void a_damaged_session_is_one_line_and_no_more(void **state) {
    (void)state;
    need_gl();
    static const char *const texts[] = {
        "",
        "{",
        "[]",
        "{\"names\": 3, \"maps\": 0}",
        "{\"names\": [\"cloth\"], \"maps\": 0, \"state\": {\"materials\": [{\"index\": 99999999999}]}}",
        "{\"names\": [\"cloth\"], \"maps\": 0, \"state\": {\"materials\": [], \"lights\": [{\"kind\": 7}]}}",
        "{\"names\": [\"cloth\"], \"maps\": 0, \"state\": {\"materials\": [], \"lights\": []}, \"lobes\": 5}"};
    char path[512];
    scene_make();
    Drive drive = drive_start("wait rest\nset \"Material/sheen roughness\" 0.7\nwait rest\nstay\n",
                              LIST(REMEMBERS, "scene.gltf"));
    await_session(&drive);
    kill_now(&drive);
    assert_int_equal(sessions_kept(".json", path), 1);
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        file_make(path, texts[k], strlen(texts[k]));
        drive = drive_start("wait rest\nwait seconds 1\nquit\n", LIST(REMEMBERS, "scene.gltf"));
        json_t *said = drive_until(&drive, "message", "restored");
        assert_null(strchr(word_of(said, "message"), '\n'));
        const double rough = input_of(said, 0, "sheen_roughness", 0);
        if (fabs(rough - 0.5) > 1e-6) fail_msg("%s: %g", texts[k], rough);
        json_decref(said);
        drive_finish(&drive);
    }
}

/* A name that is longer than what the window keeps of it is cut, and its last character with it. */
static void a_session_has_names_that_were_cut(void **state) {
    (void)state;
    need_gl();
    Ran ran = run_shell(
        "n=$(printf '\\303\\251%.0s' $(seq 100)); for s in '' x; do sed \"s/\\\"name\\\": *\\\"cloth\\\"/"
        "\\\"name\\\":\\\"$s$n\\\"/\" scene.gltf >\"cut$s.gltf\" && grep -q \"$n\" \"cut$s.gltf\" || exit 9; done");
    if (ran.code != 0) fail_msg("%d %s", ran.code, ran.err);
    ran_free(&ran);
    static const char *const scenes[] = {"cut.gltf", "cutx.gltf"};
    for (size_t k = 0; k < 2; k++) {
        Drive drive = drive_start("wait rest\nset \"Material/sheen roughness\" 0.7\nwait rest\nstay\n",
                                  LIST(REMEMBERS, scenes[k]));
        await_session(&drive);
        kill_now(&drive);
        drive = drive_start("wait rest\nstay\n", LIST(REMEMBERS, scenes[k]));
        json_t *later = drive_until(&drive, "message", "restored what was not saved");
        assert_float_equal(input_of(later, 0, "sheen_roughness", 0), 0.7, 1e-6);
        json_decref(later);
        kill_now(&drive);
        forget_sessions(NULL);
    }
}

static void closing_asks_if_changes_are_not_saved(void **state) {
    (void)state;
    need_gl();
    scene_make();
    /* Nothing is asked of a scene that was only looked at. */
    drive_through("wait rest\ndrag left 0.4 0.4 0.6 0.5\nwait rest\nkey control+q\nwait 600\nkey z\nwindow late.png\n",
                  LIST(REMEMBERS, "scene.gltf"));
    assert_int_not_equal(access("late.png", F_OK), 0);
    assert_int_equal(sessions_kept(".json", NULL), 0);

    script_begin();
    say("wait rest\nset \"Material/sheen roughness\" 0.7\nwait session\n");
    say("close\nwait 3\nclick \"Unsaved changes/Cancel\"\nwait 3\n");
    say("key control+q\nwait 3\nkey escape\nwait 3\n");
    say("drop builtin:cloth\nwait 3\nwindow asks.png\nkey escape\nwait rest\nwindow stays.png\n");
    say("key control+q\nwait 3\nkey enter\nwait 3\nclick \"Save the scene/Cancel\"\nwait 3\n");
    say("key control+q\nwait 3\nclick \"Unsaved changes/Save ...\"\nwait 3\nclick \"Save the scene/Save\"\nwait 900\n");
    say("window late.png\n");
    drive_through(script, LIST(REMEMBERS, "scene.gltf"));
    assert_int_equal(access("stays.png", F_OK), 0);
    assert_int_not_equal(access("late.png", F_OK), 0);
    assert_int_equal(access("scene-weft.glb", F_OK), 0);
    assert_int_equal(sessions_kept(".json", NULL), 0); /* what was saved is not kept */
    assert_int_equal(sessions_kept(".lock", NULL), 0);

    /* What is discarded is gone, and undo leaves nothing to ask. */
    drive_through("wait rest\nset \"Material/sheen roughness\" 0.7\nwait session\nkey control+q\nwait 3\nkey d\n"
                  "wait 600\nwindow late.png\n",
                  LIST(REMEMBERS, "scene.gltf"));
    drive_through("wait rest\nset \"Material/sheen roughness\" 0.7\nwait 5\nkey control+z\nwait 3\nclose\nwait 600\n"
                  "window late.png\n",
                  LIST(REMEMBERS, "scene.gltf"));
    assert_int_not_equal(access("late.png", F_OK), 0);
    assert_int_equal(sessions_kept(".json", NULL), 0);
}

static void opening_another_scene_asks_too(void **state) {
    (void)state;
    need_gl();
    scene_make();
    script_begin();
    say("wait rest\nset \"Material/sheen roughness\" 0.7\nwait session\ndrop builtin:cloth\nwait 3\n");
    say("click \"Unsaved changes/Discard\"\nwait message builtin:cloth\nwait rest\nstay\n");
    Drive drive = drive_start(script, LIST(REMEMBERS, "scene.gltf", "--occlusion", "0"));
    json_t *later = drive_until(&drive, "scene", "builtin:cloth");
    json_decref(later);
    assert_int_equal(sessions_kept(".json", NULL), 0); /* that of the scene before */
    kill_now(&drive);
}

/* Two windows of one scene do not write each other's session. */
static void a_second_window_of_a_scene_leaves_the_session_alone(void **state) {
    (void)state;
    need_gl();
    scene_make();
    Drive drive = drive_start("wait rest\nset \"Material/sheen roughness\" 0.7\nwait rest\nstay\n",
                              LIST(REMEMBERS, "scene.gltf"));
    await_session(&drive);
    Ran second = RUN("view", "--windowless", "scene.gltf", "--frames", "30");
    assert_int_equal(second.code, 0);
    ran_free(&second);
    assert_int_equal(sessions_kept(".json", NULL), 1);
    kill_now(&drive);
}

int main(void) {
#define TEST(name) cmocka_unit_test_teardown(name, forget_sessions)
    const struct CMUnitTest tests[] = {TEST(a_killed_window_comes_back_with_its_state),
                                       TEST(a_cloth_and_the_last_scene_come_back_without_an_argument),
                                       TEST(a_damaged_session_is_one_line_and_no_more),
                                       TEST(a_session_has_names_that_were_cut),
                                       TEST(closing_asks_if_changes_are_not_saved),
                                       TEST(opening_another_scene_asks_too),
                                       TEST(a_second_window_of_a_scene_leaves_the_session_alone)};
    return cmocka_run_group_tests_name("view/session", tests, session_begin, drive_end);
}
