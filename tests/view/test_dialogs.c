/* The dialogs that open and save files: places, words that narrow the list, Open and Save, what they ask.
 *
 * Labels: slow unsanitized */
#include "drive.h"

#include <errno.h>

static void folder_make(const char *path) {
    if (mkdir(path, 0700) != 0 && errno != EEXIST) fail_msg("%s", path);
}

static int dialogs_set_up(void **state) {
    char path[SCRATCH_SIZE + 16], text[SCRATCH_SIZE + 128];
    if (drive_begin(state) != 0) return -1;
    snprintf(path, sizeof path, "%s/config", work_folder);
    setenv("XDG_CONFIG_HOME", path, 1);
    folder_make("config");
    folder_make("config/gtk-3.0");
    folder_make("of mine");
    folder_make("of mine/deeper");
    snprintf(text, sizeof text, "file://%s/of%%20mine Drafts of mine\nfile://%s/gone\nsftp://else/where\nnonsense\n",
             work_folder, work_folder);
    file_make("config/gtk-3.0/bookmarks", text, strlen(text));
    scene_make();
    size_t size;
    char *scene = file_bytes("scene.gltf", &size);
    file_make("of mine/Chair.gltf", scene, size);
    file_make("of mine/table.gltf", scene, size);
    file_make("of mine/deeper/stool.gltf", scene, size);
    free(scene);
    return 0;
}

/* Returns true if a state had the control, up to the end. */
static bool ever(Drive *drive, const char *control, const char *without) {
    bool seen = false;
    for (bool ended = false; !ended;) {
        ended = drive_ended(drive);
        for (json_t *now; (now = drive_next(drive)); json_decref(now)) {
            const json_t *controls = json_object_get(now, "controls");
            seen |= json_object_get(controls, control) && !(without && json_object_get(controls, without));
        }
        if (!ended) sleep_seconds(0.02);
    }
    drive_finish(drive);
    return seen;
}

static void opened(const char *script_text, const char *scene) {
    Drive drive = drive_start(script_text, LIST(UNSEEN, "scene.gltf"));
    char title[200];
    snprintf(title, sizeof title, "%s: 1 triangles", scene);
    json_decref(drive_until(&drive, "message", title));
    drive_finish(&drive);
}

static void a_bookmark_and_words_find_a_file_by_keys_and_by_mouse(void **state) {
    (void)state;
    need_gl();
#define OPEN "wait rest\nkey control+o\nwait 4\n"
#define MINE OPEN "click \"Open/places/Drafts of mine\"\nwait 4\n"
    opened(MINE "type CHA\nwait 3\nkey enter\nwait message Chair.gltf\nwait rest\n", "of mine/Chair.gltf");
    opened(MINE "key down\nkey down\nkey down\nkey up\nwait 2\nkey enter\nwait message Chair.gltf\nwait rest\n",
           "of mine/Chair.gltf");
    opened(MINE "click Open/table.gltf\nclick Open/Open\nwait message table.gltf\nwait rest\n", "of mine/table.gltf");
    opened(MINE "click Open/deeper/\nclick Open/Open\nwait 3\nclick Open/stool.gltf\npress\nrelease\npress\nrelease\n"
                "wait message stool.gltf\nwait rest\n",
           "of mine/deeper/stool.gltf");
    /* A click in the path selects all of it. */
    opened(OPEN "click Open/path\ntype of mine/table.gltf\nkey enter\nwait message table.gltf\nwait rest\n",
           "of mine/table.gltf");
    Drive drive = drive_start(MINE "type able\nwait 30\nkey escape\nwait 10\nquit\n", LIST(UNSEEN, "scene.gltf"));
    assert_true(ever(&drive, "Open/table.gltf", "Open/Chair.gltf"));
    drive = drive_start(MINE "wait 30\nquit\n", LIST(UNSEEN, "scene.gltf"));
    assert_true(ever(&drive, "Open/Chair.gltf", "Open/places/gone"));
}

static void saving_asks_before_it_replaces_a_file(void **state) {
    (void)state;
    need_gl();
    static const char *const ways[][3] = {{"key control+s", "Save the scene", "scene-weft.glb"},
                                          {"key f12", "Save a picture", "scene-weft.png"}};
    for (int k = 0; k < 2; k++) {
        const char *name = ways[k][1], *file = ways[k][2];
        file_make(file, "precious", 8);
        script_begin();
        say("wait rest\n%s\nwait 4\nclick \"%s/Save\"\nwait 60\nwindow asks.png\nclick \"%s/Cancel\"\nwait 10\n",
            ways[k][0], name, name);
        drive_through(script, LIST(UNSEEN, "scene.gltf"));
        assert_true(same_bytes(file, "precious", 8));
        script_begin();
        say("wait rest\n%s\nwait 4\nclick \"%s/Save\"\nwait 4\nclick \"%s/Save\"\nwait message wrote %s\n", ways[k][0],
            name, name, file);
        drive_through(script, LIST(UNSEEN, "scene.gltf"));
        assert_false(same_bytes(file, "precious", 8));
        unlink(file);
        /* Another name than the one that was asked about is asked about again; one that is free is not. */
        file_make(file, "precious", 8);
        file_make("other.glb", "other", 5);
        script_begin();
        say("wait rest\n%s\nwait 4\nclick \"%s/Save\"\nwait 4\nclick \"%s/file\"\ntype other.glb\nkey enter\nwait 60\n"
            "quit\n",
            ways[k][0], name, name);
        drive_through(script, LIST(UNSEEN, "scene.gltf"));
        assert_true(same_bytes("other.glb", "other", 5));
        unlink(file);
    }
}

