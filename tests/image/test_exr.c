/* OpenEXR files as OpenEXRCore writes them: compressions, types, tiles, windows, layers, parts; round trips
 * of ours; damage and claims. */
#include "image/fixture.h"

#include <math.h>
#include <stdbool.h>

#include <openexr.h>

enum { WIDTH = 21, HEIGHT = 37, TILE = 16, CHANNELS_MAX = 5 };

typedef struct Form {
    exr_compression_t compression;
    int tiled;                   /* 1: one level, 2: mip levels */
    int parts;                   /* 0 means 1 */
    exr_storage_t first_storage; /* of part 0 */
    const char *channels[CHANNELS_MAX + 1];
    exr_pixel_type_t types[CHANNELS_MAX];
    int sampling;              /* of the last channel; 0 means 1 */
    int window[4], display[4]; /* x y width height; zero: the full size at 0 */
    float (*value)(int channel, int x, int y);
} Form;

/* Small dyadic numbers that half, float and uint hold exactly. */
static float plain(int channel, int x, int y) { return (float)((x * 3 + y * 5 + channel * 7) % 64); }

/* Whole numbers too, but without jumps: blocks that B44 keeps within a few. */
static float smooth(int channel, int x, int y) {
    const int value = channel * 8 + 16 + x / 4 + y / 4;
    return (float)value;
}

static int64_t append(exr_const_context_t exr, void *user, const void *data, uint64_t size, uint64_t offset,
                      exr_stream_error_func_ptr_t report) {
    (void)exr;
    (void)report;
    Bytes *bytes = user;
    assert_true(offset + size <= sizeof bytes->data);
    memcpy(bytes->data + offset, data, size);
    if (offset + size > bytes->size) bytes->size = offset + size;
    return (int64_t)size;
}

static void silent(exr_const_context_t exr, exr_result_t code, const char *text) {
    (void)exr;
    (void)code;
    (void)text;
}

static void good(exr_result_t status) {
    assert_string_equal(exr_get_default_error_message(status), exr_get_default_error_message(EXR_ERR_SUCCESS));
}

static exr_attr_box2i_t box(const int window[4]) {
    exr_attr_box2i_t result;
    result.min.x = window[0];
    result.min.y = window[1];
    result.max.x = window[0] + window[2] - 1;
    result.max.y = window[1] + window[3] - 1;
    return result;
}

static void describe(exr_context_t exr, const Form *form, int part) {
    static const int full[4] = {0, 0, WIDTH, HEIGHT};
    const exr_attr_box2i_t data = box(form->window[2] ? form->window : full);
    const exr_attr_box2i_t display = box(form->display[2] ? form->display : full);
    const exr_attr_v2f_t center = {{{0.0f, 0.0f}}};
    good(exr_initialize_required_attr(exr, part, &display, &data, 1.0f, &center, 1.0f, EXR_LINEORDER_INCREASING_Y,
                                      form->compression));
    for (int c = 0; form->channels[c]; c++) {
        const int sampling = form->sampling && !form->channels[c + 1] ? form->sampling : 1;
        good(exr_add_channel(exr, part, form->channels[c], form->types[c], EXR_PERCEPTUALLY_LOGARITHMIC, sampling,
                             sampling));
    }
    if (form->tiled)
        good(exr_set_tile_descriptor(exr, part, TILE, TILE,
                                     form->tiled == 2 ? EXR_TILE_MIPMAP_LEVELS : EXR_TILE_ONE_LEVEL,
                                     EXR_TILE_ROUND_DOWN));
    good(exr_set_version(exr, part, 1));
}

/* A chunk that compression does not make smaller is stored as it is; OpenEXRCore 3.1.5 stores what its
 * compressors made of it where that is as large (ZIP) or larger (B44). */
static exr_result_t (*library_compress)(exr_encode_pipeline_t *);

static exr_result_t compress_right(exr_encode_pipeline_t *pipeline) {
    exr_result_t status = library_compress(pipeline);
    if (status == EXR_ERR_SUCCESS && pipeline->compressed_bytes >= pipeline->packed_bytes) {
        memcpy(pipeline->compressed_buffer, pipeline->packed_buffer, pipeline->packed_bytes);
        pipeline->compressed_bytes = pipeline->packed_bytes;
    }
    return status;
}

