/* Loading with progress: it rises from 0 to 1, and may be stopped anywhere. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

#include "weft/weft.h"

typedef struct Seen {
    int calls, stop; /* stop: at which call */
    double last;
} Seen;

static int watch(void *user, double fraction) {
    Seen *seen = user;
    assert_true(fraction >= 0.0 && fraction <= 1.0);
    if (fraction > seen->last) seen->last = fraction;
    return ++seen->calls == seen->stop;
}

static void load_reports_progress_and_can_be_stopped(void **state) {
    (void)state;
    static const char *const paths[] = {WEFT_SOURCE_DIR "/scenes/sewing.glb", "builtin:cloth"};
    for (size_t k = 0; k < sizeof paths / sizeof *paths; k++) {
        Seen seen = {0};
        WeftScene *scene;
        WeftError error;
        assert_int_equal(weft_scene_load_watched(paths[k], watch, &seen, &scene, NULL, &error), WEFT_OK);
        assert_true(seen.calls >= 3 && seen.last > 0.999);
        weft_scene_free(scene);
        for (int stop = 1; stop <= seen.calls; stop++) {
            Seen stopped = {.stop = stop};
            WeftResult result = weft_scene_load_watched(paths[k], watch, &stopped, &scene, NULL, &error);
            if (result == WEFT_OK && stopped.calls < stop) { /* another thread decoded the last picture */
                weft_scene_free(scene);
                continue;
            }
            assert_int_equal(result, WEFT_INTERRUPTED);
            assert_int_equal(error.result, WEFT_INTERRUPTED);
            assert_null(scene);
        }
    }
    WeftScene *scene;
    assert_int_equal(weft_scene_load_watched("builtin:spheres", NULL, NULL, &scene, NULL, NULL), WEFT_OK);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(load_reports_progress_and_can_be_stopped)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
