/* The calls of weft/arrays.h: the same bits whatever the count, the alignment and the thread, and near the
 * calls for one pair */
#include <pthread.h>

#include "cases.h"
#include "weft/arrays.h"

enum { N = 1100, ROOM = N + 8 }; /* more than two blocks, and a rest */

typedef struct Questions {
    float o[3][ROOM], i[3][ROOM], u[ROOM], v[ROOM];
} Questions;

typedef struct Answers {
    float f[3][ROOM], pdf[ROOM], wi[3][ROOM], drawn[ROOM];
} Answers;

static Questions questions;

static void questions_make(void) {
    Random random = {21};
    for (int k = 0; k < ROOM; k++) {
        Dir o = random_direction(&random), i = random_direction(&random);
        if (k % 7 == 0) i = dir(-o.x, -o.y, o.z);
        if (k % 11 == 0) i.z = -i.z;
        if (k % 13 == 0) o = dir(1.0f, 0.0f, 0.0f);
        questions.o[0][k] = o.x, questions.o[1][k] = o.y, questions.o[2][k] = o.z;
        questions.i[0][k] = i.x, questions.i[1][k] = i.y, questions.i[2][k] = i.z;
        questions.u[k] = random_unit(&random), questions.v[k] = random_unit(&random);
    }
}

static WeftDirections at(float w[3][ROOM], size_t k) { return (WeftDirections){w[0] + k, w[1] + k, w[2] + k}; }

/* Asks questions [first, first + n) with arrays that begin `shift` floats on. */
static void ask(const WeftLobe *lobe, Questions *q, size_t first, size_t n, size_t shift, Answers *to) {
    Answers *a = malloc(sizeof *a);
    assert_non_null(a);
    memset(a, 0x55, sizeof *a);
    WeftColors f = {a->f[0] + shift, a->f[1] + shift, a->f[2] + shift};
    assert_int_equal(weft_eval_n(lobe, n, at(q->o, first), at(q->i, first), f, NULL), WEFT_OK);
    assert_int_equal(weft_pdf_n(lobe, n, at(q->o, first), at(q->i, first), a->pdf + shift, NULL), WEFT_OK);
    assert_int_equal(weft_sample_n(lobe, n, at(q->o, first), q->u + first, q->v + first, a->wi[0] + shift,
                                   a->wi[1] + shift, a->wi[2] + shift, a->drawn + shift, NULL),
                     WEFT_OK);
    float(*from)[ROOM] = a->f, (*into)[ROOM] = to->f; /* all eight arrays of each */
    uint32_t untouched;
    for (size_t k = 0; k < sizeof *a / sizeof *from; k++) {
        memcpy(into[k] + first, from[k] + shift, n * sizeof(float));
        memcpy(&untouched, from[k] + shift + n, sizeof untouched);
        assert_int_equal(untouched, 0x55555555u);
    }
    free(a);
}

static WeftLobe public_lobe(const Lobe *lobe) {
    WeftLobe p = {.lobe = lobe->id, .f0 = {0.04f, 0.5f, 1.0f}, .f90 = {1.0f, 0.9f, 0.0f}};
    memcpy(p.params, lobe->params, sizeof p.params);
    return p;
}

static void assert_same(const Answers *a, const Answers *b, size_t n, const char *name) {
    const float(*x)[ROOM] = a->f, (*y)[ROOM] = b->f;
    for (size_t k = 0; k < sizeof *a / sizeof *x; k++)
        if (memcmp(x[k], y[k], n * sizeof(float)) != 0) fail_msg("%s: array %d differs", name, (int)k);
}

/* ---- threads: first, so that they meet where the tables are made ----------------------------------- */

typedef struct Asker {
    size_t shift;
    Answers answers[32]; /* one a lobe */
} Asker;

static void *ask_all(void *user) {
    Asker *asker = user;
    for (int id = 0; id < weft_lobe_count(); id++) {
        WeftLobe lobe;
        assert_int_equal(weft_lobe_init(weft_lobe_info(id)->id, &lobe, NULL), WEFT_OK);
        ask(&lobe, &questions, 0, N, asker->shift, &asker->answers[id]);
    }
    return NULL;
}

static void arrays_from_several_threads_agree(void **state) {
    (void)state;
    enum { THREADS = 4 };
    assert_true(weft_lobe_count() <= 32);
    Asker *askers = calloc(THREADS, sizeof *askers);
    assert_non_null(askers);
    pthread_t threads[THREADS];
    for (size_t k = 0; k < THREADS; k++) {
        askers[k].shift = k;
        assert_int_equal(pthread_create(&threads[k], NULL, ask_all, &askers[k]), 0);
    }
    for (int k = 0; k < THREADS; k++) pthread_join(threads[k], NULL);
    for (int k = 1; k < THREADS; k++)
        for (int id = 0; id < weft_lobe_count(); id++)
            assert_same(&askers[0].answers[id], &askers[k].answers[id], N, weft_lobe_info(id)->id);
    free(askers);
}

