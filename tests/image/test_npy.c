/* NumPy arrays: every type, byte order and order of indices, from bytes put together here; what the writer
 * makes, byte by byte; and headers that lie. */
#include "image/fixture.h"

/* A file of version `major` whose dictionary is this text; its values are for the caller to add. */
static Bytes npy_begin(int major, const char *dictionary) {
    Bytes bytes = {.size = 0};
    put(&bytes, "\x93NUMPY", 6);
    put_byte(&bytes, major);
    put_byte(&bytes, 0);
    put_word(&bytes, (int)strlen(dictionary) + 1);
    if (major > 1) put_word(&bytes, 0);
    put_text(&bytes, dictionary);
    put_byte(&bytes, '\n');
    return bytes;
}

/* Value n of those that the tests put into arrays of every type: 0, 0.5, -0.375 and so on; whole for `u`. */
static double value(int n, char kind) { return kind == 'u' ? (double)((n * 37 + 5) % 251) : ((n * 37) % 29 - 7) / 8.0; }

/* The bits of a number that half holds exactly, by its definition: 1.f x 2^(e - 15). */
static unsigned half_bits(double x) {
    if (x == 0.0) return 0;
    int exponent;
    const double mantissa = 2.0 * frexp(fabs(x), &exponent); /* 1 .. 2 */
    return (x < 0.0 ? 0x8000u : 0u) | (unsigned)(exponent - 1 + 15) << 10 | (unsigned)((mantissa - 1.0) * 1024.0);
}

static uint64_t bits_of(double x, char kind, int size) {
    const float single = (float)x;
    uint32_t low;
    uint64_t all;
    if (kind == 'u') return (uint64_t)x * (size == 2 ? 257 : 1);
    if (size == 2) return half_bits(x);
    memcpy(&low, &single, sizeof low);
    memcpy(&all, &x, sizeof all);
    return size == 4 ? low : all;
}

static void put_bits(Bytes *bytes, uint64_t bits, int size, int big) {
    for (int k = 0; k < size; k++) put_byte(bytes, (int)(bits >> 8 * (big ? size - 1 - k : k) & 255));
}

enum { ROWS = 3, COLUMNS = 5 };

static void check_pixels(const WeftImage *image, char kind, int size) {
    for (size_t n = 0; n < value_total(image); n++) {
        const double want = value((int)n, kind);
        if (kind == 'f')
            assert_near(((float *)image->pixels)[n], (float)want, 0.0f);
        else if (size == 2)
            assert_int_equal(((uint16_t *)image->pixels)[n], 257 * (int)want);
        else
            assert_int_equal(((uint8_t *)image->pixels)[n], (int)want);
    }
}

static void npy_of_every_type_and_shape_is_read(void **state) {
    (void)state;
    static const struct {
        char kind;
        int size;
        WeftPixelType type;
    } types[] = {{'f', 2, WEFT_PIXEL_F32},
                 {'f', 4, WEFT_PIXEL_F32},
                 {'f', 8, WEFT_PIXEL_F32},
                 {'u', 1, WEFT_PIXEL_U8},
                 {'u', 2, WEFT_PIXEL_U16}};
    for (size_t t = 0; t < sizeof types / sizeof *types; t++)
        for (int form = 0; form < 4 * 5; form++) {
            const int big = form & 1, by_column = form & 2, channels = form / 4; /* 0: two indices */
            const int deep = channels ? channels : 1;
            char dictionary[128], last[16] = "";
            if (channels) snprintf(last, sizeof last, ", %d", channels);
            snprintf(dictionary, sizeof dictionary, "{'descr': '%c%c%d', 'fortran_order': %s, 'shape': (%d, %d%s), }",
                     big ? '>' : '<', types[t].kind, types[t].size, by_column ? "True" : "False", ROWS, COLUMNS, last);
            Bytes bytes = npy_begin(1 + form % 3, dictionary);
            /* the values in the order of the file: the last index fastest, or the first */
            for (int n = 0; n < ROWS * COLUMNS * deep; n++) {
                const int y = n % ROWS, x = n / ROWS % COLUMNS, c = n / ROWS / COLUMNS;
                const int index = by_column ? (y * COLUMNS + x) * deep + c : n;
                put_bits(&bytes, bits_of(value(index, types[t].kind), types[t].kind, types[t].size), types[t].size,
                         big);
            }
            WeftImage image = read_bytes(&bytes);
            assert_shape(&image, COLUMNS, ROWS, deep, types[t].type);
            check_pixels(&image, types[t].kind, types[t].size);
            weft_image_free(&image);
            if (form == 9) refuse_prefixes(&bytes);
        }
}

