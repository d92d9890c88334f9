/* Things that a hand could do, at random, ten thousand in a long run: nothing may come of it but what is
 * shown.
 *
 * Labels: slow */
#include "drive.h"

static uint64_t seed = 20240811;

static unsigned roll(unsigned below) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (unsigned)(seed >> 33) % below;
}

static double share(void) { return (double)roll(1001) / 1000.0; }

/* Without control: nothing can be saved over, opened or closed by chance; and not enter, for the same. */
static const char *const keys[] = {"tab",       "shift+tab", "escape",    "home",      "space",
                                   "f1",        "f8",        "f12",       "backspace", "a",
                                   "b",         "c",         "d",         "e",         "f",
                                   "g",         "p",         "q",         "s",         "w",
                                   "x",         "z",         "1",         "2",         "3",
                                   "4",         "5",         "6",         "7",         "8",
                                   "9",         "0",         "control+z", "control+y", "control+shift+z",
                                   "control+c", "control+v", "control+o", "control+s", "control+shift+c"};
static const char *const buttons[] = {"left", "left", "left", "right", "middle"};
static const char *const sliders[] = {"roughness", "metallic", "sheen", "base color"}; /* never folded away */

static void act(FILE *stream) {
    switch (roll(16)) {
    case 0:
    case 1:
    case 2: fprintf(stream, "key %s\n", keys[roll(sizeof keys / sizeof *keys)]); break;
    case 3:
    case 4:
        fprintf(stream, "drag %s %.3f %.3f %.3f %.3f\n", buttons[roll(5)], share(), share(), share(), share());
        break;
    case 5: /* anywhere in the window, panels as well */
    case 6:
    case 7:
        fprintf(stream, "move %.3f %.3f\npress %s\n", 2.6 * share() - 0.1, 1.2 * share() - 0.1, buttons[roll(5)]);
        fprintf(stream, "move %.3f %.3f\n", 2.6 * share() - 0.1, 1.2 * share() - 0.1);
        break;
    case 8: fprintf(stream, "release left\nrelease right\nrelease middle\n"); break;
    case 9: fprintf(stream, "wheel %.1f\n", 12.0 * share() - 6.0); break;
    case 10: fprintf(stream, "keydown %c\n", "wasdeq"[roll(6)]); break;
    case 11: fprintf(stream, "keyup %c\n", "wasdeq"[roll(6)]); break;
    case 12: /* what text might be: numbers, words, what is neither */
        fprintf(stream, "type %s\n",
                (const char *const[]){"0.5", "-1e30", "nan", "1e999", "?", "../x", "%s%n", "\xC3\xA4"}[roll(8)]);
        break;
    case 13:
        if (roll(6) == 0) fprintf(stream, "resize %u %u\n", 320 + roll(500), 240 + roll(400));
        if (roll(12) == 0) fprintf(stream, "resize 0 0\n"); /* minimised */
        break;
    case 14:
        fprintf(stream, "keydown control\npress left\nrelease left\nkeyup control\ntype %.4g\nkey escape\n",
                pow(10.0, 8.0 * share() - 4.0) * (roll(4) ? 1.0 : -1.0));
        break;
    default: fprintf(stream, "move %.3f %.3f\n", 2.6 * share() - 0.1, 1.2 * share() - 0.1); break;
    }
}

/* Leaves whatever is open, and tries a slider by its name. */
static void come_back(FILE *stream) {
    fprintf(stream, "release left\nrelease right\nrelease middle\n");
    for (const char *k = "wasdeq"; *k; k++) fprintf(stream, "keyup %c\n", *k);
    fprintf(stream, "resize 400 300\n");
    for (int k = 0; k < 3; k++) fprintf(stream, "key escape\nwait 2\n");
}

static void random_events_leave_the_window_working(void **state) {
    (void)state;
    need_gl();
    int count = getenv("WEFT_TEST_LONG") ? 10000 : getenv("WEFT_TEST_SHORT") ? 150 : 600;
    FILE *stream = fopen("mash", "wb");
    assert_non_null(stream);
    fprintf(stream, "wait rest\n");
    for (int k = 0; k < count / 40; k++)
        fprintf(stream, "set \"Material/%s\" %.4g\n", sliders[roll(4)],
                pow(10.0, 10.0 * share() - 5.0) * (roll(4) ? 1.0 : -1.0));
    for (int k = 0; k < count; k++) act(stream);
    come_back(stream);
    assert_int_equal(fclose(stream), 0);
    Drive drive = drive_start(NULL, LIST("view", "--windowless", "--forget", "--json", "--width", "400", "--height",
                                         "300", CHEAP, "--script", "mash"));
    drive_finish_within(&drive, 0.3 * count + 100.0);
    size_t size;
    char *said = file_bytes("stdout", &size);
    assert_true(size > 1000);
    free(said);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(random_events_leave_the_window_working)};
    return cmocka_run_group_tests(tests, drive_begin, drive_end);
}