/* A chunk whose first pixel is (x, y) of the data window. Channels are handed over as float or uint; the
 * library makes half of float. */
static void encode(exr_context_t exr, const Form *form, int part, const exr_chunk_info_t *chunk, int x, int y) {
    static uint32_t planes[CHANNELS_MAX][WIDTH * 4 * HEIGHT * 4];
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    good(exr_encoding_initialize(exr, part, chunk, &pipeline));
    for (int c = 0; c < pipeline.channel_count; c++) {
        exr_coding_channel_info_t *channel = pipeline.channels + c;
        const int whole = form->types[c] == EXR_PIXEL_UINT;
        for (int n = 0; n < chunk->width * chunk->height; n++) {
            const float value = form->value(c, x + n % chunk->width, y + n / chunk->width);
            if (whole)
                planes[c][n] = (uint32_t)value;
            else
                memcpy(&planes[c][n], &value, 4);
        }
        channel->encode_from_ptr = (const uint8_t *)planes[c];
        channel->user_data_type = whole ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = 4;
        channel->user_pixel_stride = 4;
        channel->user_line_stride = 4 * chunk->width;
    }
    good(exr_encoding_choose_default_routines(exr, part, &pipeline));
    library_compress = pipeline.compress_fn;
    if (library_compress) pipeline.compress_fn = compress_right;
    good(exr_encoding_run(exr, part, &pipeline));
    good(exr_encoding_destroy(exr, &pipeline));
}

static void encode_part(exr_context_t exr, const Form *form, int part) {
    const int width = form->window[2] ? form->window[2] : WIDTH, height = form->window[3] ? form->window[3] : HEIGHT;
    const int top = form->window[1];
    exr_chunk_info_t chunk;
    int levels = 1, lines = 1;
    if (form->tiled)
        good(exr_get_tile_levels(exr, part, &levels, NULL));
    else
        good(exr_get_scanlines_per_chunk(exr, part, &lines));
    for (int y = 0; !form->tiled && y < height; y += lines) {
        good(exr_write_scanline_chunk_info(exr, part, top + y, &chunk));
        encode(exr, form, part, &chunk, 0, y);
    }
    for (int level = 0; form->tiled && level < levels; level++)
        for (int y = 0; y * TILE < (height >> level) || y == 0; y++)
            for (int x = 0; x * TILE < (width >> level) || x == 0; x++) {
                good(exr_write_tile_chunk_info(exr, part, x, y, level, level, &chunk));
                encode(exr, form, part, &chunk, x * TILE, y * TILE);
            }
}

static Bytes exr_make(Form form) {
    Bytes bytes = {.size = 0};
    if (!form.value) form.value = plain;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.user_data = &bytes;
    setup.write_fn = append;
    setup.error_handler_fn = silent;
    exr_context_t exr;
    good(exr_start_write(&exr, "bytes", EXR_WRITE_FILE_DIRECTLY, &setup));
    const int parts = form.parts ? form.parts : 1;
    for (int p = 0; p < parts; p++) {
        char name[16];
        int part;
        snprintf(name, sizeof name, "part%d", p);
        good(exr_add_part(exr, name,
                          p == 0 && form.first_storage ? form.first_storage
                          : form.tiled                 ? EXR_STORAGE_TILED
                                                       : EXR_STORAGE_SCANLINE,
                          &part));
        describe(exr, &form, part);
    }
    good(exr_write_header(exr));
    for (int p = 0; p < parts; p++)
        if (p > 0 || form.first_storage < EXR_STORAGE_DEEP_SCANLINE) encode_part(exr, &form, p);
    exr_finish(&exr); /* complains of the chunks that a deep part lacks, after writing the tables */
    return bytes;
}

static const float *pixel(const WeftImage *image, int x, int y) {
    return (const float *)image->pixels + (y * image->width + x) * image->channels;
}

