/* The parts of the window that need none: the camera, history, the file watch, strokes, names of files, and how
 * a command line is quoted. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "scratch.h"
#include "view/files/paths.h"
#include "view/panels/render_command.h"
#include "view/state/brush.h"
#include "view/state/states.h"
#include "view/ui/help.h"

static char folder[SCRATCH_SIZE];

static int begin(void **state) {
    (void)state;
    return scratch_enter(folder) ? 0 : -1;
}

static int end(void **state) {
    (void)state;
    unlink("file");
    return scratch_remove_empty(folder) ? 0 : -1;
}

static void assert_near(float a, float b, float within) {
    if (!(fabsf(a - b) <= within)) fail_msg("%.9g is not %.9g", (double)a, (double)b);
}

static void assert_near3(const float a[3], const float b[3], float within) {
    for (int k = 0; k < 3; k++) assert_near(a[k], b[k], within);
}

/* ---- the camera ---- */

static const Orbit cameras[] = {{.eye = {0.4f, 1.0f, 1.9f}, .target = {0.0f, 0.5f, 0.0f}, .fov = 30.0f},
                                {.eye = {-3.0f, 0.1f, -2.0f}, .target = {1.0f, 2.0f, 0.3f}, .fov = 75.0f},
                                {.eye = {0.0f, 9.0f, 0.001f}, .target = {0.0f, 0.0f, 0.0f}, .fov = 12.0f}};
enum { CAMERAS = sizeof cameras / sizeof *cameras };