/* ---- pieces ---------------------------------------------------------------------------------------- */

static void array_element_does_not_depend_on_its_neighbours(void **state) {
    (void)state;
    static Answers whole, pieces;
    Random random = {22};
    for (int id = 0; id < weft_lobe_count(); id++)
        for (int c = 0; c < case_count(id); c++) {
            Lobe inner = case_lobe(id, c);
            WeftLobe lobe = public_lobe(&inner);
            const char *name = case_name(&inner, dir(0.0f, 0.0f, 1.0f)).text;
            ask(&lobe, &questions, 0, N, 0, &whole);
            if (c == 0) /* every count, every place of a vector */
                for (size_t n = 0; n <= 70; n++) {
                    ask(&lobe, &questions, n % 17, n, n % 5, &pieces);
                    for (size_t k = 0; k < 3; k++)
                        assert_memory_equal(pieces.f[k] + n % 17, whole.f[k] + n % 17, n * sizeof(float));
                    assert_memory_equal(pieces.pdf + n % 17, whole.pdf + n % 17, n * sizeof(float));
                    assert_memory_equal(pieces.wi[2] + n % 17, whole.wi[2] + n % 17, n * sizeof(float));
                }
            for (size_t first = 0; first < N;) {
                size_t n = 1 + random_bits(&random) % (random_bits(&random) % 2 ? 700 : 90);
                n = n < N - first ? n : N - first;
                ask(&lobe, &questions, first, n, random_bits(&random) % 8, &pieces);
                first += n;
            }
            assert_same(&whole, &pieces, N, name);
        }
}

/* ---- one pair at a time ---------------------------------------------------------------------------- */

static bool near(float a, float b) { return fabsf(a - b) <= 3e-5f * fabsf(b) + 1e-7f; }

static void arrays_agree_with_calls_for_one_pair(void **state) {
    (void)state;
    static Answers a;
    for (int id = 0; id < weft_lobe_count(); id++)
        for (int c = 0; c < case_count(id); c++) {
            Lobe inner = case_lobe(id, c);
            WeftLobe lobe = public_lobe(&inner);
            ask(&lobe, &questions, 0, N, 0, &a);
            for (int k = 0; k < N; k++) {
                const Questions *q = &questions;
                float wo[3] = {q->o[0][k], q->o[1][k], q->o[2][k]}, u[2] = {q->u[k], q->v[k]};
                float wi[3] = {q->i[0][k], q->i[1][k], q->i[2][k]}, f[3];
                weft_lobe_eval(&lobe, wo, wi, f);
                float pdf = weft_lobe_pdf(&lobe, wo, wi), drawn = weft_lobe_sample(&lobe, wo, u, wi);
                bool same = near(a.pdf[k], pdf) && near(a.drawn[k], drawn);
                for (int d = 0; d < 3; d++) same = same && near(a.f[d][k], f[d]);
                for (int d = 0; d < 3 && drawn > 0.0f; d++) same = same && near(a.wi[d][k], wi[d]);
                if (!same)
                    fail_msg("%s: f %.9g pdf %.9g drawn %.9g, one pair %.9g %.9g %.9g",
                             case_name(&inner, dir(wo[0], wo[1], wo[2])).text, (double)a.f[0][k], (double)a.pdf[k],
                             (double)a.drawn[k], (double)f[0], (double)pdf, (double)drawn);
            }
        }
}

static void missing_channel_arrays_are_skipped(void **state) {
    (void)state;
    static Answers a;
    float red[N];
    WeftLobe lobe;
    weft_lobe_init("ggx", &lobe, NULL);
    lobe.f0[1] = 0.25f;
    ask(&lobe, &questions, 0, N, 0, &a);
    assert_int_equal(weft_eval_n(&lobe, N, at(questions.o, 0), at(questions.i, 0), (WeftColors){.g = red}, NULL),
                     WEFT_OK);
    assert_memory_equal(red, a.f[1], sizeof red);
}

/* ---- what is wrong --------------------------------------------------------------------------------- */

static bool is_zero(float x) { return !(x < 0.0f || x > 0.0f) && !isnan(x); }

