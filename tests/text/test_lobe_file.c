/* weft_lobe_load: lobes that come, change while others use them, and are too many */
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "scratch.h"
#include "weft/arrays.h"
#include "weft/lobe.h"

static char folder[SCRATCH_SIZE];

static int begin(void **state) {
    (void)state;
    return scratch_cache(folder) && chdir(folder) == 0 ? 0 : -1;
}

static int end(void **state) {
    (void)state;
    return scratch_remove(folder) ? 0 : -1;
}

/* A Lambert that is so bright. In its text @ is the record, $ the name. */
static void write_lobe(const char *name, const char *bright) {
    static const char form[] =
        "#include \"shading/lobe/lobe.h\"\n#include \"shading/dialect/warp.h\"\n"
        "#define @_PARAMS(P) P(float, level, BRIGHT, 0.0f, 9.0f, 0.0f, 9.0f, \"how bright it is\")\n"
        "#define @_TRAITS TRAIT_RECIPROCAL\n"
        "STRUCT(@){@_PARAMS(FIELD)};\nPREPARED_AS_IT_IS($, @)\nSEEN_AS_IT_IS($, @)\n"
        "FN LobeValue $_value(const @Prepared *p, const @View *w, Angles a) {\n"
        "    return lobe_value_of(BRIGHT * p->m.level, 0.0f, warp_cosine_pdf(a.i));\n}\n"
        "FN Dir $_sample(const @Prepared *p, const @View *w, Dir o, float u, float v) {\n"
        "    return warp_cosine(u, v);\n}\n";
    char file[32];
    snprintf(file, sizeof file, "%s.h", name);
    FILE *stream = fopen(file, "wb");
    assert_non_null(stream);
    fprintf(stream, "#define BRIGHT %s\n", bright);
    for (const char *c = form; *c; c++) fputc(*c == '@' ? name[0] - 'a' + 'A' : *c == '$' ? name[0] : *c, stream);
    assert_int_equal(fclose(stream), 0);
}