static float length(const float a[3], const float b[3]) {
    return sqrtf((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

static void projected_point_lies_on_its_ray(void **state) {
    (void)state;
    for (int c = 0; c < CAMERAS; c++)
        for (int k = 0; k < 60; k++) {
            float aspect = k % 3 == 0 ? 0.5f : 1.7f, x = (float)(k % 7) / 6.0f, y = (float)(k % 11) / 10.0f;
            float ray[3], point[3], at[2], behind[3];
            orbit_ray(&cameras[c], aspect, x, y, ray);
            assert_near(ray[0] * ray[0] + ray[1] * ray[1] + ray[2] * ray[2], 1.0f, 1e-5f);
            for (int j = 0; j < 3; j++) {
                point[j] = cameras[c].eye[j] + (0.5f + (float)k) * ray[j];
                behind[j] = cameras[c].eye[j] - 2.0f * ray[j];
            }
            assert_true(orbit_project(&cameras[c], point, aspect, at));
            assert_near(at[0], x, 2e-4f);
            assert_near(at[1], y, 2e-4f);
            assert_false(orbit_project(&cameras[c], behind, aspect, at));
        }
}

static void camera_turns_about_its_target(void **state) {
    (void)state;
    for (int c = 0; c < CAMERAS; c++) {
        Orbit o = cameras[c];
        float far = length(o.eye, o.target);
        for (int k = 0; k < 200; k++) {
            orbit_rotate(&o, 0.37f, k % 50 < 25 ? 0.4f : -0.4f); /* into both poles */
            assert_near3(o.target, cameras[c].target, 0.0f);
            assert_near(length(o.eye, o.target), far, 1e-3f * far);
            float flat = hypotf(o.eye[0] - o.target[0], o.eye[2] - o.target[2]);
            assert_true(flat > 0.01f * far);
        }
    }
    Orbit o = cameras[0];
    snprintf(o.name, sizeof o.name, "0");
    orbit_rotate(&o, 0.5f, 0.2f);
    assert_string_equal(o.name, ""); /* it is no camera of the scene any more */
    orbit_rotate(&o, -0.5f, -0.2f);
    assert_near3(o.eye, cameras[0].eye, 1e-5f);
}

static void camera_looks_pans_flies_and_zooms(void **state) {
    (void)state;
    for (int c = 0; c < CAMERAS; c++) {
        Orbit o = cameras[c];
        float far = length(o.eye, o.target), at[2], right[3], up[3], forward[3], moved[3];
        orbit_look(&o, 0.1f, -0.05f);
        assert_near3(o.eye, cameras[c].eye, 0.0f);
        assert_near(length(o.eye, o.target), far, 1e-3f * far);

        o = cameras[c]; /* what was under the mouse stays there */
        orbit_pan(&o, 0.25f, -0.1f);
        assert_true(orbit_project(&o, cameras[c].target, 1.0f, at));
        assert_near(at[0], 0.75f, 1e-4f);
        assert_near(at[1], 0.4f, 1e-4f);

        o = cameras[c];
        orbit_dolly(&o, 0.5f);
        assert_near3(o.target, cameras[c].target, 0.0f);
        assert_near(length(o.eye, o.target), 0.5f * far, 1e-4f * far);
        for (int k = 0; k < 100; k++) orbit_dolly(&o, 0.1f);
        assert_true(length(o.eye, o.target) > 0.0f && isfinite(o.eye[0]));
        for (int k = 0; k < 100; k++) orbit_dolly(&o, 10.0f);
        assert_true(length(o.eye, o.target) < 2e5f);

        o = cameras[c];
        orbit_axes(&o, right, up, forward);
        orbit_fly(&o, 2.0f, -1.0f, 0.5f);
        for (int k = 0; k < 3; k++) moved[k] = cameras[c].eye[k] + 2.0f * forward[k] - right[k];
        moved[1] += 0.5f;
        assert_near3(o.eye, moved, 1e-4f);
        assert_near(length(o.eye, o.target), far, 1e-3f * far);
        for (int k = 0; k < 50; k++) orbit_fly(&o, 1e5f, NAN, INFINITY);
        for (int k = 0; k < 3; k++) assert_true(fabsf(o.eye[k]) <= 1e6f);
    }
}

static void framed_box_is_wholly_visible(void **state) {
    (void)state;
    static const float boxes[][2][3] = {{{-1.0f, -1.0f, -1.0f}, {1.0f, 1.0f, 1.0f}},
                                        {{5.0f, 0.0f, -2.0f}, {5.1f, 4.0f, 30.0f}},
                                        {{0.0f, 0.0f, 0.0f}, {1e-3f, 2e-3f, 0.0f}}};
    static const float aspects[] = {0.3f, 1.0f, 2.4f};
    for (int k = 0; k < CAMERAS * 9; k++) {
        Orbit o = cameras[k % CAMERAS];
        const float(*box)[3] = boxes[k / CAMERAS % 3];
        float aspect = aspects[k / CAMERAS / 3], least = 1.0f, most = 0.0f;
        orbit_frame(&o, box[0], box[1], aspect);
        for (int corner = 0; corner < 8; corner++) {
            float p[3], at[2];
            for (int j = 0; j < 3; j++) p[j] = box[corner >> j & 1][j];
            assert_true(orbit_project(&o, p, aspect, at));
            for (int j = 0; j < 2; j++) {
                assert_in_range((int)(1000.0f * at[j]), 0, 1000);
                least = fminf(least, at[j]), most = fmaxf(most, at[j]);
            }
        }
        assert_true(most - least > 0.1f); /* and not from far away */
    }
}

static void a_camera_is_read_as_it_is_written(void **state) {
    (void)state;
    WeftScene *scene;
    WeftError error;
    char text[ORBIT_TEXT];
    if (weft_scene_load("builtin:cloth", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    for (int c = 0; c < CAMERAS; c++) {
        Orbit again;
        assert_true(orbit_at(&again, scene, orbit_text(&cameras[c], text), 1.5f));
        assert_near3(again.eye, cameras[c].eye, 1e-5f);
        float right[3], up[3], forward[3], ahead[3];
        orbit_axes(&cameras[c], right, up, forward);
        orbit_axes(&again, right, up, ahead);
        assert_near3(ahead, forward, 1e-4f);
        assert_near(again.fov, cameras[c].fov, 1e-4f);
        assert_string_equal(again.name, "");
    }
    Orbit first, none;
    assert_true(orbit_at(&first, scene, "0", 1.5f));
    assert_string_equal(orbit_text(&first, text), "0");
    assert_false(orbit_at(&none, scene, "nobody", 1.5f));
    weft_scene_free(scene);
}

/* ---- looks to go back to ---- */

/* A state with one light that is as bright as a number. */
static SceneState state_of(int number) {
    SceneState state = {.light_count = 1, .environment = environment_state_studio()};
    state.lights[0].color[0] = (float)number;
    return state;
}

static int number_of(const SceneState *state) { return (int)state->lights[0].color[0]; }

static void change(History *history, SceneState *state, int number) {
    history_keep(history, state);
    state->lights[0].color[0] = (float)number;
}

static void steps_of_the_history_are_undone_and_redone(void **state) {
    (void)state;
    History *history = calloc(1, sizeof *history);
    SceneState scene = state_of(0);
    assert_non_null(history);
    assert_false(history_undo(history, &scene));
    assert_false(history_redo(history, &scene));
    for (int k = 1; k <= 3; k++) {
        change(history, &scene, 10 * k);
        change(history, &scene, 10 * k + 1); /* the same drag: one step */
        history_close(history);
    }
    static const int back[] = {21, 11, 0}, forth[] = {11, 21, 31};
    for (int pass = 0; pass < 2; pass++) {
        for (int k = 0; k < 3; k++) {
            assert_true(history_undo(history, &scene));
            assert_int_equal(number_of(&scene), back[k]);
        }
        assert_false(history_undo(history, &scene));
        for (int k = 0; k < 3; k++) {
            assert_true(history_redo(history, &scene));
            assert_int_equal(number_of(&scene), forth[k]);
        }
        assert_false(history_redo(history, &scene));
    }
    assert_true(history_undo(history, &scene));
    change(history, &scene, 99); /* what was undone is gone */
    history_close(history);
    assert_false(history_redo(history, &scene));
    assert_true(history_undo(history, &scene));
    assert_int_equal(number_of(&scene), 21);
    scene_state_free(&scene);
    history_free(history);
    free(history);
}

static void oldest_steps_of_the_history_are_dropped(void **state) {
    (void)state;
    History *history = calloc(1, sizeof *history);
    SceneState scene = state_of(0);
    int undone = 0;
    assert_non_null(history);
    for (int k = 1; k <= HISTORY_STEPS + 50; k++) {
        change(history, &scene, k);
        history_close(history);
    }
    while (history_undo(history, &scene)) assert_int_equal(number_of(&scene), HISTORY_STEPS + 49 - undone++);
    assert_int_equal(undone, HISTORY_STEPS);
    scene_state_free(&scene);
    history_free(history);
    free(history);
}

static void copied_states_share_materials_until_changed(void **state) {
    (void)state;
    WeftScene *scene;
    WeftError error;
    SceneState a, b;
    if (weft_scene_load("builtin:cloth", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_true(scene_state_read(&a, scene) && scene_state_copy(&b, &a));
    weft_scene_free(scene);
    assert_true(scene_state_same(&a, &b));
    WeftMaterial m = *scene_state_material(&a, 0);
    int roughness = weft_material_input_find("roughness");
    assert_true(roughness >= 0);
    assert_int_equal(weft_material_input_find("nonsense"), -1);
    m.inputs[roughness].value[0] = 0.123f;
    assert_true(scene_state_set_material(&b, 0, &m));
    assert_false(scene_state_same(&a, &b));
    assert_false(scene_state_same_material(&a, &b, 0));
    assert_true(scene_state_same_material(&a, &b, 1));
    assert_true(scene_state_set_material(&b, 0, scene_state_material(&a, 0)));
    assert_true(scene_state_same(&a, &b));
    WeftImage own, *image;
    assert_null(nap_copy(&b, 0, NULL, &image));
    assert_true(nap_own(NULL, scene_state_material(&b, 0), &own));
    BrushedNap *nap = nap_copy(&b, 0, &own, &image);
    assert_non_null(nap);
    assert_true(scene_state_set_nap(&b, nap));
    assert_false(scene_state_same(&a, &b));
    assert_ptr_equal(scene_state_nap(&b, 0), image);
    assert_null(scene_state_nap(&b, 1));
    for (int k = 1; k < STATE_NAPS; k++) assert_true(scene_state_set_nap(&b, nap_copy(&b, k, &own, &image)));
    assert_false(scene_state_set_nap(&b, nap_copy(&b, STATE_NAPS, &own, &image))); /* no more */
    weft_image_free(&own);
    scene_state_free(&a);
    scene_state_free(&b);
}

/* A preset is put on late; what was chosen meanwhile stays, and all else is the preset's. */
static void choice_made_while_a_preset_is_put_on_stays(void **state) {
    (void)state;
    WeftMaterial was, made;
    weft_material_default(&was);
    assert_int_equal(weft_material_read("preset:velvet", &made, NULL, NULL), WEFT_OK);
    WeftMaterial now = was;
    assert_int_equal(weft_material_set(&now, "profile", "khronos", NULL, NULL), WEFT_OK);
    assert_int_equal(weft_material_set(&now, "roughness", "0.31", NULL, NULL), WEFT_OK);
    WeftMaterial wanted = made;
    assert_int_equal(weft_material_set(&wanted, "profile", "khronos", NULL, NULL), WEFT_OK);
    assert_int_equal(weft_material_set(&wanted, "roughness", "0.31", NULL, NULL), WEFT_OK);
    WeftMaterial merged = material_merged(&was, &now, &made);
    assert_memory_not_equal(&made, &wanted, sizeof made);
    assert_memory_equal(&merged, &wanted, sizeof merged);
    merged = material_merged(&was, &was, &made);
    assert_memory_equal(&merged, &made, sizeof merged);
}

static void preset_is_copied_with_its_state(void **state) {
    (void)state;
    WeftScene *scene;
    WeftError error;
    SceneState a, b, read;
    if (weft_scene_load("builtin:cloth", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_true(scene_state_read(&a, scene) && scene_state_copy(&b, &a) && scene_state_read(&read, scene));
    weft_scene_free(scene);
    assert_true(scene_state_set_preset(&b, 0, 3));
    assert_int_equal(scene_state_preset(&a, 0), 0);
    assert_int_equal(scene_state_preset(&b, 0), 3);
    assert_true(scene_state_same(&a, &b));
    WeftMaterial m = *scene_state_material(&b, 0);
    m.inputs[weft_material_input_find("roughness")].value[0] = 0.123f;
    assert_true(scene_state_set_material(&b, 0, &m));
    assert_int_equal(scene_state_preset(&b, 0), 3);
    assert_true(scene_state_take_presets(&read, &b));
    assert_int_equal(scene_state_preset(&read, 0), 3);
    b.variant = 1;
    assert_true(scene_state_set_material(&b, 0, scene_state_material(&a, 0)));
    assert_false(scene_state_same(&a, &b));
    scene_state_free(&a);
    scene_state_free(&b);
    scene_state_free(&read);
}

static void folder_of_maps_replaces_the_one_before(void **state) {
    (void)state;
    Folders folders = {.count = 0};
    folders_keep(&folders, "a", -1);
    folders_keep(&folders, "b", 2);
    folders_keep(&folders, "c", -1);
    assert_int_equal(folders.count, 2);
    assert_string_equal(folders.paths[0], "c");
    for (int k = 0; k < 2 * STATE_FOLDERS; k++) folders_keep(&folders, "d", k);
    assert_int_equal(folders.count, STATE_FOLDERS);
}

/* A map that points along +v on its left half and leans on its right one alone. */
static int add_own_map(WeftScene *scene) {
    WeftImage image;
    assert_int_equal(weft_image_create(8, 4, 3, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
    unsigned char *p = image.pixels;
    for (int k = 0; k < 32; k++, p += 3)
        p[0] = k % 8 < 4 ? 128 : 255, p[1] = k % 8 < 4 ? 255 : 128, p[2] = k % 8 < 4 ? 0 : 255;
    int texture = weft_scene_add_texture(scene, &image, NULL);
    assert_true(texture > 0);
    return texture;
}

static void brushing_begins_with_the_map_of_the_material(void **state) {
    (void)state;
    WeftScene *scene;
    WeftError error;
    WeftMaterial m;
    WeftImage nap;
    if (weft_scene_load("builtin:cloth", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_scene_material(scene, 0, &m, NULL), WEFT_OK);
    WeftInput *way = &m.inputs[weft_material_input_find("nap_direction")],
              *lean = &m.inputs[weft_material_input_find("nap")];
    way->texture = lean->texture = add_own_map(scene);
    lean->channel = 2, lean->value[0] = 0.4f, way->value[0] = 1.5707963f; /* a quarter turn more */
    assert_true(nap_own(scene, &m, &nap));
    const unsigned char *left = nap.pixels, *right = left + 3 * (NAP_SIDE - 1);
    assert_in_range(left[0], 0, 1); /* +v and a quarter turn: -u */
    assert_in_range(left[1], 127, 129);
    assert_int_equal(left[2], 0);
    assert_in_range(right[1], 254, 255);
    assert_int_equal(right[2], 255);
    weft_image_free(&nap);
    for (int k = 0; k < 6; k++) way->transform[k] = 0.0f; /* all of it reads one texel */
    way->transform[2] = 0.9f, way->value[0] = 0.0f, lean->texture = 0;
    assert_true(nap_own(scene, &m, &nap));
    left = nap.pixels;
    assert_int_equal(left[0], 255);
    assert_int_equal(left[2], 255);
    weft_image_free(&nap);
    weft_scene_free(scene);
}

/* ---- requests ---- */

void *__real_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size);

static int until_failure; /* calls of calloc; 0: none fails */

void *__wrap_calloc(size_t count, size_t size) {
    return until_failure && --until_failure == 0 ? NULL : __real_calloc(count, size);
}

static void frame_request_is_copied_whole_or_not_at_all(void **state) {
    (void)state;
    WeftScene *scene;
    WeftError error;
    FrameRequest request = {.split = SPLIT_LINE, .at = 0.25f}, copy = {.at = 0.75f};
    if (weft_scene_load("builtin:cloth", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_true(scene_state_read(&request.state, scene) && scene_state_copy(&request.other, &request.state));
    weft_scene_free(scene);
    for (int k = 1; k <= 2; k++) {
        until_failure = k;
        assert_false(frame_request_copy(&copy, &request));
        assert_null(copy.state.materials);
        assert_null(copy.other.materials);
        assert_near(copy.at, 0.75f, 0.0f);
    }
    assert_true(frame_request_copy(&copy, &request));
    assert_true(scene_state_same(&copy.state, &request.state) && scene_state_same(&copy.other, &request.other));
    frame_request_free(&copy);
    frame_request_free(&request);
}

/* ---- events ---- */

/* Ctrl was held before, and is let go of within the frame in which A went down: both are seen. */
static void a_key_keeps_its_modifiers_in_a_slow_frame(void **state) {
    (void)state;
    char why[256];
    const WindowDesc desc = {.title = "", .width = 320, .height = 240, .unseen = true};
    enum { CONTROL = 341 };
    Window *window = window_open(&desc, why);
    if (!window) {
        print_message("%s\n", why);
        skip();
    }
    UiInput *input = calloc(1, sizeof *input);
    assert_non_null(input);
    const Event events[] = {{.kind = EVENT_KEY, .code = CONTROL, .down = true},
                            {.kind = EVENT_KEY, .code = 'A', .letter = 'a', .down = true, .control = true},
                            {.kind = EVENT_KEY, .code = CONTROL, .control = true},
                            {.kind = EVENT_KEY, .code = 'A', .letter = 'a'}};
    window_push(window, &events[0]);
    assert_true(window_take(window, input));
    for (int k = 1; k < 4; k++) window_push(window, &events[k]);
    assert_true(window_take(window, input));
    assert_true(input->key['A'] && input->control);
    assert_true(window_take(window, input));
    assert_false(input->control);
    while (window_take(window, input)) continue;
    assert_false(input->key['A'] || input->control);
    free(input);
    window_close(window);
}

/* ---- files of others ---- */

static void write_file(const char *text) {
    FILE *stream = fopen("file", "wb");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0);
    assert_int_equal(fclose(stream), 0);
}

/* A file that is watched by itself is not told of twice. */
static void file_added_to_a_watched_folder_is_noticed(void **state) {
    (void)state;
    FileWatch *man = file_watch_start();
    assert_non_null(man);
    write_file("one");
    assert_int_equal(mkdir("maps", 0700), 0);
    assert_int_equal(rename("file", "maps/a"), 0);
    file_watch_add(man, "maps/a", 7);
    file_watch_add(man, "maps", 8);
    assert_int_equal(file_watch_poll(man, 100.0), -1);
    write_file("two");
    assert_int_equal(rename("file", "maps/b"), 0);
    assert_int_equal(file_watch_poll(man, 101.0), -1);
    write_file("two, and written on");
    assert_int_equal(rename("file", "maps/b"), 0);
    assert_int_equal(file_watch_poll(man, 102.0), -1); /* it does not stand still */
    assert_int_equal(file_watch_poll(man, 103.0), 8);
    assert_int_equal(file_watch_poll(man, 104.0), -1);
    write_file("one and a half");
    assert_int_equal(rename("file", "maps/a"), 0);
    assert_int_equal(file_watch_poll(man, 105.0), -1);
    assert_int_equal(file_watch_poll(man, 106.0), 7);
    assert_int_equal(file_watch_poll(man, 107.0), -1);
    file_watch_stop(man);
    assert_int_equal(unlink("maps/a") + unlink("maps/b") + rmdir("maps"), 0);
}

static void half_written_file_is_read_when_complete(void **state) {
    (void)state;
    FileWatch *man = file_watch_start();
    assert_non_null(man);
    write_file("one");
    file_watch_add(man, "file", 7);
    file_watch_add(man, "absent", 8);
    assert_int_equal(file_watch_poll(man, 100.0), -1);
    write_file("one and a half");
    assert_int_equal(file_watch_poll(man, 100.1), -1); /* not so often */
    assert_int_equal(file_watch_poll(man, 101.0), -1); /* it has just changed */
    write_file("one and a half, and more");
    assert_int_equal(file_watch_poll(man, 102.0), -1); /* and again */
    assert_int_equal(file_watch_poll(man, 102.26), -1);
    assert_int_equal(file_watch_poll(man, 103.0), 7);  /* it stands still */
    assert_int_equal(file_watch_poll(man, 104.0), -1); /* told once */
    assert_int_equal(unlink("file"), 0);
    assert_int_equal(file_watch_poll(man, 105.0), -1);
    assert_int_equal(file_watch_poll(man, 106.0), -1); /* gone is no change */
    write_file("and back");
    assert_int_equal(file_watch_poll(man, 107.0), -1);
    assert_int_equal(file_watch_poll(man, 108.0), 7);
    file_watch_clear(man);
    write_file("nobody looks");
    assert_int_equal(file_watch_poll(man, 109.0), -1);
    assert_int_equal(file_watch_poll(man, 110.0), -1);
    file_watch_stop(man);
}

static void kind_of_a_file_follows_from_its_name(void **state) {
    (void)state;
    static const struct {
        const char *path;
        PathKind kind;
    } files[] = {{"a.glb", PATH_SCENE},      {"a b/c.GLTF", PATH_SCENE}, {"builtin:cloth", PATH_SCENE},
                 {"x.hdr", PATH_LIGHT},      {"x.EXR", PATH_LIGHT},      {"m.json", PATH_MATERIAL},
                 {"p.png", PATH_PICTURE},    {"p.jpeg", PATH_PICTURE},   {"p.tga", PATH_PICTURE},
                 {"/tmp", PATH_FOLDER},      {"a.glb/x", PATH_UNKNOWN},  {"glb", PATH_UNKNOWN},
                 {"", PATH_UNKNOWN},         {"a.", PATH_UNKNOWN},       {"preset:velvet", PATH_MATERIAL},
                 {"a.glb.txt", PATH_UNKNOWN}};
    for (size_t k = 0; k < sizeof files / sizeof *files; k++)
        if (path_kind(files[k].path) != files[k].kind) fail_msg("\"%s\"", files[k].path);
    assert_string_equal(path_name("/a/b.c"), "b.c");
    assert_string_equal(path_name("b.c"), "b.c");
    assert_true(path_contains("/x/Velvet_NORMAL.png", "normal"));
    assert_false(path_contains("/normal/velvet.png", "normal"));
    static const char *const stems[][2] = {{"/a/chair.v2.glb", "chair.v2"},
                                           {"builtin:cloth", "cloth"},
                                           {"a\nb.glb", "a-b"},
                                           {".hidden", ".hidden"},
                                           {"builtin:../../x", "..-..-x"}};
    for (size_t k = 0; k < sizeof stems / sizeof *stems; k++) {
        char stem[64], tight[4];
        path_stem(stems[k][0], stem, sizeof stem);
        if (k < 4) assert_string_equal(stem, stems[k][1]);
        assert_null(strchr(stem, '/'));
        path_stem(stems[k][0], tight, sizeof tight);
        assert_true(strlen(tight) < sizeof tight);
    }
    assert_true(path_stamp("/nowhere") == 0);
    write_file("1");
    unsigned long long stamp = path_stamp("file");
    assert_true(stamp != 0 && stamp == path_stamp("file"));
    write_file("12");
    assert_true(stamp != path_stamp("file"));
}

/* ---- the nap ---- */

enum { SIDE = 64 };

static WeftImage plain_nap(void) {
    WeftImage image;
    assert_int_equal(weft_image_create(SIDE, SIDE, 3, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
    unsigned char *p = image.pixels;
    for (int k = 0; k < SIDE * SIDE; k++, p += 3) p[0] = 255, p[1] = p[2] = 128;
    return image;
}

static const unsigned char *texel(const WeftImage *image, int x, int y) {
    return (const unsigned char *)image->pixels + 3 * ((y & (SIDE - 1)) * SIDE + (x & (SIDE - 1)));
}

static float pointing(const WeftImage *image, int x, int y, int axis) {
    return (float)texel(image, x, y)[axis] / 127.5f - 1.0f;
}

static void brush_strokes_turn_the_nap_beneath(void **state) {
    (void)state;
    const float places[][2] = {{0.5f, 0.5f}, {0.0f, 0.0f}, {0.99f, 0.01f}, {-3.25f, 7.75f}};
    const float across[2] = {0.0f, 3.0f};
    for (int k = 0; k < 4; k++) {
        WeftImage image = plain_nap();
        int x = (int)floorf(places[k][0] * SIDE), y = (int)floorf(places[k][1] * SIDE), turned = 0;
        for (int pass = 0; pass < 20; pass++) brush_stroke(&image, places[k], 0.125f, across, 0.7f);
        assert_near(pointing(&image, x, y, 0), 0.0f, 0.05f);
        assert_near(pointing(&image, x, y, 1), 1.0f, 0.02f);
        for (int j = 0; j < SIDE; j++)
            for (int i = 0; i < SIDE; i++) {
                float a = pointing(&image, i, j, 0), b = pointing(&image, i, j, 1);
                assert_near(a * a + b * b, 1.0f, 0.03f);
                turned += b > 0.5f;
            }
        assert_in_range(turned, 60, 204);                        /* a disc of 8 texels has 201 */
        assert_near(pointing(&image, x + 10, y, 0), 1.0f, 0.0f); /* beyond it nothing */
        assert_near(pointing(&image, x + 32, y + 32, 0), 1.0f, 0.0f);
        weft_image_free(&image);
    }
    WeftImage image = plain_nap();
    const float back[2] = {-1.0f, 0.0f}, middle[2] = {0.5f, 0.5f};
    for (int pass = 0; pass < 20; pass++) brush_stroke(&image, middle, 0.125f, back, 0.5f);
    assert_near(pointing(&image, SIDE / 2, SIDE / 2, 0), -1.0f, 0.02f); /* opposite to what it was */
    weft_image_free(&image);
}

static void brush_strokes_without_sense_change_nothing(void **state) {
    (void)state;
    WeftImage image = plain_nap(), plain = plain_nap();
    const float middle[2] = {0.5f, 0.5f}, up[2] = {0.0f, 1.0f}, none[2] = {0.0f, 0.0f};
    const float nowhere[2] = {NAN, 0.5f}, away[2] = {0.5f, INFINITY}, wild[2] = {NAN, NAN};
    brush_stroke(&image, middle, 0.125f, none, 1.0f);
    brush_stroke(&image, middle, 0.0f, up, 1.0f);
    brush_stroke(&image, middle, NAN, up, 1.0f);
    brush_stroke(&image, nowhere, 0.1f, up, 1.0f);
    brush_stroke(&image, away, 0.1f, up, 1.0f);
    brush_stroke(&image, middle, 0.1f, wild, 1.0f);
    assert_memory_equal(image.pixels, plain.pixels, 3 * SIDE * SIDE);
    brush_stroke(&image, middle, 1e9f, up, 1.0f); /* no more than once around */
    weft_image_free(&image);
    weft_image_free(&plain);
}

/* ---- what is remembered ---- */

/* Nobody writes into the pipes: whoever opens one waits. */
static void settings_file_that_is_a_pipe_is_ignored(void **state) {
    (void)state;
    Settings settings = settings_default();
    char config[256];
    assert_true(snprintf(config, sizeof config, "%s/config", folder) > 0);
    assert_int_equal(mkdir("config", 0700) | mkdir("config/weft", 0700), 0);
    assert_int_equal(mkfifo("config/weft/view.json", 0600) | mkfifo("config/weft/view.json.part", 0600), 0);
    setenv("XDG_CONFIG_HOME", config, 1);
    alarm(20);
    settings_read(&settings);
    assert_int_equal(settings.width, 1280);
    settings.width = 1000;
    assert_true(settings_write(&settings));
    settings.width = 1280;
    settings_read(&settings);
    alarm(0);
    assert_int_equal(settings.width, 1000);
    assert_int_equal(access("config/weft/view.json.part", F_OK), -1);
    unsetenv("XDG_CONFIG_HOME");
    unlink("config/weft/view.json");
    assert_int_equal(rmdir("config/weft") | rmdir("config"), 0);
}

/* Tips wrap paragraphs by themselves: a line that goes on with a small letter was wrapped before. */
static void tips_of_models_have_whole_paragraphs(void **state) {
    (void)state;
    int told = 0;
    for (int choice = 0; weft_material_choice_name(choice); choice++)
        for (int value = 0; weft_material_choice_value(choice, value); value++) {
            const char *text = help_choice(choice, value);
            told += strchr(text, ' ') != NULL;
            for (const char *line = strchr(text, '\n'); line; line = strchr(line + 1, '\n'))
                if (line[1] >= 'a' && line[1] <= 'z')
                    fail_msg("%s: %.60s", weft_material_choice_value(choice, value), line + 1);
        }
    assert_true(told > 50);
}

/* ---- the command line ---- */

/* The maps of a folder are said by its name; one that was chosen since is not. */
static void map_replaced_by_a_folder_is_not_in_the_command_line(void **state) {
    (void)state;
    static const ViewDesc desc = {.materials = "maps"};
    WeftScene *scene;
    WeftError error;
    Viewer *v = viewer_create(&desc);
    assert_non_null(v);
    if (weft_scene_load("builtin:cloth", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    v->states->camera.orbit = cameras[1];
    assert_true(facts_read(&v->states->shown.facts, scene, "builtin:cloth"));
    snprintf(v->states->opening.configured, sizeof v->states->opening.configured, "builtin:cloth");
    WeftMaterial m;
    assert_int_equal(weft_scene_material(scene, 0, &m, NULL), WEFT_OK);
    m.inputs[weft_material_input_find("roughness")].texture = add_own_map(scene);
    assert_int_equal(weft_scene_put_material(scene, 0, &m, NULL), WEFT_OK);
    assert_true(scene_state_read(&v->states->edit.first, scene) &&
                scene_state_copy(&v->states->edit.state, &v->states->edit.first));
    for (int k = 0; k < 3; k++) {
        char *unsaid;
        if (k == 1) m.inputs[weft_material_input_find("roughness")].texture = add_own_map(scene);
        if (k == 2) m.inputs[weft_material_input_find("roughness")].texture = 0;
        assert_true(scene_state_set_material(&v->states->edit.state, 0, &m));
        char *line = command_line(v, &unsaid);
        assert_non_null(strstr(line, " --materials maps "));
        assert_int_equal(strstr(line, " --set 0.roughness=") != NULL, k == 2);
        assert_int_equal(strstr(unsaid, "the map of roughness of Cloth\n") != NULL, k == 1);
        assert_int_equal(unsaid[0] != '\0', k == 1);
        free(line);
        free(unsaid);
    }
    scene_state_free(&v->states->edit.first);
    scene_state_free(&v->states->edit.state);
    facts_free(&v->states->shown.facts);
    weft_scene_free(scene);
    free(v);
}

static void copied_command_line_is_read_by_a_shell_as_meant(void **state) {
    (void)state;
    static const char *const names[] = {"plain.glb", "it's a file.glb", "$HOME `x` \"y\" \\z;&|*?~#!.glb",
                                        "''",        "tab\there.glb",   "-o"};
    static const ViewDesc desc = {.options = NULL};
    Viewer *v = viewer_create(&desc);
    assert_non_null(v);
    v->states->camera.orbit = cameras[1];
    v->states->frame.stage = (UiBox){.width = 320.0f, .height = 200.0f};
    v->states->edit.state.environment = environment_state_studio();
    v->states->edit.state.environment.kind = ENVIRONMENT_FILE;
    v->states->edit.first.environment = v->states->edit.state.environment;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        snprintf(v->states->shown.facts.path, sizeof v->states->shown.facts.path, "%s", names[k]);
        snprintf(v->states->edit.state.environment.path, sizeof v->states->edit.state.environment.path, "%s", names[k]);
        char *unsaid, *line = command_line(v, &unsaid), shell[2048], word[512], camera[ORBIT_TEXT];
        const char *const expected[] = {
            "render",     names[k],   "--env",    names[k],   "--width",
            "320",        "--height", "200",      "--camera", orbit_text(&v->states->camera.orbit, camera),
            "--stage",    "none",     "--engine", "raster",   "-o",
            "picture.png"};
        assert_non_null(line);
        assert_string_equal(unsaid, "");
        free(unsaid);
        snprintf(shell, sizeof shell, "weft() { printf '%%s\\n' \"$@\"; }; %s", line);
        FILE *pipe = popen(shell, "r");
        assert_non_null(pipe);
        for (size_t j = 0; j < sizeof expected / sizeof *expected; j++) {
            assert_non_null(fgets(word, sizeof word, pipe));
            word[strcspn(word, "\n")] = '\0';
            assert_string_equal(word, expected[j]);
        }
        assert_null(fgets(word, sizeof word, pipe));
        assert_int_equal(pclose(pipe), 0);
        free(line);
    }
    free(v);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(projected_point_lies_on_its_ray),
                                       cmocka_unit_test(camera_turns_about_its_target),
                                       cmocka_unit_test(camera_looks_pans_flies_and_zooms),
                                       cmocka_unit_test(framed_box_is_wholly_visible),
                                       cmocka_unit_test(a_camera_is_read_as_it_is_written),
                                       cmocka_unit_test(steps_of_the_history_are_undone_and_redone),
                                       cmocka_unit_test(oldest_steps_of_the_history_are_dropped),
                                       cmocka_unit_test(copied_states_share_materials_until_changed),
                                       cmocka_unit_test(choice_made_while_a_preset_is_put_on_stays),
                                       cmocka_unit_test(preset_is_copied_with_its_state),
                                       cmocka_unit_test(folder_of_maps_replaces_the_one_before),
                                       cmocka_unit_test(brushing_begins_with_the_map_of_the_material),
                                       cmocka_unit_test(settings_file_that_is_a_pipe_is_ignored),
                                       cmocka_unit_test(tips_of_models_have_whole_paragraphs),
                                       cmocka_unit_test(map_replaced_by_a_folder_is_not_in_the_command_line),
                                       cmocka_unit_test(frame_request_is_copied_whole_or_not_at_all),
                                       cmocka_unit_test(a_key_keeps_its_modifiers_in_a_slow_frame),
                                       cmocka_unit_test(half_written_file_is_read_when_complete),
                                       cmocka_unit_test(file_added_to_a_watched_folder_is_noticed),
                                       cmocka_unit_test(kind_of_a_file_follows_from_its_name),
                                       cmocka_unit_test(brush_strokes_turn_the_nap_beneath),
                                       cmocka_unit_test(brush_strokes_without_sense_change_nothing),
                                       cmocka_unit_test(copied_command_line_is_read_by_a_shell_as_meant)};
    return cmocka_run_group_tests(tests, begin, end);
}
