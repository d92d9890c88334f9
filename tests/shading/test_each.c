/* The calls of weft/arrays.h in which each element is a lobe of its own: as the calls for one pair have it,
 * whatever the count and the place */
#include <math.h>

#include "cases.h"
#include "weft/arrays.h"

enum { N = 700, INPUTS = 6 + 2 + 6 + WEFT_LOBE_PARAMS_MAX, OUTPUTS = 8 }; /* more than two blocks, and a rest */

/* in: wo, wi, u, v, f0, f90, parameters; out: f, pdf, wi, its pdf */
static float in[INPUTS][N], out[OUTPUTS][N], pieces[OUTPUTS][N];

/* The tolerances below were set for these draws, so a lobe keeps them where others come before it. */
static bool came_later(int id) { return id == LOBE_BODY || id == LOBE_FABRIC || id == LOBE_LTC_FIBRE_PUBLISHED; }
static uint64_t seed_of(int id) {
    uint64_t seed = (uint64_t)id + 31;
    for (int before = 0; before < id; before++) seed -= came_later(before);
    return came_later(id) ? seed + 1000 : seed;
}

static void inputs_make(int id) {
    Random random = {seed_of(id)};
    const WeftLobeInfo *info = weft_lobe_info(id);
    for (int k = 0; k < N; k++) {
        Dir o = random_direction(&random), i = random_direction(&random);
        if (k % 7 == 0) i = dir(-o.x, -o.y, o.z);
        if (k % 11 == 0) i.z = -i.z;
        if (k % 17 == 0) o.x = NAN;
        const float pair[] = {o.x, o.y, o.z, i.x, i.y, i.z};
        for (int c = 0; c < 6; c++) in[c][k] = pair[c];
        for (int c = 6; c < 14; c++) in[c][k] = random_unit(&random);
        for (int p = 0; p < info->param_count; p++) {
            const WeftParamInfo *param = &info->params[p];
            in[14 + p][k] = param->low + (param->high - param->low) * random_unit(&random);
            if (k % 97 == 0) in[14 + p][k] = 2.0f * param->hard_high; /* clamped */
        }
    }
}

static WeftDirections row(int first, size_t k) {
    return (WeftDirections){in[first] + k, in[first + 1] + k, in[first + 2] + k};
}

/* Choices are those of the lobe, and one parameter of `without` the arrays; -1: none. */
static WeftLobes lobes_of(const WeftLobe *lobe, int without, size_t k) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    WeftLobes lobes = {.lobe = *lobe};
    for (int c = 0; c < 3; c++) {
        lobes.f0[c] = in[8 + c] + k;
        lobes.f90[c] = in[11 + c] + k;
    }
    for (int p = 0; p < info->param_count; p++)
        if (!info->params[p].choices && p != without) lobes.params[p] = in[14 + p] + k;
    return lobes;
}

static void ask(const WeftLobe *lobe, size_t first, size_t n, float to[OUTPUTS][N]) {
    const WeftLobes lobes = lobes_of(lobe, -1, first);
    WeftColors f = {to[0] + first, to[1] + first, to[2] + first};
    assert_int_equal(weft_eval_each(&lobes, n, row(0, first), row(3, first), f, to[3] + first, NULL), WEFT_OK);
    assert_int_equal(weft_sample_each(&lobes, n, row(0, first), in[6] + first, in[7] + first, to[4] + first,
                                      to[5] + first, to[6] + first, to[7] + first, NULL),
                     WEFT_OK);
}

/* The lobe of element k alone. */
static WeftLobe lobe_at(const WeftLobe *lobe, size_t k) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    WeftLobe one = *lobe;
    for (int p = 0; p < info->param_count; p++)
        if (!info->params[p].choices) one.params[p] = in[14 + p][k];
    for (int c = 0; c < 3; c++) one.f0[c] = in[8 + c][k], one.f90[c] = in[11 + c][k];
    return one;
}

