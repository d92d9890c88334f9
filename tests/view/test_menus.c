/* Every menu of the material's model, through all of its values.
 *
 * Labels: slow unsanitized */
#include "drive.h"

/* "sheen lobe" of "sheen_lobe". */
static void label_of(const char *name, char label[64]) {
    snprintf(label, 64, "%s", name);
    for (char *p = label; *p; p++)
        if (*p == '_') *p = ' ';
}

/* Whether a file holds a text. */
static bool file_has(const char *path, const char *text) {
    size_t size;
    char *bytes = file_bytes(path, &size);
    bool has = bytes && strstr(bytes, text);
    free(bytes);
    return has;
}

/* Whether a value is one for that choice: others change nothing. */
static bool fits(WeftMaterial material, int choice, int value) {
    weft_material_choose(&material, choice, value);
    return material.choices[choice] == value;
}

static WeftMaterial cloth_material(void) {
    WeftScene *scene;
    WeftMaterial material;
    WeftError error;
    if (weft_scene_load("builtin:cloth", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_scene_material(scene, 0, &material, &error), WEFT_OK);
    weft_scene_free(scene);
    return material;
}

/* What each choice came to is told by the command line; what it looks like is waited for once a menu. */
static void every_menu_goes_through_all_its_values(void **state) {
    (void)state;
    need_gl();
    const WeftMaterial material = cloth_material();
    script_begin();
    say("wait rest\nclick \"Material/Models\"\n");
    for (int k = 0; weft_material_choice_name(k); k++) {
        const char *name = weft_material_choice_name(k);
        char label[64];
        label_of(name, label);
        for (int j = 0; weft_material_choice_value(k, j); j++) {
            if (!fits(material, k, j)) continue;
            say("choose \"Material/%s\" %s\n", label, weft_material_choice_value(k, j));
            say("wait 6\ncommand %s.%d\n", name, j);
        }
        say("choose \"Material/%s\" auto\nwait rest\n", label);
    }
    say_picture("end.png");
    say("wait rest\n");
    Drive drive = drive_start(
        script, LIST("view", "--windowless", "--forget", "--json", "--width", "320", "--height", "360", CHEAP));
    json_t *last = NULL;
    for (bool ended = false; !ended || last;) {
        json_decref(last);
        ended = drive_ended(&drive);
        last = drive_next(&drive);
        const char *message = word_of(last, "message");
        if (message[0] && strncmp(message, "builtin:cloth: ", 15) != 0 && !strstr(message, "wrote end.png"))
            drive_give_up(&drive, message);
        if (!last && !ended) sleep_seconds(0.02);
    }
    drive_finish(&drive);
    for (int k = 0; weft_material_choice_name(k); k++)
        for (int j = 0; weft_material_choice_value(k, j); j++) {
            char path[64], set[96];
            if (!fits(material, k, j)) continue;
            snprintf(path, sizeof path, "%s.%d", weft_material_choice_name(k), j);
            snprintf(set, sizeof set, " 0.%s=%s ", weft_material_choice_name(k), weft_material_choice_value(k, j));
            if (!file_has(path, set)) fail_msg("%s:%s", path, set);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_menu_goes_through_all_its_values)};
    return cmocka_run_group_tests(tests, drive_begin, drive_end);
}
