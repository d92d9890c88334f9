/* KHR_draco_mesh_compression: both methods, damaged data with a fallback and without, and false numbers.
 *
 * The bytes are what libdraco's encoder made of a sheet: 3 x 3 points from (0, 0, 0) to (1, 1, 0), normals +z, texture
 * coordinates (x, 1 - y), colours (x, y, 0.2, 1) of 8 bits; unique ids 0 to 3. */
#include "reading.h"

#include <math.h>

static const unsigned char edgebreaker[] = {
    0x44, 0x52, 0x41, 0x43, 0x4f, 0x02, 0x02, 0x01, 0x01, 0x00, 0x00, 0x00, 0x09, 0x08, 0x03, 0x08, 0x01, 0x00,
    0x03, 0xef, 0xd3, 0x1a, 0xff, 0x01, 0x11, 0xff, 0x02, 0x88, 0x40, 0xff, 0x02, 0x88, 0x40, 0xff, 0x02, 0x88,
    0x40, 0x04, 0xff, 0x00, 0x00, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x02, 0x00, 0x00, 0x01, 0x00, 0x09, 0x03,
    0x00, 0x00, 0x02, 0x01, 0x01, 0x09, 0x03, 0x00, 0x01, 0x03, 0x01, 0x03, 0x09, 0x02, 0x00, 0x02, 0x02, 0x01,
    0x02, 0x02, 0x04, 0x01, 0x03, 0x01, 0x01, 0x01, 0x01, 0x00, 0x0c, 0x03, 0xad, 0x2a, 0x23, 0x55, 0x15, 0x03,
    0x2a, 0x62, 0x4c, 0xff, 0xff, 0x3f, 0x00, 0xfe, 0xef, 0x7f, 0x00, 0x00, 0xa0, 0xff, 0x00, 0x10, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0xff, 0x07, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x80, 0x3f, 0x0b, 0x00, 0x03, 0x01, 0x01, 0x01, 0x80, 0x01, 0x71, 0x3c, 0xff, 0xf7,
    0x91, 0x03, 0x03, 0xa0, 0xcc, 0x8a, 0xff, 0x00, 0x00, 0x00, 0x7f, 0x00, 0x00, 0x00, 0x08, 0x01, 0x01, 0x01,
    0x00, 0x0b, 0x03, 0xad, 0x2a, 0x1f, 0x55, 0x15, 0x03, 0x2a, 0x62, 0x4c, 0xff, 0xff, 0xff, 0xff, 0xff, 0x00,
    0xfc, 0x0f, 0x20, 0x00, 0x00, 0x00, 0x00, 0xff, 0x03, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x80, 0x3f, 0x0a, 0x01, 0x01, 0x01, 0x01, 0x02, 0x80, 0x02, 0xf9, 0x2f, 0xc9, 0x01, 0x91,
    0x03, 0xff, 0x8b, 0xc9, 0x01, 0xff, 0xff, 0x57, 0xc9, 0x01, 0x91, 0x03, 0x91, 0x03, 0x09, 0xc8, 0xf9, 0x85,
    0x38, 0x31, 0x0e, 0x6f, 0xee, 0x82, 0x00, 0x00, 0x00, 0x00, 0xff, 0x00, 0x00, 0x00};
