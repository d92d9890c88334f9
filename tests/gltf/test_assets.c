/* The shared sample assets and malformed files; skipped where they are not at hand. */
#include "reading.h"

#include <dirent.h>
#include <math.h>

static char folder[1024]; /* of the data, "" where there is none */

static int find_data(void **state) {
    (void)state;
    const char *named = getenv("WEFT_DATA");
    snprintf(folder, sizeof folder, "%s", named ? named : WEFT_SOURCE_DIR "/../shared/data");
    DIR *data = opendir(folder);
    if (data)
        closedir(data);
    else
        folder[0] = 0;
    return 0;
}

static void need_data(void) {
    if (folder[0]) return;
    print_message("no sample assets: set WEFT_DATA\n");
    skip();
}

static Reading *read_asset(const char *name) {
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return read_gltf(path, NULL, 0);
}

static void sample_assets_load_with_known_counts(void **state) {
    (void)state;
    need_data();
    static const struct {
        const char *name;
        int meshes, triangles, materials, images, tangents, variants;
    } assets[] = {
        {"09_texture_transform/09_texture_transform.gltf", 1, 2, 1, 1, 1, 0},
        {"19_sheen/19_sheen.gltf", 7, 6720, 7, 1, 0, 0},
        {"AnisotropyStrengthTest.glb", 50, 97240, 50, 1, 49, 0},
        {"Box With Spaces/Box With Spaces.gltf", 1, 12, 1, 3, 1, 0},
        {"Box-Draco/Box.gltf", 1, 12, 1, 0, 0, 0},
        {"Box.glb", 1, 12, 1, 0, 0, 0},
        {"BoxInterleaved.glb", 1, 12, 1, 0, 0, 0},
        {"BoxMeshopt.glb", 1, 12, 1, 0, 0, 0},
        {"BoxVertexColors.glb", 1, 12, 1, 0, 0, 0},
        {"ClearCoatTest.glb", 27, 37116, 19, 6, 7, 0},
        {"MeshPrimitiveModes/MeshPrimitiveModes.gltf", 3, 16, 1, 0, 0, 0},
        {"MetalRoughSpheresNoTextures.glb", 123, 1040213, 99, 0, 0, 0},
        {"NegativeScaleTest.glb", 11, 7724, 6, 2, 0, 0},
        {"SheenChair/SheenChair.gltf", 4, 39936, 6, 7, 1, 2},
        {"SheenCloth/SheenCloth.gltf", 1, 115200, 1, 4, 1, 0},
        {"SimpleSparseAccessor/SimpleSparseAccessor.gltf", 1, 12, 1, 0, 0, 0},
        {"SpecularTest.glb", 24, 44828, 24, 4, 0, 0},
        {"TextureTransformMultiTest.glb", 29, 3956, 29, 4, 6, 0},
        {"TextureTransformTest/TextureTransformTest.gltf", 12, 24, 9, 5, 0, 0},
        {"TriangleWithoutIndices/TriangleWithoutIndices.gltf", 1, 1, 1, 0, 0, 0},
        {"material-sheen.gltf", 0, 0, 5, 0, 0, 0},
    };
    for (size_t i = 0; i < sizeof assets / sizeof *assets; i++) {
        char path[256];
        snprintf(path, sizeof path, "gltf/%s", assets[i].name);
        Reading *reading = read_asset(path);
        assert_read(reading);
        const WeftScene *scene = reading->scene;
        int triangles = 0, tangents = 0;
        for (int m = 0; m < scene->mesh_count; m++) {
            triangles += (int)scene->meshes[m].triangle_count;
            tangents += scene->meshes[m].tangent != NULL;
        }
        const int found[] = {scene->mesh_count,  triangles, scene->material_count,
                             scene->image_count, tangents,  scene->variant_count};
        if (memcmp(found, &assets[i].meshes, sizeof found) != 0)
            fail_msg("%s: %d meshes, %d triangles, %d materials, %d images, %d tangents, %d variants", assets[i].name,
                     found[0], found[1], found[2], found[3], found[4], found[5]);
        done(reading);
    }
}

/* Every triangle of a has one of b with the same corners, in the same order but for where it starts. */
static void assert_same_surface(const Mesh *a, const Mesh *b, float tolerance) {
    assert_int_equal(a->triangle_count, b->triangle_count);
    for (uint32_t s = 0; s < a->triangle_count; s++) {
        bool found = false;
        for (uint32_t t = 0; t < b->triangle_count && !found; t++)
            for (uint32_t turn = 0; turn < 3 && !found; turn++) {
                found = true;
                for (uint32_t k = 0; k < 9; k++) {
                    float p = a->position[3 * a->index[3 * s + k / 3] + k % 3];
                    float q = b->position[3 * b->index[3 * t + (k / 3 + turn) % 3] + k % 3];
                    found = found && fabsf(p - q) <= tolerance;
                }
            }
        assert_true(found);
    }
}

