/* JSON that is read while memory runs out */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/json.h"

static long allowed; /* so many allocations are granted, then one is refused */

static void *allocate(size_t size) { return allowed-- == 0 ? NULL : malloc(size); }

static const char text[] = "{\"a name of more than sixteen bytes\": [1, 2.5, \"text of more than sixteen bytes\"]}";

static json_t *parse(bool *starved) {
    json_error_t where;
    return json_parse(text, sizeof text - 1, 0, &where, starved);
}

/* Also where a number behind what was lost clears errno. */
static void parse_without_memory_is_reported(void **state) {
    (void)state;
    bool starved = false;
    allowed = -1;
    json_t *whole = parse(&starved);
    assert_non_null(whole);
    assert_false(starved);
    long tried = 0;
    for (starved = true; starved; tried++) {
        allowed = tried;
        json_t *root = parse(&starved);
        assert_true(starved ? root == NULL : json_equal(root, whole));
        json_decref(root);
        assert_true(tried < 1000);
    }
    assert_true(tried > 10);
    allowed = -1;
    json_decref(whole);
}

static void damaged_text_is_not_reported_as_lack_of_memory(void **state) {
    (void)state;
    json_error_t where;
    bool starved = true;
    assert_null(json_parse("{\"a\": ", 6, 0, &where, &starved));
    assert_false(starved);
}

int main(void) {
    json_set_alloc_funcs(allocate, free); /* as a program may that has its own */
    allowed = -1;
    const struct CMUnitTest tests[] = {cmocka_unit_test(parse_without_memory_is_reported),
                                       cmocka_unit_test(damaged_text_is_not_reported_as_lack_of_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