/* The dictionary may be written in other ways. */
static void npy_dictionary_in_any_spelling_is_read(void **state) {
    (void)state;
    static const char *const good[] = {
        "{'shape': (1, 2), 'fortran_order': False, 'descr': '|u1'}",
        "{\"descr\":\"|u1\",\"fortran_order\":False,\"shape\":(1L,2L,)}",
        "  { 'descr' : '|u1' ,\n 'fortran_order' : True , 'shape' : ( 1 , 2 ) , }   ",
    };
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        Bytes bytes = npy_begin(1, good[k]);
        put_text(&bytes, "\x07\x63 and what follows");
        WeftImage image = read_bytes(&bytes);
        assert_shape(&image, 2, 1, 1, WEFT_PIXEL_U8);
        assert_int_equal(((uint8_t *)image.pixels)[0], 7);
        assert_int_equal(((uint8_t *)image.pixels)[1], 99);
        weft_image_free(&image);
    }
}

static void npy_with_a_hostile_header_is_refused(void **state) {
    (void)state;
    static const struct {
        const char *dictionary;
        WeftMessage message;
    } bad[] = {
        {"", WEFT_MESSAGE_IMAGE_DAMAGED},
        {"{", WEFT_MESSAGE_IMAGE_DAMAGED},
        {"{}", WEFT_MESSAGE_IMAGE_DAMAGED},
        {"{,}", WEFT_MESSAGE_IMAGE_DAMAGED},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2)", WEFT_MESSAGE_IMAGE_DAMAGED},
        {"{'descr': '<f4' 'fortran_order': False, 'shape': (2, 2)}", WEFT_MESSAGE_IMAGE_DAMAGED},
        {"{'descr': '<f4, 'fortran_order': False, 'shape': (2, 2)}", WEFT_MESSAGE_IMAGE_DAMAGED},
        {"{'descr': '<f4', 'fortran_order': 1, 'shape': (2, 2)}", WEFT_MESSAGE_IMAGE_DAMAGED},
        {"{'descr': '<f4', 'shape': (2, 2)}", WEFT_MESSAGE_IMAGE_DAMAGED},
        {"{'descr': '<f4', 'fortran_order': False}", WEFT_MESSAGE_IMAGE_DAMAGED},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (-2, 2)}", WEFT_MESSAGE_IMAGE_DAMAGED},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2 2)}", WEFT_MESSAGE_IMAGE_DAMAGED},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2}", WEFT_MESSAGE_IMAGE_DAMAGED},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (,2, 2)}", WEFT_MESSAGE_IMAGE_DAMAGED},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2), 'more': 1}", WEFT_MESSAGE_IMAGE_DAMAGED},
        {"{'descr': [('r', '<f4')], 'fortran_order': False, 'shape': (2, 2)}", WEFT_MESSAGE_IMAGE_UNSUPPORTED},
        {"{'descr': '<i4', 'fortran_order': False, 'shape': (2, 2)}", WEFT_MESSAGE_IMAGE_UNSUPPORTED},
        {"{'descr': '<f16', 'fortran_order': False, 'shape': (2, 2)}", WEFT_MESSAGE_IMAGE_UNSUPPORTED},
        {"{'descr': '<f', 'fortran_order': False, 'shape': (2, 2)}", WEFT_MESSAGE_IMAGE_UNSUPPORTED},
        {"{'descr': '|O', 'fortran_order': False, 'shape': (2, 2)}", WEFT_MESSAGE_IMAGE_UNSUPPORTED},
        {"{'descr': 'f4', 'fortran_order': False, 'shape': (2, 2)}", WEFT_MESSAGE_IMAGE_UNSUPPORTED},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': ()}", WEFT_MESSAGE_IMAGE_UNSUPPORTED},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (4,)}", WEFT_MESSAGE_IMAGE_UNSUPPORTED},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2, 5)}", WEFT_MESSAGE_IMAGE_UNSUPPORTED},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2, 0)}", WEFT_MESSAGE_IMAGE_UNSUPPORTED},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1, 1, 1)}", WEFT_MESSAGE_IMAGE_UNSUPPORTED},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (0, 2)}", WEFT_MESSAGE_IMAGE_SIZE},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (65536, 65536)}", WEFT_MESSAGE_IMAGE_SIZE},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3)}", WEFT_MESSAGE_IMAGE_SIZE},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999999999999999999, 1)}", WEFT_MESSAGE_IMAGE_SIZE},
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        Bytes bytes = npy_begin(1, bad[k].dictionary);
        for (int n = 0; n < 4; n++) put_bits(&bytes, 0x3f800000, 4, 0); /* four values: enough for 2 x 2 */
        refuse(&bytes, bad[k].message);
    }
    Bytes later = npy_begin(4, "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1)}");
    put_bits(&later, 0, 4, 0);
    refuse(&later, WEFT_MESSAGE_IMAGE_UNSUPPORTED);
    refuse_bytes("\x93NUMPY\1\0\xff\xff{", 11, WEFT_MESSAGE_IMAGE_DAMAGED); /* a header longer than the file */
    refuse_bytes("\x93NUMPY\2\0\xff\xff\xff\xff{", 13, WEFT_MESSAGE_IMAGE_DAMAGED);
}

