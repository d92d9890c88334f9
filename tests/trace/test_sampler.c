/* The sampler's points are Owen-scrambled Sobol points, and choices follow their weights. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "trace/geometry/sampler.h"
#include "trace/light/distribution.h"

/* Bit j of the second Sobol dimension's k-th direction number is (k choose j) mod 2, by the recurrence of its
 * primitive polynomial x + 1: v_k = v_{k-1} xor (v_{k-1} >> 1). */
static uint32_t sobol_by_definition(uint32_t i) {
    uint32_t v = 0x80000000u, x = 0;
    for (; i; i >>= 1, v ^= v >> 1)
        if (i & 1) x ^= v;
    return x;
}

static void pascal_bits_give_the_sobol_sequence(void **state) {
    (void)state;
    for (uint32_t k = 0; k < 100000; k++) {
        uint32_t i = k < 50000 ? k : hash32(k);
        assert_int_equal(reverse_bits(pascal_bits(i)), sobol_by_definition(i));
    }
}

/* Every aligned block of 2^m samples of a pair has one point in each elementary interval of area 2^-m. */
static void sample_pairs_are_stratified(void **state) {
    (void)state;
    enum { M = 8, N = 1 << M };
    for (uint32_t pixel = 0; pixel < 5; pixel++)
        for (int pair = 0; pair < 6; pair++)
            for (int split = 0; split <= M; split++)
                for (uint32_t block = 0; block < 2; block++) {
                    unsigned char seen[N] = {0};
                    for (uint32_t k = 0; k < N; k++) {
                        Point p = sampler_point(sampler_key(pixel, 3, 9), sampler_index(block * N + k), (uint32_t)pair);
                        int column = (int)(p.u * (float)(1 << split)), row = (int)(p.v * (float)(1 << (M - split)));
                        seen[column * (1 << (M - split)) + row]++;
                    }
                    for (int k = 0; k < N; k++) assert_int_equal(seen[k], 1);
                }
}

static void samples_of_pixels_and_pairs_are_decorrelated(void **state) {
    (void)state;
    enum { N = 4096 };
    double sum = 0.0;
    for (uint32_t k = 0; k < N; k++) {
        uint32_t one = sampler_key(k, 0, 1), two = sampler_key(k + 1, 0, 1), first = sampler_index(0);
        Point p = sampler_point(one, first, 0), q = sampler_point(two, first, 0), next = sampler_point(one, first, 1);
        sum += ((double)p.u - 0.5) * ((double)q.u - 0.5) * 12.0;    /* between pixels */
        sum += ((double)p.u - 0.5) * ((double)next.u - 0.5) * 12.0; /* between pairs */
        sum += ((double)next.u - 0.5) * ((double)next.v - 0.5) * 12.0;
    }
    assert_true(sum * sum < 16.0 * 3.0 * N); /* 4 standard errors of a sum of 3 N products of variance 1 */
}

/* The cumulative weight before a choice and with it have u between them. */
static bool finds(const Distribution *d, Choice c, float u) {
    return c.index >= 0 && c.index < d->n && d->ends[c.index - 1] <= u && u < d->ends[c.index] && c.rest >= 0.0f &&
           c.rest < 1.0f;
}

static void sampled_choices_follow_their_weights(void **state) {
    (void)state;
    enum { N = 7, U = 70000 };
    static const float weights[N] = {0.0f, 3.0f, 0.5f, 0.0f, 4.0f, 2.5f, 0.0f};
    float room[64];
    assert_true(distribution_size(N) <= 64);
    Distribution d;
    assert_true(distribution_make(&d, N, weights, room) == 10.0);
    int count[N] = {0};
    for (int k = 0; k < U; k++) {
        float u = ((float)k + 0.5f) / U;
        Choice c = distribution_choose(&d, u);
        assert_true(finds(&d, c, u));
        count[c.index]++;
    }
    for (int k = 0; k < N; k++)
        assert_in_range(count[k], (int)(weights[k] * U / 10) - 2 < 0 ? 0 : (int)(weights[k] * U / 10) - 2,
                        (int)(weights[k] * U / 10) + 2);
    assert_true(distribution_choose(&d, 0x1.fffffep-1f).index == 5);
    assert_true(distribution_choose(&d, 0.0f).index == 1);
}

static void choice_without_weights_is_uniform(void **state) {
    (void)state;
    static const float none[4];
    float room[64];
    Distribution d;
    assert_true(distribution_make(&d, 4, none, room) == 0.0);
    for (int k = 0; k < 4; k++) assert_int_equal(distribution_choose(&d, (float)k / 4 + 0.1f).index, k);
}

/* Many sizes, of one to four levels, and uneven weights. */
static void search_of_a_distribution_finds_the_cell(void **state) {
    (void)state;
    enum { MAX = 5000 };
    static float weights[MAX], room[2 * MAX];
    for (uint32_t n = 1; n <= MAX; n += n < 40 ? 1 : 311) {
        for (uint32_t k = 0; k < n; k++) {
            float r = unit_float(hash_combine(n, k));
            weights[k] = r < 0.3f ? 0.0f : r * r * r * r;
        }
        Distribution d;
        assert_true(distribution_size((int)n) <= 2 * MAX);
        distribution_make(&d, (int)n, weights, room);
        for (uint32_t k = 0; k < 2000; k++) {
            float u = k < 1000 ? unit_float(hash32(k)) : (float)(k % (n + 1)) / (float)(n + 1);
            assert_true(finds(&d, distribution_choose(&d, u), u));
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pascal_bits_give_the_sobol_sequence),
        cmocka_unit_test(sample_pairs_are_stratified),
        cmocka_unit_test(samples_of_pixels_and_pairs_are_decorrelated),
        cmocka_unit_test(sampled_choices_follow_their_weights),
        cmocka_unit_test(choice_without_weights_is_uniform),
        cmocka_unit_test(search_of_a_distribution_finds_the_cell),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