static int load(const char *file) {
    WeftError error;
    int lobe = -1;
    if (weft_lobe_load(file, &lobe, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return lobe;
}

static float value_of(int index) {
    static const float up[3] = {0.0f, 0.0f, 1.0f};
    WeftLobe lobe = {.lobe = index, .params = {1.0f}, .f0 = {1.0f, 1.0f, 1.0f}};
    float f[3];
    weft_lobe_eval(&lobe, up, up, f);
    return f[0];
}

static bool is(float x, float y) { return !(x < y) && !(x > y); }

static void lobe_file_of_a_loaded_name_replaces_it(void **state) {
    (void)state;
    int before = weft_lobe_count();
    assert_null(weft_lobe_info(before));
    write_lobe("a", "1.0f");
    int a = load("a.h");
    const WeftLobeInfo *info = weft_lobe_info(a);
    assert_int_equal(a, before);
    assert_int_equal(weft_lobe_count(), before + 1);
    assert_int_equal(weft_lobe_find("a"), a);
    assert_string_equal(info->id, "a");
    assert_true(is(value_of(a), 1.0f) && is(info->params[0].def, 1.0f));
    write_lobe("a", "2.0f");
    assert_int_equal(load("a.h"), a);
    assert_true(is(value_of(a), 2.0f) && is(weft_lobe_info(a)->params[0].def, 2.0f));
    assert_true(is(info->params[0].def, 1.0f)); /* as it was */
    assert_non_null(strstr(weft_catalogue_text("lobes/a.h"), "2.0f"));

    WeftError error;
    FILE *stream = fopen("a.h", "ab");
    assert_non_null(stream);
    assert_true(fputs("nonsense\n", stream) >= 0);
    assert_int_equal(fclose(stream), 0);
    assert_int_equal(weft_lobe_load("a.h", NULL, NULL, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_LOBE_COMPILE);
    assert_true(is(value_of(a), 2.0f)); /* what there was stays */
}

typedef struct User {
    int lobe;
    atomic_bool stop;
    long asked, wrong;
} User;

static void *ask(void *user) {
    User *self = user;
    while (!atomic_load(&self->stop)) {
        float f = value_of(self->lobe);
        self->asked++;
        self->wrong += !is(f, 3.0f) && !is(f, 4.0f);
    }
    return NULL;
}

static void lobe_file_in_use_may_be_replaced(void **state) {
    (void)state;
    write_lobe("b", "3.0f");
    User user = {.lobe = load("b.h")};
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, ask, &user), 0);
    for (int k = 0; k < 20; k++) {
        write_lobe("b", k & 1 ? "3.0f" : "4.0f"); /* compiled twice, then in the cache */
        load("b.h");
    }
    atomic_store(&user.stop, true);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_true(user.asked > 0);
    assert_int_equal(user.wrong, 0);
}

static void ninth_lobe_file_is_refused(void **state) {
    (void)state;
    char name[2] = "c", file[8];
    for (; name[0] < 'i'; name[0]++) {
        write_lobe(name, "1.0f");
        snprintf(file, sizeof file, "%s.h", name);
        load(file);
    }
    WeftError error;
    int count = weft_lobe_count();
    write_lobe("i", "1.0f");
    assert_int_equal(weft_lobe_load("i.h", NULL, NULL, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_LOBE_FILE);
    assert_non_null(strstr(error.text, "there are 8 already"));
    assert_int_equal(weft_lobe_count(), count);
    assert_true(is(value_of(count), 0.0f)); /* no lobe, no light */
}

/* The loops of a lobe from outside take parameters and colours of each element, as those of the list. */
static void element_loops_of_a_lobe_file_take_own_parameters(void **state) {
    (void)state;
    enum { N = 75 };
    float o[3][N], i[3][N], u[N], v[N], level[N], red[N], f[N], pdf[N], drawn[3][N];
    WeftError error;
    write_lobe("a", "1.0f");
    WeftLobes lobes = {.lobe = {.lobe = load("a.h"), .params = {1.0f}}, .params = {level}, .f0 = {red}};
    for (int k = 0; k < N; k++) {
        const float z = 0.1f + 0.01f * (float)k, x = 1.0f - z;
        o[0][k] = 0.6f, o[1][k] = 0.0f, o[2][k] = 0.8f;
        i[0][k] = x, i[1][k] = -x, i[2][k] = z;
        u[k] = (float)k / N, v[k] = 1.0f - z, level[k] = 0.1f * (float)k, red[k] = z;
    }
    const WeftDirections wo = {o[0], o[1], o[2]}, wi = {i[0], i[1], i[2]};
    assert_int_equal(weft_eval_each(&lobes, N, wo, wi, (WeftColors){f, NULL, NULL}, pdf, &error), WEFT_OK);
    for (int k = 0; k < N; k++) {
        const float a[3] = {o[0][k], o[1][k], o[2][k]}, b[3] = {i[0][k], i[1][k], i[2][k]};
        assert_float_equal(f[k], level[k] * red[k], 1e-6f);
        assert_float_equal(pdf[k], weft_lobe_pdf(&lobes.lobe, a, b), 1e-6f);
    }
    assert_int_equal(weft_sample_each(&lobes, N, wo, u, v, drawn[0], drawn[1], drawn[2], pdf, &error), WEFT_OK);
    for (int k = 0; k < N; k++) {
        const float a[3] = {o[0][k], o[1][k], o[2][k]}, at[2] = {u[k], v[k]};
        float b[3];
        weft_lobe_sample(&lobes.lobe, a, at, b);
        for (int c = 0; c < 3; c++) assert_float_equal(drawn[c][k], b[c], 1e-5f);
    }
}

static void on_warning(void *user, WeftMessage message, const char *text) {
    (void)text;
    *(int *)user += message == WEFT_MESSAGE_CACHE_IGNORED;
}

static void cache_that_cannot_keep_a_lobe_is_a_warning(void **state) {
    (void)state;
    int count = 0;
    const WeftLog log = {on_warning, &count};
    WeftError error;
    write_lobe("a", "3.0f");
    assert_int_equal(weft_lobe_load("a.h", NULL, &log, &error), WEFT_OK);
    assert_int_equal(count, 0);
    setenv("XDG_CACHE_HOME", "/dev/null", 1);
    assert_int_equal(weft_lobe_load("a.h", NULL, &log, &error), WEFT_OK);
    setenv("XDG_CACHE_HOME", folder, 1);
    assert_int_equal(count, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobe_file_of_a_loaded_name_replaces_it), cmocka_unit_test(lobe_file_in_use_may_be_replaced),
        cmocka_unit_test(element_loops_of_a_lobe_file_take_own_parameters),
        cmocka_unit_test(cache_that_cannot_keep_a_lobe_is_a_warning), cmocka_unit_test(ninth_lobe_file_is_refused)};
    return cmocka_run_group_tests(tests, begin, end);
}
