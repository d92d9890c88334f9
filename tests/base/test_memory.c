/* Allocation with checked sizes, and the arena */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"

static void array_sizes_that_overflow_are_refused(void **state) {
    (void)state;
    Arena arena = {0};
    static const size_t sizes[][2] = {
        {SIZE_MAX, 2}, {SIZE_MAX / 2, 3}, {3, SIZE_MAX / 2}, {SIZE_MAX / 2, 2}, {SIZE_MAX, SIZE_MAX}};
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
        assert_null(alloc_array(sizes[k][0], sizes[k][1]));
        assert_null(arena_array(&arena, sizes[k][0], sizes[k][1]));
        void *block = alloc_array(4, 4);
        assert_null(realloc_array(block, sizes[k][0], sizes[k][1]));
        free(block);
    }
    assert_int_equal(arena.used, 0);
    arena_free(&arena);
}

static void allocated_memory_is_zero(void **state) {
    (void)state;
    unsigned char *block = alloc_array(1000, 3);
    for (int k = 0; k < 3000; k++) assert_int_equal(block[k], 0);
    memset(block, 7, 3000);
    block = realloc_array(block, 2000, 3);
    for (int k = 0; k < 3000; k++) assert_int_equal(block[k], 7);
    free(block);
    void *none = alloc_array(0, 8);
    assert_non_null(none);
    free(none);
}

static void arena_blocks_are_aligned_and_apart(void **state) {
    (void)state;
    Arena arena = {0};
    enum { COUNT = 3000 };
    static unsigned char *blocks[COUNT];
    static size_t sizes[COUNT];
    for (int k = 0; k < COUNT; k++) {
        sizes[k] = (size_t)(k * 37 % 300) + (k % 500 == 0 ? 100000 : 1);
        blocks[k] = arena_array(&arena, sizes[k], 1);
        assert_non_null(blocks[k]);
        assert_int_equal((uintptr_t)blocks[k] % 16, 0);
        for (size_t b = 0; b < sizes[k]; b++) assert_int_equal(blocks[k][b], 0);
        memset(blocks[k], k % 251, sizes[k]);
    }
    for (int k = 0; k < COUNT; k++)
        for (size_t b = 0; b < sizes[k]; b++) assert_int_equal(blocks[k][b], k % 251);
    size_t total = 0;
    for (int k = 0; k < COUNT; k++) total += sizes[k];
    assert_true(arena.used >= total && arena.used < total + 16 * COUNT);
    arena_free(&arena);
    assert_int_equal(arena.used, 0);
    assert_string_equal(arena_text(&arena, "again"), "again"); /* it can be used again */
    assert_non_null(arena_array(&arena, 0, 4));
    arena_free(&arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(array_sizes_that_overflow_are_refused),
        cmocka_unit_test(allocated_memory_is_zero),
        cmocka_unit_test(arena_blocks_are_aligned_and_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
