/* What a file does not show: a list with each thing once, and the warnings of writers as items of it */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>
#undef fail /* cmocka has a macro of that name */

#include "base/fail.h"
#include "weft/loss.h"

static void equal_losses_are_listed_once(void **state) {
    (void)state;
    WeftLosses losses = {0};
    assert_true(weft_losses_add(&losses, 0, "satin", "dust", "it is not baked"));
    assert_true(weft_losses_add(&losses, 0, "satin", "dust", "it is not baked"));
    assert_true(weft_losses_add(&losses, 1, "satin", "dust", "it is not baked"));
    assert_true(weft_losses_add(&losses, -1, NULL, "dust", NULL));
    assert_int_equal(losses.count, 3);
    assert_string_equal(losses.items[2].name, "");
    assert_string_equal(losses.items[2].why, "");
    weft_losses_free(&losses);
    assert_int_equal(losses.count, 0);
    assert_null(losses.items);
}

static void hostile_texts_stay_one_line_and_within_bounds(void **state) {
    (void)state;
    WeftLosses losses = {0};
    char name[400];
    memset(name, 'n', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    assert_true(weft_losses_add(&losses, 0, name, "a\nb\033[31m", name));
    assert_int_equal(strlen(losses.items[0].name), sizeof losses.items[0].name - 1);
    assert_string_equal(losses.items[0].what, "a?b?[31m");
    assert_int_equal(strlen(losses.items[0].why), sizeof losses.items[0].why - 1);
    weft_losses_free(&losses);
}

static void hear(void *user, WeftMessage message, const char *text) {
    assert_true(weft_losses_hear(user, 0, "satin", "out/satin: has a part.u3ma", message, text));
}

/* Also where the name of the file contains the text of the message. */
static void warnings_of_writers_are_heard_as_losses(void **state) {
    (void)state;
    WeftLosses losses = {0};
    const WeftLog log = {.fn = hear, .user = &losses};
    warn(&log, WEFT_MESSAGE_GLTF_WARN_IGNORED, "out/satin: has a part.u3ma", "%s: U3M has no word for it", "emission");
    warn(&log, WEFT_MESSAGE_GLTF_WARN_IGNORED, "out/satin: has a part.u3ma", "its hair");
    assert_int_equal(losses.count, 2);
    assert_string_equal(losses.items[0].what, "emission");
    assert_string_equal(losses.items[0].why, "U3M has no word for it");
    assert_string_equal(losses.items[1].what, "its hair");
    assert_string_equal(losses.items[1].why, "");
    weft_losses_free(&losses);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(equal_losses_are_listed_once),
                                       cmocka_unit_test(hostile_texts_stay_one_line_and_within_bounds),
                                       cmocka_unit_test(warnings_of_writers_are_heard_as_losses)};
    return cmocka_run_group_tests_name("base/loss", tests, NULL, NULL);
}
