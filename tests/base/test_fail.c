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

/* A terminal would obey some characters of a name, and turn the line around or hide a part of it by others; letters of
 * any script stay. */
static void names_cannot_command_a_terminal(void **state) {
    (void)state;
    static const struct {
        const char *name, *shown;
    } cases[] = {
        {"a\xc2\x9b"
         "31mb",
         "a?31mb"}, /* U+009B, CSI in one character */
        {"a\xc2\x85"
         "b",
         "a?b"}, /* U+0085, next line */
        {"a\x9b"
         "31mb",
         "a?31mb"}, /* the same as a bare byte */
        {"\xe2\x80\xae"
         "fdp.exe",
         "?fdp.exe"}, /* U+202E, from right to left */
        {"a\xe2\x81\xa6"
         "b\xe2\x81\xa9",
         "a?b?"}, /* U+2066 and U+2069, isolates */
        {"a\xe2\x80\x8b\xe2\x80\xa8"
         "b\xef\xbb\xbf",
         "a??b?"}, /* zero width, line separator, mark */
        {"a\xf3\xa0\x81\x81"
         "b",
         "a?b"},                           /* a tag, U+E0041 */
        {"\xc0\xaf\xed\xa0\x80", "?????"}, /* an overlong slash, a surrogate */
        {"cut\xe2\x80", "cut??"},
        {"sammet r\xc3\xb6"
         "d \xe7\xbb\x92 \xf0\x9f\xa7\xb5",
         "sammet r\xc3\xb6"
         "d \xe7\xbb\x92 \xf0\x9f\xa7\xb5"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        WeftError error;
        char line[200];
        fail(&error, WEFT_MESSAGE_FILE_OPEN, "x", "%s", cases[k].name);
        snprintf(line, sizeof line, "x: cannot be opened: %s", cases[k].shown);
        assert_string_equal(error.text, line);
    }
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
        cmocka_unit_test(error_text_is_one_line),          cmocka_unit_test(hostile_names_leave_an_error_on_one_line),
        cmocka_unit_test(names_cannot_command_a_terminal), cmocka_unit_test(warnings_reach_the_log),
        cmocka_unit_test(every_message_has_a_text),        cmocka_unit_test(version_string_and_numbers_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
