/* A material's reflection as a viewer plots it: the passport's numbers, parts that sum up to all, the same
 * both ways where a rule is reciprocal; quick, and careful with what it is given. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/steady_clock.h"
#include "scene/record/material.h"
#include "shading/material/choice.h"
#include "shading/material/material_stack.h"
#include "weft/weft.h"

#undef sin /* of the dialect, which is single precision */
#undef cos
#undef sqrt

/* A material as a scene tells it. */
static WeftMaterial plain(void) {
    WeftMaterial m;
    memset(&m, 0, sizeof m);
    const Material from = material_default();
    for (int k = 0; k < INPUT_COUNT; k++) memcpy(m.inputs[k].value, from.inputs[k].value, sizeof m.inputs[k].value);
    for (int k = 0; k < CHOICE_COUNT; k++) m.choices[k] = -1;
    return m;
}

static void set(WeftMaterial *m, InputId input, float value) {
    for (int c = 0; c < 3; c++) m->inputs[input].value[c] = value;
}

/* Something in each slot. */
static WeftMaterial full(void) {
    WeftMaterial m = plain();
    set(&m, INPUT_base_color, 0.4f);
    set(&m, INPUT_sheen_color, 0.6f);
    set(&m, INPUT_sheen_roughness, 0.4f);
    set(&m, INPUT_clearcoat, 0.7f);
    set(&m, INPUT_clearcoat_roughness, 0.05f);
    set(&m, INPUT_roughness, 0.4f);
    set(&m, INPUT_anisotropy, 0.5f);
    set(&m, INPUT_anisotropy_direction, 0.6f);
    set(&m, INPUT_dust, 0.4f);
    return m;
}

static WeftReflection *made(const WeftMaterial *m) {
    WeftReflection *r;
    WeftError error;
    if (weft_reflection_create(m, &r, &error) != WEFT_OK) fail_msg("%s", error.text);
    return r;
}

enum { N = 10000 };
static float wi[N][3], f[N][3], sum[N][3], part[N][3];

static void spread(void) {
    for (int k = 0; k < N; k++) {
        double z = (k + 0.5) / N, r = sqrt(1.0 - z * z), phi = 2.39996323 * k;
        wi[k][0] = (float)(r * cos(phi)), wi[k][1] = (float)(r * sin(phi)), wi[k][2] = (float)z;
    }
}

static void parts_of_a_reflection_sum_to_the_whole(void **state) {
    (void)state;
    const float wo[3] = {0.6f, 0.0f, 0.8f};
    spread();
    for (int layer = 0; layer < LAYER_STOCHASTIC; layer++) {
        WeftMaterial m = full();
        m.choices[CHOICE_layer] = layer;
        WeftReflection *r = made(&m);
        float all_e[3], sum_e[3] = {0.0f};
        double begin = clock_now();
        weft_reflection_eval(r, WEFT_PART_ALL, wo, N, (const float(*)[3])wi, f);
        double took = clock_now() - begin;
        memset(sum, 0, sizeof sum);
        for (int p = WEFT_PART_DIFFUSE; p <= WEFT_PART_DUST; p++) {
            float e[3];
            weft_reflection_eval(r, p, wo, N, (const float(*)[3])wi, part);
            weft_reflection_albedo(r, p, 0.8f, e);
            for (int c = 0; c < 3; c++) sum_e[c] += e[c];
            for (int k = 0; k < N; k++)
                for (int c = 0; c < 3; c++) sum[k][c] += part[k][c];
        }
        begin = clock_now();
        for (int k = 0; k < 32; k++) weft_reflection_albedo(r, WEFT_PART_ALL, ((float)k + 0.5f) / 32.0f, all_e);
        if (!layer)
            print_message("10000 directions: %.1f ms; 32 albedos: %.1f ms\n", 1e3 * took, 1e3 * (clock_now() - begin));
        weft_reflection_albedo(r, WEFT_PART_ALL, 0.8f, all_e);
        double furnace = 0.0; /* the same from directions that know no lobe */
        for (int k = 0; k < N; k++) {
            assert_true(fabsf(sum[k][1] - f[k][1]) <= 1e-5f * f[k][1] + 1e-7f);
            furnace += (double)f[k][1] * (double)wi[k][2] * 6.283185307179586 / N;
        }
        assert_true(fabsf(sum_e[1] - all_e[1]) < 1e-5f);
        if (!(fabs(furnace - (double)all_e[1]) < 0.015 * furnace))
            fail_msg("layer %d: %g, not %g", layer, (double)all_e[1], furnace);
        weft_reflection_free(r);
    }
}

