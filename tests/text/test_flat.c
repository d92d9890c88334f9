/* A flat text draws what its text draws: calls, records, loops and jumps of every kind that shading text has. Where all
 * numbers are constant the flat text is the answer itself. What is not understood is refused with its name, and no
 * piece of a text is dangerous. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "text/assemble/dispatch.h"
#include "text/flat/flatten.h"

#define HEAD "#version 330 core\n"
#define OUT  "out highp vec4 fragment;\n"

static void flatten(const char *text, Buffer *out) {
    FlattenGap gap = {""};
    *out = (Buffer){0};
    if (!flatten_text(text, out, &gap)) fail_msg("%s\n%s", gap.what, text);
}

/* Asserts that main does nothing but set the output to `answer`. */
static void expect_answer(const char *declarations, const char *body, const char *answer) {
    char text[4096], expected[512];
    Buffer out;
    snprintf(text, sizeof text, HEAD OUT "%s\nvoid main() {\n%s\n}\n", declarations, body);
    snprintf(expected, sizeof expected, HEAD "\n" OUT "void main() {\n fragment = %s;\n}\n", answer);
    flatten(text, &out);
    const char *main_of = strstr(out.bytes, "void main"), *main_expected = strstr(expected, "void main");
    assert_string_equal(main_of, main_expected);
    buffer_free(&out);
}

static void records_and_calls_are_followed(void **state) {
    (void)state;
    expect_answer("struct Pair { float a, b; };\n"
                  "void twice(inout Pair p) { p.a = 2.0 * p.a; p.b += p.a; }\n"
                  "float sum(Pair p) { p.a = p.a + 1.0; return p.a + p.b; }",
                  "Pair p = Pair(1.0, 3.0), q;\nq = p;\ntwice(p);\nfragment = vec4(sum(p), p.a, p.b, q.b);",
                  "vec4(8.0, 2.0, 5.0, 3.0)");
    expect_answer("struct In { float x[3]; };\nstruct Out { In a; vec2 v; };\n"
                  "In filled(float by) { In m; for (int k = 0; k < 3; k++) m.x[k] = by * float(k); return m; }",
                  "Out o;\no.a = filled(2.0);\no.v = vec2(1.0);\no.v.y = o.a.x[2];\n"
                  "fragment = vec4(o.a.x[1], o.v.yx, o.v.x);",
                  "vec4(2.0, 4.0, 1.0, 1.0)");
    expect_answer(
        "float taken(inout int k) { return float(k++); }",
        "int k = 3;\nfloat a = taken(k), b = float(++k), c = float(k--);\nfragment = vec4(a, b, c, float(k));",
        "vec4(3.0, 5.0, 5.0, 4.0)");
    expect_answer("const int N = 2, M = N * 3;\nfloat more = 1.0;\nfloat next() { more += 1.0; return more; }",
                  "float a = next(), b = next();\nfragment = vec4(a, b, more, float(M));", "vec4(2.0, 3.0, 3.0, 6.0)");
}

static void jumps_skip_what_they_skip(void **state) {
    (void)state;
    expect_answer("float f(int k) { if (k > 2) return 1.0; if (k > 1) { return 2.0; } else if (k < 0) return 4.0; "
                  "return 3.0; }",
                  "fragment = vec4(f(3), f(2), f(1), f(-1));", "vec4(1.0, 2.0, 3.0, 4.0)");
    expect_answer("float sum(int n) { float s = 0.0; for (int k = 0; k < 6; k++) { if (k == 1) continue; "
                  "if (k == n) break; s += float(k); } return s; }\n"
                  "float first(int n) { for (int k = 0; k < 6; k++) if (k * k > n) return float(k); return -1.0; }",
                  "fragment = vec4(sum(4), sum(9), first(7), first(70));", "vec4(5.0, 14.0, 3.0, -1.0)");
    expect_answer("float of(int k) { float x = 0.5; switch (k) { case 1: x = 1.0; break; case 2: case 3: return 2.0; "
                  "default: x = 7.0; break; } return x; }",
                  "fragment = vec4(of(1), of(2), of(3), of(4));", "vec4(1.0, 2.0, 2.0, 7.0)");
    expect_answer("float count = 0.0;\nbool seen(bool x) { count += 1.0; return x; }",
                  "bool a = seen(false) && seen(true), b = seen(true) || seen(false);\n"
                  "fragment = vec4(count, a ? 1.0 : 0.0, b ? seen(true) ? 3.0 : 4.0 : 5.0, count);",
                  "vec4(2.0, 0.0, 3.0, 3.0)");
}