#define RGB_HALF .channels = {"B", "G", "R"}, .types = {EXR_PIXEL_HALF, EXR_PIXEL_HALF, EXR_PIXEL_HALF}

/* Every compression, type, tiling and set of channels: what is no loss comes back exactly. */
static void exr_of_every_compression_type_and_tiling_is_read(void **state) {
    (void)state;
    static const struct {
        const char *channels[CHANNELS_MAX + 1];
        int count, from[4]; /* our channels and the file's for each */
    } sets[] = {{{"Y"}, 1, {0}},
                {{"B", "G", "R"}, 3, {2, 1, 0}},
                {{"B", "G", "R", "Z"}, 3, {2, 1, 0}},
                {{"G", "R"}, 3, {1, 0, -1}},
                {{"B", "G", "R", "Z", "id"}, 3, {2, 1, 0}},
                {{"Y", "Z", "z2"}, 1, {0}}};
    for (int compression = 0; compression < EXR_COMPRESSION_DWAA; compression++)
        for (int tiled = 0; tiled <= 2; tiled++)
            for (size_t set = 0; set < sizeof sets / sizeof *sets; set++)
                for (int type = 0; type <= 3; type++) { /* 3: mixed */
                    Form form = {.compression = (exr_compression_t)compression, .tiled = tiled};
                    for (int c = 0; sets[set].channels[c]; c++) {
                        form.channels[c] = sets[set].channels[c];
                        form.types[c] = (exr_pixel_type_t)(type < 3 ? type : c == 3 ? EXR_PIXEL_FLOAT : (c + 1) % 3);
                    }
                    const int lossy = compression == EXR_COMPRESSION_B44 || compression == EXR_COMPRESSION_B44A;
                    form.value = lossy ? smooth : plain;
                    Bytes bytes = exr_make(form);
                    const bool whole = sets[set].count == 1 || sets[set].from[2] >= 0;
                    WeftImage image = whole ? read_bytes(&bytes) : read_bytes_said(&bytes, "the colour that it lacks");
                    assert_shape(&image, WIDTH, HEIGHT, sets[set].count, WEFT_PIXEL_F32);
                    for (int n = 0; n < WIDTH * HEIGHT * sets[set].count; n++) {
                        const int c = n % sets[set].count, p = n / sets[set].count, from = sets[set].from[c];
                        const float want = from < 0 ? 0.0f : form.value(from, p % WIDTH, p / WIDTH);
                        assert_near(((float *)image.pixels)[n], want, lossy ? 4.0f : 0.0f);
                    }
                    weft_image_free(&image);
                }
}

/* The display window is the image; what the data window lacks is 0, what it has beyond is dropped. */
static void exr_display_window_is_the_image(void **state) {
    (void)state;
    static const struct {
        int window[4], display[4];
    } cases[] = {{{3, 4, 9, 20}, {0, 0, 21, 37}},
                 {{-5, -7, 30, 40}, {0, 0, 21, 17}},
                 {{-5, 9, 12, 20}, {-2, -3, 8, 14}},
                 {{100, 100, 5, 5}, {0, 0, 9, 9}},
                 {{1, -20, 6, 60}, {-3, -4, 30, 3}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int tiled = 0; tiled < 2; tiled++) {
            Form form = {.compression = EXR_COMPRESSION_ZIP, .tiled = tiled, RGB_HALF};
            memcpy(form.window, cases[i].window, sizeof form.window);
            memcpy(form.display, cases[i].display, sizeof form.display);
            Bytes bytes = exr_make(form);
            WeftImage image = read_bytes(&bytes);
            assert_shape(&image, form.display[2], form.display[3], 3, WEFT_PIXEL_F32);
            for (int y = 0; y < image.height; y++)
                for (int x = 0; x < image.width; x++) {
                    const int column = form.display[0] + x - form.window[0], row = form.display[1] + y - form.window[1];
                    const int inside = column >= 0 && column < form.window[2] && row >= 0 && row < form.window[3];
                    for (int c = 0; c < 3; c++)
                        assert_near(pixel(&image, x, y)[c], inside ? plain(2 - c, column, row) : 0.0f, 0.0f);
                }
            weft_image_free(&image);
        }
}

static float half_covered(int channel, int x, int y) {
    if (channel == 0) return x == 0 ? 0.0f : 0.5f;
    return (float)(channel * (y + 1)) / 64.0f;
}

/* Colours times alpha in the file, straight in the image; light without cover stays. */
static void exr_with_alpha_is_divided_by_it(void **state) {
    (void)state;
    Bytes bytes = exr_make((Form){.channels = {"A", "B", "G", "R"},
                                  .types = {EXR_PIXEL_HALF, EXR_PIXEL_HALF, EXR_PIXEL_HALF, EXR_PIXEL_HALF},
                                  .compression = EXR_COMPRESSION_PIZ,
                                  .value = half_covered});
    WeftImage image = read_bytes(&bytes);
    assert_shape(&image, WIDTH, HEIGHT, 4, WEFT_PIXEL_F32);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < 2; x++) {
            assert_near(pixel(&image, x, y)[3], x == 0 ? 0.0f : 0.5f, 0.0f);
            for (int c = 0; c < 3; c++)
                assert_near(pixel(&image, x, y)[c], (float)((3 - c) * (y + 1)) / (x == 0 ? 64.0f : 32.0f), 0.0f);
        }
    weft_image_free(&image);
}