/* White velvet under profiles, as weft_passport_measure has it. */
static void albedo_of_a_reflection_is_that_of_the_passport(void **state) {
    (void)state;
    static const char *const profiles[] = {"khronos", "filament-cloth", "unreal4"};
    static WeftPassport passport;
    WeftError error;
    for (size_t k = 0; k < sizeof profiles / sizeof *profiles; k++) {
        WeftMaterial m = plain();

        m.choices[CHOICE_profile] = choice_find(CHOICE_profile, profiles[k]);
        set(&m, INPUT_base_color, 1.0f);
        set(&m, INPUT_sheen_color, 1.0f);
        set(&m, INPUT_specular_color, 1.0f);
        set(&m, INPUT_roughness, 1.0f);
        set(&m, INPUT_ior, 1.5f);
        assert_int_equal(
            weft_passport_measure(&(WeftPassportDesc){.id = profiles[k], .quick = 1, .no_gpu = 1, .brief = 1},
                                  &passport, &error),
            WEFT_OK);
        set(&m, INPUT_sheen_roughness, passport.values[passport.row_default]);
        WeftReflection *r = made(&m);
        for (int c = 0; c < WEFT_PASSPORT_COSINES; c += 4) {
            float e[3], known = passport.albedo[passport.row_default][c];
            if (passport.cosines[c] < 0.05f) continue;
            weft_reflection_albedo(r, WEFT_PART_ALL, passport.cosines[c], e);
            if (!(fabsf(fmaxf(e[0], fmaxf(e[1], e[2])) - known) < 0.012f * known + 1e-3f))
                fail_msg("%s, cosine %g: %g, not %g", profiles[k], (double)passport.cosines[c], (double)e[1],
                         (double)known);
        }
        weft_reflection_free(r);
    }
}

static void reflection_of_a_reciprocal_material_is_reciprocal(void **state) {
    (void)state;
    WeftMaterial m = plain();
    set(&m, INPUT_sheen_color, 0.6f);
    set(&m, INPUT_sheen_roughness, 0.4f);
    set(&m, INPUT_anisotropy, 0.5f);
    set(&m, INPUT_anisotropy_direction, 0.6f);
    m.choices[CHOICE_layer] = LAYER_RECIPROCAL;
    WeftReflection *r = made(&m);
    spread();
    for (int k = 0; k < N; k += 97) {
        const float(*o)[3] = (const float(*)[3])wi[(k * 31 + 500) % N];
        float there[1][3], back[1][3];
        weft_reflection_eval(r, WEFT_PART_ALL, *o, 1, (const float(*)[3])wi[k], there);
        weft_reflection_eval(r, WEFT_PART_ALL, wi[k], 1, o, back);
        assert_true(fabsf(there[0][0] - back[0][0]) <= 2e-3f * fmaxf(there[0][0], back[0][0]) + 1e-5f);
    }
    const float below[3] = {0.6f, 0.0f, -0.8f};
    weft_reflection_eval(r, WEFT_PART_ALL, below, 1, (const float(*)[3])wi, f);
    assert_float_equal(f[0][0], 0.0f, 0.0f);
    weft_reflection_eval(r, WEFT_PART_ALL, wi[N / 2], 1, &below, f);
    assert_float_equal(f[0][0], 0.0f, 0.0f);
    weft_reflection_free(r);
}

/* Under rule multiplicative a red sheen makes a red rim: each channel of the base times 1 + its own colour times E. With
 * by=max the rim is as grey as the base. */
static void rim_of_rule_multiplicative_has_the_colour_of_the_sheen(void **state) {
    (void)state;
    const float wo[3] = {0.96f, 0.0f, 0.28f}, up[1][3] = {{0.0f, 0.0f, 1.0f}};
    for (int by = -1; by < 2; by++) {
        WeftMaterial m = plain();
        float with[1][3], without[1][3];
        set(&m, INPUT_base_color, 0.3f);
        set(&m, INPUT_sheen_beta, 3.0f);
        m.choices[CHOICE_workflow] = choice_find(CHOICE_workflow, "cloth");
        m.choices[CHOICE_sheen_lobe] = choice_find(CHOICE_sheen_lobe, "exponential");
        m.choices[CHOICE_layer] = choice_find(CHOICE_layer, "multiplicative");
        m.choices[CHOICE_layer_by] = by;
        WeftReflection *r = made(&m);
        weft_reflection_eval(r, WEFT_PART_ALL, wo, 1, up, without);
        weft_reflection_free(r);
        set(&m, INPUT_sheen_color, 0.1f);
        m.inputs[INPUT_sheen_color].value[0] = 1.0f;
        r = made(&m);
        weft_reflection_eval(r, WEFT_PART_ALL, wo, 1, up, with);
        weft_reflection_free(r);
        float red = with[0][0] / without[0][0] - 1.0f, green = with[0][1] / without[0][1] - 1.0f;
        print_message("by %d: red gains %.4f, green %.4f\n", by, (double)red, (double)green);
        assert_true(red > 0.05f);
        assert_float_equal(green, by == LAYER_BY_MAX ? red : 0.1f * red, 2e-3f * red);
    }
}

static void impossible_reflections_are_refused(void **state) {
    (void)state;
    WeftMaterial m = plain();
    WeftReflection *r;
    WeftError error;
    m.inputs[INPUT_roughness].value[0] = NAN;
    assert_int_equal(weft_reflection_create(&m, &r, &error), WEFT_USAGE);
    assert_null(r);
    m = plain();
    m.choices[CHOICE_layer] = 1000;
    assert_int_equal(weft_reflection_create(&m, &r, &error), WEFT_USAGE);
    m.choices[CHOICE_layer] = -2;
    assert_int_equal(weft_reflection_create(&m, &r, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_PARAM_VALUE);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(parts_of_a_reflection_sum_to_the_whole),
                                       cmocka_unit_test(albedo_of_a_reflection_is_that_of_the_passport),
                                       cmocka_unit_test(reflection_of_a_reciprocal_material_is_reciprocal),
                                       cmocka_unit_test(rim_of_rule_multiplicative_has_the_colour_of_the_sheen),
                                       cmocka_unit_test(impossible_reflections_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