static void array_element_without_a_direction_is_zero(void **state) {
    (void)state;
    static const float wrong[] = {NAN, INFINITY, -INFINITY};
    static Answers right, a;
    static Questions q;
    for (int id = 0; id < weft_lobe_count(); id++) {
        WeftLobe lobe;
        weft_lobe_init(weft_lobe_info(id)->id, &lobe, NULL);
        ask(&lobe, &questions, 0, N, 0, &right);
        q = questions;
        /* every third pair is spoilt, each component in turn */
        for (int k = 0; k < N; k += 3) {
            int component = k / 3 % 6;
            (component < 3 ? q.o[component] : q.i[component - 3])[k] = wrong[k / 18 % 3];
            q.u[k] = k / 54 % 2 ? wrong[k / 18 % 3] : -3.0f;
        }
        ask(&lobe, &q, 0, N, 0, &a);
        for (int k = 0; k < N; k++) {
            if (k % 3 == 0) {
                assert_true(is_zero(a.f[0][k]) && is_zero(a.f[1][k]) && is_zero(a.f[2][k]) && is_zero(a.pdf[k]));
                if (k / 3 % 6 < 3) assert_true(is_zero(a.drawn[k]));
                assert_true(isfinite(a.drawn[k]) && isfinite(a.wi[0][k] + a.wi[1][k] + a.wi[2][k]));
            } else {
                assert_memory_equal(&a.f[0][k], &right.f[0][k], sizeof(float));
                assert_memory_equal(&a.pdf[k], &right.pdf[k], sizeof(float));
                assert_memory_equal(&a.drawn[k], &right.drawn[k], sizeof(float));
            }
        }
    }
}

static void array_errors_are_returned(void **state) {
    (void)state;
    WeftDirections o = at(questions.o, 0), i = at(questions.i, 0), none = {NULL, NULL, NULL};
    float x[4] = {9, 9, 9, 9}, y[4] = {9, 9, 9, 9}, z[4] = {9, 9, 9, 9}, pdf[4] = {9, 9, 9, 9};
    WeftColors f = {x, y, z};
    WeftError error;
    WeftLobe lobe = {.lobe = -1};
    assert_int_equal(weft_eval_n(&lobe, 3, o, i, f, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_LOBE_NAME);
    assert_true(is_zero(x[2]) && is_zero(y[2]) && is_zero(z[0]) && !is_zero(x[3]));
    assert_int_equal(weft_pdf_n(&lobe, 3, o, i, pdf, &error), WEFT_USAGE);
    assert_true(is_zero(pdf[2]) && !is_zero(pdf[3]));
    pdf[0] = 9.0f;
    assert_int_equal(weft_sample_n(&lobe, 3, o, questions.u, questions.v, x, y, z, pdf, NULL), WEFT_USAGE);
    assert_true(is_zero(pdf[0]));
    x[0] = 9.0f;
    assert_int_equal(weft_albedo_n(&lobe, 3, questions.u, f, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_LOBE_NAME);
    assert_true(is_zero(x[0]));

    weft_lobe_init("ggx", &lobe, NULL);
    assert_int_equal(weft_eval_n(&lobe, 1, none, i, f, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_DESC);
    assert_int_equal(weft_eval_n(&lobe, 1, o, none, f, &error), WEFT_USAGE);
    assert_int_equal(weft_pdf_n(&lobe, 1, o, none, pdf, &error), WEFT_USAGE);
    assert_int_equal(weft_pdf_n(&lobe, 1, o, i, NULL, &error), WEFT_USAGE);
    assert_int_equal(weft_sample_n(&lobe, 1, none, x, y, x, y, z, pdf, &error), WEFT_USAGE);
    assert_int_equal(weft_sample_n(&lobe, 1, o, NULL, y, x, y, z, pdf, &error), WEFT_USAGE);
    assert_int_equal(weft_sample_n(&lobe, 1, o, x, y, x, NULL, z, pdf, &error), WEFT_USAGE);
    assert_int_equal(weft_sample_n(&lobe, 1, o, x, y, x, y, z, NULL, &error), WEFT_USAGE);
    assert_int_equal(weft_albedo_n(&lobe, 1, NULL, f, &error), WEFT_USAGE);
    /* nothing asked, nothing needed */
    assert_int_equal(weft_eval_n(&lobe, 0, none, none, (WeftColors){NULL, NULL, NULL}, NULL), WEFT_OK);
    assert_int_equal(weft_pdf_n(&lobe, 0, none, none, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_sample_n(&lobe, 0, none, NULL, NULL, NULL, NULL, NULL, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_albedo_n(&lobe, 0, NULL, (WeftColors){NULL, NULL, NULL}, NULL), WEFT_OK);
}

static int make(void **state) {
    (void)state;
    questions_make();
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays_from_several_threads_agree),
        cmocka_unit_test(array_element_does_not_depend_on_its_neighbours),
        cmocka_unit_test(arrays_agree_with_calls_for_one_pair),
        cmocka_unit_test(missing_channel_arrays_are_skipped),
        cmocka_unit_test(array_element_without_a_direction_is_zero),
        cmocka_unit_test(array_errors_are_returned),
    };
    return cmocka_run_group_tests(tests, make, NULL);
}