static void exr_with_layers_or_parts_reads_the_first_colours(void **state) {
    (void)state;
    const exr_pixel_type_t half = EXR_PIXEL_HALF;
    static const struct {
        const char *channels[CHANNELS_MAX + 1];
        int count, from; /* our channels, and where the first of them is in the file */
        const char *said;
    } cases[] = {{{"B", "G", "R", "diffuse.R"}, 3, 2, NULL},
                 {{"a.Z", "b.c.B", "b.c.G", "b.c.R"}, 3, 3, "it shows channels b.c.R b.c.G b.c.B"},
                 {{"a.Y", "b.R"}, 1, 0, "it shows channel a.Y, as grey"},
                 {{"Y", "a.R"}, 1, 0, NULL},
                 {{"b", "g", "r"}, 3, 2, "it shows channels r g b"},
                 {{"blue", "green", "red"}, 3, 2, "it shows channels red green blue"},
                 {{"Alpha", "Blue", "Green", "Red"}, 4, 3, "it shows channels Red Green Blue"},
                 {{"V"}, 1, 0, "it shows channel V, as grey"},
                 {{"Depth.V", "a.Z"}, 1, 0, "it shows channel Depth.V, as grey"},
                 {{"R"}, 1, 0, "it shows channel R, as grey"},
                 {{"Y", "y"}, 1, 0, NULL}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Form form = {.compression = EXR_COMPRESSION_ZIPS, .types = {half, half, half, half, half}};
        memcpy(form.channels, cases[i].channels, sizeof form.channels);
        Bytes bytes = exr_make(form);
        WeftImage image = cases[i].said ? read_bytes_said(&bytes, cases[i].said) : read_bytes(&bytes);
        assert_int_equal(image.channels, cases[i].count);
        if (image.channels < 4) assert_near(pixel(&image, 5, 6)[0], plain(cases[i].from, 5, 6), 0.0f);
        weft_image_free(&image);
    }
    for (int tiled = 0; tiled < 2; tiled++) {
        Bytes bytes = exr_make((Form){.compression = EXR_COMPRESSION_RLE, .tiled = tiled, .parts = 2, RGB_HALF});
        WeftImage image = read_bytes_said(&bytes, "it shows the first of its 2 parts");
        assert_shape(&image, WIDTH, HEIGHT, 3, WEFT_PIXEL_F32);
        assert_near(pixel(&image, 5, 6)[0], plain(2, 5, 6), 0.0f);
        weft_image_free(&image);
    }
}

static float white_xyz(int channel, int x, int y) {
    static const float xyz[3] = {0.95046f, 1.0f, 1.08906f}; /* of D65, times a number */
    return xyz[channel] * (1.0f + (float)((x + y) % 4));
}

