/* Lights of a scene: whatever is added, changed and removed, in whichever order, each is where its caller
 * counts it and as it was given; polygons are meshes behind all others; memory does not grow without bound.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "scene/light/polygons.h"
#include "trace/scenes.h"

enum { MOST = 24, STEPS = 4000 };

static const WeftLight panel = {.kind = WEFT_LIGHT_POLYGON,
                                .position = {0.0f, 2.0f, 0.0f},
                                .direction = {0.0f, -1.0f, 0.0f},
                                .color = {3.0f, 2.0f, 1.0f},
                                .size = {1.0f, 0.5f}};

static WeftScene *floor_scene(void) {
    WeftScene *scene = test_scene();
    test_material(scene, 0.5f);
    test_quad(scene, vec3(-1.0f, 0.0f, 1.0f), vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -2.0f));
    scene_bounds(scene);
    return scene;
}

/* A light of one of the kinds that tells itself by its number. */
static WeftLight numbered(int kind, float number) {
    WeftLight light = panel;
    light.kind = (WeftLightKind)kind;
    light.color[0] = number;
    light.outer = kind == WEFT_LIGHT_SPOT ? 45.0f : 0.0f;
    light.corners = kind == WEFT_LIGHT_POLYGON ? 3 + (int)number % 6 : 0;
    return light;
}

static void is_as_given(const WeftScene *scene, int index, const WeftLight *given) {
    WeftLight light;
    WeftError error;
    assert_int_equal(weft_scene_light(scene, index, &light, &error), WEFT_OK);
    assert_int_equal(light.kind, given->kind);
    assert_float_equal(light.color[0], given->color[0], 0.0f);
    assert_int_equal(light.corners, given->corners);
    assert_float_equal(light.outer, given->outer, 1e-3f);
}

static void holds_together(const WeftScene *scene, const WeftLight *given, int count) {
    WeftSceneInfo info = weft_scene_info(scene);
    int polygons = 0;
    for (int k = 0; k < count; k++) polygons += given[k].kind == WEFT_LIGHT_POLYGON;
    assert_int_equal(info.light_count, count);
    assert_int_equal(info.mesh_count, 1);
    assert_int_equal(info.material_count, 1);
    assert_int_equal(scene->mesh_count, 1 + polygons);
    assert_int_equal(scene->material_count, 1 + polygons);
    for (int k = 0; k < count; k++) is_as_given(scene, k, &given[k]);
    for (int k = 0; k < polygons; k++) {
        const Mesh *mesh = &scene->meshes[1 + k];
        const WeftLight *light = &scene->polygon_lights[k].light;
        assert_int_equal(mesh->material, 1 + k);
        assert_int_equal(mesh->vertex_count, light->corners);
        assert_float_equal(scene->materials[1 + k].inputs[INPUT_emission].value[0], light->color[0], 0.0f);
    }
}

static void light_list_reads_as_it_is_written(void **state) {
    (void)state;
    WeftScene *scene = floor_scene();
    WeftLight given[MOST];
    WeftError error;
    int count = 0;
    size_t half = 0;
    for (int step = 0; step < STEPS; step++) {
        uint32_t x = hash32((uint32_t)step);
        int at = count ? (int)(x >> 8) % count : 0;
        WeftLight light = numbered((int)(x >> 4) % 4, (float)(step + 1));
        bool add = count < 4 || (x % 3 == 0 && count < MOST);
        if (add) {
            assert_int_equal(weft_scene_add_light(scene, &light, &error), WEFT_OK);
            given[count++] = light;
        } else if (x % 3 == 1) {
            assert_int_equal(weft_scene_put_light(scene, at, &light, &error), WEFT_OK);
            given[at] = light;
        } else {
            assert_int_equal(weft_scene_remove_light(scene, at, &error), WEFT_OK);
            count--;
            memmove(given + at, given + at + 1, (size_t)(count - at) * sizeof *given);
        }
        holds_together(scene, given, count);
        if (step == STEPS / 2) half = scene->arena.used;
    }
    assert_int_equal(scene->arena.used, half);
    assert_float_equal(scene->high.y, 0.0f, 0.0f); /* lights are not framed */
    weft_scene_free(scene);
}

/* Of each count of corners: one polygon of that area, shining that way, the first axis level. */
static void light_of_any_corner_count_has_its_area_and_direction(void **state) {
    (void)state;
    for (int corners = 3; corners <= LIGHT_CORNERS; corners++) {
        WeftScene *scene = floor_scene();
        WeftLight light = panel;
        LightPolygons found;
        light.direction[0] = 2.0f;
        light.corners = corners;
        light.roll = corners % 2 ? 30.0f : 0.0f;
        assert_int_equal(weft_scene_add_light(scene, &light, NULL), WEFT_OK);
        assert_true(light_polygons_find(&found, scene, 8));
        assert_int_equal(found.count, 1);
        assert_int_equal(found.items[0].count, corners);
        double turn = 6.283185307179586 / corners, area = 0.125 * corners * sin(turn) * 0.5;
        assert_float_equal(found.items[0].area, (float)(corners == 4 ? 0.5 : area), 1e-5f);
        assert_float_equal(found.items[0].normal.x, 0.894427f, 1e-5f);
        assert_float_equal(found.items[0].normal.y, -0.447214f, 1e-5f);
        assert_float_equal(found.items[0].radiance[1], 2.0f, 1e-5f);
        assert_false(found.items[0].two_sided);
        Vec3 middle = {0};
        for (int k = 0; k < corners; k++) middle = vec3_madd(middle, found.items[0].corners[k], 1.0f / (float)corners);
        assert_float_equal(vec3_length(vec3_sub(middle, vec3_load(light.position))), 0.0f, 1e-5f);
        light_polygons_free(&found);
        weft_scene_free(scene);
    }
}

