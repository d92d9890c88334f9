/* The dialect's statements and declarations in the syntax of WGSL */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "text/passes/returned.h"
#include "text/passes/wgsl.h"

/* The first item of a text. */
static char *translated(const char *text) {
    Items items;
    Buffer out = {0};
    items_cut(text, &items);
    assert_false(items.short_of_memory);
    assert_int_equal(items.count, 1);
    (items.all[0].kind == ITEM_RECORD ? wgsl_put_members : wgsl_put_function)(&items.all[0], &out);
    assert_false(out.failed);
    items_free(&items);
    free(out.marks);
    return out.bytes;
}

static void functions_are_translated_to_wgsl(void **state) {
    (void)state;
    static const char *const cases[][2] = {
        {"float f(float x, T t) { return x * t.a; }", "fn f(x: float, t: T) -> float { return x * t.a; }"},
        {"void f() { g(); }", "fn f() { g(); }"},
        /* variables: what is written to again, and what is not */
        {"float f() { float a = 1.0, b = a; b = 2.0; return a + b; }",
         "fn f() -> float { let a = 1.0; var b = a; b = 2.0; return a + b; }"},
        {"T f() { T t; t.a = 1.0; return t; }", "fn f() -> T { var t: T; t.a = 1.0; return t; }"},
        {"float f(int k) { float a[4]; a[k] = 1.0; return a[k]; }",
         "fn f(k: int) -> float { var a: array<float, 4>; a[k] = 1.0; return a[k]; }"},
        {"bool f(int a, int b) { bool c = a == b; return c; }",
         "fn f(a: int, b: int) -> bool { let c = a == b; return c; }"},
        {"float f(float x) {\n    float a = x,\n          b = a;\n    return b;\n}",
         "fn f(x: float) -> float {\n    let a = x;\n    let b = a;\n    return b;\n}"},
        /* parameters cannot be written to */
        {"float f(float x, float y) { x = y; return x; }",
         "fn f(x_in: float, y: float) -> float { var x = x_in; x = y; return x; }"},
        {"T f(T t, float x) {\n    t.a = x;\n    return t;\n}",
         "fn f(t_in: T, x: float) -> T {\n    var t = t_in;\n    t.a = x;\n    return t;\n}"},
        /* choices */
        {"float f(bool a) { return a ? 1.0 : 2.0; }", "fn f(a: bool) -> float { return select(2.0, 1.0, a); }"},
        {"float f(int a) { return a < 1 ? 1.0 : a < 2 ? 2.0 : 3.0; }",
         "fn f(a: int) -> float { return select(select(3.0, 2.0, a < 2), 1.0, a < 1); }"},
        {"float f(bool a) { return g(a ? 1.0 : 2.0, 3.0) * (a ? 4.0 : h(a ? 5.0 : 6.0)); }",
         "fn f(a: bool) -> float { return g(select(2.0, 1.0, a), 3.0) * (select(h(select(6.0, 5.0, a)), 4.0, "
         "a)); }"},
        {"float f(bool a) { T t; t.x = a ? 1.0 : 2.0; return t.x; }",
         "fn f(a: bool) -> float { var t: T; t.x = select(2.0, 1.0, a); return t.x; }"},
        {"bool f(bool a, bool b, bool c) { return a && b || c; }",
         "fn f(a: bool, b: bool, c: bool) -> bool { return (a && b) || c; }"},
        {"bool f(bool a, bool b, bool c) { return a && (b || c); }",
         "fn f(a: bool, b: bool, c: bool) -> bool { return a && (b || c); }"},
        /* branches have braces */
        {"float f(bool a) { if (a) return 1.0; return 2.0; }",
         "fn f(a: bool) -> float { if (a) { return 1.0; } return 2.0; }"},
        {"void f(bool a) {\n    if (a)\n        g();\n    else if (!a)\n        h();\n    else {\n        "
         "i();\n    }\n}",
         "fn f(a: bool) {\n    if (a) {\n        g();\n    } else if (!a) {\n        h();\n    } else {\n    "
         "    i();\n    }\n}"},
        {"float f() { float a = 0.0; for (int k = 0; k < 4; k++) a = a + 1.0; return a; }",
         "fn f() -> float { var a = 0.0; for (var k = 0; k < 4; k++) { a = a + 1.0; } return a; }"},
        {"void f(bool a) { while (a) g(); }", "fn f(a: bool) { while (a) { g(); } }"},
        {"float f(int k) { switch (k) { case A: case B: return 1.0; case C: g(); break; default: break; } "
         "return 2.0; }",
         "fn f(k: int) -> float { switch (k) { case A, B: { return 1.0; } case C: { g(); } default: {} } "
         "return 2.0; }"},
        {"float f(int k) { switch (k) { case A: default: return 1.0; } }",
         "fn f(k: int) -> float { switch (k) { case A, default: { return 1.0; } } }"},
        {"float f(int k) { switch (k) { default: case A: return 1.0; } }",
         "fn f(k: int) -> float { switch (k) { case default, A: { return 1.0; } } }"},
        {"int f(int a, int b) { return a | b; }", "fn f(a: int, b: int) -> int { return a | b; }"},
        {"float f(float x) { const float a = x, b = a; return b; }",
         "fn f(x: float) -> float { let a = x; let b = a; return b; }"},
        /* comments stay */
        {"float f() { /* a ? b */ float a = 1.0; /* c */ return a; }",
         "fn f() -> float { /* a ? b */ let a = 1.0; /* c */ return a; }"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char *made = translated(cases[k][0]);
        assert_string_equal(made, cases[k][1]);
        free(made);
    }
}

static void records_are_translated_to_wgsl(void **state) {
    (void)state;
    static const char *const cases[][2] = {
        {"struct T { float a, b; };", "{ a: float, b: float }"},
        {"struct T {\n    float a, b; /* two */\n    U u;\n    float c[N];\n};",
         "{\n    a: float, b: float, /* two */\n    u: U,\n    c: array<float, N>,\n}"},
        {"struct T { float a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z; };",
         "{ a: float, b: float, c: float, d: float, e: float, f: float, g: float, h: float, i: float, j: "
         "float, "
         "k: float, l: float, m: float, n: float, o: float, p: float, q: float, r: float, s: float, t: "
         "float, "
         "u: float, v: float, w: float, x: float, y: float, z: float }"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char *made = translated(cases[k][0]);
        assert_string_equal(made, cases[k][1]);
        free(made);
    }
}

/* Without references a function that writes to one parameter returns it. */
static void parameters_that_are_written_are_returned_in_wgsl(void **state) {
    (void)state;
    static const char *const cases[][2] = {
        {"void grow(inout T p, float x) { p.a = p.a + x; } float shade() { T p; p.a = 1.0; grow(p, 2.0); "
         "return p.a; }",
         "T grow(T p, float x) {\n    p.a = p.a + x;\n    return p;\n} float shade() { T p; p.a = 1.0; p = "
         "grow(p, 2.0); "
         "return p.a; }"},
        {"void part(U u, inout T p) {\n    if (u.x) return;\n    p.a = u.y;\n}\nvoid shade(U u) { V v; v.t.b "
         "= "
         "1.0; "
         "part(u, v.t); use(v); }",
         "T part(U u, T p) {\n    if (u.x) return p;\n    p.a = u.y;\n    return p;\n}\nvoid shade(U u) { V "
         "v; v.t.b = 1.0; "
         "v.t = part(u, v.t); use(v); }"},
        {"void last(inout T p) {\n    p.a = p.a + 1.0;\n    return;\n}\nfloat shade(T q) { last(q); return "
         "q.a; }",
         "T last(T p) {\n    p.a = p.a + 1.0;\n    return p;\n}\nfloat shade(T q) { q = last(q); return q.a; "
         "}"},
        {"void several(inout T p, inout T q) { p = q; } float shade(T p, T q) { several(p, q); return p.a; }", NULL},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Items items;
        Buffer out = {0};
        items_cut(cases[k][0], &items);
        assert_true(items_keep(&items, "shade"));
        returned_put(&items, cases[k][0], true, &out);
        assert_false(out.failed);
        assert_string_equal(out.bytes, cases[k][1] ? cases[k][1] : cases[k][0]);
        assert_non_null(wgsl_lacks(&items.all[0]));
        items_free(&items);
        buffer_free(&out);
    }
}

static void text_without_a_wgsl_form_is_refused(void **state) {
    (void)state;
    static const struct {
        const char *text, *part;
    } cases[] = {
        {"void f(inout T p, inout T q) { p = q; }", "several"},
        {"float f(inout float p) { p = 1.0; return p; }", "returns something"},
        {"void f(int k) { do { g(); } while (k > 0); }", "do"},
        {"void f(int k) { switch (k) { case 0: g(); case 1: h(); break; } }", "neither"},
        {"void f(int k) { switch (k) { case 0: if (g()) { break; } case 1: h(); break; } }", "neither"},
        {"void f(int k) { switch (k) { case 0: { g(); break; } case 1: h(); } }", NULL},
        {"void f(int k) { switch (k) { case 0: if (k > a) return; else { g(); break; } case 1: h(); } }", NULL},
        {"void f(int k) { switch (k) { case 0: if (k > a) return; else g(); case 1: h(); } }", "neither"},
        {"void f(int k) { switch (k) { case 0: if (k > a) return; case 1: h(); } }", "neither"},
        {"void f(int k) { switch (k) { case 0: for (;;) { break; } case 1: h(); } }", "neither"},
        {"void f(int k) { switch (k) { case 0: case 1: if (k > a) return; else if (k > b) break; else "
         "return; "
         "default: h(); } }",
         NULL},
        {"float f(int k) { switch (k) { case 0: return k > 1 ? a : b; default: break; } return c; }", NULL},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Items items;
        items_cut(cases[k].text, &items);
        const char *lack = wgsl_lacks(&items.all[0]);
        if (!cases[k].part)
            assert_null(lack);
        else if (!lack || !strstr(lack, cases[k].part))
            fail_msg("%s: %s", cases[k].text, lack ? lack : "nothing");
        items_free(&items);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(functions_are_translated_to_wgsl),
        cmocka_unit_test(records_are_translated_to_wgsl),
        cmocka_unit_test(parameters_that_are_written_are_returned_in_wgsl),
        cmocka_unit_test(text_without_a_wgsl_form_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