static void expect_in(const char *text, const char *const *there, const char *const *gone) {
    Buffer out;
    flatten(text, &out);
    for (; *there; there++)
        if (!strstr(out.bytes, *there)) fail_msg("%s is missing in\n%s", *there, out.bytes);
    for (; *gone; gone++)
        if (strstr(out.bytes, *gone)) fail_msg("%s is left in\n%s", *gone, out.bytes);
    buffer_free(&out);
}

static void flat_text_lacks_what_is_not_needed(void **state) {
    (void)state;
    expect_in(HEAD "layout(std140) uniform Numbers {\n highp vec4 a, b;\n highp vec4 rows[2 * 3];\n};\n"
                   "layout(std140) uniform Others { highp vec4 z; };\n"
                   "uniform highp sampler2D used, dead;\nin highp vec2 place;\nin highp vec2 nowhere;\n" OUT
                   "struct Pair { vec4 x, y; };\n"
                   "Pair pair() { return Pair(texture(used, place), texture(dead, nowhere) * z); }\n"
                   "void main() {\n float zero = 0.0;\n Pair p = pair();\n"
                   " if (zero > 0.0) discard;\n fragment = p.x * a + rows[5] + zero * p.y;\n}\n",
              (const char *const[]){"uniform Numbers {", "vec4 b;", "rows[6];", "texture(used, place)", NULL},
              (const char *const[]){"Others", "dead", "nowhere", "struct", "pair", "discard", "if (", NULL});
}

static void equal_values_are_computed_once_and_outside_loops(void **state) {
    (void)state;
    Buffer out;
    flatten(HEAD "uniform highp vec4 u;\nuniform int n;\n" OUT "float f(float x) { return exp(x) + 1.0; }\n"
                 "void main() {\n float s = 0.0;\n for (int k = 0; k < n; k++) s += f(u.x) * float(k);\n"
                 " fragment = vec4(s, f(u.x), 0.0, 1.0);\n}\n",
            &out);
    const char *once = strstr(out.bytes, "exp("), *loop = strstr(out.bytes, "for (");
    assert_non_null(once);
    assert_non_null(loop);
    assert_true(once < loop);
    assert_null(strstr(once + 1, "exp("));
    buffer_free(&out);
}

/* A derivative or a look-up with one belongs to the place where all pixels are. */
static void derivatives_stay_where_they_are(void **state) {
    (void)state;
    Buffer out;
    flatten(HEAD
            "uniform highp sampler2D map;\nin highp vec2 at;\nin highp float x;\n" OUT
            "void main() {\n vec4 t = texture(map, at);\n vec4 c = vec4(0.0);\n"
            " if (x > 0.5) { for (int k = 0; k < 9; k++) { c += exp(t * float(k)) * textureLod(map, at, 2.0); } }\n"
            " fragment = c;\n}\n",
            &out);
    const char *look = strstr(out.bytes, "texture(map"), *branch = strstr(out.bytes, "if (x > 0.5)");
    assert_non_null(look);
    assert_non_null(branch);
    assert_true(look < branch);
    buffer_free(&out);
}

