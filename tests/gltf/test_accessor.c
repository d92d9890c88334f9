/* Accessors: every type, normalised, interleaved, sparse, compressed; and everything wrong with them. */
#include "reading.h"

#include <math.h>
#include <meshoptimizer.h>

#include "gltf/asset/accessor.h"
#include "gltf/asset/buffer_views.h"
#include "gltf/asset/container.h"

/* The first accessor of { 'buffers': [bytes], REST }, decoded: floats (in *values, NULL after a failure), its
 * number of elements in *count. */
typedef struct Decoded {
    Asset asset;
    WeftError error;
    Arena arena;
    WeftScene scene;
    float *values;
    size_t count;
} Decoded;

__attribute__((format(printf, 3, 4))) static Decoded *decode(const void *bytes, size_t size, const char *rest, ...) {
    va_list arguments;
    va_start(arguments, rest);
    char *text = vjson(rest, arguments);
    va_end(arguments);
    char *whole = json("{'buffers':[{'byteLength':%zu,'uri':'%s'}],%s}", size, uri(bytes, size), text);
    Decoded *d = calloc(1, sizeof *d);
    d->asset = (Asset){.name = "test", .scene = &d->scene, .error = &d->error, .limit = 1 << 20};
    container_read(&d->asset, (Span){(const unsigned char *)whole, strlen(whole)});
    static void (*const stages[])(Asset *) = {buffers_read, views_read, accessors_read};
    for (size_t i = 0; i < 3 && d->asset.result == WEFT_OK; i++) stages[i](&d->asset);
    if (d->asset.result == WEFT_OK) {
        d->values = accessor_floats(&d->asset, &d->arena, 0);
        d->count = d->asset.accessors[0].count;
    }
    free(text);
    free(whole);
    return d;
}

static void release(Decoded *d) {
    buffers_free(&d->asset);
    json_decref(d->asset.root);
    arena_free(&d->asset.arena);
    arena_free(&d->arena);
    free(d);
}

static void assert_values(Decoded *d, const float *expected, size_t count) {
    if (!d->values) fail_msg("%s", d->error.text);
    assert_all_near(d->values, expected, count, 1e-6f);
    release(d);
}

static void assert_not_decoded(Decoded *d, WeftMessage message, const char *part) {
    if (d->values || d->error.message != message || !strstr(d->error.text, part))
        fail_msg("\"%s\" is not \"%s ... %s\"", d->error.text, weft_message_text(message), part);
    release(d);
}

