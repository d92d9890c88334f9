/* What is opened: scenes that are not there, lights that cannot be read, and which material is chosen.
 *
 * Labels: slow unsanitized */
#include "drive.h"

/* ---- what is not there ---- */

static void first_scene_that_cannot_be_read_ends_the_window(void **state) {
    (void)state;
    need_gl();
    file_make("bare.gltf", "{\"asset\":{\"version\":\"2.0\"}}", 27);
    static const char *const absent[][2] = {{"nofile.glb", "nofile.glb: "}, {"bare.gltf", "nothing to render"}};
    for (int k = 0; k < 2; k++) {
        assert_complaint(NULL, LIST("view", absent[k][0], "--windowless", "--forget"), WEFT_INPUT, absent[k][1]);
        assert_complaint(NULL, LIST("view", absent[k][0], "--windowless", "--forget", "--frames", "1"), WEFT_INPUT,
                         absent[k][1]);
    }
}

static void window_is_idle_after_a_scene_with_nothing_to_render(void **state) {
    (void)state;
    need_gl();
    file_make("bare.gltf", "{\"asset\":{\"version\":\"2.0\"}}", 27);
    script_begin();
    say("wait rest\nopen bare.gltf\nwait rest\nopen nofile.glb\nwait rest\n");
    say_picture("still.png");
    drive_through(script, LIST(UNSEEN, CHEAP));
    assert_int_equal(access("still.png", F_OK), 0);
}

static void window_ends_after_its_frames_though_nothing_changes(void **state) {
    (void)state;
    need_gl();
    Drive drive = drive_start(NULL, LIST(UNSEEN, CHEAP, "--frames", "200"));
    drive_finish_within(&drive, 60.0);
}

/* ---- while shaders compile ---- */

/* Mean difference of two pictures of the window where both show the scene, of 1. */
static double stages_differ(const char *a, const char *b) {
    WeftImage x = picture_read(a), y = picture_read(b);
    double sum = 0.0;
    int count = 0;
    assert_true(x.width == y.width && x.height == y.height && x.channels == y.channels);
    for (int row = x.height / 4; row < x.height * 3 / 4; row++)
        for (int k = 0; k < x.width / 4 * x.channels; k++, count++) {
            size_t at = (size_t)(row * x.width * x.channels + k);
            sum += fabs(((const unsigned char *)x.pixels)[at] - (double)((const unsigned char *)y.pixels)[at]);
        }
    weft_image_free(&x);
    weft_image_free(&y);
    return sum / (255.0 * count);
}

/* A driver that keeps what it compiles has nothing to wait for. */
static void the_path_tracer_stands_in_while_shaders_compile(void **state) {
    (void)state;
    need_gl();
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    script_begin();
    say("wait shows traced\nwindow traced.png\nwait shows drawn\nwait rest\nwindow drawn.png\n");
    say("choose \"Material/sheen lobe\" ashikhmin-neubelt\nwait shows traced\nwait shows drawn\nwait rest\n");
    say("key tab\nwait samples 1\npicture asked.png\nwait message wrote asked.png\n");
    Drive drive = drive_start(script, LIST(UNSEEN, CHEAP));
    json_t *now = drive_until(&drive, "shows", "drawn"); /* nothing that is asked for was traced */
    assert_string_equal(word_of(now, "mode"), "live");
    json_decref(now);
    drive_finish(&drive);
    unsetenv("MESA_SHADER_CACHE_DISABLE");
    WeftImage asked = picture_read("asked.png"); /* what stood in has fewer pixels */
    assert_int_equal(asked.width, 268);
    weft_image_free(&asked);
    double off = stages_differ("traced.png", "drawn.png");
    if (!(off > 0.0 && off < 0.06)) fail_msg("%g off", off);
}

/* ---- light ---- */

