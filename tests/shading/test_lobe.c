/* WeftLobe as plain data: whatever is in it, the calls answer with numbers */
#include "cases.h"

static const float up[3] = {0.0f, 0.0f, 1.0f}, aside[3] = {0.6f, 0.0f, 0.8f};

static void lobe_of_an_unknown_id_is_black(void **state) {
    (void)state;
    const int wrong[] = {-1, weft_lobe_count(), 1 << 30};
    for (int k = 0; k < 3; k++) {
        WeftLobe lobe = {.lobe = wrong[k], .f0 = {1.0f, 1.0f, 1.0f}, .f90 = {1.0f, 1.0f, 1.0f}};
        float f[3] = {9.0f, 9.0f, 9.0f}, e[3] = {9.0f, 9.0f, 9.0f}, wi[3];
        weft_lobe_eval(&lobe, up, aside, f);
        weft_lobe_albedo(&lobe, 0.5f, e);
        for (int c = 0; c < 3; c++) assert_true(!(f[c] != 0.0f) && !(e[c] != 0.0f));
        assert_true(!(weft_lobe_pdf(&lobe, up, aside) != 0.0f));
        assert_true(!(weft_lobe_sample(&lobe, up, (const float[]){0.5f, 0.5f}, wi) != 0.0f));
        WeftError error;
        assert_int_equal(weft_lobe_set(&lobe, "alpha", "0.5", NULL, &error), WEFT_USAGE);
        assert_int_equal(error.message, WEFT_MESSAGE_LOBE_NAME);
    }
}

static void parameters_outside_the_hard_range_are_clamped(void **state) {
    (void)state;
    const float wild[] = {-1e30f, -1.0f, 0.0f, 1e30f, INFINITY, -INFINITY, NAN};
    for (int k = 0; k < weft_lobe_count(); k++)
        for (size_t w = 0; w < sizeof wild / sizeof wild[0]; w++) {
            WeftLobe lobe;
            assert_int_equal(weft_lobe_init(weft_lobe_info(k)->id, &lobe, NULL), WEFT_OK);
            for (int p = 0; p < WEFT_LOBE_PARAMS_MAX; p++) lobe.params[p] = wild[w];
            float f[3], e[3], wi[3];
            weft_lobe_eval(&lobe, aside, up, f);
            weft_lobe_albedo(&lobe, 0.5f, e);
            for (int c = 0; c < 3; c++)
                if (!(isfinite(f[c]) && isfinite(e[c])))
                    fail_msg("%s: f %g, E %g for %g", weft_lobe_info(k)->id, (double)f[c], (double)e[c],
                             (double)wild[w]);
            assert_true(isfinite(weft_lobe_pdf(&lobe, aside, up)));
            assert_true(isfinite(weft_lobe_sample(&lobe, aside, (const float[]){0.3f, 0.7f}, wi)));
        }
}

/* "roughness" is the artist's, of every lobe that has something for it to set. */
static void roughness_of_a_lobe_sets_what_a_material_sets(void **state) {
    (void)state;
    int refused = 0;
    for (int k = 0; k < weft_lobe_count(); k++) {
        const WeftLobeInfo *info = weft_lobe_info(k);
        WeftLobe lobe;
        WeftError error;
        assert_int_equal(weft_lobe_init(info->id, &lobe, NULL), WEFT_OK);
        WeftResult result = weft_lobe_set(&lobe, "roughness", "0.6", NULL, &error);
        if (info->param_count) {
            assert_int_equal(result, WEFT_OK);
            assert_float_equal(lobe.params[0], lobe_rough(k, 0.6f).params[0], 0.0f);
            assert_int_equal(weft_lobe_set(&lobe, "roughness", "much", NULL, &error), WEFT_USAGE);
        } else {
            assert_int_equal(result, WEFT_USAGE);
            assert_int_equal(error.message, WEFT_MESSAGE_PARAM_NAME);
            assert_non_null(strstr(error.text, "has nothing that a roughness sets"));
            refused++;
        }
    }
    assert_int_equal(refused, 2); /* lambert and burley-sheen */
    WeftLobe silk;
    assert_int_equal(weft_lobe_init("silk", &silk, NULL), WEFT_OK);
    assert_int_equal(weft_lobe_set(&silk, "roughness", "0.6", NULL, NULL), WEFT_OK);
    assert_float_equal(silk.params[0], 0.36f, 1e-7f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobe_of_an_unknown_id_is_black),
        cmocka_unit_test(parameters_outside_the_hard_range_are_clamped),
        cmocka_unit_test(roughness_of_a_lobe_sets_what_a_material_sets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
