/* Pictures made with each set of instructions that the processor has, and names of those that it lacks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "shading/dialect/isa_choice.h"
#include "trace/scenes.h"

static void sets_are_named_and_the_widest_is_in_use(void **state) {
    (void)state;
    assert_string_equal(weft_isa_name(ISA_SSE2), "sse2");
    assert_string_equal(weft_isa_name(ISA_AVX2), "avx2");
    assert_string_equal(weft_isa_name(ISA_AVX512), "avx512");
    assert_null(weft_isa_name(ISA_COUNT));
    assert_null(weft_isa_name(-1));
    assert_string_equal(weft_isa(), weft_isa_name((int)isa_widest()));
    for (int k = 0; k < ISA_COUNT; k++) {
        Isa chosen;
        assert_int_equal(isa_choose(weft_isa_name(k), ISA_SSE2, ISA_AVX512, &chosen, NULL), WEFT_OK);
        assert_int_equal(chosen, k);
    }
}

/* A set that is not there is refused by a line, and the choice stays. */
static void absent_sets_are_refused(void **state) {
    (void)state;
    WeftError error;
    Isa chosen = ISA_AVX2;
    assert_int_equal(isa_choose("avx512", ISA_SSE2, ISA_AVX2, &chosen, &error), WEFT_RESOURCES);
    assert_int_equal(error.message, WEFT_MESSAGE_ISA);
    assert_string_equal(error.text, "avx512: cannot be used: this processor, or this build, has at most avx2");
    assert_int_equal(isa_choose("avx2", ISA_SSE2, ISA_SSE2, &chosen, &error), WEFT_RESOURCES);
    assert_int_equal(isa_choose("sse2", ISA_AVX2, ISA_AVX2, &chosen, &error), WEFT_RESOURCES);
    assert_string_equal(error.text, "sse2: cannot be used: this build has avx2 alone; -DWEFT_ISA=all builds all");
    for (int k = 0; k < 3; k++) {
        static const char *const wrong[] = {"avx", "AVX2", ""};
        assert_int_equal(isa_choose(wrong[k], ISA_SSE2, ISA_AVX512, &chosen, &error), WEFT_USAGE);
        assert_int_equal(error.message, WEFT_MESSAGE_ISA_NAME);
    }
    assert_int_equal(chosen, ISA_AVX2);
    assert_int_equal(isa_choose(NULL, ISA_SSE2, ISA_SSE2, &chosen, &error), WEFT_OK);
    assert_int_equal(chosen, ISA_SSE2);
    assert_int_equal(weft_isa_use("mmx", &error), WEFT_USAGE);
    assert_string_equal(weft_isa(), weft_isa_name((int)isa_widest()));
}

/* A build for a wider processor tells what this one lacks; no build lacks anything where it is tested. */
static void a_lesser_processor_is_told(void **state) {
    (void)state;
    assert_null(isa_lacking(isa_of_processor()));
    assert_null(isa_lacking(ISA_AVX512));
    if (isa_least() == ISA_AVX512) assert_string_equal(isa_lacking(ISA_AVX2), "AVX-512");
    if (isa_least() >= ISA_AVX2) assert_non_null(isa_lacking(ISA_SSE2));
}

/* A coated ball with sheen before a wall, under the studio's light. */
static WeftScene *sheen_scene(void) {
    WeftScene *scene = test_scene();
    Material *ball = test_material(scene, 0.3f);
    test_color(ball, INPUT_sheen_color, 0.8f);
    test_color(ball, INPUT_sheen_roughness, 0.5f);
    test_color(ball, INPUT_clearcoat, 0.7f);
    test_color(ball, INPUT_specular, 1.0f);
    test_sphere(scene, vec3(0, 0, 0), 1.0f);
    test_material(scene, 0.5f);
    test_quad(scene, vec3(-4, -4, -1.5f), vec3(8, 0, 0), vec3(0, 8, 0));
    scene_bounds(scene);
    return scene;
}