static const unsigned char sequential[] = {
    0x44, 0x52, 0x41, 0x43, 0x4f, 0x02, 0x02, 0x01, 0x00, 0x00, 0x00, 0x08, 0x09, 0x01, 0x00, 0x01, 0x03, 0x03, 0x01,
    0x04, 0x01, 0x02, 0x04, 0x04, 0x02, 0x05, 0x03, 0x04, 0x06, 0x06, 0x04, 0x07, 0x04, 0x05, 0x07, 0x07, 0x05, 0x08,
    0x01, 0x04, 0x00, 0x09, 0x03, 0x00, 0x00, 0x01, 0x09, 0x03, 0x00, 0x01, 0x03, 0x09, 0x02, 0x00, 0x02, 0x02, 0x02,
    0x04, 0x01, 0x03, 0x02, 0x03, 0x02, 0x01, 0x00, 0x01, 0x01, 0x00, 0x0c, 0x03, 0x1d, 0x07, 0x23, 0xe5, 0x38, 0x03,
    0x04, 0xe0, 0x85, 0xf8, 0x3f, 0x00, 0x00, 0xe0, 0x7f, 0x00, 0x00, 0x40, 0x00, 0xff, 0x07, 0xc0, 0xff, 0x01, 0x00,
    0x00, 0xff, 0x03, 0x00, 0x00, 0x02, 0xf0, 0x3f, 0x00, 0xfe, 0x0f, 0x00, 0x00, 0xf8, 0x1f, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0xff, 0x07, 0x00, 0x00, 0x00, 0x03, 0x01, 0x01, 0x01, 0x80, 0x01, 0x71, 0x3c, 0xff, 0xf7, 0x91,
    0x03, 0x03, 0xa0, 0xcc, 0x8a, 0xff, 0x00, 0x00, 0x00, 0x7f, 0x00, 0x00, 0x00, 0x00, 0x01, 0x01, 0x00, 0x0b, 0x03,
    0x1d, 0x07, 0x1f, 0xe5, 0x38, 0x03, 0x04, 0xe0, 0x85, 0xfe, 0x0f, 0x80, 0xff, 0x00, 0x08, 0xd0, 0xff, 0xff, 0x00,
    0xf8, 0x0f, 0x80, 0x00, 0xff, 0xff, 0x0f, 0x80, 0xff, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xff, 0x03, 0x00, 0x00,
    0x00, 0x01, 0x01, 0x01, 0x02, 0x80, 0x02, 0xa9, 0x2a, 0xc9, 0x01, 0x91, 0x03, 0xff, 0x8b, 0xc9, 0x01, 0xff, 0xff,
    0x5b, 0x1d, 0x07, 0x1d, 0x07, 0x0a, 0xeb, 0x12, 0xdb, 0xe8, 0xa8, 0xc6, 0x0d, 0xa5, 0xd1, 0x80, 0x00, 0x00, 0x00,
    0x00, 0xff, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x80, 0x3f, 0x0b, 0x08, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3f, 0x0a};

static const struct {
    const unsigned char *bytes;
    size_t size;
} methods[] = {{edgebreaker, sizeof edgebreaker}, {sequential, sizeof sequential}};

/* A node with the sheet of these bytes, whose coordinates are TEXCOORD_n, and whose normal map reads those. `views` is
 * what accessors have beside their types: nothing, or a view. */
static Reading *read_sheet_by(int n, const unsigned char *bytes, size_t size, const char *views, int points,
                              const char *ids) {
    char map[64] = "";
    if (n) snprintf(map, sizeof map, "'normalTexture':{'index':0,'texCoord':%d}", n);
    return read_rest(
        "'extensionsRequired':['KHR_draco_mesh_compression'],'buffers':[{'byteLength':%zu,'uri':'%s'}],"
        "'bufferViews':[{'buffer':0,'byteLength':%zu}],"
        "'accessors':[{'componentType':5126,'count':%d,'type':'VEC3'%s},"
        "{'componentType':5126,'count':%d,'type':'VEC3'%s},"
        "{'componentType':5126,'count':%d,'type':'VEC2'%s},"
        "{'componentType':5121,'normalized':true,'count':%d,'type':'VEC4'%s},"
        "{'componentType':5121,'count':24,'type':'SCALAR'%s}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1,'TEXCOORD_%d':2,'COLOR_0':3},"
        "'indices':4,'material':0,'extensions':{'KHR_draco_mesh_compression':{'bufferView':0,'attributes':%s}}}]}],"
        "'materials':[{%s}],'textures':[{}],"
        "'nodes':[{'mesh':0},{'mesh':0,'translation':[0,0,5]}]",
        size, uri(bytes, size), size, points, views, points, views, points, views, points, views, views, n, ids, map);
}

