/* A function over arrays on the GPU: what goes in comes out, tables are read as they are, errors are one
 * line, and several contexts live beside each other */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <epoxy/egl.h>

#include "raster/frame/compute.h"

static const TextLanguage languages[] = {TEXT_GLSL_330, TEXT_GLSL_ES_300};
enum { LANGUAGES = 2 };

static GlContext *context_or_skip(TextLanguage language) {
    GlContext *context;
    WeftError error = {0};
    if (context_create(language, &context, &error) == WEFT_OK) return context;
    assert_int_equal(error.message, WEFT_MESSAGE_GL_CONTEXT);
    print_message("%s\n", error.text);
    skip();
    return NULL;
}

static WeftResult create(GlContext *context, const char *lines, const char *body, int inputs, int outputs,
                         Compute **out, WeftError *error) {
    Text text;
    text_begin(&text, &(TextDesc){.language = context_language(context), .tables = true});
    text_line(&text, "%s", lines);
    assert_int_equal(text_end(&text, NULL), WEFT_OK);
    WeftResult result = compute_create(
        context, &(ComputeDesc){.name = "a test", .text = &text, .body = body, .inputs = inputs, .outputs = outputs},
        out, error);
    text_free(&text);
    return result;
}

/* Bits that are not a NaN and no denormal come back as they went. */
static float any_float(uint32_t k) {
    uint32_t bits = k * 2654435761u;
    if ((bits >> 23 & 0xff) == 0xff || (bits >> 23 & 0xff) == 0) bits ^= 0x40000000;
    float value;
    memcpy(&value, &bits, 4);
    return value;
}

