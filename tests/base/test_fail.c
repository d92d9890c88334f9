/* Errors and warnings: one line, with an id */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#undef fail /* cmocka has a macro of that name */

#include "base/fail.h"
#include "weft/version.h"

static void error_text_is_one_line(void **state) {
    (void)state;
    WeftError error;
    assert_int_equal(fail(&error, WEFT_MESSAGE_FILE_OPEN, "a.png", "%s (%d)", "no such file", 2), WEFT_INPUT);
    assert_int_equal(error.result, WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_OPEN);
    assert_string_equal(error.text, "a.png: cannot be opened: no such file (2)");
    assert_int_equal(fail(&error, WEFT_MESSAGE_MEMORY, "a.png", NULL), WEFT_RESOURCES);
    assert_string_equal(error.text, "a.png: out of memory");
    assert_int_equal(fail(NULL, WEFT_MESSAGE_DESC, "x", NULL), WEFT_USAGE);
}

static void hostile_names_leave_an_error_on_one_line(void **state) {
    (void)state;
    WeftError error;
    fail(&error, WEFT_MESSAGE_FILE_OPEN, "a\nb\033[31m%s%n\x7f", "%s", "c\r\nd");
    for (const char *c = error.text; *c; c++) assert_true((unsigned char)*c >= 0x20 && *c != 0x7f);
    assert_non_null(strstr(error.text, "a?b?[31m%s%n?"));
    char name[4096];
    memset(name, 'n', sizeof name - 1);
    name[sizeof name - 1] = 0;
    fail(&error, WEFT_MESSAGE_FILE_OPEN, name, "%s", name);
    assert_true(strlen(error.text) < sizeof error.text);
    assert_non_null(strstr(error.text, "cannot be opened"));
}

typedef struct Seen {
    int count;
    WeftMessage message;
    char text[512];
} Seen;

static void see(void *user, WeftMessage message, const char *text) {
    Seen *seen = user;
    seen->count++;
    seen->message = message;
    strncpy(seen->text, text, sizeof seen->text - 1);
}

static void warnings_reach_the_log(void **state) {
    (void)state;
    Seen seen = {0};
    WeftLog log = {see, &seen}, deaf = {0};
    warn(&log, WEFT_MESSAGE_IMAGE_REPAIRED, "a.hdr", "%d rows", 3);
    assert_int_equal(seen.count, 1);
    assert_int_equal(seen.message, WEFT_MESSAGE_IMAGE_REPAIRED);
    assert_string_equal(seen.text, "a.hdr: was repaired: 3 rows");
    warn(NULL, WEFT_MESSAGE_IMAGE_REPAIRED, "a.hdr", NULL);
    warn(&deaf, WEFT_MESSAGE_IMAGE_REPAIRED, "a.hdr", NULL);
    assert_int_equal(seen.count, 1);
}

static void every_message_has_a_text(void **state) {
    (void)state;
    for (int k = 1; k < WEFT_MESSAGE_COUNT; k++) {
        const char *text = weft_message_text((WeftMessage)k);
        assert_true(strlen(text) > 4 && strlen(text) < 200);
        assert_null(strchr(text, '\n'));
        assert_true(text[strlen(text) - 1] != '.');
    }
    assert_string_equal(weft_message_text(WEFT_MESSAGE_NONE), "");
    assert_string_equal(weft_message_text(WEFT_MESSAGE_COUNT), "");
}

static void version_string_and_numbers_agree(void **state) {
    (void)state;
    int major, minor, patch;
    assert_int_equal(sscanf(weft_version(), "%d.%d.%d", &major, &minor, &patch), 3);
    assert_int_equal(major, WEFT_VERSION_MAJOR);
    assert_int_equal(minor, WEFT_VERSION_MINOR);
    assert_int_equal(patch, WEFT_VERSION_PATCH);
    assert_string_equal(weft_version(), WEFT_VERSION);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(error_text_is_one_line),           cmocka_unit_test(hostile_names_leave_an_error_on_one_line),
        cmocka_unit_test(warnings_reach_the_log),           cmocka_unit_test(every_message_has_a_text),
        cmocka_unit_test(version_string_and_numbers_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
