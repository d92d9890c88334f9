/* docs/ says what the program says. */
#include "run.h"

static void pages_hold_the_output_of_their_commands(void **state) {
    (void)state;
    Ran ran =
        program_end(program_start("/bin/sh", NULL, LIST(WEFT_SOURCE_DIR "/script/docs", "--check", WEFT_PROGRAM)));
    if (ran.code != 0) fail_msg("script/docs --check: %d\n%s%s", ran.code, ran.out, ran.err);
    ran_free(&ran);
}

/* A check that could not fail would be none: another program's words must be noticed. */
static void changed_block_of_a_page_is_noticed(void **state) {
    (void)state;
    Ran ran = program_end(program_start("/bin/sh", NULL, LIST(WEFT_SOURCE_DIR "/script/docs", "--check", "/bin/echo")));
    assert_int_equal(ran.code, 1);
    assert_non_null(strstr(ran.out, "docs/cli.md"));
    ran_free(&ran);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(pages_hold_the_output_of_their_commands),
                                       cmocka_unit_test(changed_block_of_a_page_is_noticed)};
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
