/* What drivers say of a broken text, in each of their forms, becomes one line with the file and line that a
 * person edits */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "raster/gl/complaint.h"
#include "weft/lobe.h"

static const char file[] = "shading/lobes/ggx.h", statement[] = "    GgxPrepared p;\n";

/* The line on which a part of the text is, from 1 on. */
static int line_with(const char *bytes, const char *part) {
    const char *at = strstr(bytes, part);
    int line = 1;
    assert_non_null(at);
    for (const char *c = bytes; c < at; c++) line += *c == '\n';
    return line;
}

static void make_text(Text *text) {
    text_begin(text, &(TextDesc){.language = TEXT_GLSL_330});
    text_include(text, file);
    text_line(text, "float own;");
    assert_int_equal(text_end(text, NULL), WEFT_OK);
}

/* %d stands for the line in the text. */
static void assert_said(const Text *text, const char *form, int line, const char *subject, const char *words) {
    char log[512], expected[512];
    WeftError error = {0};
    snprintf(log, sizeof log, form, line);
    complain("a test", log, text, &error);
    snprintf(expected, sizeof expected, "%s: %s: %s", subject, weft_message_text(WEFT_MESSAGE_GL_COMPILE), words);
    assert_int_equal(error.result, WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_GL_COMPILE);
    assert_string_equal(error.text, expected);
}

static void line_of_every_driver_is_read(void **state) {
    (void)state;
    static const struct {
        const char *form, *words;
    } logs[] = {
        {"0:%d(7): error: syntax error, unexpected ','\n", "syntax error, unexpected ','"},
        {"0:3(1): warning: `x' used uninitialized\n0:%d(7): error: `ay' undeclared\n0:99(1): error: more\n",
         "`ay' undeclared"},
        {"0:%d(12): preprocessor error: wrong\n", "preprocessor error: wrong"},
        {"0(%d) : error C1503: undefined variable \"ay\"\n", "error C1503: undefined variable \"ay\""},
        {"0(3) : warning C7050: \"x\" might be\r\n0(%d) : error C0000: syntax error\r\n", "error C0000: syntax error"},
        {"ERROR: 0:%d: 'ay' : undeclared identifier \nERROR: 1 compilation errors.  No code generated.\n",
         "'ay' : undeclared identifier "},
        {"ERROR: 0:%d: '' :  syntax error\n", "'' :  syntax error"},
        {"Fragment shader failed to compile with the following errors:\nERROR: 0:%d: error(#143) "
         "Undeclared\n",
         "error(#143) Undeclared"},
    };
    Text text;
    char subject[64];
    make_text(&text);
    int line = line_with(text.bytes, statement);
    snprintf(subject, sizeof subject, "%s:%d", file,
             line_with(weft_catalogue_text(file + strlen("shading/")), statement));
    assert_int_not_equal(line, line_with(weft_catalogue_text(file + strlen("shading/")), statement));
    for (size_t k = 0; k < sizeof logs / sizeof logs[0]; k++)
        assert_said(&text, logs[k].form, line, subject, logs[k].words);
    text_free(&text);
}

/* A line of the caller's, no line, no such line, no text: the driver's own words. */
static void log_without_a_line_of_ours_is_unchanged(void **state) {
    (void)state;
    static const char *const logs[] = {"0:%d(7): error: wrong",
                                       "linking with an error at %d",
                                       "no reason to %d",
                                       "0(%d",
                                       "0:%dERROR",
                                       "0:-%d: error",
                                       ""};
    Text text;
    make_text(&text);
    int last = line_with(text.bytes, "float own;");
    for (size_t k = 0; k < sizeof logs / sizeof logs[0]; k++) {
        char words[128];
        static const int places[] = {-1, 0, 1, 2147483647};
        for (int n = 0; n < 6; n++) {
            int line = n < 4 ? places[n] : n == 4 ? last : last + 1;
            snprintf(words, sizeof words, logs[k], line);
            assert_said(&text, logs[k], line, "a test", words);
        }
        snprintf(words, sizeof words, logs[k], 20);
        assert_said(NULL, logs[k], 20, "a test", words);
    }
    text_free(&text);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(line_of_every_driver_is_read),
                                       cmocka_unit_test(log_without_a_line_of_ours_is_unchanged)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
