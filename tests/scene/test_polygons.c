/* Emissive triangles as polygon lights: what is merged, what is not, and how strong it is */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/pi.h"
#include "scene/light/polygons.h"
#include "shading/dialect/angles.h"

/* A scene of one mesh that emits (3, 2, 1). */
typedef struct Stage {
    WeftScene scene;
    Material material;
    Mesh mesh;
} Stage;

static void stage_set(Stage *stage, const float *position, uint32_t vertices, const uint32_t *index,
                      uint32_t triangles) {
    static const float radiance[3] = {3.0f, 2.0f, 1.0f};
    *stage = (Stage){.material = material_default()};
    memcpy(stage->material.inputs[INPUT_emission].value, radiance, sizeof radiance);
    stage->mesh = (Mesh){.name = "lamp",
                         .vertex_count = vertices,
                         .triangle_count = triangles,
                         .position = (float *)(uintptr_t)position,
                         .index = (uint32_t *)(uintptr_t)index};
    stage->scene.materials = &stage->material;
    stage->scene.material_count = 1;
    stage->scene.meshes = &stage->mesh;
    stage->scene.mesh_count = 1;
}

/* Convex, flat, counter-clockwise about the normal, of the area that it says; returns the sum of areas. */
static float check_all(const LightPolygons *lights) {
    float sum = 0.0f;
    for (int n = 0; n < lights->count; n++) {
        const LightPolygon *l = &lights->items[n];
        Vec3 twice = {0.0f, 0.0f, 0.0f};
        assert_in_range(l->count, 3, LIGHT_CORNERS);
        for (int k = 0; k < l->count; k++) {
            Vec3 a = l->corners[k], b = l->corners[(k + 1) % l->count], c = l->corners[(k + 2) % l->count];
            assert_true(vec3_dot(vec3_cross(vec3_sub(b, a), vec3_sub(c, b)), l->normal) > 0.0f);
            twice = vec3_add(twice, vec3_cross(a, b));
        }
        assert_float_equal(0.5f * vec3_dot(twice, l->normal), l->area, 1e-5f);
        assert_float_equal(vec3_length(l->normal), 1.0f, 1e-5f);
        if (n) assert_true(l->power <= l[-1].power);
        sum += l->area;
    }
    return sum;
}

static void emissive_quad_is_one_polygon(void **state) {
    (void)state;
    static const float position[] = {0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 1, 0};
    static const uint32_t index[] = {0, 1, 2, 0, 2, 3};
    Stage stage;
    LightPolygons lights;
    stage_set(&stage, position, 4, index, 2);
    stage.material.inputs[INPUT_emission_strength].value[0] = 10.0f;
    assert_true(light_polygons_find(&lights, &stage.scene, 16));
    assert_int_equal(lights.count, 1);
    assert_float_equal(check_all(&lights), 2.0f, 1e-6f);
    const LightPolygon *l = lights.items;
    assert_int_equal(l->count, 4);
    assert_float_equal(l->normal.z, 1.0f, 1e-6f);
    assert_float_equal(l->radiance[0], 30.0f, 1e-4f);
    assert_float_equal(l->radiance[2], 10.0f, 1e-4f);
    float luminance = 0.2126f * 30.0f + 0.7152f * 20.0f + 0.0722f * 10.0f;
    assert_float_equal(l->power, PI_FLOAT * 2.0f * luminance, 1e-3f);
    assert_false(l->two_sided);
    light_polygons_free(&lights);
    stage.material.double_sided = true;
    assert_true(light_polygons_find(&lights, &stage.scene, 16));
    assert_true(lights.items[0].two_sided);
    assert_float_equal(lights.items[0].power, 2.0f * PI_FLOAT * 2.0f * luminance, 1e-3f);
    light_polygons_free(&lights);
}