/* Returns the text of a .glb's JSON; to be freed. */
static char *glb_text(const char *path) {
    size_t size;
    char *bytes = file_bytes(path, &size);
    assert_non_null(bytes);
    assert_true(size > 20);
    uint32_t length;
    memcpy(&length, bytes + 12, sizeof length);
    assert_true(length <= size - 20);
    memmove(bytes, bytes + 20, length);
    bytes[length] = '\0';
    return bytes;
}

/* Returns the mean green of the picture of a file, path traced. */
static double mean_green(const char *path) {
    WeftImage image;
    WeftError error;
    Ran ran = RUN("render", path, "--env", "1", "--width", "60", "--height", "60", "--spp", "16", "--quiet",
                  "--background", "0,0,0", "-o", "mean.npy");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    assert_int_equal(weft_image_read("mean.npy", &image, NULL, &error), WEFT_OK);
    double sum = 0.0;
    const int count = image.width * image.height;
    for (int k = 0; k < count; k++) sum += (double)((const float *)image.pixels)[k * image.channels + 1];
    weft_image_free(&image);
    return sum / count;
}

/* The file has textures in place of the weave and reflects as much; where nothing is woven, nothing is offered. */
static void a_weave_is_baked_into_the_saved_file(void **state) {
    (void)state;
    need_gl();
#define BAKES "Save the scene/bake into the file"
    Ran ran = RUN("render", "builtin:ball", "--preset", "woven-denim", "--save", "denim.glb");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    drive_through("wait rest\nkey control+s\nwait 4\nclick \"" BAKES "\"\nwait 4\nwindow bake.png\n"
                  "click \"Save the scene/Save\"\nwait message woven material baked\n",
                  LIST(UNSEEN, "denim.glb"));
    char *woven = glb_text("denim.glb"), *baked = glb_text("denim-weft.glb");
    assert_non_null(strstr(woven, "\"weave\""));
    assert_null(strstr(baked, "\"weave\""));
    assert_non_null(strstr(baked, "normalTexture"));
    assert_non_null(strstr(baked, "KHR_materials_anisotropy"));
    free(woven);
    free(baked);
    const double threads = mean_green("denim.glb"), textures = mean_green("denim-weft.glb");
    print_message("under an even sky %.4f of threads, %.4f of textures\n", threads, textures);
    assert_true(fabs(textures / threads - 1.0) < 0.05);
    Drive drive = drive_start("wait rest\nkey control+s\nwait 20\nquit\n", LIST(UNSEEN, "scene.gltf"));
    assert_false(ever(&drive, BAKES, NULL));
}

/* Closing the window asks first, and the file comes if the answer is to stay. What it lacks is said. */
static void a_file_that_is_being_baked_is_not_lost_without_a_question(void **state) {
    (void)state;
    need_gl();
    Ran ran = RUN("render", "builtin:ball", "--preset", "woven-denim", "--set", "*.dust=0.3", "--save", "jeans.glb");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    drive_through("wait rest\nkey control+s\nwait 4\nclick \"" BAKES "\"\nwait 4\nclick \"Save the scene/Save\"\n"
                  "wait 2\nclose\nwait 3\nwindow asks.png\nclick \"Unsaved changes/Cancel\"\n"
                  "wait message dust: 0.3 of it is not baked\n",
                  LIST(UNSEEN, "jeans.glb"));
    assert_int_equal(access("asks.png", F_OK), 0); /* it was still open, since it asked */
    assert_int_equal(access("jeans-weft.glb", F_OK), 0);
}

static void saving_goes_to_the_folder_that_is_shown(void **state) {
    (void)state;
    need_gl();
    drive_through("wait rest\nkey control+s\nwait 4\nclick \"Save the scene/places/Drafts of mine\"\nwait 3\n"
                  "click \"Save the scene/table.gltf\"\nwait 3\nclick \"Save the scene/file\"\ntype new.gltf\n"
                  "click \"Save the scene/Save\"\nwait message new.gltf\nkey f12\nwait 4\n"
                  "click \"Save a picture/folder\"\nwait 4\nwindow folder.png\nclick \"Save a picture/Up\"\nwait 3\n"
                  "click \"Save a picture/Save\"\nwait message wrote scene-weft.png\n",
                  LIST(UNSEEN, "scene.gltf"));
    assert_int_equal(access("of mine/new.gltf", F_OK), 0);
    assert_int_equal(access("scene-weft.png", F_OK), 0);
    assert_int_not_equal(access("of mine/scene-weft.png", F_OK), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_bookmark_and_words_find_a_file_by_keys_and_by_mouse),
                                       cmocka_unit_test(saving_asks_before_it_replaces_a_file),
                                       cmocka_unit_test(a_weave_is_baked_into_the_saved_file),
                                       cmocka_unit_test(a_file_that_is_being_baked_is_not_lost_without_a_question),
                                       cmocka_unit_test(saving_goes_to_the_folder_that_is_shown)};
    return cmocka_run_group_tests_name("view/dialogs", tests, dialogs_set_up, drive_end);
}
