/* A real window, real events: on a display of its own, without a person. Skips where it cannot be had. */
#include "display.h"

/* ---- the hand ---- */

static void layout(const char *name) {
    char line[64];
    snprintf(line, sizeof line, "setxkbmap %s", name);
    if (system(line) != 0) fail_msg("%s", line);
    sleep_seconds(0.2);
}

static void numbers_of(const json_t *array, double *out, int count) {
    for (int k = 0; k < count; k++) out[k] = json_number_value(json_array_get(array, (size_t)k));
}

/* The middle of a control, or a share of its width. */
static void place_of(const json_t *state, const char *control, double across, int at[2]) {
    double box[4];
    const json_t *found = json_object_get(json_object_get(state, "controls"), control);
    if (!found) fail_msg("there is no %s", control);
    numbers_of(found, box, 4);
    at[0] = (int)(box[0] + across * box[2]);
    at[1] = (int)(box[1] + 0.5 * box[3]);
}

static void stage_place(const json_t *state, double x, double y, int at[2]) {
    double box[4];
    numbers_of(json_object_get(state, "stage"), box, 4);
    at[0] = (int)(box[0] + x * box[2]);
    at[1] = (int)(box[1] + y * box[3]);
}

/* The next state at rest of which `holds` is true; the one before is let go. */
static void wait_where(Drive *drive, json_t **now, bool (*holds)(const json_t *now, const json_t *before),
                       const char *what) {
    double start = clock_now();
    for (json_t *state; clock_now() - start < 60.0;) {
        bool ended = drive_ended(drive);
        state = drive_next(drive);
        if (state && is_true(state, "rest") && holds(state, *now)) {
            json_decref(*now);
            *now = state;
            return;
        }
        json_decref(state);
        if (!state && ended) break;
        if (!state) sleep_seconds(0.02);
    }
    drive_give_up(drive, what);
}
#define rest_where(drive, now, holds) wait_where(drive, now, holds, "never at rest and " #holds)

static bool other_camera(const json_t *now, const json_t *before) {
    return strcmp(word_of(now, "camera"), word_of(before, "camera")) != 0;
}
static bool in_live(const json_t *now, const json_t *before) { return strcmp(word_of(now, "mode"), "live") == 0; }
static bool has_list(const json_t *now, const json_t *before) {
    return json_object_get(json_object_get(now, "controls"), "Material/sheen lobe/charlie-neubelt") != NULL;
}
static bool is_charlie(const json_t *now, const json_t *before) {
    return strcmp(word_of(material_of(now, 0), "sheen_lobe"), "charlie-neubelt") == 0;
}
static bool shows_slider(const json_t *now, const json_t *before) {
    return json_object_get(json_object_get(now, "controls"), "View/exposure") != NULL;
}
static bool shows_path(const json_t *now, const json_t *before) {
    return json_object_get(json_object_get(now, "controls"), "Save the scene/file") != NULL;
}
static bool other_command(const json_t *now, const json_t *before) {
    return strcmp(word_of(now, "command"), word_of(before, "command")) != 0;
}
static bool helps(const json_t *now, const json_t *before) { return is_true(now, "help"); }
static bool helps_not(const json_t *now, const json_t *before) { return !is_true(now, "help"); }
static bool other_stage(const json_t *now, const json_t *before) {
    return !json_equal(json_object_get(now, "stage"), json_object_get(before, "stage"));
}

/* How far the eye went along where it looked at first: 1 is straight ahead. */
static double ahead(const char *camera, const json_t *before, const json_t *now) {
    double a[3], b[3], eye[3], target[3], moved = 0.0, look = 0.0, dot = 0.0;
    numbers_of(json_object_get(before, "eye"), a, 3);
    numbers_of(json_object_get(now, "eye"), b, 3);
    assert_int_equal(
        sscanf(camera, "%lf,%lf,%lf;%lf,%lf,%lf", &eye[0], &eye[1], &eye[2], &target[0], &target[1], &target[2]), 6);
    for (int k = 0; k < 3; k++) {
        moved += (b[k] - a[k]) * (b[k] - a[k]);
        look += (target[k] - eye[k]) * (target[k] - eye[k]);
        dot += (b[k] - a[k]) * (target[k] - eye[k]);
    }
    assert_true(moved > 0.0 && look > 0.0);
    return dot / sqrt(moved * look);
}

