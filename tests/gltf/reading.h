/* reading.h - glTF text written in the test, read from memory */
#ifndef WEFT_TEST_GLTF_READING_H
#define WEFT_TEST_GLTF_READING_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/read/gltf.h"

/* What came of a read: the scene (to be freed by done), the error, and how often each warning came. */
typedef struct Reading {
    WeftScene *scene;
    WeftResult result;
    WeftError error;
    int warnings[WEFT_MESSAGE_COUNT];
    char warning[512]; /* the last */
} Reading;

static inline void note(void *user, WeftMessage message, const char *text) {
    Reading *reading = user;
    reading->warnings[message]++;
    snprintf(reading->warning, sizeof reading->warning, "%s", text);
}

/* path, or bytes called so, at a moment of an animation; NULL: at rest. */
static inline Reading *read_gltf_at(const WeftMoment *moment, const char *path, const void *data, size_t size) {
    Reading *reading = calloc(1, sizeof *reading);
    const WeftLog log = {note, reading};
    reading->scene = calloc(1, sizeof *reading->scene);
    reading->result = gltf_read_watched(path, data, size, moment, reading->scene, NULL, NULL, &log, &reading->error);
    return reading;
}

static inline Reading *read_gltf(const char *path, const void *data, size_t size) {
    return read_gltf_at(NULL, path, data, size);
}

static inline void done(Reading *reading) {
    weft_scene_free(reading->scene);
    free(reading);
}

/* printf with ' for ", because JSON in C is hard to look at. Release with free(). */
__attribute__((format(printf, 1, 0))) static inline char *vjson(const char *format, va_list arguments) {
    enum { SIZE = 1 << 20 };
    char *text = malloc(SIZE);
    assert_in_range(vsnprintf(text, SIZE, format, arguments), 0, SIZE - 1);
    for (char *c = text; *c; c++)
        if (*c == '\'') *c = '"';
    return text;
}

__attribute__((format(printf, 1, 2))) static inline char *json(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    char *text = vjson(format, arguments);
    va_end(arguments);
    return text;
}

/* Reads { 'asset': {'version': '2.0'}, REST }. */
__attribute__((format(printf, 1, 2))) static inline Reading *read_rest(const char *rest, ...) {
    va_list arguments;
    va_start(arguments, rest);
    char *text = vjson(rest, arguments), *whole = json("{'asset':{'version':'2.0'},%s}", text);
    va_end(arguments);
    Reading *reading = read_gltf("memory", whole, strlen(whole));
    free(text);
    free(whole);
    return reading;
}

static inline void assert_read(const Reading *reading) {
    if (reading->result != WEFT_OK) fail_msg("%s", reading->error.text);
}

/* Refused as an input, with this message, in one line that contains part; then done. */
static inline void assert_refused(Reading *reading, WeftMessage message, const char *part) {
    if (reading->result == WEFT_OK) fail_msg("read, but \"%s\" was expected", weft_message_text(message));
    if (reading->error.message != message || !strstr(reading->error.text, part))
        fail_msg("\"%s\" is not \"%s ... %s\"", reading->error.text, weft_message_text(message), part);
    assert_int_equal(reading->result, WEFT_INPUT);
    assert_null(strchr(reading->error.text, '\n'));
    done(reading);
}

/* The bytes as a data URI; the last four results stay valid. */
static inline const char *uri(const void *bytes, size_t size) {
    enum { SIZE = 1 << 17 };
    static char texts[4][SIZE];
    static int next;
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *text = texts[next++ % 4];
    const unsigned char *b = bytes;
    assert_true(size * 4 / 3 + 64 < SIZE);
    int at = snprintf(text, SIZE, "data:application/octet-stream;base64,");
    for (size_t i = 0; i < size; i += 3) {
        uint32_t word = (uint32_t)b[i] << 16;
        if (i + 1 < size) word |= (uint32_t)b[i + 1] << 8;
        if (i + 2 < size) word |= b[i + 2];
        for (int k = 0; k < 4; k++) text[at++] = i + (size_t)k > size ? '=' : digits[word >> (18 - 6 * k) & 63];
    }
    text[at] = 0;
    return text;
}

/* The same, each byte percent-encoded, as RFC 2397 allows. */
static inline const char *percent_uri(const void *bytes, size_t size) {
    enum { SIZE = 1 << 12 };
    static char text[SIZE];
    const unsigned char *b = bytes;
    assert_true(3 * size + 64 < SIZE);
    int at = snprintf(text, SIZE, "data:application/octet-stream,");
    for (size_t k = 0; k < size; k++) at += snprintf(text + at, SIZE - (size_t)at, k % 2 ? "%%%02x" : "%%%02X", b[k]);
    return text;
}

static inline void assert_near(float a, float b, float tolerance) {
    if (!(a - b <= tolerance && b - a <= tolerance)) fail_msg("%g is not %g", (double)a, (double)b);
}

static inline void assert_all_near(const float *a, const float *b, size_t count, float tolerance) {
    for (size_t i = 0; i < count; i++) assert_near(a[i], b[i], tolerance);
}

/* A unit square in the xy plane seen from +z: positions, normals, coordinates (v down), then indices. */
static const struct Square {
    float position[12], normal[12], texcoord[8];
    uint16_t index[6];
} square = {{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0},
            {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1},
            {0, 1, 1, 1, 0, 0, 1, 0},
            {0, 1, 2, 2, 1, 3}};

/* Buffers, views and accessors 0 position, 1 normal, 2 texcoord, 3 index of the square; give it uri(&square,
 * sizeof square). */
#define SQUARE_DATA                                                                                                    \
    "'buffers':[{'byteLength':140,'uri':'%s'}],"                                                                       \
    "'bufferViews':[{'buffer':0,'byteLength':48},{'buffer':0,'byteOffset':48,'byteLength':48},"                        \
    "{'buffer':0,'byteOffset':96,'byteLength':32},{'buffer':0,'byteOffset':128,'byteLength':12}],"                     \
    "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},"                                      \
    "{'bufferView':1,'componentType':5126,'count':4,'type':'VEC3'},"                                                   \
    "{'bufferView':2,'componentType':5126,'count':4,'type':'VEC2'},"                                                   \
    "{'bufferView':3,'componentType':5123,'count':6,'type':'SCALAR'}]"

#define SQUARE_URI uri(&square, sizeof square)

/* The whole of a primitive with everything the square has, less the braces. */
#define SQUARE_PRIMITIVE "'attributes':{'POSITION':0,'NORMAL':1,'TEXCOORD_0':2},'indices':3"

#endif
