/* What makes a text read as though it had been written in its language: operators in place of calls, records
 * returned in place of filled, nothing that is written and never read */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "text/passes/native.h"
#include "text/passes/returned.h"
#include "text/passes/spell.h"
#include "text/passes/types.h"
#include "text/passes/unused.h"
#include "text/source/reference.h"

/* The text without the blanks that no one asked about. */
static void assert_words(const char *made, const char *wanted) {
    char *packed = calloc(strlen(made) + 1, 1);
    assert_non_null(packed);
    size_t size = 0;
    for (const char *c = made; *c; c++) {
        bool blank = *c == ' ' || *c == '\n';
        if (!blank || (size && packed[size - 1] != ' ')) packed[size++] = blank ? ' ' : *c;
    }
    while (size && packed[size - 1] == ' ') packed[--size] = 0;
    assert_string_equal(packed, wanted);
    free(packed);
}

static void calls_of_arithmetic_become_operators(void **state) {
    (void)state;
    static const char *const cases[][2] = {
        {"c = rgb_add(a, b);", "c = a + b;"},
        {"c = rgb_scale(rgb_add(a, b), k);", "c = (a + b) * k;"},
        {"c = rgb_add(rgb_scale(a, k), rgb_mul(b, d));", "c = a * k + b * d;"},
        {"c = rgb_scale(a, x - y);", "c = a * (x - y);"},
        {"c = rgb_scale(a, p ? x : y);", "c = a * (p ? x : y);"},
        {"c = rgb_scale(a, f(x + y));", "c = a * f(x + y);"},
        {"c = rgb_scale(a, b * d);", "c = a * (b * d);"},
        {"c = rgb_add(a, b - d);", "c = a + (b - d);"},
        {"c = rgb_add(a - b, d);", "c = a - b + d;"},
        {"c = rgb_scale(a, -k);", "c = a * (-k);"},
        {"x = rgb_add(a, b).r;", "x = (a + b).r;"},
        {"x = dir_scale(a, k).x;", "x = (a * k).x;"},
        {"x = y - dir_dot(o, dir_add(h, i)) / z;", "x = y - dot(o, h + i) / z;"},
        {"c = rgb_mix(rgb_grey(1.0), rgb(r, g, b), t);", "c = mix(Rgb(1.0), Rgb(r, g, b), t);"},
        {"i = dir_mirror(o, h);", "i = reflect(-o, h);"},
        {"i = dir_mirror(dir_add(o, p), h);", "i = reflect(-(o + p), h);"},
        {"c = rgb_min(rgb_scale(a, k), 1.0);", "c = min(a * k, Rgb(1.0));"},
        {"Rgb rgb_add(Rgb a, Rgb b) { return rgb(a.r + b.r, 0.0, 0.0); }",
         "Rgb rgb_add(Rgb a, Rgb b) { return Rgb(a.r + b.r, 0.0, 0.0); }"},
        {"float my_rgb_add(float rgb_add) { return rgb_add; }", "float my_rgb_add(float rgb_add) { return rgb_add; }"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Buffer out = {0};
        native_put(cases[k][0], &out);
        assert_false(out.failed);
        assert_words(out.bytes, cases[k][1]);
        buffer_free(&out);
    }
}

/* Items of a text, of which those are kept that `shade` needs. */
static void cut(const char *text, Items *items) {
    items_cut(text, items);
    assert_false(items->short_of_memory);
    assert_true(items_keep(items, "shade"));
}

static void filled_record_becomes_a_returned_one(void **state) {
    (void)state;
    static const char *const cases[][2] = {
        {"void fill(float x, inout T p) { p.a = x; } float shade(float x) { T p; fill(x, p); return p.a; }",
         "T fill(float x) { T p; p.a = x; return p; } float shade(float x) { T p = fill(x); return p.a; }"},
        {"void fill(float x, inout T p) { p = make(x); } float shade(float x) { T p; fill(x, p); return p.a; "
         "}",
         "T fill(float x) { return make(x); } float shade(float x) { T p = fill(x); return p.a; }"},
        /* what was written before may be read */
        {"void grow(inout T p) { p.a = p.a + 1.0; } float shade() { T p; p.a = 1.0; grow(p); return p.a; }",
         "void grow(inout T p) { p.a = p.a + 1.0; } float shade() { T p; p.a = 1.0; grow(p); return p.a; }"},
        /* another round of a loop may read it */
        {"void most(float v, inout float m) { m = max(m, v); } float shade() { float m; for (int k = 0; k < "
         "3; "
         "k++) { most(v, m); } return m; }",
         "void most(float v, inout float m) { m = max(m, v); } float shade() { float m; for (int k = 0; k < "
         "3; "
         "k++) { most(v, m); } return m; }"},
        /* a part of what a caller fills */
        {"void part(inout U q) { q.b = 1.0; } void fill(inout T p) { p.a = 2.0; part(p.u); } float shade() { "
         "T p; "
         "fill(p); return p.a; }",
         "U part() { U q; q.b = 1.0; return q; } T fill() { T p; p.a = 2.0; p.u = part(); return p; } float "
         "shade() { T p = fill(); return p.a; }"},
        {"void fill(inout T p) { if (x) return; p.a = 1.0; } float shade() { T p; fill(p); return p.a; }",
         "T fill() { T p; if (x) return p; p.a = 1.0; return p; } float shade() { T p = fill(); return p.a; "
         "}"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Items items;
        Buffer out = {0};
        cut(cases[k][0], &items);
        returned_put(&items, cases[k][0], false, &out);
        assert_false(out.failed);
        assert_words(out.bytes, cases[k][1]);
        items_free(&items);
        buffer_free(&out);
    }
}

static void unused_members_are_removed(void **state) {
    (void)state;
    static const char *const whole[] = {"Kept", NULL};
    static const char *const cases[][2] = {
        {"struct T { float a, b; }; float shade() { T t; t.a = 1.0; t.b = 2.0; return t.a; }",
         "struct T { float a; }; float shade() { T t; t.a = 1.0; return t.a; }"},
        {"struct Kept { float a, b; }; float shade() { Kept t; t.a = 1.0; t.b = 2.0; return t.a; }", NULL},
        /* of two records with a member of one name */
        {"struct T { float a, b; }; struct U { float b; }; float shade(U u) { T t; t.a = u.b; t.b = 2.0; "
         "return "
         "t.a; }",
         "struct T { float a; }; struct U { float b; }; float shade(U u) { T t; t.a = u.b; return t.a; }"},
        {"float f(float x, float y, float z) { return x + z; } float shade() { return f(1.0, g(2.0, 3.0), "
         "4.0); }",
         "float f(float x, float z) { return x + z; } float shade() { return f(1.0, 4.0); }"},
        {"float shade(float x, float y) { float a = x, b = x * x; return a; }",
         "float shade(float x, float y) { float a = x; return a; }"},
        {"float shade(float x) { float a = 1.0; a = x; return a; }", "float shade(float x) { float a = x; return a; }"},
        {"float shade(float x) { float a = 1.0; if (x > 0.0) { a = x; } return a; }", NULL},
        {"float shade(float x) { float a = 1.0; a = a + x; return a; }", NULL},
        {"void none(float x) { } float shade(float x) { none(x); return x; }",
         "void none() { } float shade(float x) { return x; }"},
        /* a write that a condition guards stays: nothing else would be its branch */
        {"struct T { float a, b; }; float shade() { T t; t.a = 1.0; if (t.a > 0.0) t.b = 1.0; return t.a; }", NULL},
        /* what a call writes to may be read, whatever becomes of its value */
        {"float bump(inout float y) { y = 2.0; return y; } float shade() { float y = 1.0; float idle = "
         "bump(y); return y; }",
         NULL},
        {"float bump(inout float y) { y = 2.0; return y; } float shade() { float y = 1.0; float idle; idle = "
         "bump(y); return y; }",
         NULL},
        {"float bump(inout float y) { y = 2.0; return y; } float shade() { float y = 1.0; float x = bump(y); "
         "x = 3.0; return x + y; }",
         NULL},
        {"struct T { float a, b; }; float bump(inout T t) { t.a = 2.0; return t.a; } float shade() { T t; "
         "t.b = bump(t); return t.a; }",
         NULL},
        {"float bump(inout float y) { y = 2.0; return y; } float f(float x, float z) { return x; } float "
         "shade() { float y = 1.0; return f(y, bump(y)); }",
         NULL},
        {"float shade(float x) { float a = x; float b = a++; return a; }", NULL},
        {"float shade(float x) { float a = x; float b = a = 2.0; return a; }", NULL},
        {"float shade(float x) { float a = x; float b; b = a = 2.0; return a; }", NULL},
        {"float shade(float x) { bool b = x == 2.0; return x; }", "float shade(float x) { return x; }"},
        /* what is copied whole keeps what is read of the copy */
        {"struct T { float a, b; }; float shade(T t) { T u = t; return u.a + u.b; }", NULL},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Buffer now = {0}, next = {0};
        Items items;
        buffer_put_text(&now, cases[k][0]);
        for (int pass = 0; pass < 9; pass++) {
            cut(now.bytes, &items);
            bool any = unused_cut(&items, now.bytes, whole, &next);
            items_free(&items);
            assert_false(next.failed);
            if (!any) break;
            buffer_free(&now);
            now = next;
            next = (Buffer){0};
        }
        assert_words(now.bytes, cases[k][1] ? cases[k][1] : cases[k][0]);
        buffer_free(&now);
    }
}

/* A list that nothing closes ends with its function. */
static void unclosed_parameter_list_ends_with_its_function(void **state) {
    (void)state;
    static const char text[] = "float shade(float x { return x; } float other() { return 1.0; }";
    Items items;
    const char *body;
    cut(text, &items);
    types_parameters(&items.all[0], &body);
    assert_ptr_equal(body, items.all[0].end);
    items_free(&items);
    Buffer out = {0};
    native_put("c = rgb_add(a", &out);
    assert_false(out.failed);
    buffer_free(&out);
}

static void references_lose_their_marks_in_native_text(void **state) {
    (void)state;
    static const char *const cases[][2] = {
        {"void f(float *m, float v) { if (c) *m = v; else *m = v * *m; }",
         "void f(inout float m, float v) { if (c) m = v; else m = v * m; }"},
        {"void f(float *m) { for (int k = 0; k < (a + 1) * b; k++) *m = (k) * c; while (g(h)) *m = 1.0; }",
         "void f(inout float m) { for (int k = 0; k < (a + 1) * b; k++) m = (k) * c; while (g(h)) m = 1.0; "
         "}"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Buffer source = {0}, out = {0};
        buffer_put_text(&source, cases[k][0]);
        reference_put(&source, &out);
        assert_words(out.bytes, cases[k][1]);
        buffer_free(&source);
        buffer_free(&out);
    }
}

static void pointers_are_written_in_c(void **state) {
    (void)state;
    static const char text[] = "void f(inout float m, float v) { m = v * m; } void shade(inout float v, float "
                               "m) { f(v, m); v = float(1); }";
    Items items;
    Buffer out = {0};
    cut(text, &items);
    spell_items(&(Speller){.language = SPELL_C}, &items, false, &out);
    assert_words(out.bytes, "static inline void f(float *m, float v) { *m = v * *m; } static inline void "
                            "shade(float *v, float m) { f(v, m); *v = (float)(1); }");
    items_free(&items);
    buffer_free(&out);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(calls_of_arithmetic_become_operators),
        cmocka_unit_test(filled_record_becomes_a_returned_one),
        cmocka_unit_test(unused_members_are_removed),
        cmocka_unit_test(unclosed_parameter_list_ends_with_its_function),
        cmocka_unit_test(references_lose_their_marks_in_native_text),
        cmocka_unit_test(pointers_are_written_in_c),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
