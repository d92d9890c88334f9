/* Numbers come back from the user's cache as they went in, or not at all */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/cache.h"
#include "scratch.h"

static char folder[SCRATCH_SIZE];

static void count(void *user, WeftMessage message, const char *text) {
    (void)text;
    assert_int_equal(message, WEFT_MESSAGE_CACHE_IGNORED);
    ++*(int *)user;
}

static void numbers_kept_under_a_key_are_found_again(void **state) {
    (void)state;
    int warnings = 0;
    const WeftLog log = {count, &warnings};
    const float numbers[5] = {1.0f, -2.5f, 0.0f, 1e-30f, 3e30f};
    float back[5] = {0.0f};
    assert_false(cache_find(17, "num", back, sizeof back, &log));
    cache_keep(17, "num", numbers, sizeof numbers, &log);
    assert_true(cache_find(17, "num", back, sizeof back, &log));
    assert_memory_equal(back, numbers, sizeof back);
    assert_false(cache_find(18, "num", back, sizeof back, &log));
    assert_false(cache_find(17, "other", back, sizeof back, &log));
    assert_int_equal(warnings, 0);
    assert_false(cache_find(17, "num", back, sizeof back - 4, &log)); /* longer than it should be */
    assert_false(cache_find(17, "num", back, sizeof(float), &log));
    assert_int_equal(warnings, 2);
}

/* Each byte in turn, and each length. */
static void damaged_file_is_ignored_with_a_warning(void **state) {
    (void)state;
    int warnings = 0;
    const WeftLog log = {count, &warnings};
    const float numbers[3] = {1.0f, 2.0f, 3.0f};
    char path[CACHE_PATH_SIZE], bytes[128];
    assert_true(cache_path(path, 19, "num"));
    cache_keep(19, "num", numbers, sizeof numbers, &log);
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    size_t size = fread(bytes, 1, sizeof bytes, stream);
    fclose(stream);
    assert_int_equal(size, 8 + 8 + sizeof numbers + 8);
    for (size_t k = 0; k < 2 * size; k++) {
        float back[3] = {7.0f, 7.0f, 7.0f};
        stream = fopen(path, "wb");
        assert_non_null(stream);
        if (k < size) bytes[k] ^= 4;
        fwrite(bytes, 1, k < size ? size : k - size, stream);
        if (k < size) bytes[k] ^= 4;
        fclose(stream);
        assert_false(cache_find(19, "num", back, sizeof back, &log));
        assert_true(back[0] > 6.0f && back[2] > 6.0f); /* nothing was written */
        assert_int_equal(warnings, (int)k + 1);
    }
}

/* A library is loaded by its path: its bytes stand at the beginning. */
static void sealed_file_is_whole_or_distrusted(void **state) {
    (void)state;
    int warnings = 0;
    const WeftLog log = {count, &warnings};
    char path[CACHE_PATH_SIZE], bytes[64] = "";
    assert_true(cache_path(path, 23, "lib"));
    assert_false(cache_is_sealed(23, "lib", &log));
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_false(cache_is_sealed(23, "lib", &log));         /* and nobody waits */
    assert_true(cache_seal(23, "lib", "library", 7, &log)); /* in place of the pipe */
    assert_true(cache_is_sealed(23, "lib", &log));
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    size_t size = fread(bytes, 1, sizeof bytes, stream);
    fclose(stream);
    assert_memory_equal(bytes, "library", 7);
    assert_int_equal(warnings, 0);
    for (size_t k = 0; k < 2 * size; k++) {
        stream = fopen(path, "r+b");
        assert_non_null(stream);
        if (k < size) bytes[k] ^= 4;
        assert_int_equal(ftruncate(fileno(stream), k < size ? (off_t)size : (off_t)(k - size)), 0);
        fwrite(bytes, 1, k < size ? size : k - size, stream);
        if (k < size) bytes[k] ^= 4;
        fclose(stream);
        assert_false(cache_is_sealed(23, "lib", &log));
        assert_int_equal(warnings, (int)k + 1);
    }
    assert_true(cache_seal(23, "lib", "library", 7, &log));
    assert_int_equal(rename(path, "other"), 0);
    assert_true(cache_path(path, 24, "lib"));
    assert_int_equal(rename("other", path), 0);
    assert_false(cache_is_sealed(24, "lib", &log)); /* made of something else */
    assert_true(cache_seal(24, "lib", "library", 7, &log));
    assert_int_equal(chmod(path, 0720), 0);
    assert_false(cache_is_sealed(24, "lib", &log)); /* others can write it */
}

static int begin(void **state) {
    (void)state;
    return scratch_cache(folder) && chdir(folder) == 0 ? 0 : -1;
}

static int end(void **state) {
    (void)state;
    return chdir("/") == 0 && scratch_remove(folder) ? 0 : -1;
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(numbers_kept_under_a_key_are_found_again),
                                       cmocka_unit_test(damaged_file_is_ignored_with_a_warning),
                                       cmocka_unit_test(sealed_file_is_whole_or_distrusted)};
    return cmocka_run_group_tests(tests, begin, end);
}
