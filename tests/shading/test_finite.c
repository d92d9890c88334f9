/* No NaN, no infinity, nothing negative: 10^7 random and adversarial pairs of directions and parameters */
#include "cases.h"

/* By its bits, so that no compiler option can fold the question away. */
static bool is_finite(float x) {
    uint32_t bits;
    memcpy(&bits, &x, 4);
    return (bits & 0x7f800000u) != 0x7f800000u;
}

static bool is_sound(float x) { return is_finite(x) && !(x < 0.0f); }

/* A direction that is hard on formulas: grazing, the normal, an axis, or any. */
static Dir hard_direction(Random *random) {
    double phi = 2.0 * PI_DOUBLE * (double)random_unit(random);
    switch (random_bits(random) % 8) {
    case 0: { /* grazing, 1e-7 .. 1e-3 */
        double z = (pow)(10.0, -7.0 + 4.0 * (double)random_unit(random));
        return direction_cos(z, phi);
    }
    case 1: return dir(0.0f, 0.0f, 1.0f);
    case 2: { /* an axis, hardly above the horizon */
        static const float axes[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
        const float *axis = axes[random_bits(random) % 4];
        return dir(axis[0], axis[1], random_bits(random) % 2 ? 1e-7f : 1e-30f);
    }
    case 3: { /* near the normal */
        double theta = (pow)(10.0, -8.0 + 7.0 * (double)random_unit(random));
        return direction(theta, phi);
    }
    default: return random_direction(random);
    }
}

static Dir partner(Random *random, Dir o) {
    switch (random_bits(random) % 6) {
    case 0: return o;
    case 1: return dir(-o.x, -o.y, o.z);                      /* the mirror direction */
    case 2: return dir(-o.x, -o.y, o.z > 0.5f ? o.z : 1e-7f); /* opposite, or nearly */
    default: return hard_direction(random);
    }
}

static void lobes_stay_finite(void **state) {
    (void)state;
    enum { BLOCK = 500 };
    const int total = test_long() ? 100000000 : test_short() ? 1000000 : 10000000;
    float ox[BLOCK], oy[BLOCK], oz[BLOCK], ix[BLOCK], iy[BLOCK], iz[BLOCK], f[BLOCK];
    Random random = {9};
    float highest = 0.0f;
    for (int n = 0; n < total; n += BLOCK) {
        int id = ((n / BLOCK) % weft_lobe_count());
        int spread = case_count(id);
        Lobe lobe = case_lobe(id, (n / BLOCK / weft_lobe_count()) % spread);
        for (int k = 0; k < BLOCK; k++) {
            Dir o = hard_direction(&random), i = partner(&random, o);
            ox[k] = o.x, oy[k] = o.y, oz[k] = o.z, ix[k] = i.x, iy[k] = i.y, iz[k] = i.z;
        }
        lobe_eval_n(&lobe, BLOCK, ox, oy, oz, ix, iy, iz, f, NULL);
        for (int k = 0; k < BLOCK; k++) {
            Dir o = dir(ox[k], oy[k], oz[k]), i = dir(ix[k], iy[k], iz[k]);
            Angles a = angles_between(o, i);
            float scalar = lobe_eval(&lobe, a), pdf = lobe_pdf(&lobe, a);
            if (!is_sound(scalar) || !is_sound(pdf) || !is_sound(f[k]))
                fail_msg("%s wi=(%g %g %g): f %g, array f %g, pdf %g", case_name(&lobe, o).text, (double)i.x,
                         (double)i.y, (double)i.z, (double)scalar, (double)f[k], (double)pdf);
            if (fabsf(scalar - f[k]) > 1e-4f * scalar + 1e-7f)
                fail_msg("%s: f %.9g, array f %.9g", case_name(&lobe, o).text, (double)scalar, (double)f[k]);
            highest = fmaxf(highest, scalar * i.z);
            if (k % 4) continue;
            float u = k % 8 ? random_unit(&random) : (float)(k / 8 % 2) * 0x1.fffffep-1f;
            float v = k % 16 ? random_unit(&random) : (float)(k / 16 % 2) * 0x1.fffffep-1f;
            Dir s = lobe_sample(&lobe, o, u, v);
            float length = s.x * s.x + s.y * s.y + s.z * s.z;
            if (!is_finite(length) || fabsf(length - 1.0f) > 2e-4f)
                fail_msg("%s u=%.9g v=%.9g: a sample of length^2 %g", case_name(&lobe, o).text, (double)u, (double)v,
                         (double)length);
            if (s.z <= 0.0f) continue;
            a = angles_between(o, s);
            if (!is_sound(lobe_pdf(&lobe, a)) || !is_sound(lobe_eval(&lobe, a)))
                fail_msg("%s u=%.9g v=%.9g: pdf %g", case_name(&lobe, o).text, (double)u, (double)v,
                         (double)lobe_pdf(&lobe, a));
        }
    }
    print_message("highest f cos_i: %g\n", (double)highest);
}

/* The same through the public calls, with whatever values a person types. */
static void public_calls_stay_finite(void **state) {
    (void)state;
    static const char *const values[] = {"0", "-1", "1e-38", "1e-7", "0.3", "1", "1e3", "3e38", "-3e38"};
    Random random = {10};
    for (int n = 0; n < 20000; n++) {
        const WeftLobeInfo *info = weft_lobe_info(n % weft_lobe_count());
        WeftLobe lobe;
        assert_int_equal(weft_lobe_init(info->id, &lobe, NULL), WEFT_OK);
        for (int p = 0; p < info->param_count; p++) {
            const WeftParamInfo *row = &info->params[p];
            uint32_t choices = row->choices ? (uint32_t)row->hard_high + 1 : 9;
            const char *value = (row->choices ? row->choices : values)[random_bits(&random) % choices];
            assert_int_equal(weft_lobe_set(&lobe, row->name, value, NULL, NULL), WEFT_OK);
        }
        weft_lobe_set(&lobe, "color", values[random_bits(&random) % 9], NULL, NULL);
        Dir o = hard_direction(&random), i = partner(&random, o);
        float wo[3] = {o.x, o.y, o.z}, wi[3] = {i.x, i.y, i.z}, f[3];
        float u[2] = {random_unit(&random), random_unit(&random)};
        weft_lobe_eval(&lobe, wo, wi, f);
        assert_true(is_sound(f[0]) && is_sound(f[1]) && is_sound(f[2]));
        assert_true(is_sound(weft_lobe_pdf(&lobe, wo, wi)));
        assert_true(is_sound(weft_lobe_sample(&lobe, wo, u, wi)));
    }
}

static void reflection_from_below_is_zero(void **state) {
    (void)state;
    float up[3] = {0.6f, 0.0f, 0.8f}, down[3] = {0.6f, 0.0f, -0.8f}, level[3] = {1.0f, 0.0f, 0.0f};
    float opposite[3] = {-0.6f, 0.0f, 0.8f};
    float u[2] = {0.5f, 0.5f}, f[3], wi[3];
    for (int id = 0; id < weft_lobe_count(); id++) {
        WeftLobe lobe;
        weft_lobe_init(weft_lobe_info(id)->id, &lobe, NULL);
        const float *pairs[4][2] = {{up, down}, {down, up}, {up, level}, {level, up}};
        for (int k = 0; k < 4; k++) {
            weft_lobe_eval(&lobe, pairs[k][0], pairs[k][1], f);
            assert_true(!(f[0] != 0.0f) && !(f[1] != 0.0f) && !(f[2] != 0.0f));
            assert_true(!(weft_lobe_pdf(&lobe, pairs[k][0], pairs[k][1]) != 0.0f));
        }
        assert_true(!(weft_lobe_sample(&lobe, down, u, wi) != 0.0f));
        weft_lobe_eval(&lobe, up, opposite, f);
        assert_true(f[0] > 0.0f);
    }
}

static void stacks_stay_finite(void **state) {
    (void)state;
    static AlbedoTable table;
    fill_albedo(&table, LOBE_CHARLIE_CONTY_KULLA);
    Random random = {12};
    for (int n = 0; n < 200000; n++) {
        Surface surface = random_surface(&random, n % 2);
        if (n % 5 == 0) surface.roughness = surface.sheen_roughness = surface.clearcoat_roughness = 0.0f;
        Dir o = hard_direction(&random), i = partner(&random, o);
        SeenStack stack = test_stack(&surface, n % LAYER_COUNT, &table, o);
        StackValue value = seen_eval(&stack, i, 0);
        assert_true(is_sound(value.f_cos.r) && is_sound(value.f_cos.g) && is_sound(value.f_cos.b));
        assert_true(is_sound(value.pdf));
        Dir s = seen_sample(&stack, random_unit(&random), random_unit(&random));
        assert_true(is_finite(s.x) && is_finite(s.y) && is_finite(s.z));
        if (s.z > 0.0f) assert_true(is_sound(seen_eval(&stack, s, 0).pdf));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobes_stay_finite),
        cmocka_unit_test(public_calls_stay_finite),
        cmocka_unit_test(reflection_from_below_is_zero),
        cmocka_unit_test(stacks_stay_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