/* X Y Z are colours of CIE, not a position and not Y alone. */
static void exr_of_xyz_becomes_rec709(void **state) {
    (void)state;
    const exr_pixel_type_t single = EXR_PIXEL_FLOAT;
    Bytes bytes = exr_make((Form){.channels = {"X", "Y", "Z"}, .types = {single, single, single}, .value = white_xyz});
    WeftImage image = read_bytes_said(&bytes, "it shows channels X Y Z, as CIE XYZ");
    assert_shape(&image, WIDTH, HEIGHT, 3, WEFT_PIXEL_F32);
    for (int c = 0; c < 3; c++) assert_near(pixel(&image, 6, 7)[c], 2.0f, 2e-3f);
    weft_image_free(&image);
}

/* Replaces the value of an attribute (its type name is `type`) in a finished file. */
static void patch(Bytes *bytes, const char *name, const char *type, const void *value, size_t size) {
    char key[64];
    const size_t a = strlen(name) + 1, b = strlen(type) + 1;
    memcpy(key, name, a);
    memcpy(key + a, type, b);
    for (size_t i = 0; i + a + b + 4 + size < bytes->size; i++)
        if (memcmp(bytes->data + i, key, a + b) == 0) {
            memcpy(bytes->data + i + a + b + 4, value, size);
            return;
        }
    fail_msg("no attribute %s", name);
}

static void unsupported_exr_is_refused(void **state) {
    (void)state;
    const exr_pixel_type_t half = EXR_PIXEL_HALF;
    Bytes bytes = exr_make((Form){.channels = {"BY", "RY", "Y"}, .types = {half, half, half}});
    refuse(&bytes, WEFT_MESSAGE_IMAGE_UNSUPPORTED);
    bytes = exr_make((Form){.channels = {"Z"}, .types = {EXR_PIXEL_FLOAT}});
    refuse(&bytes, WEFT_MESSAGE_IMAGE_UNSUPPORTED);
    bytes = exr_make((Form){.first_storage = EXR_STORAGE_DEEP_SCANLINE, .compression = EXR_COMPRESSION_ZIPS, RGB_HALF});
    refuse(&bytes, WEFT_MESSAGE_IMAGE_UNSUPPORTED);
    for (int i = EXR_COMPRESSION_DWAA; i <= EXR_COMPRESSION_DWAB; i++) {
        const unsigned char dwa = (unsigned char)i;
        bytes = exr_make((Form){.compression = EXR_COMPRESSION_ZIP, RGB_HALF});
        patch(&bytes, "compression", "compression", &dwa, 1); /* its chunks are not of that kind */
        refuse(&bytes, WEFT_MESSAGE_IMAGE_DAMAGED);
    }
}

static void exr_that_claims_too_many_pixels_is_refused(void **state) {
    (void)state;
    static const int32_t windows[][4] = {{0, 0, 65536, 0},
                                         {0, 0, 59999, 59999},
                                         {0, 0, 1999, 1999},
                                         {0, 0, -1, 5},
                                         {-2147483647, 0, -2147483600, 30},
                                         {2147483600, 0, 2147483620, 30},
                                         {-2000000000, 0, 2000000000, 30}};
    for (size_t i = 0; i < sizeof windows / sizeof *windows; i++)
        for (int which = 0; which < 2; which++) {
            Bytes bytes = exr_make((Form){.compression = EXR_COMPRESSION_ZIP, RGB_HALF});
            patch(&bytes, which ? "displayWindow" : "dataWindow", "box2i", windows[i], sizeof windows[i]);
            WeftImage image;
            WeftError error = {0};
            /* only the display window of 2000 x 2000 can be meant */
            const WeftResult result = weft_image_read_memory(bytes.data, bytes.size, "bytes", &image, NULL, &error);
            assert_int_equal(result, which && i == 2 ? WEFT_OK : WEFT_INPUT);
            if (result != WEFT_OK)
                assert_true(error.message == WEFT_MESSAGE_IMAGE_SIZE || error.message == WEFT_MESSAGE_IMAGE_DAMAGED);
            weft_image_free(&image);
        }
    static const int32_t fits[] = {0, 0, 1999, 1999};
    Bytes bytes = exr_make((Form){.compression = EXR_COMPRESSION_ZIP, RGB_HALF});
    patch(&bytes, "dataWindow", "box2i", fits, sizeof fits);
    refuse(&bytes, WEFT_MESSAGE_IMAGE_SIZE);
}

