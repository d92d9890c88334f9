/* Numbers to and from text, against the C library's strtod and printf */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "cli/console/decimal.c"

static uint64_t random_state = 1;
static uint32_t random_bits(void) {
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(random_state >> 32);
}

static void check_write(float value) {
    char text[DECIMAL_SIZE], expected[64];
    char *end = decimal_write(text, value);
    assert_true(end <= text + DECIMAL_SIZE);
    size_t length = (size_t)snprintf(expected, sizeof expected, "%.9g", (double)value);
    if ((size_t)(end - text) != length || memcmp(text, expected, length) != 0)
        fail_msg("\"%.*s\", printf \"%s\"", (int)(end - text), text, expected);
}

static void decimal_writes_what_printf_writes(void **state) {
    (void)state;
    static const float special[] = {
        0.0f, -0.0f, NAN,          INFINITY, -INFINITY,      1.0f, 1e-45f, 3.4028235e38f, 1.17549435e-38f,
        1e9f, 1e8f,  999999999.0f, 0.0001f,  9.99999997e-5f, 0.5f, 0.1f,   123456.7f,     16777216.0f};
    for (size_t k = 0; k < sizeof special / sizeof special[0]; k++) check_write(special[k]), check_write(-special[k]);
    for (int k = 0; k < 500000; k++) { /* any bits, and numbers of few digits */
        uint32_t bits = random_bits();
        float value;
        memcpy(&value, &bits, 4);
        check_write(value);
        check_write((float)(bits % 2000000) / (k % 2 ? 1024.0f : 1000.0f));
    }
    for (int power = -149; power < 128; power++) { /* about every power of two and of ten */
        check_write(ldexpf(1.0f, power));
        float ten = (float)pow(10.0, power / 3.5);
        check_write(ten), check_write(nextafterf(ten, 0.0f)), check_write(nextafterf(ten, INFINITY));
    }
}

static void check_read(const char *text) {
    double value = 7.0, expected;
    char *expected_end;
    const char *end = decimal_read(text, &value);
    expected = strtod(text, &expected_end);
    if (end != expected_end || memcmp(&value, &expected, sizeof value) != 0)
        fail_msg("\"%s\": %.17g and \"%s\", strtod %.17g and \"%s\"", text, value, end, expected, expected_end);
}

static void decimal_reads_what_strtod_reads(void **state) {
    (void)state;
    static const char *const texts[] = {"0",
                                        "-0",
                                        "1",
                                        "+1",
                                        "-1.5",
                                        "1.",
                                        ".5",
                                        "-.5",
                                        ".",
                                        "",
                                        "-",
                                        "+-1",
                                        "x",
                                        "12,5",
                                        "1 2",
                                        "1e5",
                                        "1e",
                                        "1e+",
                                        "1.5e-3",
                                        "1E400",
                                        "0x",
                                        "inf",
                                        "-infinity",
                                        "nan",
                                        "1x",
                                        "9007199254740991",
                                        "9007199254740993",
                                        "123456789012345678901234567890",
                                        "99999999999999999999",
                                        "0.0000000000000000000000000000000000000001",
                                        "00000000000000000000000000000000001.25",
                                        "0.1",
                                        "0.30000000000000004",
                                        "1.7976931348623157e308",
                                        "4.9406564584124654e-324",
                                        "179.99999999999997",
                                        "3.1415926535897932384626433832795"};
    for (size_t k = 0; k < sizeof texts / sizeof texts[0]; k++) check_read(texts[k]);
    for (int k = 0; k < 500000; k++) {
        char text[400];
        double scale = ldexp(1.0, -(int)(random_bits() % 60));
        double value = ((double)random_bits() * 4294967296.0 + (double)random_bits()) * scale;
        snprintf(text, sizeof text, k % 3 ? "%.*f" : "%.*g", 1 + (int)(random_bits() % 20), k % 2 ? -value : value);
        check_read(text);
    }
}

/* A number in hexadecimal is none: it ends behind its 0. */
static void decimal_refuses_hexadecimal(void **state) {
    (void)state;
    static const char *const texts[] = {"0x1e", "-0X1.8p3", "00x2", "0x"};
    for (size_t k = 0; k < sizeof texts / sizeof texts[0]; k++) {
        double value = 7.0;
        const char *end = decimal_read(texts[k], &value);
        assert_true(*end == 'x' || *end == 'X');
        assert_true(value >= 0.0 && value <= 0.0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(decimal_writes_what_printf_writes),
        cmocka_unit_test(decimal_reads_what_strtod_reads),
        cmocka_unit_test(decimal_refuses_hexadecimal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