static void accessor_of_every_component_type_is_read(void **state) {
    (void)state;
    static const struct {
        int type;
        bool normalized;
        unsigned char bytes[8];
        float value[2];
    } cases[] = {
        {5120, false, {0x80, 0x7f}, {-128.0f, 127.0f}},
        {5120, true, {0x80, 0x7f}, {-1.0f, 1.0f}},
        {5121, false, {0, 255}, {0.0f, 255.0f}},
        {5121, true, {51, 255}, {0.2f, 1.0f}},
        {5122, false, {0x00, 0x80, 0xff, 0x7f}, {-32768.0f, 32767.0f}},
        {5122, true, {0x00, 0x80, 0xff, 0x7f}, {-1.0f, 1.0f}},
        {5123, false, {0x01, 0x02, 0xff, 0xff}, {513.0f, 65535.0f}},
        {5123, true, {0, 0, 0xff, 0xff}, {0.0f, 1.0f}},
        {5125, false, {0x01, 0x02, 0x03, 0x00, 0, 0, 0, 0x80}, {197121.0f, 2147483648.0f}},
        {5126, false, {0, 0, 0x80, 0x3f, 0, 0, 0, 0xc0}, {1.0f, -2.0f}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_values(decode(cases[i].bytes, 8,
                             "'bufferViews':[{'buffer':0,'byteLength':8}],'accessors':[{'bufferView':0,"
                             "'componentType':%d,'normalized':%s,'count':2,'type':'SCALAR'}]",
                             cases[i].type, cases[i].normalized ? "true" : "false"),
                      cases[i].value, 2);
}

static void accessor_of_every_shape_is_read(void **state) {
    (void)state;
    /* Columns of matrices start at multiples of 4 bytes: 9 marks what must be skipped. */
    static const struct {
        const char *type;
        int component;
        unsigned char bytes[64];
        size_t size, count;
        float value[16];
    } cases[] = {
        {"SCALAR", 5121, {7}, 1, 1, {7}},
        {"VEC2", 5121, {1, 2}, 2, 2, {1, 2}},
        {"VEC3", 5121, {1, 2, 3}, 3, 3, {1, 2, 3}},
        {"VEC4", 5121, {1, 2, 3, 4}, 4, 4, {1, 2, 3, 4}},
        {"MAT2", 5121, {1, 2, 9, 9, 3, 4, 9, 9}, 8, 4, {1, 2, 3, 4}},
        {"MAT3", 5121, {1, 2, 3, 9, 4, 5, 6, 9, 7, 8, 1, 9}, 12, 9, {1, 2, 3, 4, 5, 6, 7, 8, 1}},
        {"MAT3",
         5123,
         {1, 0, 2, 0, 3, 0, 9, 9, 4, 0, 5, 0, 6, 0, 9, 9, 7, 0, 8, 0, 1, 0, 9, 9},
         24,
         9,
         {1, 2, 3, 4, 5, 6, 7, 8, 1}},
        {"MAT4",
         5121,
         {1, 2, 3, 4, 5, 6, 7, 8, 1, 2, 3, 4, 5, 6, 7, 8},
         16,
         16,
         {1, 2, 3, 4, 5, 6, 7, 8, 1, 2, 3, 4, 5, 6, 7, 8}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int short_of = 0; short_of < 2; short_of++) {
            Decoded *d = decode(cases[i].bytes, 64,
                                "'bufferViews':[{'buffer':0,'byteLength':%zu}],'accessors':[{'bufferView':0,"
                                "'componentType':%d,'count':1,'type':'%s'%s}]",
                                cases[i].size, cases[i].component, cases[i].type, short_of ? ",'byteOffset':1" : "");
            if (short_of)
                assert_not_decoded(d, WEFT_MESSAGE_GLTF_BOUNDS, "accessors[0]");
            else
                assert_values(d, cases[i].value, cases[i].count);
        }
}

static void interleaved_accessors_are_read(void **state) {
    (void)state;
    float bytes[16];
    for (int i = 0; i < 16; i++) bytes[i] = (float)i;
    static const float expected[6] = {3, 4, 8, 9, 13, 14};
    assert_values(decode(bytes, sizeof bytes,
                         "'bufferViews':[{'buffer':0,'byteOffset':4,'byteLength':60,'byteStride':20}],"
                         "'accessors':[{'bufferView':0,'byteOffset':8,'componentType':5126,'count':3,"
                         "'type':'VEC2'}]"),
                  expected, 6);
    /* The last element may end where the view ends, but not beyond. */
    assert_not_decoded(decode(bytes, sizeof bytes,
                              "'bufferViews':[{'buffer':0,'byteOffset':4,'byteLength':55,'byteStride':20}],"
                              "'accessors':[{'bufferView':0,'byteOffset':8,'componentType':5126,'count':3,"
                              "'type':'VEC2'}]"),
                       WEFT_MESSAGE_GLTF_BOUNDS, "accessors[0]");
    assert_not_decoded(decode(bytes, sizeof bytes,
                              "'bufferViews':[{'buffer':0,'byteLength':64,'byteStride':4}],"
                              "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC2'}]"),
                       WEFT_MESSAGE_GLTF_SCHEMA, "stride of 4");
}

static void sparse_accessor_is_read(void **state) {
    (void)state;
    static const struct {
        float base[4], values[2];
        uint16_t indices[2];
    } bytes = {{1, 2, 3, 4}, {20, 40}, {1, 3}};
    static const char form[] =
        "'bufferViews':[{'buffer':0,'byteLength':16},{'buffer':0,'byteOffset':16,'byteLength':8},"
        "{'buffer':0,'byteOffset':24,'byteLength':4}],'accessors':[{%s'componentType':5126,'count':4,"
        "'type':'SCALAR','sparse':{'count':%d,'indices':{'bufferView':2,'componentType':%d},"
        "'values':{'bufferView':1}}}]";
    char *text = json(form, "'bufferView':0,", 2, 5123);
    assert_values(decode(&bytes, sizeof bytes, "%s", text), (const float[]){1, 20, 3, 40}, 4);
    free(text);
    text = json(form, "", 2, 5123); /* without a view: zeros */
    assert_values(decode(&bytes, sizeof bytes, "%s", text), (const float[]){0, 20, 0, 40}, 4);
    free(text);
    text = json(form, "", 2, 5121); /* bytes 1, 0: the later one wins */
    assert_values(decode(&bytes, sizeof bytes, "%s", text), (const float[]){40, 20, 0, 0}, 4);
    free(text);
    text = json(form, "", 5, 5121);
    assert_not_decoded(decode(&bytes, sizeof bytes, "%s", text), WEFT_MESSAGE_GLTF_SCHEMA, "sparse.count");
    free(text);
    text = json(form, "", 3, 5123);
    assert_not_decoded(decode(&bytes, sizeof bytes, "%s", text), WEFT_MESSAGE_GLTF_BOUNDS, "sparse.indices");
    free(text);
    text = json(form, "", 1, 5125); /* the word 0x00030001 */
    assert_not_decoded(decode(&bytes, sizeof bytes, "%s", text), WEFT_MESSAGE_GLTF_BOUNDS, "196609 of 4");
    free(text);
    text = json(form, "", 1, 5126);
    assert_not_decoded(decode(&bytes, sizeof bytes, "%s", text), WEFT_MESSAGE_GLTF_SCHEMA, "unsigned");
    free(text);
}

static void malformed_accessors_are_refused(void **state) {
    (void)state;
    static const struct {
        const char *rest;
        WeftMessage message;
        const char *part;
    } cases[] = {
        {"'accessors':[{'componentType':5124,'count':1,'type':'VEC3'}]", WEFT_MESSAGE_GLTF_SCHEMA,
         "accessors[0].componentType: 5124"},
        {"'accessors':[{'count':1,'type':'VEC3'}]", WEFT_MESSAGE_GLTF_SCHEMA, "missing"},
        {"'accessors':[{'componentType':5126,'count':1,'type':'VEC5'}]", WEFT_MESSAGE_GLTF_SCHEMA, ".type"},
        {"'accessors':[{'componentType':5126,'count':0,'type':'VEC3'}]", WEFT_MESSAGE_GLTF_SCHEMA, ".count"},
        {"'accessors':[{'componentType':5126,'count':1.5,'type':'VEC3'}]", WEFT_MESSAGE_GLTF_SCHEMA, ".count"},
        {"'accessors':[{'componentType':5126,'count':'1','type':'VEC3'}]", WEFT_MESSAGE_GLTF_SCHEMA, ".count"},
        {"'accessors':[{'componentType':5126,'count':4294967296,'type':'VEC3'}]", WEFT_MESSAGE_GLTF_SCHEMA, ".count"},
        {"'accessors':[{'componentType':5126,'count':4294967295,'type':'MAT4'}]", WEFT_MESSAGE_GLTF_TOO_LARGE,
         "decode to more"},
        {"'accessors':[{'bufferView':0,'componentType':5126,'count':1,'type':'VEC3'}]", WEFT_MESSAGE_GLTF_REFERENCE,
         "accessors[0].bufferView: 0 of 0"},
        {"'accessors':[{'bufferView':-1,'componentType':5126,'count':1,'type':'VEC3'}]", WEFT_MESSAGE_GLTF_SCHEMA,
         "bufferView"},
        {"'accessors':{}", WEFT_MESSAGE_GLTF_SCHEMA, "accessors: expected an array"},
        {"'accessors':[3]", WEFT_MESSAGE_GLTF_SCHEMA, "accessors[0]: expected an object"},
        {"'bufferViews':[{'buffer':0,'byteLength':9}]", WEFT_MESSAGE_GLTF_BOUNDS, "bufferViews[0]"},
        {"'bufferViews':[{'buffer':0,'byteOffset':9007199254740991,'byteLength':1}]", WEFT_MESSAGE_GLTF_BOUNDS,
         "bufferViews[0]"},
        {"'bufferViews':[{'buffer':0,'byteLength':1e300}]", WEFT_MESSAGE_GLTF_SCHEMA, "byteLength"},
        {"'bufferViews':[{'buffer':0,'byteLength':0}]", WEFT_MESSAGE_GLTF_SCHEMA, "byteLength"},
        {"'bufferViews':[{'buffer':1,'byteLength':1}]", WEFT_MESSAGE_GLTF_REFERENCE, "bufferViews[0].buffer"},
        {"'bufferViews':[{'byteLength':1}]", WEFT_MESSAGE_GLTF_SCHEMA, "bufferViews[0].buffer: missing"},
        {"'bufferViews':[{'buffer':0,'byteLength':8,'byteStride':2}]", WEFT_MESSAGE_GLTF_SCHEMA, "byteStride"},
        /* count - 1 strides overflow 64 bits */
        {"'bufferViews':[{'buffer':0,'byteLength':8,'byteStride':252}],'accessors':[{'bufferView':0,"
         "'byteOffset':9007199254740991,'componentType':5121,'count':4294967295,'type':'SCALAR'}]",
         WEFT_MESSAGE_GLTF_BOUNDS, "accessors[0]"},
    };
    static const unsigned char bytes[8] = {0};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_not_decoded(decode(bytes, sizeof bytes, "%s", cases[i].rest), cases[i].message, cases[i].part);
}

/* --- EXT_meshopt_compression, round trips through the library's own encoder --- */

static const char meshopt_form[] =
    "'bufferViews':[{'buffer':0,'byteLength':%zu,%s'extensions':{'EXT_meshopt_compression':{'buffer':0,"
    "'byteLength':%zu,'byteStride':%zu,'count':%zu,'mode':'%s','filter':'%s'}}}],"
    "'accessors':[{'bufferView':0,'componentType':%d,'normalized':%s,'count':%zu,'type':'%s'}]";

/* The encoded bytes are padded to the decoded length, because the view's range is checked against its buffer
 * too; real files have a second, empty buffer for that. */
static Decoded *decode_compressed(unsigned char *encoded, size_t size, size_t stride, size_t count, const char *mode,
                                  const char *filter, int component, const char *normalized, const char *type) {
    size_t room = size > stride * count ? size : stride * count;
    char step[32] = "";
    if (type[0] == 'V') snprintf(step, sizeof step, "'byteStride':%zu,", stride);
    char *text =
        json(meshopt_form, stride * count, step, size, stride, count, mode, filter, component, normalized, count, type);
    Decoded *d = decode(encoded, room, "%s", text);
    free(text);
    return d;
}

static void meshopt_streams_of_every_mode_are_decoded(void **state) {
    (void)state;
    unsigned char encoded[4096] = {0};
    uint16_t vertices[33][4];
    float expected[99];
    for (unsigned i = 0; i < 33; i++)
        for (unsigned c = 0; c < 4; c++) {
            vertices[i][c] = (uint16_t)(i * 321u * (c + 1));
            if (c < 3) expected[3 * i + c] = vertices[i][c];
        }
    size_t size = meshopt_encodeVertexBuffer(encoded, sizeof encoded, vertices, 33, 8);
    assert_values(decode_compressed(encoded, size, 8, 33, "ATTRIBUTES", "NONE", 5123, "false", "VEC3"), expected, 99);
    for (size_t cut = 0; cut < size; cut += 7) {
        Decoded *d = decode_compressed(encoded, cut ? cut : 1, 8, 33, "ATTRIBUTES", "NONE", 5123, "false", "VEC3");
        assert_not_decoded(d, WEFT_MESSAGE_GLTF_DECODE, "bufferViews[0]");
    }

    static const unsigned indices[6] = {0, 1, 2, 2, 1, 3};
    static const float as_floats[6] = {0, 1, 2, 2, 1, 3};
    for (size_t width = 2; width <= 4; width += 2) {
        int component = width == 2 ? 5123 : 5125;
        size = meshopt_encodeIndexBuffer(encoded, sizeof encoded, indices, 6);
        assert_values(decode_compressed(encoded, size, width, 6, "TRIANGLES", "NONE", component, "false", "SCALAR"),
                      as_floats, 6);
        size = meshopt_encodeIndexSequence(encoded, sizeof encoded, indices, 6);
        assert_values(decode_compressed(encoded, size, width, 6, "INDICES", "NONE", component, "false", "SCALAR"),
                      as_floats, 6);
    }
}

static void meshopt_filters_are_undone(void **state) {
    (void)state;
    unsigned char encoded[1024] = {0};
    static const float units[8] = {0.6f, 0.0f, 0.8f, 0.0f, -0.48f, 0.6f, -0.64f, 0.0f};
    int8_t octahedral[2][4];
    meshopt_encodeFilterOct(octahedral, 2, 4, 8, units);
    size_t size = meshopt_encodeVertexBuffer(encoded, sizeof encoded, octahedral, 2, 4);
    Decoded *d = decode_compressed(encoded, size, 4, 2, "ATTRIBUTES", "OCTAHEDRAL", 5120, "true", "VEC3");
    assert_non_null(d->values);
    for (int i = 0; i < 2; i++) assert_all_near(d->values + 3 * i, units + 4 * i, 3, 0.02f);
    release(d);

    static const float quaternion[4] = {0.5f, -0.5f, 0.5f, 0.5f};
    int16_t packed[4];
    meshopt_encodeFilterQuat(packed, 1, 8, 12, quaternion);
    size = meshopt_encodeVertexBuffer(encoded, sizeof encoded, packed, 1, 8);
    d = decode_compressed(encoded, size, 8, 1, "ATTRIBUTES", "QUATERNION", 5122, "true", "VEC4");
    assert_non_null(d->values);
    for (int i = 0; i < 4; i++) assert_near(fabsf(d->values[i]), 0.5f, 0.01f);
    release(d);

    static const float numbers[3] = {0.125f, -3.5f, 1000.0f};
    uint32_t exponential[3];
    meshopt_encodeFilterExp(exponential, 1, 12, 15, numbers);
    size = meshopt_encodeVertexBuffer(encoded, sizeof encoded, exponential, 1, 12);
    d = decode_compressed(encoded, size, 12, 1, "ATTRIBUTES", "EXPONENTIAL", 5126, "false", "VEC3");
    assert_non_null(d->values);
    assert_all_near(d->values, numbers, 3, 0.5f);
    release(d);
}

/* KHR_meshopt_compression: what EXT_ has, and the filter of colours. 8 bits each, and 12 bits in words of 16. */
static void colors_of_the_newer_extension_are_undone(void **state) {
    (void)state;
    unsigned char encoded[1024] = {0};
    static const unsigned char bytes[2][4] = {{112, 75, (unsigned char)-13, 255}, {64, 0, 0, 128}};
    static const uint16_t words[4] = {2048, 0, 0, 0x0c00};
    static const float expected[8] = {200 / 255.0f, 99 / 255.0f, 50 / 255.0f, 1,
                                      64 / 255.0f,  64 / 255.0f, 64 / 255.0f, 0};
    static const float wide[4] = {2048 / 4095.0f, 2048 / 4095.0f, 2048 / 4095.0f, 2048 / 4095.0f};
    for (size_t width = 1; width <= 2; width++) {
        const size_t count = width == 1 ? 2 : 1;
        size_t size = meshopt_encodeVertexBuffer(encoded, sizeof encoded, width == 1 ? (const void *)bytes : words,
                                                 count, 4 * width);
        char *text = json("'bufferViews':[{'buffer':0,'byteLength':%zu,'extensions':{'KHR_meshopt_compression':{"
                          "'buffer':0,'byteLength':%zu,'byteStride':%zu,'count':%zu,'mode':'ATTRIBUTES','filter':"
                          "'COLOR'}}}],'accessors':[{'bufferView':0,'componentType':%d,'normalized':true,'count':%zu,"
                          "'type':'VEC4'}]",
                          4 * width * count, size, 4 * width, count, width == 1 ? 5121 : 5123, count);
        Decoded *d = decode(encoded, size, "%s", text);
        free(text);
        if (!d->values) fail_msg("%s", d->error.text);
        assert_all_near(d->values, width == 1 ? expected : wide, 4 * count, 1e-3f);
        release(d);
    }
    assert_not_decoded(decode_compressed(encoded, 64, 4, 8, "ATTRIBUTES", "COLOR", 5121, "true", "VEC4"),
                       WEFT_MESSAGE_GLTF_SCHEMA, "not a value");
}

static void note_warning(void *user, WeftMessage message, const char *text) {
    (void)message;
    snprintf(user, 256, "%s", text);
}

/* A stream that is not decoded, as one of a version that does not exist: its fallback is read, or one line
 * says what is wrong. */
static void fallback_of_a_stream_that_is_not_decoded_is_read(void **state) {
    (void)state;
    static const uint16_t vertices[4][2] = {{1, 2}, {3, 4}, {5, 6}, {7, 8}};
    unsigned char bytes[256] = {0};
    memcpy(bytes, vertices, sizeof vertices);
    const size_t size = meshopt_encodeVertexBuffer(bytes + 16, sizeof bytes - 16, vertices, 4, 4);
    bytes[16] = 0xa2;
    for (int fallback = 0; fallback < 2; fallback++) {
        char said[256] = "";
        const WeftLog log = {note_warning, said};
        char *whole =
            json("{'buffers':[{'byteLength':%zu,'uri':'%s'},{'byteLength':16%s%s%s}],'bufferViews':[{'buffer':1,"
                 "'byteLength':16,'extensions':{'KHR_meshopt_compression':{'buffer':0,'byteLength':%zu,"
                 "'byteStride':4,'count':4,'mode':'ATTRIBUTES'}}}],'accessors':[{'bufferView':0,"
                 "'componentType':5123,'count':4,'type':'VEC2'}]}",
                 size, uri(bytes + 16, size), fallback ? ",'uri':'" : "", fallback ? uri(bytes, 16) : "",
                 fallback ? "'" : "", size);
        Decoded *d = calloc(1, sizeof *d);
        d->asset = (Asset){.name = "test", .scene = &d->scene, .error = &d->error, .limit = 1 << 20, .log = &log};
        container_read(&d->asset, (Span){(const unsigned char *)whole, strlen(whole)});
        buffers_read(&d->asset);
        views_read(&d->asset);
        accessors_read(&d->asset);
        assert_int_equal(d->asset.result, WEFT_OK);
        d->values = accessor_floats(&d->asset, &d->arena, 0);
        free(whole);
        const char *line = fallback ? said : d->error.text;
        if (!strstr(line, "bufferViews[0]: damaged data")) fail_msg("%s", line);
        assert_int_equal(d->values != NULL, fallback);
        for (int k = 0; k < 8 && fallback; k++) assert_near(d->values[k], (float)(k + 1), 0.0f);
        if (fallback) assert_non_null(strstr(said, "the bytes without compression are used"));
        release(d);
    }
}

static void malformed_meshopt_views_are_refused(void **state) {
    (void)state;
    static const struct {
        size_t stride, count;
        const char *mode, *filter, *part;
    } cases[] = {
        {6, 8, "ATTRIBUTES", "NONE", "byteStride does not suit the mode"},
        {8, 6, "TRIANGLES", "NONE", "byteStride does not suit the mode"},
        {4, 7, "TRIANGLES", "NONE", "multiple of 3"},
        {4, 6, "TRIANGLES", "OCTAHEDRAL", "only attributes"},
        {16, 3, "ATTRIBUTES", "OCTAHEDRAL", "suit the filter"},
        {4, 12, "ATTRIBUTES", "QUATERNION", "suit the filter"},
        {4, 6, "STRIPS", "NONE", "not a value"},
        {4, 6, "INDICES", "GZIP", "not a value"},
    };
    unsigned char bytes[64] = {0};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_not_decoded(decode_compressed(bytes, 8, cases[i].stride, cases[i].count, cases[i].mode, cases[i].filter,
                                             5121, "false", "SCALAR"),
                           WEFT_MESSAGE_GLTF_SCHEMA, cases[i].part);
    char *text = json(meshopt_form, (size_t)48, "", (size_t)8, (size_t)4, (size_t)13, "ATTRIBUTES", "NONE", 5121,
                      "false", (size_t)1, "SCALAR");
    assert_not_decoded(decode(bytes, sizeof bytes, "%s", text), WEFT_MESSAGE_GLTF_SCHEMA, "count times");
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(accessor_of_every_component_type_is_read),
        cmocka_unit_test(accessor_of_every_shape_is_read),
        cmocka_unit_test(interleaved_accessors_are_read),
        cmocka_unit_test(sparse_accessor_is_read),
        cmocka_unit_test(malformed_accessors_are_refused),
        cmocka_unit_test(meshopt_streams_of_every_mode_are_decoded),
        cmocka_unit_test(meshopt_filters_are_undone),
        cmocka_unit_test(colors_of_the_newer_extension_are_undone),
        cmocka_unit_test(fallback_of_a_stream_that_is_not_decoded_is_read),
        cmocka_unit_test(malformed_meshopt_views_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