static void damaged_exr_is_refused_or_read(void **state) {
    (void)state;
    for (int tiled = 0; tiled < 2; tiled++) {
        Bytes bytes = exr_make((Form){.compression = EXR_COMPRESSION_ZIP, .tiled = tiled, RGB_HALF});
        refuse_prefixes(&bytes);
        for (size_t i = 4; i < bytes.size; i++) { /* any outcome but a crash, and no image on failure */
            Bytes damaged = bytes;
            damaged.data[i] ^= (unsigned char)(1 << i % 8);
            WeftImage image;
            WeftError error = {0};
            if (weft_image_read_memory(damaged.data, damaged.size, "bytes", &image, NULL, &error) != WEFT_OK) {
                assert_int_equal(error.result, WEFT_INPUT);
                assert_null(image.pixels);
            }
            weft_image_free(&image);
        }
    }
}

static float wild(int channel, int x, int y) {
    if (y != 3) return 1.0f;
    return x == 1 ? NAN : x == 2 ? INFINITY : x == 3 && channel == 0 ? -INFINITY : 2.0f;
}

static void exr_values_that_are_not_finite_become_finite(void **state) {
    (void)state;
    for (exr_pixel_type_t type = EXR_PIXEL_HALF; type <= EXR_PIXEL_FLOAT; type++) {
        Bytes bytes = exr_make((Form){.channels = {"B", "G", "R"},
                                      .types = {type, type, type},
                                      .compression = EXR_COMPRESSION_ZIP,
                                      .value = wild});
        int warnings = 0;
        const WeftLog log = {count_warning, &warnings};
        WeftImage image;
        assert_int_equal(weft_image_read_memory(bytes.data, bytes.size, "bytes", &image, &log, NULL), WEFT_OK);
        assert_int_equal(warnings, 1);
        for (int c = 0; c < 3; c++) {
            assert_near(pixel(&image, 1, 3)[c], 0.0f, 0.0f);
            assert_near(pixel(&image, 2, 3)[c], 0.0f, 0.0f);
            assert_near(pixel(&image, 3, 3)[c], c == 2 ? 0.0f : 2.0f, 0.0f);
            assert_near(pixel(&image, 4, 3)[c], 2.0f, 0.0f);
        }
        weft_image_free(&image);
    }
}

/* All finite halves, subnormal ones too, survive writing and reading. */
static void exr_reads_every_half_float(void **state) {
    (void)state;
    WeftImage image = make_image(31 * 64, 2, 3, WEFT_PIXEL_F32);
    float *values = image.pixels;
    for (int n = 0; n < 31 * 64 * 2; n++)
        for (int c = 0; c < 3; c++) {
            const int half = n * 16 + c * 5, exponent = half % 31744 >> 10, mantissa = half & 1023;
            const float size =
                exponent ? ldexpf((float)(1024 + mantissa), exponent - 25) : ldexpf((float)mantissa, -24);
            values[3 * n + c] = half >= 31744 ? -size : size;
        }
    WeftImage back = write_and_read(&image, ".exr");
    assert_shape(&back, image.width, image.height, 3, WEFT_PIXEL_F32);
    for (size_t i = 0; i < value_total(&image); i++) assert_near(((float *)back.pixels)[i], values[i], 0.0f);
    weft_image_free(&back);
    weft_image_free(&image);
}

static void exr_reads_what_it_wrote(void **state) {
    (void)state;
    for (int channels = 1; channels <= 4; channels++)
        for (int height = 1; height <= 33; height += 16) {
            WeftImage image = make_image(19, height, channels, WEFT_PIXEL_F32);
            float *values = image.pixels;
            for (size_t i = 0; i < value_total(&image); i++)
                values[i] = channels % 2 == 0 && (int)i % channels == channels - 1 ? 0.25f + (float)(i % 7) / 10.0f
                                                                                   : expf((float)(i % 19) - 9.0f);
            WeftImage back = write_and_read(&image, ".exr");
            assert_shape(&back, 19, height, channels, WEFT_PIXEL_F32);
            for (size_t i = 0; i < value_total(&image); i++)
                assert_true(fabsf(((float *)back.pixels)[i] - values[i]) <= values[i] * 0x1p-9f + 1e-6f);
            weft_image_free(&back);
            weft_image_free(&image);
        }
}

