/* fixture.h - what the image tests share: bytes put together one by one, a folder to write to, a log that is
 * looked at */
#ifndef WEFT_TESTS_IMAGE_FIXTURE_H
#define WEFT_TESTS_IMAGE_FIXTURE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "scratch.h"
#include "weft/image.h"

typedef struct Bytes {
    unsigned char data[1 << 16];
    size_t size;
} Bytes;

static inline void put(Bytes *bytes, const void *data, size_t size) {
    assert_true(size <= sizeof bytes->data - bytes->size);
    memcpy(bytes->data + bytes->size, data, size);
    bytes->size += size;
}

static inline void put_byte(Bytes *bytes, int byte) { put(bytes, &(unsigned char){(unsigned char)byte}, 1); }

static inline void put_word(Bytes *bytes, int word) {
    put_byte(bytes, word & 255);
    put_byte(bytes, word >> 8);
}

static inline void put_text(Bytes *bytes, const char *text) { put(bytes, text, strlen(text)); }

/* A function, where cmocka's macro would cast the first part of an expression only; and NaN is near nothing.
 */
static inline void assert_near(float got, float want, float most) {
    if (!(fabsf(got - want) <= most)) fail_msg("%g is not %g within %g", (double)got, (double)want, (double)most);
}

/* Counts warnings; user is an int. */
static inline void count_warning(void *user, WeftMessage message, const char *text) {
    assert_int_equal(message, WEFT_MESSAGE_IMAGE_REPAIRED);
    assert_null(strchr(text, '\n'));
    ++*(int *)user;
}

/* Reads what must be readable without a warning. */
static inline WeftImage read_bytes(const Bytes *bytes) {
    WeftImage image;
    WeftError error = {0};
    int warnings = 0;
    const WeftLog log = {count_warning, &warnings};
    if (weft_image_read_memory(bytes->data, bytes->size, "bytes", &image, &log, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    assert_int_equal(warnings, 0);
    return image;
}

static inline void keep_warning(void *user, WeftMessage message, const char *text) {
    (void)message;
    snprintf(user, 512, "%s", text);
}

/* Reads what must be readable, with a last warning that has this part. */
static inline WeftImage read_bytes_said(const Bytes *bytes, const char *part) {
    WeftImage image;
    WeftError error = {0};
    char said[512] = "";
    const WeftLog log = {keep_warning, said};
    if (weft_image_read_memory(bytes->data, bytes->size, "bytes", &image, &log, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    if (!strstr(said, part)) fail_msg("\"%s\" has no \"%s\"", said, part);
    return image;
}

/* Asserts that reading fails with this message, in one line that starts with the name, and leaves no image.
 * The bytes are copied to a block of their exact size, so that a sanitizer sees a step over their end. */
static inline void refuse_bytes(const void *data, size_t size, WeftMessage message) {
    unsigned char *exact = malloc(size ? size : 1);
    assert_non_null(exact);
    memcpy(exact, data, size);
    WeftImage image = {.width = 7};
    WeftError error = {0};
    WeftResult result = weft_image_read_memory(exact, size, "bytes", &image, NULL, &error);
    free(exact);
    assert_int_equal(result, WEFT_INPUT);
    assert_string_equal(weft_message_text(error.message), weft_message_text(message));
    assert_int_equal(strncmp(error.text, "bytes: ", 7), 0);
    assert_null(strchr(error.text, '\n'));
    assert_null(image.pixels);
}

static inline void refuse(const Bytes *bytes, WeftMessage message) { refuse_bytes(bytes->data, bytes->size, message); }

/* Every proper prefix of a good file is refused: as cut off, as too small for what it claims, or as nothing.
 */
static inline void refuse_prefixes(const Bytes *bytes) {
    for (size_t size = 0; size < bytes->size; size++) {
        unsigned char *exact = malloc(size ? size : 1);
        assert_non_null(exact);
        memcpy(exact, bytes->data, size);
        WeftImage image;
        WeftError error = {0};
        WeftResult result = weft_image_read_memory(exact, size, "bytes", &image, NULL, &error);
        free(exact);
        assert_int_equal(result, WEFT_INPUT);
    }
}

static inline WeftImage make_image(int width, int height, int channels, WeftPixelType type) {
    WeftImage image;
    assert_int_equal(weft_image_create(width, height, channels, type, &image, NULL), WEFT_OK);
    return image;
}

static inline size_t value_total(const WeftImage *image) {
    return (size_t)image->width * (size_t)image->height * (size_t)image->channels;
}

static inline void assert_shape(const WeftImage *image, int width, int height, int channels, WeftPixelType type) {
    assert_int_equal(image->width, width);
    assert_int_equal(image->height, height);
    assert_int_equal(image->channels, channels);
    assert_int_equal(image->type, type);
}

/* Writes to a file of a new folder, reads that back and removes both. */
static inline WeftImage write_and_read_as(const WeftImage *image, const char *suffix, const WeftImageWriting *how) {
    char folder[SCRATCH_SIZE], path[300];
    assert_true(scratch_make(folder));
    snprintf(path, sizeof path, "%s/image%s", folder, suffix);
    WeftError error = {0};
    if (weft_image_write_as(path, image, how, &error) != WEFT_OK) fail_msg("%s", error.text);
    WeftImage back;
    if (weft_image_read(path, &back, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(rmdir(folder), 0); /* so nothing else was left there */
    return back;
}

static inline WeftImage write_and_read(const WeftImage *image, const char *suffix) {
    return write_and_read_as(image, suffix, &(WeftImageWriting){0});
}

#endif
