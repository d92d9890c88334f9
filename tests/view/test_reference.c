/* The path tracer's thread of the window: its pictures bear the numbers of the view and the state that they show. */
#include "cli/run.h"

#include "view/render/reference_view.h"
#include "weft/weft.h"

enum { WIDTH = 24, HEIGHT = 16, SAMPLES = 4 };

static WeftScene *scene;
static ReferenceView *reference;

static int begin(void **state) {
    (void)state;
    reference = reference_start(NULL);
    if (!reference || weft_scene_load("builtin:cloth", &scene, NULL, NULL) != WEFT_OK) return -1;
    reference_resume(reference, scene, ~0u);
    reference_set_state(reference, 1);
    return 0;
}

static int end(void **state) {
    (void)state;
    reference_stop(reference);
    weft_scene_free(scene);
    return 0;
}

static ReferenceRequest asked(void) {
    ReferenceRequest request;
    memset(&request, 0, sizeof request);
    request.wanted = true;
    request.desc.width = WIDTH, request.desc.height = HEIGHT;
    request.desc.halves = request.desc.first_hits = 1;
    snprintf(request.camera, sizeof request.camera, "0");
    request.samples = SAMPLES;
    return request;
}

/* Returns true if there is another picture once the thread is at rest: `last`, without its image. */
static bool rested(ReferenceFrame *last) {
    double start = clock_now();
    while (!reference_is_idle(reference)) {
        if (clock_now() - start > 60.0) fail_msg("it does not come to rest");
        sleep_seconds(0.005);
    }
    if (!reference_take_frame(reference, last)) return false;
    weft_image_free(&last->image);
    assert_string_equal(last->failure, "");
    return true;
}

static void shows(unsigned view, unsigned state) {
    ReferenceFrame last;
    assert_true(rested(&last));
    assert_int_equal(last.view, view);
    assert_int_equal(last.state, state);
    assert_int_equal((int)last.samples, SAMPLES);
}

static void pictures_bear_the_numbers_of_what_they_show(void **state) {
    (void)state;
    ReferenceFrame none;
    ReferenceRequest request = asked();
    unsigned first = reference_request(reference, &request);
    shows(first, 1);
    assert_int_equal(reference_request(reference, &request), first);
    assert_false(rested(&none)); /* nothing has changed */
    request.exposure = 1.0f;
    assert_int_equal(reference_request(reference, &request), first); /* the same samples */
    shows(first, 1);
    request.desc.floor.on = 1;
    unsigned other = reference_request(reference, &request);
    assert_true(other != first);
    shows(other, 1);
    reference_set_state(reference, 2); /* it changes nothing that the path tracer sees */
    shows(other, 2);
    reference_set_state(reference, 2);
    assert_false(rested(&none));
    reference_pause(reference);
    reference_resume(reference, scene, WEFT_CHANGED_LIGHTS);
    shows(other, 0); /* of no request, until the renderer says so */
    reference_set_state(reference, 3);
    shows(other, 3);
}

static void compare_with_grey(unsigned view) {
    WeftImage grey;
    assert_int_equal(weft_image_create(WIDTH, HEIGHT, 4, WEFT_PIXEL_F32, &grey, NULL), WEFT_OK);
    for (int k = 0; k < WIDTH * HEIGHT * 4; k++) ((float *)grey.pixels)[k] = 0.5f;
    reference_set_comparison(reference, view, &grey);
    assert_null(grey.pixels);
}

static void differences_are_from_pictures_of_the_same_view(void **state) {
    (void)state;
    ReferenceFrame last;
    ReferenceRequest request = asked();
    unsigned plain = reference_request(reference, &request);
    assert_true(rested(&last) && !last.compared && last.view == plain);
    request.difference = true;
    unsigned first = reference_request(reference, &request);
    assert_true(first != plain); /* samples of a picture are not those of a difference */
    compare_with_grey(first);
    assert_true(rested(&last) && last.compared);
    request.desc.floor.on = !request.desc.floor.on;
    unsigned view = reference_request(reference, &request);
    assert_false(rested(&last)); /* until there is one of this view */
    compare_with_grey(first);    /* it comes late */
    assert_false(rested(&last));
    compare_with_grey(view);
    assert_true(rested(&last) && last.compared && last.view == view);
    reference_pause(reference);
    reference_resume(reference, scene, WEFT_CHANGED_LIGHTS);
    assert_false(rested(&last));
    compare_with_grey(view);
    assert_true(rested(&last) && last.compared);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(pictures_bear_the_numbers_of_what_they_show),
                                       cmocka_unit_test(differences_are_from_pictures_of_the_same_view)};
    return cmocka_run_group_tests(tests, begin, end);
}