static void gap_is_named(void **state) {
    (void)state;
    static const struct {
        const char *declarations, *body, *gap;
    } cases[] = {
        {"", "fragment = vec4(unheard_of(1.0));", "a function: unheard_of"},
        {"", "fragment = vec4(nothing);", "a name: nothing"},
        {"", "fragment = vec4(2 * 1.5);", "an operator between these types"},
        {"", "float x = 1;\nfragment = vec4(x);", "an assignment of another type"},
        {"struct A { float x; };\nuniform bool b;", "A p = A(1.0), q = A(2.0), r = b ? p : q;\nfragment = vec4(r.x);",
         "?: between records"},
        {"struct A { float x; };\nuniform A a;", "fragment = vec4(a.x);", "a record from outside: a"},
        {"struct A { float x; };\nuniform B { A a[2]; };", "fragment = vec4(a[1].x);", "a record from outside: a"},
        {"float f(float x) { return f(x); }", "fragment = vec4(f(1.0));", "a call with other arguments: f"},
        {"uniform int n;", "switch (n) { case 1: fragment = vec4(1.0); case 2: fragment = vec4(2.0); break; }",
         "a case that runs into the next"},
        {"", "fragment = vec4(1.0, 2.0);", "a value of other parts"},
        {"", "fragment = vec4(0.0)", "a mark is missing"}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        char text[1024];
        Buffer out = {0};
        FlattenGap gap = {""};
        snprintf(text, sizeof text, HEAD OUT "%s\nvoid main() {\n%s\n}\n", cases[k].declarations, cases[k].body);
        assert_false(flatten_text(text, &out, &gap));
        assert_string_equal(gap.what, cases[k].gap);
        assert_int_equal(out.size, 0);
        buffer_free(&out);
    }
}

/* A text cut off anywhere, or with a character changed, is flattened or refused. */
static void pieces_do_no_harm(void **state) {
    (void)state;
    Text text;
    const int ids[] = {LOBE_GGX, LOBE_CHARLIE_NEUBELT, LOBE_LAMBERT};
    text_begin(&text, &(TextDesc){.language = TEXT_GLSL_330, .tables = true});
    text_dispatch(&text, ids, 3);
    text_line(&text, "in highp vec3 a, b;\nout highp vec4 fragment;\nuniform int which;\nvoid main() {\n"
                     "    Angles p = angles_between(dir(a.x, a.y, a.z), dir(b.x, b.y, b.z));\n"
                     "    fragment = vec4(lobe_f(lobe_rough(which, a.x), p));\n}");
    assert_int_equal(text_end(&text, NULL), WEFT_OK);
    Buffer whole;
    flatten(text.bytes, &whole);
    assert_non_null(strstr(whole.bytes, "fragment = "));
    buffer_free(&whole);
    char *copy = malloc(text.size + 1);
    assert_non_null(copy);
    static const char marks[] = "({[;,.=x0 ";
    for (size_t k = 0, count = 400; k < count; k++) {
        const size_t at = text.size * k / count;
        Buffer out = {0};
        memcpy(copy, text.bytes, text.size + 1);
        if (k % 2)
            copy[at] = '\0';
        else
            copy[at] = marks[k % (sizeof marks - 1)];
        flatten_text(copy, &out, NULL);
        buffer_free(&out);
    }
    free(copy);
    text_free(&text);
}

static void deep_texts_are_refused_long_ones_are_not(void **state) {
    (void)state;
    enum { DEPTH = 100000 };
    char *text = malloc(16 * DEPTH + 256);
    assert_non_null(text);
    static const char marks[] = "(-!{";
    for (int kind = 0; kind < 5; kind++) {
        Buffer out = {0};
        char *to = text + sprintf(text, HEAD OUT "uniform highp float u;\nvoid main() {\nfloat x = u;\n");
        if (kind < 4) {
            to += sprintf(to, kind < 3 ? "x = " : "");
            memset(to, marks[kind], DEPTH);
            strcpy(to + DEPTH, "u;\n}\n");
        } else {
            for (int k = 0; k < DEPTH / 4; k++) to += sprintf(to, "x = x * x + u;\n");
            strcpy(to, "fragment = vec4(x);\n}\n");
        }
        assert_int_equal(flatten_text(text, &out, NULL), kind == 4);
        buffer_free(&out);
    }
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(records_and_calls_are_followed),
                                       cmocka_unit_test(jumps_skip_what_they_skip),
                                       cmocka_unit_test(flat_text_lacks_what_is_not_needed),
                                       cmocka_unit_test(equal_values_are_computed_once_and_outside_loops),
                                       cmocka_unit_test(derivatives_stay_where_they_are),
                                       cmocka_unit_test(gap_is_named),
                                       cmocka_unit_test(pieces_do_no_harm),
                                       cmocka_unit_test(deep_texts_are_refused_long_ones_are_not)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