static void rectangle_light_of_a_level_scene_is_level(void **state) {
    (void)state;
    WeftScene *scene = floor_scene();
    WeftLight light = panel;
    light.direction[2] = 1.0f;
    assert_int_equal(weft_scene_add_light(scene, &light, NULL), WEFT_OK);
    const float *p = scene->meshes[1].position;
    assert_float_equal(p[1], p[4], 1e-6f); /* upper right and upper left */
    assert_float_equal(fabsf(p[0] - p[3]), 1.0f, 1e-6f);
    weft_scene_free(scene);
}

static void lights_without_sense_are_refused(void **state) {
    (void)state;
    WeftScene *scene = floor_scene();
    WeftLight wrong[7], out;
    WeftError error;
    for (int k = 0; k < 7; k++) wrong[k] = panel;
    wrong[0].size[0] = 0.0f;
    wrong[1].size[1] = INFINITY;
    wrong[2].corners = 9;
    wrong[3].corners = 2;
    wrong[4].roll = NAN;
    wrong[5].direction[1] = 0.0f;
    wrong[6].position[0] = wrong[6].size[0] = 3e38f;
    wrong[6].direction[2] = 1.0f;
    assert_int_equal(weft_scene_add_light(scene, &panel, &error), WEFT_OK);
    for (int k = 0; k < 7; k++) {
        assert_int_equal(weft_scene_add_light(scene, &wrong[k], &error), WEFT_USAGE);
        assert_int_equal(error.message, WEFT_MESSAGE_DESC);
        assert_int_equal(weft_scene_put_light(scene, 0, &wrong[k], &error), WEFT_USAGE);
    }
    const int nowhere[] = {-1, 1, 1000};
    for (size_t k = 0; k < sizeof nowhere / sizeof *nowhere; k++) {
        assert_int_equal(weft_scene_light(scene, nowhere[k], &out, &error), WEFT_USAGE);
        assert_int_equal(weft_scene_put_light(scene, nowhere[k], &panel, &error), WEFT_USAGE);
        assert_int_equal(weft_scene_remove_light(scene, nowhere[k], &error), WEFT_USAGE);
    }
    assert_int_equal(scene->mesh_count, 2);
    weft_scene_free(scene);
}

/* What is for all materials leaves those of lights alone. */
static void each_light_has_a_material_of_its_own(void **state) {
    (void)state;
    WeftScene *scene = floor_scene();
    WeftError error;
    float losses[1];
    assert_int_equal(weft_scene_add_light(scene, &panel, &error), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "*.emission_strength", "0", NULL, &error), WEFT_OK);
    assert_int_equal(weft_scene_assign_material(scene, "*", "preset:denim", NULL, &error), WEFT_OK);
    assert_int_equal(weft_scene_convert(scene, "specular", losses, &error), WEFT_OK);
    assert_true(material_emits(&scene->materials[1]));
    assert_float_equal(scene->materials[1].inputs[INPUT_base_color].value[0], 0.0f, 0.0f);
    assert_null(weft_scene_material_name(scene, 1));
    weft_scene_free(scene);
}

static void camera_text_is_read(void **state) {
    (void)state;
    WeftScene *scene = floor_scene();
    WeftCamera camera;
    WeftError error;
    assert_int_equal(weft_scene_camera(scene, "0,2,4;0,1,2;30", 1.5f, &camera, &error), WEFT_OK);
    assert_float_equal(camera.fov, 30.0f, 1e-4f);
    assert_float_equal(camera.eye[2], 4.0f, 0.0f);
    assert_true(camera.target[2] < 3.0f);
    assert_true(camera.up[1] > 0.8f);
    assert_int_equal(weft_scene_camera(scene, "no such", 1.0f, &camera, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_CAMERA_NAME);
    assert_int_equal(weft_scene_camera(scene, NULL, 0.0f, &camera, &error), WEFT_USAGE);
    WeftCamera before, after;
    assert_int_equal(weft_scene_camera(scene, NULL, 1.0f, &before, &error), WEFT_OK);
    assert_int_equal(weft_scene_add_light(scene, &panel, &error), WEFT_OK);
    assert_int_equal(weft_scene_camera(scene, NULL, 1.0f, &after, &error), WEFT_OK);
    assert_memory_equal(&before, &after, sizeof before);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(light_list_reads_as_it_is_written),
                                       cmocka_unit_test(light_of_any_corner_count_has_its_area_and_direction),
                                       cmocka_unit_test(rectangle_light_of_a_level_scene_is_level),
                                       cmocka_unit_test(lights_without_sense_are_refused),
                                       cmocka_unit_test(each_light_has_a_material_of_its_own),
                                       cmocka_unit_test(camera_text_is_read)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