static void drag(const json_t *now, double x, double y, double to_x, double to_y) {
    int a[2], b[2];
    stage_place(now, x, y, a);
    stage_place(now, to_x, to_y, b);
    hand("mousemove %d %d sleep 0.1 mousedown 1 sleep 0.1 mousemove %d %d sleep 0.1 mousemove %d %d sleep 0.1 "
         "mouseup 1",
         a[0], a[1], (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, b[0], b[1]);
}

/* Flies with a key of the keyboard as it is now. */
static void fly(Drive *drive, json_t **now, const char *key) {
    json_t *before = json_incref(*now);
    hand("keydown %s sleep 0.4 keyup %s", key, key);
    rest_where(drive, now, other_camera);
    double straight = ahead(word_of(before, "camera"), before, *now);
    if (!(straight > 0.999)) fail_msg("%s: %g", key, straight);
    json_decref(before);
}

static void window_driven_by_real_mouse_and_keys_does_as_told(void **state) {
    (void)state;
    if (no_display) skip();
    need_gl();
    int at[2];
    layout("us");
    Drive drive = drive_start("wait rest\nwindow window.png\nstay\n",
                              LIST("view", "--forget", "--json", "--width", "800", "--height", "700", CHEAP));
    json_t *now = drive_rest(&drive);
    assert_string_equal(word_of(now, "camera"), "0");
    stage_place(now, 0.5, 0.5, at);
    hand("mousemove %d %d sleep 0.2", at[0], at[1]);

    drag(now, 0.5, 0.5, 0.62, 0.44);
    rest_where(&drive, &now, other_camera);
    hand("click 4");
    rest_where(&drive, &now, other_camera);
    fly(&drive, &now, "w");
    layout("fr");
    fly(&drive, &now, "z"); /* the same place on the keyboard */
    layout("us");

    hand("key Tab");
    json_decref(drive_until(&drive, "mode", "truth"));
    hand("key Tab");
    rest_where(&drive, &now, in_live);

    place_of(now, "Material/sheen lobe", 0.5, at);
    hand("mousemove %d %d sleep 0.2 click 1", at[0], at[1]);
    rest_where(&drive, &now, has_list);
    place_of(now, "Material/sheen lobe/charlie-neubelt", 0.3, at);
    hand("mousemove %d %d sleep 0.2 click 1", at[0], at[1]);
    rest_where(&drive, &now, is_charlie);

    place_of(now, "Panel/View", 0.5, at);
    hand("mousemove %d %d sleep 0.2 click 1", at[0], at[1]);
    rest_where(&drive, &now, shows_slider);
    place_of(now, "View/exposure", 0.5, at);
    hand("mousemove %d %d sleep 0.1 mousedown 1 sleep 0.1 mousemove %d %d sleep 0.1 mouseup 1", at[0], at[1],
         at[0] + 25, at[1]);
    rest_where(&drive, &now, other_command);
    assert_non_null(strstr(word_of(now, "command"), " --exposure "));

    hand("key ctrl+s");
    rest_where(&drive, &now, shows_path);
    place_of(now, "Save the scene/file", 0.5, at);
    hand("mousemove %d %d sleep 0.2 click 1 sleep 0.2", at[0], at[1]);
    hand("key --delay 1 ctrl+a type --delay 30 mine.glb"); /* quicker than a frame: else it is appended */
    hand("sleep 0.3 key Return");
    json_decref(drive_until(&drive, "message", "wrote mine.glb"));
    assert_int_equal(access("mine.glb", F_OK), 0);

    stage_place(now, 0.5, 0.5, at);
    hand("mousemove %d %d type '?'", at[0], at[1]);
    rest_where(&drive, &now, helps);
    hand("key F1");
    rest_where(&drive, &now, helps_not);

    hand("search --name '^weft - ' windowsize 700 500");
    rest_where(&drive, &now, other_stage);
    hand("key ctrl+q");
    drive_finish(&drive);
    json_decref(now);

    /* what it looked like stays beside the tests */
    WeftImage window = picture_read("window.png");
    assert_true(window.width == 800 && window.height == 700);
    const unsigned char *p = window.pixels;
    bool seen[256] = {false};
    int levels = 0;
    for (int k = 0; k < window.width * window.height * window.channels; k++) {
        levels += !seen[p[k]];
        seen[p[k]] = true;
    }
    assert_true(levels > 50);
    weft_image_write(WEFT_BINARY_DIR "/view-window.png", &window, NULL);
    weft_image_free(&window);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(window_driven_by_real_mouse_and_keys_does_as_told)};
    return cmocka_run_group_tests(tests, display_begin, display_end);
}