static Reading *read_sheet(const unsigned char *bytes, size_t size, const char *views, int points, const char *ids) {
    return read_sheet_by(0, bytes, size, views, points, ids);
}

static const char all[] = "{'POSITION':0,'NORMAL':1,'TEXCOORD_0':2,'COLOR_0':3}";

static void meshes_of_both_methods_are_decoded(void **state) {
    (void)state;
    for (size_t k = 0; k < 2; k++) {
        Reading *reading = read_sheet(methods[k].bytes, methods[k].size, "", 9, all);
        assert_read(reading);
        assert_string_equal(reading->warning, "");
        assert_int_equal(reading->scene->mesh_count, 2);
        for (int m = 0; m < 2; m++) {
            const Mesh *mesh = &reading->scene->meshes[m];
            float area = 0.0f;
            assert_int_equal(mesh->triangle_count, 8);
            assert_int_equal(mesh->vertex_count, 9);
            for (uint32_t t = 0; t < 8; t++) {
                const float *a = mesh->position + 3 * mesh->index[3 * t],
                            *b = mesh->position + 3 * mesh->index[3 * t + 1],
                            *c = mesh->position + 3 * mesh->index[3 * t + 2];
                area += 0.5f * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
            }
            assert_near(area, 1.0f, 1e-3f); /* and all face +z */
            for (uint32_t v = 0; v < 9; v++) {
                const float x = mesh->position[3 * v], y = mesh->position[3 * v + 1];
                assert_near(mesh->position[3 * v + 2], m ? 5.0f : 0.0f, 1e-3f);
                assert_all_near(mesh->normal + 3 * v, (const float[3]){0, 0, 1}, 3, 0.02f);
                assert_all_near(mesh->texcoord[0] + 2 * v, (const float[2]){x, 1.0f - y}, 2, 3e-3f);
                assert_all_near(mesh->color + 4 * v, (const float[4]){x, y, 0.2f, 1}, 4, 4e-3f);
            }
        }
        done(reading);
    }
}

/* Coordinates beyond the first two sets: the second of the mesh, since the material reads no other. */
static void coordinates_of_any_set_are_decoded(void **state) {
    (void)state;
    Reading *reading = read_sheet_by(5, edgebreaker, sizeof edgebreaker, "", 9, "{'POSITION':0,'TEXCOORD_5':2}");
    assert_read(reading);
    const Mesh *mesh = reading->scene->meshes;
    assert_null(mesh->texcoord[0]);
    for (uint32_t v = 0; v < 9; v++)
        assert_all_near(mesh->texcoord[1] + 2 * v,
                        (const float[2]){mesh->position[3 * v], 1.0f - mesh->position[3 * v + 1]}, 2, 3e-3f);
    done(reading);
    assert_refused(read_sheet_by(5, edgebreaker, sizeof edgebreaker, "", 9, "{'POSITION':0,'TEXCOORD_5':77}"),
                   WEFT_MESSAGE_GLTF_DECODE, "lacks an attribute");
}

/* An attribute that is not compressed is that of its accessor: here zeros. */
static void attributes_beside_the_compressed_ones_are_kept(void **state) {
    (void)state;
    Reading *reading = read_sheet(edgebreaker, sizeof edgebreaker, "", 9, "{'POSITION':0,'NORMAL':1,'TEXCOORD_0':2}");
    assert_read(reading);
    for (int k = 0; k < 4 * 9; k++) assert_near(reading->scene->meshes[0].color[k], 0.0f, 0.0f);
    done(reading);
}

static void data_that_do_not_fit_the_primitive_are_refused(void **state) {
    (void)state;
    assert_refused(read_sheet(sequential, sizeof sequential, "", 8, all), WEFT_MESSAGE_GLTF_DECODE,
                   "meshes[0].primitives[0]: Draco: it has not as many points");
    assert_refused(read_sheet(sequential, sizeof sequential, "", 9, "{'POSITION':0,'NORMAL':17}"),
                   WEFT_MESSAGE_GLTF_DECODE, "it lacks an attribute");
    assert_refused(read_sheet(sequential, sizeof sequential, "", 9, "{'POSITION':0,'COLOR_0':2}"),
                   WEFT_MESSAGE_GLTF_DECODE, "it lacks an attribute"); /* of two components */
    assert_refused(read_sheet(sequential, sizeof sequential, "", 9, "{'POSITION':0,'TANGENT':2}"),
                   WEFT_MESSAGE_GLTF_SCHEMA, "no such attribute");
    assert_refused(read_sheet(sequential, sizeof sequential, "", 9, "7"), WEFT_MESSAGE_GLTF_SCHEMA, "attributes");
}