/* A picture of one colour, and the half of its file. */
static void write_light(const char *path, float red, float blue, bool half) {
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_image_create(64, 32, 3, WEFT_PIXEL_F32, &image, NULL), WEFT_OK);
    float *p = image.pixels;
    for (int k = 0; k < 64 * 32; k++, p += 3) p[0] = red + 0.001f * (float)(k % 61), p[1] = 0.4f, p[2] = blue;
    if (weft_image_write(path, &image, &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_image_free(&image);
    struct stat s;
    if (half) assert_int_equal(stat(path, &s) | truncate(path, s.st_size / 2), 0);
}

static void a_light_that_cannot_be_read_leaves_the_one_before(void **state) {
    (void)state;
    need_gl();
    write_light("good.hdr", 0.9f, 0.2f, false);
    write_light("half.hdr", 0.2f, 0.9f, true);
    file_make("none.exr", "v/1\1nonsense", 12);
    script_begin();
    say("wait rest\ndrop good.hdr\nwait message lit by good.hdr\n");
    say_picture("lit.png");
    static const char *const broken[] = {"half.hdr", "nowhere.hdr", "none.exr"};
    for (int k = 0; k < 3; k++) {
        say("drop %s\nwait message %s: \ndrag left 0.5 0.5 0.7 0.5\n", broken[k], broken[k]);
        say_picture("turned.png");
        say("camera 0\n");
        say_picture("again.png");
        say("command said\n");
    }
    say("key control+z\nwait message undone\n"); /* to what was there before any file */
    say_picture("dark.png");
    say("key control+z\nwait message nothing to undo\nwait rest\n");
    drive_through(script, LIST(UNSEEN, CHEAP));
    assert_true(pictures_most("lit.png", "turned.png") > 0.1); /* it is drawn on */
    assert_true(pictures_most("lit.png", "again.png") < 0.5 / 255.0);
    assert_true(pictures_most("lit.png", "dark.png") > 0.1);
    size_t size;
    char *said = file_bytes("said", &size);
    assert_non_null(strstr(said, " --env good.hdr "));
    free(said);
}

static void a_light_that_breaks_while_it_is_shown_stays_until_it_is_whole(void **state) {
    (void)state;
    need_gl();
    write_light("sky.hdr", 0.9f, 0.2f, false);
    script_begin();
    say("wait rest\ndrop sky.hdr\nwait message lit by sky.hdr\n");
    say_picture("1.png");
    say("wait message sky.hdr: \n");
    say_picture("2.png");
    say("wait message lit by sky.hdr\n");
    say_picture("3.png");
    Drive drive = drive_start(script, LIST(UNSEEN, CHEAP));
    json_decref(drive_until(&drive, "message", "wrote 1.png"));
    write_light("sky.hdr", 0.2f, 0.9f, true);
    json_decref(drive_until(&drive, "message", "wrote 2.png"));
    write_light("sky.hdr", 0.2f, 0.9f, false);
    drive_finish(&drive);
    assert_true(pictures_most("1.png", "2.png") < 0.5 / 255.0);
    assert_true(pictures_most("1.png", "3.png") > 0.1);
}

/* A file that went away after it was read: undo cannot bring it back, and says so. */
static void undo_to_a_deleted_light_keeps_the_light_that_is_there(void **state) {
    (void)state;
    need_gl();
    write_light("one.hdr", 0.9f, 0.2f, false);
    write_light("two.hdr", 0.2f, 0.9f, false);
    script_begin();
    say("wait rest\ndrop one.hdr\nwait message lit by one.hdr\ndrop two.hdr\nwait message lit by two.hdr\n");
    say_picture("two.png");
    say("wait seconds 1\nkey control+z\nwait message one.hdr: \nset Material/roughness 0.2\nset "
        "Material/roughness 0.9\n");
    say_picture("still.png");
    Drive drive = drive_start(script, LIST(UNSEEN, CHEAP));
    json_decref(drive_until(&drive, "message", "wrote two.png"));
    assert_int_equal(unlink("one.hdr"), 0);
    drive_finish(&drive);
    assert_true(pictures_most("two.png", "still.png") < 0.5 / 255.0);
}

static void chooser_of_lights_keeps_the_typed_text(void **state) {
    (void)state;
    need_gl();
    assert_int_equal(mkdir("lights", 0700), 0);
    write_light("lights/dome.hdr", 0.9f, 0.2f, false);
    file_make("lights/notes.json", "{}", 2);
    script_begin();
    say("wait rest\nclick Panel/Light\nclick \"Light/Choose a picture ...\"\nwait 3\n");
    say("click \"Choose a light/path\"\nkey control+a\ntype lights\nkey enter\nwait 3\n");
    say("click \"Choose a light/path\"\nkey control+a\ntype lights/nowhere.hdr\nkey enter\nwait 3\n");
    say("window kept.png\nwait 3\n");
    say("click \"Choose a light/path\"\nkey control+a\ntype dome.hdr\nkey enter\n");
    say("wait message lit by\nwait rest\ncommand said\n");
    Drive drive = drive_start(script, LIST(UNSEEN, CHEAP));
    bool listed = false, stays = false;
    for (bool ended = false; !ended;) {
        ended = drive_ended(&drive);
        for (json_t *now; (now = drive_next(&drive)); json_decref(now)) {
            const json_t *controls = json_object_get(now, "controls");
            listed |= json_object_get(controls, "Choose a light/dome.hdr") != NULL;
            stays |= listed && json_object_get(controls, "Choose a light/path") != NULL;
            assert_null(json_object_get(controls, "Choose a light/notes.json"));
        }
        if (!ended) sleep_seconds(0.02);
    }
    drive_finish(&drive);
    assert_true(listed && stays);
    size_t size;
    char *said = file_bytes("said", &size);
    if (!said || !strstr(said, "/lights/dome.hdr ")) fail_msg("%s", said);
    free(said);
}

/* ---- which material is chosen ---- */

static const char quads[] =
    "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_materials_variants\"],"
    "\"extensions\":{\"KHR_materials_variants\":{\"variants\":[{\"name\":\"red\"},{\"name\":\"blue\"}]}},"
    "\"scenes\":[{\"nodes\":[0,1]}],"
    "\"nodes\":[{\"mesh\":0,\"scale\":[3,3,3]},{\"mesh\":1,\"translation\":[0,-1.2,0]}],"
    "\"materials\":[{\"name\":\"Spare\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,1,1]}},"
    "{\"name\":\"Small\"},{\"name\":\"Large\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0,0,1]}}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":2,\"extensions\":"
    "{\"KHR_materials_variants\":{\"mappings\":[{\"material\":2,\"variants\":[0]},"
    "{\"material\":0,\"variants\":[1]}]}}}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":1}]}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":6,\"type\":\"VEC3\","
    "\"min\":[-0.5,0,0],\"max\":[0.5,1,0]}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":72}],"
    "\"buffers\":[{\"byteLength\":72,\"uri\":\"quad.bin\"}]}";