/* Among these lines are some that compress to exactly their own size. */
static void exr_lines_that_do_not_compress_read_back(void **state) {
    (void)state;
    uint32_t random = 1;
    for (int width = 9; width < 40; width += 2)
        for (int levels = 8; levels <= 32; levels *= 2) {
            WeftImage image = make_image(width, 1, 1, WEFT_PIXEL_F32);
            for (int x = 0; x < width; x++) {
                random = random * 1664525u + 1013904223u;
                ((float *)image.pixels)[x] = (float)((int)(random >> 16) % levels);
            }
            WeftImage back = write_and_read(&image, ".exr");
            assert_memory_equal(back.pixels, image.pixels, (size_t)width * sizeof(float));
            weft_image_free(&back);
            weft_image_free(&image);
        }
}

static void exr_writes_values_beyond_half_clamped(void **state) {
    (void)state;
    static const float odd[] = {1e30f, -1e30f, INFINITY, -INFINITY, NAN, 65520.0f};
    static const float want[] = {65504.0f, -65504.0f, 65504.0f, -65504.0f, 0.0f, 65504.0f};
    WeftImage image = make_image(6, 1, 3, WEFT_PIXEL_F32);
    for (int x = 0; x < 6; x++) ((float *)image.pixels)[3 * x] = odd[x];
    WeftImage back = write_and_read(&image, ".exr");
    for (int x = 0; x < 6; x++) assert_near(pixel(&back, x, 0)[0], want[x], 0.0f);
    weft_image_free(&back);
    weft_image_free(&image);
}

/* Data: every bit of a float, and no product with alpha, by which the reader divides. */
static void exr_of_data_keeps_every_bit(void **state) {
    (void)state;
    const WeftImageWriting how = {.data = 1, .single = 1, .comment = "weft bake \"this\""};
    for (int channels = 1; channels <= 4; channels++) {
        WeftImage image = make_image(23, 18, channels, WEFT_PIXEL_F32);
        float *values = image.pixels;
        for (size_t i = 0; i < value_total(&image); i++)
            values[i] = channels % 2 == 0 && (int)i % channels == channels - 1
                            ? 0.25f
                            : ldexpf((float)(i * 7919 % 65521) - 3e4f, (int)(i % 60) - 40);
        WeftImage back = write_and_read_as(&image, ".exr", &how);
        assert_shape(&back, 23, 18, channels, WEFT_PIXEL_F32);
        for (size_t i = 0; i < value_total(&image); i++) {
            const int straight = channels % 2 || (int)i % channels == channels - 1;
            assert_near(((float *)back.pixels)[i], straight ? values[i] : 4.0f * values[i], 0.0f);
        }
        weft_image_free(&back);
        weft_image_free(&image);
    }
}

static void fill(WeftImage *image, float scale) {
    for (size_t i = 0; i < value_total(image); i++)
        ((float *)image->pixels)[i] = image->channels % 2 == 0 && i % 4 == 3 ? 0.5f : scale * (float)(i * 7919 % 1021);
}

static void count_denoised(void *user, WeftMessage message, const char *text) {
    assert_int_equal(message, WEFT_MESSAGE_IMAGE_DENOISED);
    assert_non_null(strstr(text, "image.exr"));
    ++*(int *)user;
}

/* Channels beside the picture's: the picture reads as it does without them; they are there by name, and exact: of a
 * grey picture the reader takes a layer that is called R G B. */
