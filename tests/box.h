/* box.h - an asset that brings neither light nor floor: a pale box of 1 m, which stands at y = 0 */
#ifndef WEFT_TESTS_BOX_H
#define WEFT_TESTS_BOX_H

#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

/* The kinds of boxes. */
enum { BOX_BARE, BOX_LIT, BOX_GLOWING, BOX_ON_FLOOR };

/* Writes path and box.bin beside it. */
static inline void box_write(const char *path, int kind) {
    static const float corners[36] = {-0.5f, 0, -0.5f, 0.5f, 0, -0.5f, 0.5f, 0, 0.5f, -0.5f, 0, 0.5f,
                                      -0.5f, 1, -0.5f, 0.5f, 1, -0.5f, 0.5f, 1, 0.5f, -0.5f, 1, 0.5f,
                                      -2,    0, -2,    2,    0, -2,    2,    0, 2,    -2,    0, 2};
    static const uint16_t faces[42] = {0, 1, 2, 0, 2, 3, 4, 7, 6, 4, 6, 5, 0, 4, 5, 0, 5,  1,  1, 5,  6,
                                       1, 6, 2, 2, 6, 7, 2, 7, 3, 3, 7, 4, 3, 4, 0, 8, 11, 10, 8, 10, 9};
    FILE *file = fopen("box.bin", "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(corners, sizeof corners, 1, file) + fwrite(faces, sizeof faces, 1, file), 2);
    assert_int_equal(fclose(file), 0);
    file = fopen(path, "wb");
    assert_non_null(file);
    fprintf(file,
            "{\"asset\":{\"version\":\"2.0\"},%s\"scene\":0,\"scenes\":[{\"nodes\":[0%s]}],\"nodes\":[{\"mesh\":0}%s],"
            "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.7,0.7,0.7,1],\"metallicFactor\":0}%s}],"
            "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"material\":0}]}],"
            "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":12,\"type\":\"VEC3\","
            "\"min\":[-2,0,-2],\"max\":[2,1,2]},"
            "{\"bufferView\":1,\"componentType\":5123,\"count\":%d,\"type\":\"SCALAR\"}],"
            "\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}],"
            "\"buffers\":[{\"uri\":\"box.bin\",\"byteLength\":%zu}]}",
            kind == BOX_LIT ? "\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{\"KHR_lights_punctual\":"
                              "{\"lights\":[{\"type\":\"directional\"}]}},"
                            : "",
            kind == BOX_LIT ? ",1" : "",
            kind == BOX_LIT ? ",{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}" : "",
            kind == BOX_GLOWING ? ",\"emissiveFactor\":[0.2,0.1,0]" : "", kind == BOX_ON_FLOOR ? 42 : 36,
            sizeof corners, sizeof corners, sizeof faces, sizeof corners + sizeof faces);
    assert_int_equal(fclose(file), 0);
}

#endif
