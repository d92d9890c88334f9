/* The window at rest adds up frames: it says how many, shows nearly what the path tracer does, answers a movement, and
 * comes to rest; without frames it draws no more
 *
 * Labels: slow unsanitized */
#include "drive.h"

#define SMALL "view", "--windowless", "--forget", "--json", "--width", "480", "--height", "300"

/* The sum of |a - b| over the sum of b, in the middle of two pictures as displayed. */
static double off(const char *a, const char *b) {
    WeftImage x, y;
    double sum = 0.0, all = 0.0;
    assert_int_equal(weft_image_read(a, &x, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_image_read(b, &y, NULL, NULL), WEFT_OK);
    assert_true(x.width == y.width && x.height == y.height);
    for (int row = y.height / 4; row < 3 * y.height / 4; row++)
        for (int k = 0; k < y.width * y.channels; k++) {
            const size_t at = (size_t)row * (size_t)(y.width * y.channels) + (size_t)k;
            const int p = ((const unsigned char *)x.pixels)[at], q = ((const unsigned char *)y.pixels)[at];
            sum += abs(p - q), all += q;
        }
    weft_image_free(&x);
    weft_image_free(&y);
    return sum / all;
}

static void rest_adds_up_frames(void **state) {
    (void)state;
    need_gl();
    Drive drive = drive_start("wait rest\n"
                              "window before.png\n"
                              "wait summed 1\n"
                              "window first.png\n"
                              "wait summed 12\n"
                              "wait 4\n"
                              "window summed.png\n"
                              "drag left .5 .5 .55 .5\n"
                              "wait rest\n"
                              "wait 4\n"
                              "stay\n",
                              LIST(SMALL, CHEAP, "--accumulate", "12", "--bounces", "0"));
    json_t *now = NULL;
    double most = 0.0;
    bool again = false;
    const double start = clock_now();
    while (!(again && number_of(now, "summed") >= 12.0)) {
        json_t *next = drive_next(&drive);
        if (!next && clock_now() - start > 150.0) drive_give_up(&drive, "frames are not summed");
        if (!next) {
            sleep_seconds(0.02);
            continue;
        }
        json_decref(now);
        now = next;
        if (number_of(now, "summed") > most) most = number_of(now, "summed");
        again |= most >= 12.0 && number_of(now, "summed") < 1.0; /* the drag began another picture */
    }
    assert_true(most <= 12.0);
    json_decref(now);
    kill(drive.child, SIGTERM);
    waitpid(drive.child, NULL, 0);
    const double jump = off("first.png", "before.png"), grown = off("summed.png", "before.png");
    print_message("first frame %.2f %% off, 12 frames %.2f %%\n", 100.0 * jump, 100.0 * grown);
    assert_true(jump < 0.02);
    assert_true(grown > 0.0 && grown < 0.06);
}

/* At rest surfaces light each other: "Bounced light" is on, and may be switched off. */
static void rest_has_bounced_light(void **state) {
    (void)state;
    need_gl();
    Drive drive = drive_start("click Panel/View\n"
                              "wait 3\n"
                              "click \"View/Bounced light\"\n"
                              "move 0.1 0.1\n"
                              "wait seconds 0.5\n"
                              "wait summed 6\n"
                              "wait 4\n"
                              "window without.png\n"
                              "click \"View/Bounced light\"\n"
                              "move 0.1 0.1\n"
                              "wait seconds 0.5\n"
                              "wait summed 6\n"
                              "wait 4\n"
                              "window with.png\n",
                              LIST(SMALL, CHEAP, "--accumulate", "6"));
    waitpid(drive.child, NULL, 0);
    const double bounced = off("with.png", "without.png");
    print_message("bounced light is %.2f %%\n", 100.0 * bounced);
    assert_true(bounced > 0.01 && bounced < 0.08);
}

/* A replay adds nothing up unless it is told to. */
static void replay_alone_adds_up_none(void **state) {
    (void)state;
    need_gl();
    Drive drive = drive_start("wait rest\nstay\n", LIST(SMALL, CHEAP));
    json_t *now = drive_rest(&drive);
    assert_int_equal((int)number_of(now, "summed"), 0);
    json_decref(now);
    sleep_seconds(1.0); /* a slow machine tells late that it rests */
    while ((now = drive_next(&drive))) {
        assert_int_equal((int)number_of(now, "summed"), 0);
        json_decref(now);
    }
    sleep_seconds(2.0);
    assert_null(drive_next(&drive));
    kill(drive.child, SIGTERM);
    waitpid(drive.child, NULL, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(rest_adds_up_frames), cmocka_unit_test(rest_has_bounced_light),
                                       cmocka_unit_test(replay_alone_adds_up_none)};
    return cmocka_run_group_tests(tests, drive_begin, drive_end);
}