/* The lobe with every choice that it has, one after the other; 0 behind the last. */
static int choice_of(const WeftLobeInfo *info, int turn, WeftLobe *lobe) {
    int any = turn == 0;
    for (int p = 0; p < info->param_count; p++) {
        int count = 0;
        if (!info->params[p].choices) continue;
        while (info->params[p].choices[count]) count++;
        any |= turn < count;
        lobe->params[p] = (float)(turn < count ? turn : 0);
    }
    return any;
}

/* By how much rounding alone moves f: sums of many powers, exp of a sum, F of an interface and the facets of yarn that
 * just face a direction, small differences of large numbers, go further. */
static double rounding_of(int lobe) {
    const bool yarns = lobe == LOBE_WOVEN || lobe == LOBE_YARN;
    return yarns || lobe == LOBE_FIBRE || lobe == LOBE_CHARLIE_CONTY_KULLA || lobe == LOBE_COOK_TORRANCE ? 2e-5 : 3e-6;
}

static void assert_near(const WeftLobe *lobe, const char *what, size_t k, float got, float wanted, double tolerance) {
    if (!(fabs((double)got - (double)wanted) <= tolerance))
        fail_msg("%s: %s of element %zu: %.9g, one pair %.9g", weft_lobe_info(lobe->lobe)->id, what, k, (double)got,
                 (double)wanted);
}

static double relative(double tolerance, float value) { return tolerance * (fabs((double)value) + 1e-6); }

static void assert_one(const WeftLobe *lobe, size_t k) {
    WeftLobe one = lobe_at(lobe, k);
    const float wo[3] = {in[0][k], in[1][k], in[2][k]}, wi[3] = {in[3][k], in[4][k], in[5][k]};
    const float u[2] = {in[6][k], in[7][k]}, given[3] = {out[4][k], out[5][k], out[6][k]};
    float f[3] = {0.0f, 0.0f, 0.0f}, drawn[3] = {0.0f, 0.0f, 0.0f}, pdf = 0.0f, pdf_drawn = 0.0f;
    if (isfinite(wo[0])) {
        weft_lobe_eval(&one, wo, wi, f);
        pdf = weft_lobe_pdf(&one, wo, wi);
        weft_lobe_sample(&one, wo, u, drawn);
        pdf_drawn = weft_lobe_pdf(&one, wo, given);
    }
    for (int c = 0; c < 3; c++) {
        assert_near(lobe, "f", k, out[c][k], f[c], relative(rounding_of(lobe->lobe), f[c]));
        assert_near(lobe, "wi", k, given[c], drawn[c], 3e-5); /* a sampler's maps have steep ends */
    }
    const double moves = lobe->lobe == LOBE_YARN ? rounding_of(LOBE_YARN) : 3e-6; /* its pdf has the D of f */
    assert_near(lobe, "pdf", k, out[3][k], pdf, relative(moves, pdf));
    assert_near(lobe, "pdf of what is drawn", k, out[7][k], pdf_drawn, relative(moves, pdf_drawn));
}

static void element_loops_agree_with_calls_for_one_pair(void **state) {
    (void)state;
    for (int id = 0; id < weft_lobe_count(); id++) {
        const WeftLobeInfo *info = weft_lobe_info(id);
        WeftLobe lobe;
        assert_int_equal(weft_lobe_init(info->id, &lobe, NULL), WEFT_OK);
        inputs_make(id);
        for (int turn = 0; choice_of(info, turn, &lobe); turn++) {
            ask(&lobe, 0, N, out);
            for (size_t k = 0; k < N; k++) assert_one(&lobe, k);
        }
    }
}

/* Every count up to a group and more, and pieces of any size, give the same bits. */
static void element_does_not_depend_on_its_neighbours(void **state) {
    (void)state;
    Random random = {23};
    for (int id = 0; id < weft_lobe_count(); id++) {
        WeftLobe lobe;
        assert_int_equal(weft_lobe_init(weft_lobe_info(id)->id, &lobe, NULL), WEFT_OK);
        inputs_make(id);
        ask(&lobe, 0, N, out);
        for (size_t first = 0, n; first < N; first += n) {
            n = 1 + random_bits(&random) % (random_bits(&random) % 2 ? 400 : 70);
            n = n < N - first ? n : N - first;
            ask(&lobe, first, n, pieces);
        }
        for (int k = 0; k < OUTPUTS; k++) {
            const void *whole = out[k], *cut = pieces[k];
            if (memcmp(whole, cut, sizeof out[k]) != 0) fail_msg("%s: output %d differs", weft_lobe_info(id)->id, k);
        }
    }
}