static void boxes_of_four_encodings_load_as_the_same_mesh(void **state) {
    (void)state;
    need_data();
    static const char *const others[] = {"gltf/BoxInterleaved.glb", "gltf/BoxMeshopt.glb", "gltf/Box-Draco/Box.gltf"};
    Reading *box = read_asset("gltf/Box.glb");
    assert_read(box);
    for (int i = 0; i < 3; i++) {
        Reading *other = read_asset(others[i]);
        assert_read(other);
        assert_same_surface(box->scene->meshes, other->scene->meshes, 1e-4f);
        for (uint32_t v = 0; v < other->scene->meshes[0].vertex_count; v++) {
            /* Normals of a box point along its axes. */
            const float *n = other->scene->meshes[0].normal + 3 * v;
            assert_near(fmaxf(fabsf(n[0]), fmaxf(fabsf(n[1]), fabsf(n[2]))), 1.0f, 1e-4f);
        }
        done(other);
    }
    done(box);
}

static void sheen_chair_has_its_sheen_materials(void **state) {
    (void)state;
    need_data();
    Reading *reading = read_asset("gltf/SheenChair/SheenChair.gltf");
    assert_read(reading);
    const WeftScene *scene = reading->scene;
    assert_string_equal(scene->variants[0], "Mango Velvet");
    assert_string_equal(scene->variants[1], "Peacock Velvet");
    const Mesh *fabric = &scene->meshes[0];
    assert_int_equal(fabric->variant_material[1], 4);
    for (int m = 0; m < 5; m += 4) {
        const Input *inputs = scene->materials[m].inputs;
        assert_true(inputs[INPUT_sheen_color].value[0] > 0.0f);
        assert_true(inputs[INPUT_sheen_roughness].value[0] > 0.0f);
        assert_true(inputs[INPUT_normal].texture > 0);
        assert_true(fabsf(inputs[INPUT_normal].transform[0]) > 1.0f); /* repeats many times */
    }
    assert_non_null(fabric->tangent);
    done(reading);
}

/* Files that are wrong by the letter, but whose wrong part nothing shows or can be put right. */
static const char *const forgiven[] = {
    "assimp/BoxBadNormals-glTF-Binary/BoxBadNormals.glb",     /* normals 0: made from the faces */
    "gltf-validator/buffer/invalid_uri_data.gltf",            /* one semicolon too many */
    "gltf-validator/buffer_view/invalid_stride_too_big.gltf", /* a view that nothing reads */
    "gltf-validator/glb/misplaced_bin_chunk.glb",             /* the chunk is ignored */
    "gltf-validator/image/invalid_image_data.gltf",           /* an image that nothing wears */
    "gltf-validator/mesh_data/index_buffer_oob.gltf",         /* a mesh under no node */
    "magnum/invalid-uri.gltf",                                /* images that nothing wears */
    "tinygltf/zero-sized-bin-chunk-issue-440.glb",            /* the buffer lies in the text */
};

static void check_malformed(const char *name) {
    char path[2048];
    snprintf(path, sizeof path, "malformed/%s", name);
    bool forgive = false;
    for (size_t i = 0; i < sizeof forgiven / sizeof *forgiven; i++) forgive = forgive || strcmp(name, forgiven[i]) == 0;
    Reading *reading = read_asset(path);
    if (forgive && reading->result != WEFT_OK) fail_msg("%s", reading->error.text);
    if (!forgive && reading->result != WEFT_INPUT) fail_msg("%s was read", name);
    if (!forgive && (strchr(reading->error.text, '\n') || !strstr(reading->error.text, name)))
        fail_msg("%s: \"%s\"", name, reading->error.text);
    done(reading);
}

/* Every .gltf and .glb below malformed/NAME; their number. */
static int check_folder(const char *name) {
    char path[2048];
    int count = 0;
    snprintf(path, sizeof path, "%s/malformed/%s", folder, name);
    DIR *entries = opendir(path);
    if (!entries) return 0;
    for (struct dirent *entry; (entry = readdir(entries));) {
        if (entry->d_name[0] == '.') continue;
        const char *suffix = strrchr(entry->d_name, '.');
        char inner[1024];
        snprintf(inner, sizeof inner, "%.500s%s%.500s", name, name[0] ? "/" : "", entry->d_name);
        if (suffix && (strcmp(suffix, ".gltf") == 0 || strcmp(suffix, ".glb") == 0)) {
            check_malformed(inner);
            count++;
        } else {
            count += check_folder(inner);
        }
    }
    closedir(entries);
    return count;
}

static void malformed_assets_are_refused_or_read(void **state) {
    (void)state;
    need_data();
    assert_true(check_folder("") >= 43);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sample_assets_load_with_known_counts),
        cmocka_unit_test(boxes_of_four_encodings_load_as_the_same_mesh),
        cmocka_unit_test(sheen_chair_has_its_sheen_materials),
        cmocka_unit_test(malformed_assets_are_refused_or_read),
    };
    return cmocka_run_group_tests(tests, find_data, NULL);
}
