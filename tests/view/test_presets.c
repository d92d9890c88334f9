/* The window of presets: groups, a search, pictures that are made once, materials of the user's own, and files that
 * are none.
 *
 * Labels: slow unsanitized */
#include "drive.h"

#define LARGE "view", "--windowless", "--forget", "--json", "--width", "900", "--height", "640", CHEAP

/* Folders of the user's, below the work folder. */
static void own_folders(void) {
    char path[SCRATCH_SIZE + 16];
    snprintf(path, sizeof path, "%s/cache", work_folder);
    setenv("XDG_CACHE_HOME", path, 1);
    snprintf(path, sizeof path, "%s/data", work_folder);
    setenv("XDG_DATA_HOME", path, 1);
}

/* The number of controls of that scope that are shown. */
static int controls_in(const json_t *now, const char *scope) {
    json_t *controls = json_object_get(now, "controls"), *box;
    const char *name;
    int count = 0;
    json_object_foreach(controls, name, box) count += strncmp(name, scope, strlen(scope)) == 0;
    return count;
}

static bool is_shown(const json_t *now, const char *control) {
    return json_object_get(json_object_get(now, "controls"), control) != NULL;
}

static int pictures_kept(void) {
    Ran ran = run_shell("ls cache/weft | grep -c png");
    const int count = atoi(ran.out);
    ran_free(&ran);
    return count;
}

static void presets_are_found_and_chosen_by_their_pictures(void **state) {
    (void)state;
    need_gl();
    own_folders();
    script_begin();
    say("wait rest\nclick Material/preset\nwait 5\nclick Presets/search\ntype denim\nwait 5\n");
    say_rested_picture("found.png");
    say("wait thumbnails\nwindow window.png\nclick Material/preset/woven-denim\nwait 5\n");
    say_rested_picture("chosen.png");
    say("key control+z\nwait 3\n");
    say_rested_picture("undone.png");
    Drive drive = drive_start(script, LIST(LARGE));
    json_t *now = drive_picture(&drive, "found.png");
    assert_int_equal(controls_in(now, "Material/preset/"), 6); /* with the headings of their groups */
    assert_true(is_shown(now, "Material/preset/denim") && is_shown(now, "Material/preset/irawan-denim"));
    json_decref(now);
    now = drive_picture(&drive, "chosen.png");
    assert_string_equal(word_of(material_of(now, 0), "preset"), "woven-denim");
    json_decref(now);
    drive_finish(&drive);
    assert_true(pictures_most("found.png", "chosen.png") > 0.05);
    assert_true(pictures_most("found.png", "undone.png") < 0.5 / 255.0);
    const int kept = pictures_kept();
    assert_true(kept >= 3 && kept < 10);

    /* From then on they are read from the cache; damaged ones are made again. */
    for (int damaged = 0; damaged < 2; damaged++) {
        Ran ran = run_shell(damaged ? "for k in cache/weft/*.png; do echo x >$k; touch -d 2001-01-01 $k; done"
                                    : "touch -d 2001-01-01 cache/weft/*.png");
        ran_free(&ran);
        const int before = pictures_kept();
        script_begin();
        say("wait rest\nclick Material/preset\nwait 2\nclick Presets/search\ntype denim\nwait thumbnails\n");
        drive_through(script, LIST(LARGE));
        ran = run_shell("find cache/weft -name '*.png' -newermt 2002-01-01 -size +5k | wc -l");
        if (damaged)
            assert_true(atoi(ran.out) >= 3);
        else
            assert_int_equal(atoi(ran.out), pictures_kept() - before);
        ran_free(&ran);
    }
}

static void materials_of_ones_own_are_kept_beside_files_that_are_none(void **state) {
    (void)state;
    need_gl();
    own_folders();
    Ran ran =
        run_shell("mkdir -p data/weft/materials && cd data/weft/materials && echo '{\"roughness\": ' >torn.json && "
                  "mkfifo pipe.json && mkdir folder.json && head -c 3000000 /dev/zero >large.json");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    script_begin();
    say("wait rest\nset Material/roughness 0.31\nwait rest\nclick Material/preset\nwait 5\nclick Presets/name\n"
        "type my/cloth\nkey enter\nwait message is no name\nclick Presets/name\nkey control+a\ntype mine\nwait 3\n"
        "click \"Presets/Save as preset\"\nwait message wrote\nwait seconds 1\nset Material/roughness 0.5\nclick "
        "Presets/name\n"
        "key control+a\ntype mine\nkey enter\nwait message is there: press Replace\nclick Presets/search\ntype "
        "own\nwait 5\n"
        "wait thumbnails\nwait 3\nwindow own.png\nset Material/roughness 0.9\nwait rest\n"
        "click Material/preset/own/torn\nwait message torn.json\nwait 5\n");
    say_rested_picture("torn.png");
    say("click Material/preset/own/mine\nwait 5\n");
    say_rested_picture("mine.png");
    Drive drive = drive_start(script, LIST(LARGE));
    json_t *now = drive_picture(&drive, "torn.png");
    assert_true(controls_in(now, "Material/preset/own/") >= 3 && is_shown(now, "Material/preset/own/torn"));
    assert_float_equal(input_of(now, 0, "roughness", 0), 0.9, 1e-6);
    json_decref(now);
    now = drive_picture(&drive, "mine.png");
    assert_float_equal(input_of(now, 0, "roughness", 0), 0.31, 1e-6);
    json_decref(now);
    drive_finish(&drive);
    ran = run_shell("grep -q roughness data/weft/materials/mine.json && rm -r data cache");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(presets_are_found_and_chosen_by_their_pictures),
                                       cmocka_unit_test(materials_of_ones_own_are_kept_beside_files_that_are_none)};
    return cmocka_run_group_tests(tests, drive_begin, drive_end);
}