static void write_quads(void) {
    static const float corners[6][3] = {{-0.5f, 0, 0}, {0.5f, 0, 0}, {0.5f, 1, 0},
                                        {-0.5f, 0, 0}, {0.5f, 1, 0}, {-0.5f, 1, 0}};
    file_make("quad.bin", (const char *)corners, sizeof corners);
    file_make("quads.gltf", quads, sizeof quads - 1);
}

static void chosen_material_is_one_on_screen(void **state) {
    (void)state;
    need_gl();
    write_quads();
    script_begin();
    say("wait rest\npicture red.png\nwait message wrote red.png\nwait rest\n");
    say("window marked.png\nclick Material/material\nwait 2\nkey escape\n");
    say("choose Material/variant blue\nwait 3\nwait rest\npicture blue.png\nwait message wrote blue.png\n");
    say("wait rest\nmove 0.5 0.9\npress left\nrelease left\nwait message Small\nwait rest\n");
    say("choose Material/variant red\nwait 3\nwait rest\npicture end.png\nwait message wrote end.png\nwait "
        "rest\n");
    Drive drive = drive_start(script, LIST(UNSEEN, "quads.gltf", "--env", "1,1,1", "--occlusion", "0"));
    json_t *now = drive_until(&drive, "message", "wrote red.png");
    assert_int_equal(number_of(now, "material"), 2); /* neither the first nor the spare one */
    json_decref(now);
    now = drive_until(&drive, "message", "wrote blue.png");
    assert_int_equal(number_of(now, "material"), 0);
    json_decref(now);
    now = drive_until(&drive, "message", "Small");
    assert_int_equal(number_of(now, "material"), 1);
    json_decref(now);
    now = drive_until(&drive, "message", "wrote end.png");
    assert_int_equal(number_of(now, "material"), 2);
    json_decref(now);
    drive_finish(&drive);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(first_scene_that_cannot_be_read_ends_the_window),
                                       cmocka_unit_test(window_is_idle_after_a_scene_with_nothing_to_render),
                                       cmocka_unit_test(window_ends_after_its_frames_though_nothing_changes),
                                       cmocka_unit_test(the_path_tracer_stands_in_while_shaders_compile),
                                       cmocka_unit_test(a_light_that_cannot_be_read_leaves_the_one_before),
                                       cmocka_unit_test(a_light_that_breaks_while_it_is_shown_stays_until_it_is_whole),
                                       cmocka_unit_test(undo_to_a_deleted_light_keeps_the_light_that_is_there),
                                       cmocka_unit_test(chooser_of_lights_keeps_the_typed_text),
                                       cmocka_unit_test(chosen_material_is_one_on_screen)};
    return cmocka_run_group_tests(tests, drive_begin, drive_end);
}