static void copies_are_exact(TextLanguage language, size_t n) {
    GlContext *context = context_or_skip(language);
    enum { IN = 5, OUT = 7 };
    Compute *compute;
    WeftError error = {0};
    if (create(context, "vec4 same(vec4 v) { return v; }",
               "out0 = same(in0); out1 = in1; out2 = in2; out3 = in3; out4 = in4; out5 = vec4(in0.x, in1.y, "
               "in2.z, in3.w);"
               "out6 = vec4(7.0);",
               IN, OUT, &compute, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    float *in[IN], *out[OUT];
    for (int k = 0; k < IN; k++) {
        in[k] = malloc(16 * n + 1);
        for (size_t s = 0; s < 4 * n; s++) in[k][s] = any_float((uint32_t)(s * IN + (size_t)k));
    }
    for (int k = 0; k < OUT; k++) out[k] = calloc(4 * n + 1, sizeof(float));
    /* twice: less after more uses the same room */
    for (size_t m = n;; m = m / 3) {
        for (int k = 0; k < OUT; k++) memset(out[k], 0, 16 * n);
        if (compute_run(compute, m, (const float *const *)in, out, &error) != WEFT_OK) fail_msg("%s", error.text);
        for (int k = 0; k < 5; k++) assert_memory_equal(in[k], out[k], 16 * m);
        for (size_t s = 0; s < m; s++) {
            for (size_t c = 0; c < 4; c++) {
                assert_memory_equal(&out[5][4 * s + c], &in[c][4 * s + c], 4);
                assert_true(out[6][4 * s + c] == 7.0f);
            }
        }
        for (int k = 0; k < OUT; k++)
            for (size_t s = 4 * m; s < 4 * n; s++) assert_true(out[k][s] == 0.0f); /* nothing behind the end */
        if (m < n) break;
    }
    for (int k = 0; k < IN; k++) free(in[k]);
    for (int k = 0; k < OUT; k++) free(out[k]);
    compute_destroy(compute);
    context_destroy(context);
}

static void compute_returns_its_inputs_exactly(void **state) {
    (void)state;
    static const size_t sizes[] = {1, 1023, 1024, 5000, 1024 * 256, 1024 * 256 + 1500};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
        for (int l = 0; l < LANGUAGES; l++) copies_are_exact(languages[l], sizes[k]);
}

/* Tables of several sizes; a second set replaces the first. */
static void compute_reads_tables_exactly(void **state) {
    (void)state;
    for (int l = 0; l < LANGUAGES; l++) {
        GlContext *context = context_or_skip(languages[l]);
        Compute *compute;
        WeftError error = {0};
        if (create(context, "", "out0.x = texelFetch(weft_tables, ivec3(in0.zyx), 0).r;", 1, 1, &compute, &error) !=
            WEFT_OK)
            fail_msg("%s", error.text);
        static const TextTable sizes[] = {{NULL, 4, 5, NULL}, {NULL, 1, 1, NULL}, {NULL, 2, 9, NULL}};
        enum { TABLES = 3, N = 20 + 1 + 18 };
        float values[N], in[4 * N], out[4 * N];
        const float *const ins[] = {in};
        float *const outs[] = {out};
        for (int round = 0; round < 2; round++) {
            TextTable tables[TABLES];
            int n = 0, count = TABLES - round;
            for (int t = 0; t < count; t++) {
                tables[t] = sizes[t + round];
                tables[t].texels = values + n;
                for (int k = 0; k < tables[t].rows * tables[t].columns; k++, n++) {
                    values[n] = any_float((uint32_t)(n + 100 * round));
                    in[4 * n] = (float)t;
                    in[4 * n + 1] = (float)(k / tables[t].columns);
                    in[4 * n + 2] = (float)(k % tables[t].columns);
                }
            }
            assert_int_equal(compute_tables(compute, tables, count, &error), WEFT_OK);
            assert_int_equal(compute_run(compute, (size_t)n, ins, outs, &error), WEFT_OK);
            for (int k = 0; k < n; k++) assert_memory_equal(&values[k], &out[4 * k], 4);
        }
        assert_int_equal(compute_tables(compute, NULL, 0, &error), WEFT_OK);
        compute_destroy(compute);
        context_destroy(context);
    }
}

static void compute_error_is_one_line(void **state) {
    (void)state;
    for (int l = 0; l < LANGUAGES; l++) {
        GlContext *context = context_or_skip(languages[l]);
        Compute *compute;
        WeftError error = {0};
        assert_int_equal(create(context, "", "out0 = nonsense(in0);", 1, 1, &compute, &error), WEFT_INPUT);
        assert_int_equal(error.message, WEFT_MESSAGE_GL_COMPILE);
        assert_null(compute);
        assert_non_null(strstr(error.text, "nonsense"));
        assert_null(strchr(error.text, '\n'));
        assert_ptr_equal(strstr(error.text, "a test: "), error.text);
        print_message("as expected: %s\n", error.text);
        assert_int_equal(
            create(context, "float missing(float x);", "out0 = vec4(missing(in0.x));", 1, 1, &compute, &error),
            WEFT_INPUT);
        assert_int_equal(error.message, WEFT_MESSAGE_GL_COMPILE);
        static const int wrong[][2] = {{0, 1}, {1, 0}, {COMPUTE_INPUTS_MAX + 1, 1}, {1, COMPUTE_OUTPUTS_MAX + 1}};
        for (int k = 0; k < 4; k++) {
            assert_int_equal(create(context, "", "", wrong[k][0], wrong[k][1], &compute, &error), WEFT_USAGE);
            assert_int_equal(error.message, WEFT_MESSAGE_DESC);
        }
        context_destroy(context);
    }
    GlContext *context;
    WeftError error = {0};
    assert_int_equal(context_create(TEXT_GLSL_450, &context, &error), WEFT_RESOURCES);
    assert_null(context);
}

/* Both languages in one thread, used in turn; what was current stays current; destroying one leaves the
 * others. */
static void two_contexts_compute_side_by_side(void **state) {
    (void)state;
    GlContext *a = context_or_skip(TEXT_GLSL_330), *b = context_or_skip(TEXT_GLSL_ES_300),
              *c = context_or_skip(TEXT_GLSL_330);
    print_message("%s; %s\n", context_driver(a), context_driver(b));
    Compute *twice[3];
    GlContext *const contexts[] = {a, b, c};
    for (int k = 0; k < 3; k++)
        assert_int_equal(create(contexts[k], "", "out0 = 2.0 * in0;", 1, 1, &twice[k], NULL), WEFT_OK);
    float in[4] = {1, 2, 3, 4}, out[4];
    const float *const ins[] = {in};
    float *const outs[] = {out};
    GlOuter nothing, outer;
    assert_true(context_enter(b, &nothing));
    EGLContext current = eglGetCurrentContext();
    for (int round = 0; round < 3; round++)
        for (int k = 0; k < 3; k++) {
            memset(out, 0, sizeof out);
            assert_int_equal(compute_run(twice[k], 1, ins, outs, NULL), WEFT_OK);
            for (int j = 0; j < 4; j++) assert_true(out[j] == 2.0f * in[j]);
            assert_ptr_equal(eglGetCurrentContext(), current);
        }
    assert_true(context_enter(a, &outer));
    assert_ptr_not_equal(eglGetCurrentContext(), current);
    context_leave(a, &outer);
    assert_ptr_equal(eglGetCurrentContext(), current);
    compute_destroy(twice[0]);
    context_destroy(a);
    assert_int_equal(compute_run(twice[2], 1, ins, outs, NULL), WEFT_OK);
    assert_int_equal(compute_run(twice[1], 1, ins, outs, NULL), WEFT_OK);
    context_leave(b, &nothing);
    assert_ptr_equal(eglGetCurrentContext(), EGL_NO_CONTEXT);
    compute_destroy(twice[1]);
    compute_destroy(twice[2]);
    context_destroy(c);
    context_destroy(b);
    compute_destroy(NULL);
    context_destroy(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(compute_returns_its_inputs_exactly),
        cmocka_unit_test(compute_reads_tables_exactly),
        cmocka_unit_test(compute_error_is_one_line),
        cmocka_unit_test(two_contexts_compute_side_by_side),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