static void exr_layers_leave_the_picture_as_it_is(void **state) {
    (void)state;
    WeftImage image = make_image(23, 35, 4, WEFT_PIXEL_F32), normal = make_image(23, 35, 3, WEFT_PIXEL_F32),
              depth = make_image(23, 35, 1, WEFT_PIXEL_F32);
    fill(&image, 0.25f), fill(&normal, 1e-7f), fill(&depth, 1e7f);
    const WeftImageLayer layers[] = {{&normal, {"N.X", "N.Y", "N.Z"}}, {&depth, {"Z"}}};
    WeftImage with = write_and_read_as(&image, ".exr", &(WeftImageWriting){.layers = layers, .layer_count = 2}),
              without = write_and_read(&image, ".exr");
    assert_shape(&with, 23, 35, 4, WEFT_PIXEL_F32);
    assert_memory_equal(with.pixels, without.pixels, value_total(&with) * sizeof(float));
    weft_image_free(&with);
    weft_image_free(&without);
    const WeftImageLayer colors = {&normal, {"R", "G", "B"}};
    with = write_and_read_as(&depth, ".exr", &(WeftImageWriting){.layers = &colors, .layer_count = 1});
    assert_shape(&with, 23, 35, 3, WEFT_PIXEL_F32);
    assert_memory_equal(with.pixels, normal.pixels, value_total(&with) * sizeof(float));
    weft_image_free(&with);

    WeftImage narrow = make_image(22, 35, 3, WEFT_PIXEL_F32);
    const WeftImageLayer wrong[] = {{&narrow, {"N.X", "N.Y", "N.Z"}}, {&normal, {"N.X", NULL, "N.Z"}}};
    for (int k = 0; k < 2; k++) {
        WeftError error = {0};
        const WeftImageWriting how = {.layers = &wrong[k], .layer_count = 1};
        assert_int_equal(weft_image_write_as("refused.exr", &image, &how, &error), WEFT_USAGE);
        assert_int_equal(error.message, WEFT_MESSAGE_DESC);
    }
    weft_image_free(&narrow);
    weft_image_free(&image);
    weft_image_free(&normal);
    weft_image_free(&depth);
}

/* A denoised picture says so, and the reader does. */
static void denoised_exr_warns_its_reader(void **state) {
    (void)state;
    char folder[SCRATCH_SIZE], path[300];
    assert_true(scratch_make(folder));
    snprintf(path, sizeof path, "%s/image.exr", folder);
    WeftImage image = make_image(8, 8, 3, WEFT_PIXEL_F32), back;
    for (int denoised = 0; denoised < 2; denoised++) {
        int warnings = 0;
        const WeftLog log = {count_denoised, &warnings};
        const WeftImageWriting how = {.denoised = denoised ? "regression" : NULL};
        assert_int_equal(weft_image_write_as(path, &image, &how, NULL), WEFT_OK);
        assert_int_equal(weft_image_read(path, &back, &log, NULL), WEFT_OK);
        assert_int_equal(warnings, denoised);
        weft_image_free(&back);
    }
    weft_image_free(&image);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(rmdir(folder), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exr_of_every_compression_type_and_tiling_is_read),
        cmocka_unit_test(exr_display_window_is_the_image),
        cmocka_unit_test(exr_with_alpha_is_divided_by_it),
        cmocka_unit_test(exr_with_layers_or_parts_reads_the_first_colours),
        cmocka_unit_test(unsupported_exr_is_refused),
        cmocka_unit_test(exr_that_claims_too_many_pixels_is_refused),
        cmocka_unit_test(damaged_exr_is_refused_or_read),
        cmocka_unit_test(exr_values_that_are_not_finite_become_finite),
        cmocka_unit_test(exr_reads_every_half_float),
        cmocka_unit_test(exr_reads_what_it_wrote),
        cmocka_unit_test(exr_lines_that_do_not_compress_read_back),
        cmocka_unit_test(exr_writes_values_beyond_half_clamped),
        cmocka_unit_test(exr_of_data_keeps_every_bit),
        cmocka_unit_test(exr_of_xyz_becomes_rec709),
        cmocka_unit_test(exr_layers_leave_the_picture_as_it_is),
        cmocka_unit_test(denoised_exr_warns_its_reader),
    };
    return cmocka_run_group_tests_name("exr", tests, NULL, NULL);
}