static WeftImage picture(const WeftScene *scene, const char *isa, int threads) {
    const WeftRenderDesc desc = {
        .width = 48, .height = 36, .camera = "0,1,7;0,0,0;26", .max_depth = 4, .threads = threads};
    assert_int_equal(weft_isa_use(isa, NULL), WEFT_OK);
    assert_string_equal(weft_isa(), isa);
    return test_render(scene, desc, 16);
}

/* A rounding may send a path elsewhere; it may not change the light. */
static void every_set_renders_the_same_picture(void **state) {
    (void)state;
    WeftScene *scene = sheen_scene();
    WeftImage first = picture(scene, weft_isa_name((int)isa_least()), 1);
    size_t count = (size_t)first.width * (size_t)first.height * 4;
    for (int k = (int)isa_least(); k <= (int)isa_widest(); k++) {
        WeftImage one = picture(scene, weft_isa_name(k), 1), three = picture(scene, weft_isa_name(k), 3);
        double sum = 0.0, difference = 0.0;
        size_t off = 0;
        assert_memory_equal(one.pixels, three.pixels, count * sizeof(float));
        for (size_t i = 0; i < count; i++) {
            double a = (double)((float *)first.pixels)[i], b = (double)((float *)one.pixels)[i];
            sum += a, difference += b - a;
            off += fabs(b - a) > 1e-3 * (fabs(a) + 0.01);
        }
        print_message("%s: %.4f %% of the values differ by 1e-3, their mean by %.1e\n", weft_isa_name(k),
                      100.0 * (double)off / (double)count, difference / sum);
        assert_true(off * 50 < count);
        assert_true(fabs(difference) < 1e-3 * sum);
        weft_image_free(&one);
        weft_image_free(&three);
    }
    weft_image_free(&first);
    weft_scene_free(scene);
    assert_int_equal(weft_isa_use(NULL, NULL), WEFT_OK);
}

/* The loops over arrays of every lobe, too. */
static void every_set_evaluates_the_same_lobes(void **state) {
    (void)state;
    enum { N = 64 };
    float d[6][N], f[ISA_COUNT][3][N];
    for (int k = 0; k < N; k++)
        for (int side = 0; side < 2; side++) {
            float z = 0.05f + 0.9f * (float)((k * (side ? 37 : 11) + 5) % N) / N, phi = 0.7f * (float)k;
            float r = sqrtf(1.0f - z * z);
            d[3 * side][k] = r * cosf(phi), d[3 * side + 1][k] = r * sinf(phi), d[3 * side + 2][k] = z;
        }
    const WeftDirections wo = {d[0], d[1], d[2]}, wi = {d[3], d[4], d[5]};
    for (int id = 0; weft_lobe_info(id); id++) {
        WeftLobe lobe;
        assert_int_equal(weft_lobe_init(weft_lobe_info(id)->id, &lobe, NULL), WEFT_OK);
        for (int k = (int)isa_least(); k <= (int)isa_widest(); k++) {
            assert_int_equal(weft_isa_use(weft_isa_name(k), NULL), WEFT_OK);
            const WeftColors to = {f[k][0], f[k][1], f[k][2]};
            assert_int_equal(weft_eval_n(&lobe, N, wo, wi, to, NULL), WEFT_OK);
            for (int i = 0; i < N; i++) {
                float a = f[isa_least()][0][i], b = f[k][0][i];
                if (!(fabsf(a - b) < 2e-4f * (fabsf(a) + 0.01f)))
                    fail_msg("%s: %g with %s, %g with %s", weft_lobe_info(id)->id, (double)a,
                             weft_isa_name((int)isa_least()), (double)b, weft_isa_name(k));
            }
        }
    }
    assert_int_equal(weft_isa_use(NULL, NULL), WEFT_OK);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sets_are_named_and_the_widest_is_in_use),
        cmocka_unit_test(absent_sets_are_refused),
        cmocka_unit_test(a_lesser_processor_is_told),
        cmocka_unit_test(every_set_renders_the_same_picture),
        cmocka_unit_test(every_set_evaluates_the_same_lobes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