static void npy_values_become_finite(void **state) {
    (void)state;
    Bytes bytes = npy_begin(1, "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 4)}");
    const double values[] = {(double)NAN, -(double)INFINITY, 1e300, 0.25};
    for (int n = 0; n < 4; n++) put_bits(&bytes, bits_of(values[n], 'f', 8), 8, 0);
    WeftImage image;
    int warnings = 0;
    const WeftLog log = {count_warning, &warnings};
    assert_int_equal(weft_image_read_memory(bytes.data, bytes.size, "bytes", &image, &log, NULL), WEFT_OK);
    assert_int_equal(warnings, 1);
    for (int n = 0; n < 4; n++) assert_near(((float *)image.pixels)[n], n == 3 ? 0.25f : 0.0f, 0.0f);
    weft_image_free(&image);
}

/* What the format's specification makes of two small images, written out by hand. */
static void npy_writes_the_bytes_of_the_specification(void **state) {
    (void)state;
    static const char grey[] = "\x93NUMPY\1\0v\0{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }",
                      color[] = "\x93NUMPY\1\0v\0{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1, 2), }";
    static const unsigned char values[] = {0, 0, 0x80, 0x3f, 0, 0, 0x20, 0xc0}; /* 1 and -2.5 */
    for (int k = 0; k < 2; k++) {
        const char *head = k ? color : grey;
        const size_t head_size = k ? sizeof color - 1 : sizeof grey - 1;
        WeftImage image = make_image(k ? 1 : 2, 1, k ? 2 : 1, WEFT_PIXEL_F32);
        ((float *)image.pixels)[0] = 1.0f;
        ((float *)image.pixels)[1] = -2.5f;
        char folder[SCRATCH_SIZE], path[300];
        assert_true(scratch_make(folder));
        snprintf(path, sizeof path, "%s/image.npy", folder);
        assert_int_equal(weft_image_write(path, &image, NULL), WEFT_OK);
        unsigned char got[200];
        FILE *file = fopen(path, "rb");
        assert_non_null(file);
        assert_int_equal(fread(got, 1, sizeof got, file), 128 + sizeof values);
        fclose(file);
        assert_memory_equal(got, head, head_size);
        for (size_t n = head_size; n < 127; n++) assert_int_equal(got[n], ' ');
        assert_int_equal(got[127], '\n');
        assert_memory_equal(got + 128, values, sizeof values);
        assert_int_equal(unlink(path), 0);
        assert_int_equal(rmdir(folder), 0);
        weft_image_free(&image);
    }
}

static void npy_reads_what_it_wrote(void **state) {
    (void)state;
    for (int channels = 1; channels <= 4; channels++) {
        WeftImage image = make_image(37, 21, channels, WEFT_PIXEL_F32);
        for (size_t i = 0; i < value_total(&image); i++)
            ((float *)image.pixels)[i] = ldexpf((float)(i * 7919 % 65521) - 3e4f, (int)(i % 60) - 40);
        WeftImage back = write_and_read(&image, ".npy");
        assert_shape(&back, 37, 21, channels, WEFT_PIXEL_F32);
        assert_memory_equal(back.pixels, image.pixels, value_total(&image) * sizeof(float));
        weft_image_free(&back);
        weft_image_free(&image);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(npy_of_every_type_and_shape_is_read),
        cmocka_unit_test(npy_dictionary_in_any_spelling_is_read),
        cmocka_unit_test(npy_with_a_hostile_header_is_refused),
        cmocka_unit_test(npy_values_become_finite),
        cmocka_unit_test(npy_writes_the_bytes_of_the_specification),
        cmocka_unit_test(npy_reads_what_it_wrote),
    };
    return cmocka_run_group_tests_name("npy", tests, NULL, NULL);
}
