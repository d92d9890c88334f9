/* JSON text after edits: what was not edited stays byte for byte, what was edited is what was meant. */
#include "base/patch.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"

/* Hard to copy: blanks everywhere, escapes, brackets in strings, numbers in many spellings. */
static const char odd[] = " {\n\t\"a\" : [ 1.50 , 2e-1,{ }, [ ] ] ,\r\n  \"b]}\\\"\" :{\"\\u0062\":-0.0,"
                          "\"long\":12345678901234567890.0,\"t\": true }  ,\"c\":null,\"d\":\"x\\\\\" } \n";

static json_t *parse(const char *text) {
    json_error_t error;
    json_t *value = json_loads(text, JSON_DECODE_ANY, &error);
    if (!value) fail_msg("%s: %s", error.text, text);
    return value;
}

/* The patched text, which must mean `now`. */
static char *patched(const char *text, json_t *now) {
    json_t *was = parse(text);
    size_t size = 0;
    char *out = patch_text(text, strlen(text), was, now, &size);
    assert_non_null(out);
    assert_int_equal(size, strlen(out));
    json_t *back = parse(out);
    if (!json_equal(back, now)) fail_msg("%s became %s", text, out);
    json_decref(back);
    json_decref(was);
    return out;
}

static void assert_patched(const char *text, const char *meant, const char *expected) {
    json_t *now = parse(meant);
    char *out = patched(text, now);
    assert_string_equal(out, expected);
    free(out);
    json_decref(now);
}

static void unedited_text_is_unchanged(void **state) {
    (void)state;
    assert_patched(odd, odd, odd);
    assert_patched("[]", "[ ]", "[]");
}

static void edited_text_differs_only_at_the_edit(void **state) {
    (void)state;
    assert_patched("{ \"a\" : 0.10 , \"b\":1e2 }", "{\"a\":0.1,\"b\":7.5}", "{ \"a\" : 0.10 , \"b\":7.5 }");
    assert_patched("{\"a\":[1.0, 2.0 ,3.0],\"b\":[ ]}", "{\"a\":[1.0,2.25,3.0],\"b\":[]}",
                   "{\"a\":[1.0, 2.25 ,3.0],\"b\":[ ]}");
    /* a number that needs all its digits has them */
    assert_patched("[0.5]", "[0.30000000000000004]", "[0.30000000000000004]");
    assert_patched("[0.5]", "[0.1]", "[0.1]");
}

static void added_and_removed_members_keep_the_layout(void **state) {
    (void)state;
    assert_patched("{\n  \"a\": 1,\n  \"b\": 2,\n  \"c\": 3\n}", "{\"b\":2,\"c\":3}", "{\n  \"b\": 2,\n  \"c\": 3\n}");
    assert_patched("{\n  \"a\": 1,\n  \"b\": 2,\n  \"c\": 3\n}", "{\"a\":1,\"c\":3}", "{\n  \"a\": 1,\n  \"c\": 3\n}");
    assert_patched("{\n  \"a\": 1,\n  \"b\": 2\n}", "{\"a\":1}", "{\n  \"a\": 1\n}");
    assert_patched("{\n  \"a\": 1\n}", "{\"a\":1,\"n\":{\"k\":[1,2]}}", "{\n  \"a\": 1,\n  \"n\": {\"k\": [1, 2]}\n}");
    assert_patched("{\"a\":1}", "{\"b\":2}", "{\"b\": 2}");
    assert_patched("{}", "{\"b\":2}", "{\"b\": 2}");
    assert_patched("{\"a\":1}", "{}", "{}");
    assert_patched("[1, 2]", "[1,2,3]", "[1, 2,3]");
    assert_patched("[\n 1,\n 2,\n 3\n]", "[1]", "[\n 1\n]");
    assert_patched("[1]", "[]", "[]");
}

/* Of two members of one name the last counts: so the object is written anew, and means the same. */
static void object_with_a_repeated_name_is_rewritten(void **state) {
    (void)state;
    assert_patched("{\"a\":1,\"a\":2}", "{\"a\":2}", "{\"a\":1,\"a\":2}");
    assert_patched("{\"a\":1,\"a\":2}", "{\"a\":3}", "{\"a\": 3}");
    assert_patched("{\"\\u0061\":1}", "{\"a\":3}", "{\"\\u0061\":3}");
}

/* Something somewhere in the tree is changed, added or removed. */
static json_t *mangled(json_t *value, uint32_t *salt, int depth) {
    static const char *const names[] = {"a", "b", "c", "b]}\"", "new"};
    *salt = hash_combine(*salt, 1);
    unsigned dice = *salt % 8;
    if (depth > 3 || dice == 0) return json_real((double)(*salt % 1000) / 7.0);
    if (dice == 1) return json_pack("{s:[i,s],s:b}", "x", (int)(*salt % 5), "y\n", "z", 1);
    if (json_is_object(value)) {
        const char *name = names[*salt / 8 % 5];
        if (dice == 2)
            json_object_del(value, name);
        else
            json_object_set_new(value, name, mangled(json_object_get(value, name), salt, depth + 1));
    } else if (json_is_array(value)) {
        size_t size = json_array_size(value), k = size ? *salt / 8 % size : 0;
        if (dice == 2 && size)
            json_array_remove(value, k);
        else if (dice == 3 || !size)
            json_array_append_new(value, json_integer(*salt));
        else
            json_array_set_new(value, k, mangled(json_array_get(value, k), salt, depth + 1));
    } else {
        return json_string("other");
    }
    return json_incref(value);
}

static void text_of_any_edit_parses_to_the_edited_value(void **state) {
    (void)state;
    char *text = strdup(odd);
    for (uint32_t round = 0; round < 20000; round++) {
        uint32_t salt = hash_combine(round, 77);
        json_t *was = parse(text), *now = json_deep_copy(was), *top = mangled(now, &salt, 0);
        char *out = patched(text, top);
        free(text);
        text = round % 40 ? out : strdup(odd); /* edits of edits, but not for ever */
        if (text != out) free(out);
        json_decref(top);
        json_decref(now);
        json_decref(was);
    }
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unedited_text_is_unchanged),
        cmocka_unit_test(edited_text_differs_only_at_the_edit),
        cmocka_unit_test(added_and_removed_members_keep_the_layout),
        cmocka_unit_test(object_with_a_repeated_name_is_rewritten),
        cmocka_unit_test(text_of_any_edit_parses_to_the_edited_value),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