/* What has no array comes from the lobe; what is not wanted need not be there. */
static void missing_parameter_arrays_use_the_lobe(void **state) {
    (void)state;
    for (int id = 0; id < weft_lobe_count(); id++) {
        const WeftLobeInfo *info = weft_lobe_info(id);
        WeftLobe lobe;
        assert_int_equal(weft_lobe_init(info->id, &lobe, NULL), WEFT_OK);
        inputs_make(id);
        for (int c = 0; c < 3; c++) lobe.f0[c] = 0.25f, lobe.f90[c] = 0.75f;
        for (int k = 0; k < N; k++) {
            for (int c = 0; c < 3; c++) in[8 + c][k] = lobe.f0[c], in[11 + c][k] = lobe.f90[c];
            if (info->param_count) in[14][k] = lobe.params[0];
        }
        ask(&lobe, 0, N, out);
        WeftLobes lobes = lobes_of(&lobe, 0, 0);
        memset(lobes.f0, 0, sizeof lobes.f0);
        memset(lobes.f90, 0, sizeof lobes.f90);
        assert_int_equal(weft_eval_each(&lobes, N, row(0, 0), row(3, 0), (WeftColors){.g = pieces[1]}, NULL, NULL),
                         WEFT_OK);
        assert_memory_equal(out[1], pieces[1], sizeof out[1]);
    }
}

static void errors_of_element_loops_are_returned(void **state) {
    (void)state;
    WeftLobes lobes = {.lobe = {.lobe = -1}};
    WeftDirections o = row(0, 0), i = row(3, 0), none = {NULL, NULL, NULL};
    WeftColors f = {out[0], out[1], out[2]};
    WeftError error;
    out[0][0] = out[3][2] = out[4][1] = 9.0f;
    assert_int_equal(weft_eval_each(&lobes, 3, o, i, f, out[3], &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_LOBE_NAME);
    assert_true(out[0][0] < 1.0f && out[3][2] < 1.0f);
    assert_int_equal(weft_sample_each(&lobes, 3, o, in[6], in[7], out[4], out[5], out[6], out[7], &error), WEFT_USAGE);
    assert_true(out[4][1] < 1.0f);
    assert_int_equal(weft_lobe_init("cook-torrance", &lobes.lobe, NULL), WEFT_OK);
    lobes.params[1] = in[14]; /* a choice */
    assert_int_equal(weft_eval_each(&lobes, 3, o, i, f, NULL, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_DESC);
    lobes.params[1] = NULL;
    assert_int_equal(weft_eval_each(&lobes, 3, none, i, f, NULL, &error), WEFT_USAGE);
    assert_int_equal(weft_eval_each(&lobes, 3, o, none, f, NULL, &error), WEFT_USAGE);
    assert_int_equal(weft_sample_each(&lobes, 3, none, in[6], in[7], out[4], out[5], out[6], out[7], &error),
                     WEFT_USAGE);
    assert_int_equal(weft_sample_each(&lobes, 3, o, NULL, in[7], out[4], out[5], out[6], out[7], &error), WEFT_USAGE);
    assert_int_equal(weft_sample_each(&lobes, 3, o, in[6], in[7], out[4], NULL, out[6], out[7], &error), WEFT_USAGE);
    assert_int_equal(weft_sample_each(&lobes, 3, o, in[6], in[7], out[4], out[5], out[6], NULL, &error), WEFT_USAGE);
    assert_int_equal(weft_eval_each(&lobes, 0, none, none, (WeftColors){NULL, NULL, NULL}, NULL, NULL), WEFT_OK);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(element_loops_agree_with_calls_for_one_pair),
        cmocka_unit_test(element_does_not_depend_on_its_neighbours),
        cmocka_unit_test(missing_parameter_arrays_use_the_lobe),
        cmocka_unit_test(errors_of_element_loops_are_returned),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
