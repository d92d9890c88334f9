/* OpenEXR files of the compressions DWAA and DWAB, as OpenEXR's own interface writes them: lines and tiles, windows,
 * damage. */
#include "image/fixture.h"

#include <stdbool.h>

#include <ImfCRgbaFile.h>

enum { WIDTH = 70, HEIGHT = 90, TILE = 32, LEFT = -3, TOP = 5 };

static float value(int channel, int x, int y) {
    return 0.25f + 0.5f * (float)channel + 0.01f * (float)x + 0.02f * (float)y;
}

/* Writes the file and reads its bytes. Its data window begins at LEFT, TOP; what is displayed is from 0, 0. */
static Bytes made(int compression, bool tiled, int channels) {
    static ImfRgba whole[TOP + HEIGHT][WIDTH];
    static Bytes bytes;
    char folder[SCRATCH_SIZE], path[300];
    assert_true(scratch_make(folder));
    snprintf(path, sizeof path, "%s/dwa.exr", folder);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            ImfRgba *pixel = &whole[TOP + y][x];
            ImfFloatToHalf(value(0, x, y), &pixel->r);
            ImfFloatToHalf(value(1, x, y), &pixel->g);
            ImfFloatToHalf(value(2, x, y), &pixel->b);
            ImfFloatToHalf(1.0f, &pixel->a);
        }
    ImfHeader *header = ImfNewHeader();
    ImfHeaderSetDataWindow(header, LEFT, TOP, LEFT + WIDTH - 1, TOP + HEIGHT - 1);
    ImfHeaderSetDisplayWindow(header, 0, 0, WIDTH - 1, HEIGHT - 1);
    ImfHeaderSetCompression(header, compression);
    const ImfRgba *origin = &whole[0][-LEFT]; /* of pixel 0, 0, which the window does not have */
    if (tiled) {
        ImfTiledOutputFile *file = ImfOpenTiledOutputFile(path, header, channels, TILE, TILE, IMF_ONE_LEVEL, 0);
        assert_true(file && ImfTiledOutputSetFrameBuffer(file, origin, 1, WIDTH));
        assert_true(ImfTiledOutputWriteTiles(file, 0, (WIDTH - 1) / TILE, 0, (HEIGHT - 1) / TILE, 0, 0));
        assert_true(ImfCloseTiledOutputFile(file));
    } else {
        ImfOutputFile *file = ImfOpenOutputFile(path, header, channels);
        assert_true(file && ImfOutputSetFrameBuffer(file, origin, 1, WIDTH) && ImfOutputWritePixels(file, HEIGHT));
        assert_true(ImfCloseOutputFile(file));
    }
    ImfDeleteHeader(header);
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    bytes.size = fread(bytes.data, 1, sizeof bytes.data, stream);
    assert_true(bytes.size < sizeof bytes.data && fclose(stream) == 0);
    assert_true(scratch_remove(folder));
    return bytes;
}

static void exr_of_dwa_is_read(void **state) {
    (void)state;
    for (int compression = IMF_DWAA_COMPRESSION; compression <= IMF_DWAB_COMPRESSION; compression++)
        for (int tiled = 0; tiled < 2; tiled++)
            for (int alpha = 0; alpha < 2; alpha++) {
                Bytes bytes = made(compression, tiled, alpha ? IMF_WRITE_RGBA : IMF_WRITE_RGB);
                WeftImage image = read_bytes(&bytes);
                assert_shape(&image, WIDTH, HEIGHT, 3 + alpha, WEFT_PIXEL_F32);
                for (int y = 0; y < HEIGHT; y++)
                    for (int x = 0; x < WIDTH; x++) {
                        const bool inside = x - LEFT < WIDTH && y >= TOP;
                        const float *at = (const float *)image.pixels + (y * WIDTH + x) * image.channels;
                        for (int c = 0; c < 3; c++)
                            assert_near(at[c], inside ? value(c, x - LEFT, y - TOP) : 0.0f, 0.06f);
                        if (alpha) assert_near(at[3], inside ? 1.0f : 0.0f, 1e-3f);
                    }
                weft_image_free(&image);
            }
}

static void damaged_dwa_is_refused_or_read(void **state) {
    (void)state;
    Bytes bytes = made(IMF_DWAA_COMPRESSION, false, IMF_WRITE_RGB);
    for (size_t size = 0; size < bytes.size; size += 1 + bytes.size / 97) {
        Bytes cut = bytes;
        cut.size = size;
        WeftImage image;
        WeftError error = {0};
        const WeftResult result = weft_image_read_memory(cut.data, cut.size, "bytes", &image, NULL, &error);
        assert_int_equal(result, WEFT_INPUT);
        assert_null(image.pixels);
    }
    for (size_t at = 400; at < bytes.size; at += 1 + bytes.size / 61) {
        Bytes wrong = bytes;
        wrong.data[at] ^= 0x55;
        WeftImage image;
        WeftError error = {0};
        const WeftResult result = weft_image_read_memory(wrong.data, wrong.size, "bytes", &image, NULL, &error);
        assert_true(result == WEFT_OK || (result == WEFT_INPUT && strncmp(error.text, "bytes: ", 7) == 0));
        weft_image_free(&image);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exr_of_dwa_is_read),
        cmocka_unit_test(damaged_dwa_is_refused_or_read),
    };
    return cmocka_run_group_tests_name("exr_dwa", tests, NULL, NULL);
}
