/* The brush lays the nap, and undo takes it back.
 *
 * Labels: slow unsanitized */
#include "drive.h"

static void brushed_nap_is_saved_and_drawn_by_both_engines(void **state) {
    (void)state;
    need_gl();
    script_begin();
    say("wait rest\nchoose \"Material/sheen lobe\" fibre\nset Material/nap 40\nwait rest\n");
    say_picture("plain.exr");
    say("key b\nmove 0.3 0.42\npress left\nwait rest\n");
    for (int k = 1; k <= 8; k++) say("move %.3f %.3f\nwait rest\n", 0.3 + 0.04 * k, 0.42 + 0.02 * (k % 2));
    say("release left\nwait rest\nkey b\n");
    say_picture("brushed.exr");
    say("save nap.glb\nwait message wrote nap.glb\nkey tab\nwait samples 24\npicture traced.exr\n");
    say("wait message wrote traced.exr\n");
    drive_through(script, LIST(UNSEEN, CHEAP));
    double brushed = pictures_differ("plain.exr", "brushed.exr");
    WeftImage size = picture_read("brushed.exr");
    char shell[512];
    snprintf(shell, sizeof shell,
             "\"$0\" render nap.glb --env 0,0,0 --camera 0 --width %d --height %d --quiet --engine raster"
             " --occlusion 0 -o again.exr && \"$0\" render nap.glb --env 0,0,0 --camera 0 --width %d --height %d"
             " --quiet --halves --spp 24 -o truth.exr",
             size.width, size.height, size.width, size.height);
    weft_image_free(&size);
    Ran ran = run_shell(shell);
    if (ran.code != 0) fail_msg("%s", ran.err);
    ran_free(&ran);
    double again = pictures_differ("brushed.exr", "again.exr"), traced = pictures_differ("traced.exr", "truth.exr");
    print_message("brushed: %g; read again: %g, path traced %g\n", brushed, again, traced);
    assert_true(brushed > 1e-3);
    assert_true(again < 1e-5);
    assert_true(traced < 0.01);
}

static double nap_of(const json_t *state) {
    return json_number_value(json_array_get(json_object_get(material_of(state, 0), "nap"), 0));
}

/* How many of a hundred pixels differ. */
static double share_that_differs(const char *a, const char *b) {
    WeftImage x = picture_read(a), y = picture_read(b);
    int count = 0, pixels = x.width * x.height;
    assert_true(x.width == y.width && x.height == y.height && x.channels == y.channels);
    for (int k = 0; k < pixels; k++)
        count += memcmp((const unsigned char *)x.pixels + (size_t)(k * x.channels),
                        (const unsigned char *)y.pixels + (size_t)(k * x.channels), 3) != 0;
    weft_image_free(&x);
    weft_image_free(&y);
    return 100.0 * count / pixels;
}

static void a_stroke_naps_what_it_touches_or_nothing(void **state) {
    (void)state;
    need_gl();
    script_begin();
    say("wait rest\nkey b\ndrag left 0.45 0.5 0.55 0.5\nwait message no nap\nwait rest\n");
    say("key control+z\nwait message nothing to undo\nwait seconds 0.5\nclick \"Make it fibre\"\nwait "
        "rest\n");
    say("click Panel/View\nset View/radius 0.02\n");
    say_picture("plain.png");
    say("move 0.45 0.5\npress left\nwait rest\n");
    for (int k = 1; k <= 5; k++) say("move %.3f 0.5\nwait rest\n", 0.45 + 0.02 * k);
    say("release left\nwait rest\n");
    say_picture("stroked.png");
    say("wait rest\nkey control+z\nwait message undone\n");
    say_picture("undone.png");
    say("wait rest\n");
    Drive drive = drive_start(script, LIST(UNSEEN, CHEAP));
    json_t *now = drive_until(&drive, "message", "nothing to undo");
    assert_true(nap_of(now) <= 0.0);
    json_decref(now);
    now = drive_until(&drive, "message", "wrote stroked.png");
    assert_true(fabs(nap_of(now) - 0.436332) < 1e-5);
    json_decref(now);
    now = drive_until(&drive, "message", "wrote undone.png");
    assert_true(nap_of(now) <= 0.0);
    json_decref(now);
    drive_finish(&drive);
    double touched = share_that_differs("plain.png", "stroked.png");
    print_message("%.2f %% of the picture was stroked\n", touched);
    assert_true(touched > 0.2 && touched < 15.0);
    /* The mesh keeps the tangents that the map had made, which rounds a pixel or two otherwise. */
    assert_true(pictures_most("plain.png", "undone.png") < 1.5 / 255.0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(brushed_nap_is_saved_and_drawn_by_both_engines),
                                       cmocka_unit_test(a_stroke_naps_what_it_touches_or_nothing)};
    return cmocka_run_group_tests(tests, drive_begin, drive_end);
}