/* Cut off anywhere, or with any byte changed: read, or refused in one line. */
static void damaged_data_are_refused(void **state) {
    (void)state;
    for (size_t k = 0; k < 2; k++) {
        for (size_t size = 1; size < methods[k].size; size += 3) {
            Reading *reading = read_sheet(methods[k].bytes, size, "", 9, all);
            assert_true(reading->result == WEFT_OK || reading->result == WEFT_INPUT);
            assert_null(strchr(reading->error.text, '\n'));
            done(reading);
        }
        for (size_t at = 0; at < methods[k].size; at++) {
            unsigned char bytes[512];
            memcpy(bytes, methods[k].bytes, methods[k].size);
            bytes[at] ^= 0xff;
            Reading *reading = read_sheet(bytes, methods[k].size, "", 9, all);
            assert_true(reading->result == WEFT_OK || reading->result == WEFT_INPUT);
            done(reading);
        }
    }
    unsigned char old[sizeof sequential];
    memcpy(old, sequential, sizeof old);
    old[6] = 1;
    assert_refused(read_sheet(old, sizeof old, "", 9, all), WEFT_MESSAGE_GLTF_DECODE, "it is not Draco 2.2");
}

/* 2^28 triangles, said in a header of a few bytes. */
static void false_numbers_are_refused_before_memory_is_taken(void **state) {
    (void)state;
    static const unsigned char meshes[2][20] = {
        {'D', 'R', 'A', 'C', 'O', 2, 2, 1, 1, 0, 0, 0, 9, 0x80, 0x80, 0x80, 0x80, 0x01, 3, 8},
        {'D', 'R', 'A', 'C', 'O', 2, 2, 1, 0, 0, 0, 0x80, 0x80, 0x80, 0x80, 0x01, 9, 1, 0, 1}};
    for (size_t k = 0; k < 2; k++)
        assert_refused(read_sheet(meshes[k], sizeof meshes[k], "", 9, all), WEFT_MESSAGE_GLTF_DECODE,
                       "more memory than its size is worth");
}

/* Accessors with data of their own are used where the compressed ones are damaged. */
static void accessors_with_data_are_the_fallback(void **state) {
    (void)state;
    static const char form[] =
        SQUARE_DATA ",'extensionsUsed':['KHR_draco_mesh_compression'],'meshes':[{'primitives':[{" SQUARE_PRIMITIVE
                    ",'extensions':{'KHR_draco_mesh_compression':{'bufferView':0,'attributes':{'POSITION':0}}}}]}],"
                    "'nodes':[{'mesh':0},{'mesh':0}]";
    Reading *reading = read_rest(form, SQUARE_URI);
    assert_read(reading);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_REPAIRED], 1);
    assert_non_null(strstr(reading->warning, "meshes[0].primitives[0]: Draco: damaged data; its accessors without"));
    assert_int_equal(reading->scene->mesh_count, 2);
    assert_int_equal(reading->scene->meshes[0].triangle_count, 2);
    done(reading);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(meshes_of_both_methods_are_decoded),
        cmocka_unit_test(coordinates_of_any_set_are_decoded),
        cmocka_unit_test(attributes_beside_the_compressed_ones_are_kept),
        cmocka_unit_test(data_that_do_not_fit_the_primitive_are_refused),
        cmocka_unit_test(damaged_data_are_refused),
        cmocka_unit_test(false_numbers_are_refused_before_memory_is_taken),
        cmocka_unit_test(accessors_with_data_are_the_fallback),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