static void mesh_without_emission_is_no_polygon(void **state) {
    (void)state;
    static const float position[] = {0, 0, 0, 2, 0, 0, 2, 1, 0};
    static const uint32_t index[] = {0, 1, 2};
    Stage stage;
    LightPolygons lights;
    for (int kind = 0; kind < 3; kind++) {
        stage_set(&stage, position, 3, index, 1);
        if (kind == 0) stage.material.unlit = true;
        if (kind == 1) stage.material.inputs[INPUT_emission_strength].value[0] = 0.0f;
        if (kind == 2) memset(stage.material.inputs[INPUT_emission].value, 0, 3 * sizeof(float));
        assert_true(light_polygons_find(&lights, &stage.scene, 16));
        assert_int_equal(lights.count, 0);
        light_polygons_free(&lights);
    }
}

/* Vertices are not shared here, as where a corner has several normals. */
static void emissive_l_shape_is_two_polygons(void **state) {
    (void)state;
    static const float position[] = {0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 0, 0, 2, 1, 0, 0, 1, 0,
                                     0, 1, 0, 1, 1, 0, 1, 2, 0, 0, 1, 0, 1, 2, 0, 0, 2, 0};
    static const uint32_t index[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    Stage stage;
    LightPolygons lights;
    stage_set(&stage, position, 12, index, 4);
    assert_true(light_polygons_find(&lights, &stage.scene, 16));
    assert_int_equal(lights.count, 2);
    assert_float_equal(check_all(&lights), 3.0f, 1e-6f);
    assert_float_equal(lights.items[0].area, 2.0f, 1e-6f);
    light_polygons_free(&lights);
    assert_true(light_polygons_find(&lights, &stage.scene, 1));
    assert_int_equal(lights.count, 1);
    assert_int_equal(lights.found, 2);
    light_polygons_free(&lights);
}

/* A regular polygon triangulated without a vertex in the middle. */
static void a_ring(int corners, int expected) {
    float position[3 * 32];
    uint32_t index[3 * 32];
    for (int k = 0; k < corners; k++) {
        float phi = 6.28318531f * (float)k / (float)corners;
        position[3 * k] = cosf(phi), position[3 * k + 1] = 0.6f * sinf(phi), position[3 * k + 2] = 0.8f * sinf(phi);
    }
    for (int k = 0; k + 2 < corners; k++) {
        uint32_t a = (uint32_t)k;
        index[3 * k] = 0, index[3 * k + 1] = a + 1, index[3 * k + 2] = a + 2;
    }
    Stage stage;
    LightPolygons lights;
    stage_set(&stage, position, (uint32_t)corners, index, (uint32_t)corners - 2);
    assert_true(light_polygons_find(&lights, &stage.scene, 16));
    assert_int_equal(lights.count, expected);
    assert_float_equal(check_all(&lights), 0.5f * (float)corners * sinf(6.28318531f / (float)corners), 1e-4f);
    light_polygons_free(&lights);
}

static void emissive_ring_is_one_or_few_polygons(void **state) {
    (void)state;
    for (int corners = 3; corners <= 8; corners++) a_ring(corners, 1);
    a_ring(16, 3);
}

static void emissive_flat_grid_is_one_polygon(void **state) {
    (void)state;
    enum { SIDE = 8, ACROSS = SIDE + 1 };
    float position[3 * ACROSS * ACROSS];
    uint32_t index[6 * SIDE * SIDE], *at = index;
    for (int k = 0; k < ACROSS * ACROSS; k++)
        position[3 * k] = (float)(k % ACROSS), position[3 * k + 1] = (float)(k / ACROSS), position[3 * k + 2] = 5.0f;
    for (uint32_t j = 0; j < SIDE; j++)
        for (uint32_t i = 0; i < SIDE; i++) {
            uint32_t a = j * ACROSS + i, b = a + ACROSS;
            *at++ = a, *at++ = a + 1, *at++ = b + 1, *at++ = a, *at++ = b + 1, *at++ = b;
        }
    Stage stage;
    LightPolygons lights;
    stage_set(&stage, position, ACROSS * ACROSS, index, 2 * SIDE * SIDE);
    assert_true(light_polygons_find(&lights, &stage.scene, 16));
    assert_int_equal(lights.count, 1);
    assert_int_equal(lights.items[0].count, 4);
    assert_float_equal(check_all(&lights), SIDE * SIDE, 1e-3f);
    light_polygons_free(&lights);
}

static void degenerate_triangles_are_left_out(void **state) {
    (void)state;
    static const float position[] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0};
    static const uint32_t index[] = {0, 1, 2, 0, 0, 1, 3, 3, 3, 0, 2, 3};
    Stage stage;
    LightPolygons lights;
    stage_set(&stage, position, 4, index, 4);
    assert_true(light_polygons_find(&lights, &stage.scene, 16));
    assert_int_equal(lights.count, 1);
    assert_float_equal(check_all(&lights), 1.0f, 1e-6f);
    light_polygons_free(&lights);
}

