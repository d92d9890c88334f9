/* A base that turns light back: the base itself for the mirror direction, reciprocal, with the same E; what lies over it is
 * not turned; samples follow it */
#include "cases.h"
#include "scene/record/material_at.h"

enum { PAIRS = 20000 };

/* A surface of workflow metallic without a sheen or a coat. */
static Surface base_of(Random *random, float retro) {
    Surface s = random_surface(random, false);
    s.sheen_color = (Rgb){0.0f, 0.0f, 0.0f};
    s.clearcoat = 0.0f;
    s.roughness = weft_mix(0.2f, 1.0f, s.roughness);
    s.diffuse_roughness = random_unit(random) < 0.5f ? 0.0f : random_unit(random);
    s.retroreflection = retro;
    return s;
}

static SeenStack seen_from(const Surface *s, Dir o) {
    const Choices choices = choices_unmade();
    SeenStack seen;
    seen_make(&seen, s, &choices, (TableRef){.kind = TABLE_NONE}, o);
    return seen;
}

static double f_of(const Surface *s, Dir o, Dir i) {
    const SeenStack seen = seen_from(s, o);
    return (double)seen_eval(&seen, i, 1).f_cos.g / (double)i.z;
}

static void base_is_that_of_the_mirror_direction(void **state) {
    (void)state;
    Random random = {5};
    for (int n = 0; n < PAIRS; n++) {
        Surface plain = base_of(&random, 0.0f), turned = plain, half = plain;
        turned.retroreflection = 1.0f, half.retroreflection = 0.5f;
        const Dir o = random_direction(&random), i = random_direction(&random);
        const double f = f_of(&plain, dir_opposite(o), i), g = f_of(&turned, o, i), straight = f_of(&plain, o, i);
        assert_true(fabs(f - g) <= 1e-6 * fmax(f, straight));
        assert_true(fabs(f_of(&half, o, i) - 0.5 * (straight + g)) <= 2e-6 * fmax(straight, g));
    }
}

static void turned_base_is_reciprocal(void **state) {
    (void)state;
    Random random = {6};
    double worst = 0.0;
    for (int n = 0; n < PAIRS; n++) {
        const Surface s = base_of(&random, random_unit(&random));
        const Dir o = random_direction(&random), i = random_direction(&random);
        const double f = f_of(&s, o, i), g = f_of(&s, i, o), error = fabs(f - g) / fmax(fmax(f, g), 1e-6);
        worst = fmax(worst, error);
    }
    print_message("reciprocal to %.1e\n", worst);
    assert_true(worst < 1e-5); /* of numbers that are single */
}

/* Returns E by a sum over directions of which each has its turned one. */
static double albedo_by_sum(const Surface *s, Dir o) {
    enum { COSINES = 96, AZIMUTHS = 256 };
    const SeenStack seen = seen_from(s, o);
    double sum = 0.0;
    for (int k = 0; k < COSINES; k++)
        for (int j = 0; j < AZIMUTHS / 2; j++) {
            const Dir i = direction_cos((k + 0.5) / COSINES, 2.0 * PI_DOUBLE * (j + 0.5) / AZIMUTHS);
            sum += (double)seen_eval(&seen, i, 1).f_cos.g + (double)seen_eval(&seen, dir_opposite(i), 1).f_cos.g;
        }
    return sum * 2.0 * PI_DOUBLE / (COSINES * AZIMUTHS);
}

static void turned_base_has_the_albedo_of_the_base(void **state) {
    (void)state;
    Random random = {7};
    double worst = 0.0;
    for (int n = 0; n < 24; n++) {
        Surface plain = base_of(&random, 0.0f), turned = plain;
        turned.retroreflection = n % 3 ? random_unit(&random) : 1.0f;
        const Dir o = random_direction(&random);
        worst = fmax(worst, fabs(albedo_by_sum(&plain, o) - albedo_by_sum(&turned, o)));
    }
    print_message("E is the base's own to %.1e\n", worst);
    assert_true(worst < 1e-6);
}

/* A lamp beside the eye: cloth of glass beads shines where any other is dull. */
static void light_returns_towards_the_lamp(void **state) {
    (void)state;
    Surface s = surface_default();
    s.metallic = 1.0f, s.roughness = 0.3f;
    const Dir o = direction(0.7, 1.0);
    const double dull = f_of(&s, o, o);
    s.retroreflection = 1.0f;
    assert_true(f_of(&s, o, o) > 50.0 * dull);
    s.metallic = 0.0f, s.base_color = s.specular_color = (Rgb){0.0f, 0.0f, 0.0f};
    s.specular = 0.0f;
    s.sheen_color = (Rgb){0.5f, 0.5f, 0.5f}, s.sheen_roughness = 0.5f;
    const double sheen = f_of(&s, o, direction(1.2, 0.3)); /* over a black base: it is not turned */
    s.retroreflection = 0.0f;
    assert_true(fabs(f_of(&s, o, direction(1.2, 0.3)) - sheen) <= 1e-7 * sheen);
}

static void samples_follow_the_pdf(void **state) {
    (void)state;
    enum { SAMPLES = 200000 };
    Random random = {8};
    for (int n = 0; n < 6; n++) {
        const Surface s = base_of(&random, random_unit(&random));
        const Dir o = random_direction(&random);
        const SeenStack seen = seen_from(&s, o);
        double drawn = 0.0, square = 0.0, whole = albedo_by_sum(&s, o), total = 0.0;
        for (int k = 0; k < SAMPLES; k++) {
            const Dir i = seen_sample(&seen, random_unit(&random), random_unit(&random));
            const StackValue v = i.z > 0.0f ? seen_eval(&seen, i, 1) : (StackValue){0};
            const double x = v.pdf > 0.0f ? (double)(v.f_cos.g / v.pdf) : 0.0;
            const Dir any = random_direction(&random);
            drawn += x / SAMPLES, square += x * x / SAMPLES;
            total += 2.0 * PI_DOUBLE * (double)seen_eval(&seen, any, 1).pdf / SAMPLES;
        }
        assert_true(fabs(drawn - whole) < 5.0 * (sqrt)(square / SAMPLES) + 4e-3);
        assert_true(total < 1.05);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(base_is_that_of_the_mirror_direction),
        cmocka_unit_test(turned_base_is_reciprocal),
        cmocka_unit_test(turned_base_has_the_albedo_of_the_base),
        cmocka_unit_test(light_returns_towards_the_lamp),
        cmocka_unit_test(samples_follow_the_pdf),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