static void emissive_box_is_six_polygons(void **state) {
    (void)state;
    static const float position[] = {0, 0, 0, 1, 0, 0, 1, 2, 0, 0, 2, 0, 0, 0, 3, 1, 0, 3, 1, 2, 3, 0, 2, 3};
    static const uint32_t index[] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                     1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
    Stage stage;
    LightPolygons lights;
    stage_set(&stage, position, 8, index, 12);
    assert_true(light_polygons_find(&lights, &stage.scene, 16));
    assert_int_equal(lights.count, 6);
    assert_float_equal(check_all(&lights), 22.0f, 1e-4f);
    for (int n = 0; n < 6; n++) {
        const LightPolygon *l = &lights.items[n];
        assert_int_equal(l->count, 4);
        Vec3 out = vec3_sub(l->corners[0], vec3(0.5f, 1.0f, 1.5f));
        assert_true(vec3_dot(out, l->normal) > 0.0f);
    }
    light_polygons_free(&lights);
}

/* Half of the texture is white and half black, along u. */
static void emissive_texture_counts_by_its_mean(void **state) {
    (void)state;
    static const float position[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const float texcoord[] = {0, 0, 1, 0, 1, 1, 0, 1};
    static const uint32_t index[] = {0, 1, 2, 0, 2, 3};
    Stage stage;
    LightPolygons lights;
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_image_create(64, 1, 3, WEFT_PIXEL_F32, &image, &error), WEFT_OK);
    for (int k = 0; k < 3 * 64; k++) ((float *)image.pixels)[k] = k < 3 * 32 ? 1.0f : 0.0f;
    Texture texture = {.image = 0};
    stage_set(&stage, position, 4, index, 2);
    stage.mesh.texcoord[0] = (float *)(uintptr_t)texcoord;
    stage.scene.images = &image, stage.scene.image_count = 1;
    stage.scene.textures = &texture, stage.scene.texture_count = 1;
    stage.material.inputs[INPUT_emission].texture = 1;
    assert_true(light_polygons_find(&lights, &stage.scene, 16));
    assert_int_equal(lights.count, 1);
    assert_float_equal(lights.items[0].radiance[0], 1.5f, 0.05f);
    assert_float_equal(lights.items[0].radiance[1], 1.0f, 0.05f);
    light_polygons_free(&lights);
    weft_image_free(&image);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(emissive_quad_is_one_polygon),      cmocka_unit_test(mesh_without_emission_is_no_polygon),
        cmocka_unit_test(emissive_l_shape_is_two_polygons),  cmocka_unit_test(emissive_ring_is_one_or_few_polygons),
        cmocka_unit_test(emissive_flat_grid_is_one_polygon), cmocka_unit_test(degenerate_triangles_are_left_out),
        cmocka_unit_test(emissive_box_is_six_polygons),      cmocka_unit_test(emissive_texture_counts_by_its_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
