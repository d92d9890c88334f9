/* Hair of a scene: as many fibres as are asked for and as long, none where none are; lights, saving and loading beside it;
 * and what is refused.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "scene/material/hair.h"
#include "scratch.h"
#include "trace/scenes.h"
#include "weft/weft.h"

static char folder[SCRATCH_SIZE];

static int begin(void **state) {
    (void)state;
    return scratch_make(folder) ? 0 : -1;
}

static int end(void **state) {
    (void)state;
    return scratch_remove(folder) ? 0 : -1;
}

/* A level square, 20 cm a side, that looks up. */
static WeftScene *square(void) {
    WeftScene *scene = test_scene();
    test_material(scene, 0.5f);
    test_quad(scene, vec3(-0.1f, 0.0f, 0.1f), vec3(0.2f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -0.2f));
    scene->meshes[0].name = "square";
    scene_bounds(scene);
    return scene;
}

static void set(WeftScene *scene, const char *target, const char *value) {
    WeftError error;
    if (weft_scene_set(scene, target, value, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
}

static Vec3 corner(const Mesh *mesh, uint32_t triangle, int k) {
    return vec3_load(mesh->position + 3 * (size_t)mesh->index[3 * (size_t)triangle + (size_t)k]);
}

static double area_of(const Mesh *mesh) {
    double sum = 0.0;
    for (uint32_t k = 0; k < mesh->triangle_count; k++) {
        const Vec3 a = corner(mesh, k, 0);
        sum += 0.5 * (double)vec3_length(vec3_cross(vec3_sub(corner(mesh, k, 1), a), vec3_sub(corner(mesh, k, 2), a)));
    }
    return sum;
}

static void fibres_are_as_many_and_as_long_as_asked(void **state) {
    (void)state;
    WeftScene *scene = square();
    set(scene, "*.hair_density", "100000");
    set(scene, "*.hair_thickness", "5e-5");
    assert_int_equal(scene->mesh_count, 1); /* none without a length */
    set(scene, "*.hair_length", "0.004");
    assert_int_equal(scene->mesh_count, 2);
    assert_int_equal(scene->material_count, 2);
    const Mesh *hair = &scene->meshes[1];
    const int fibres = (int)(hair->triangle_count / HAIR_TRIANGLES);
    print_message("%d fibres of 4000, %.4g m2 of %.4g\n", fibres, area_of(hair), 4000.0 * 0.5625 * 0.004 * 5e-5);
    assert_in_range(fibres, 4000 - 1, 4000 + 1); /* each of both triangles is rounded */
    /* a ribbon is half as long as the longest and more, and its outer half comes to a point: 3/4 by 3/4; where it is bent
     * across, it is narrower */
    assert_true(fabs(area_of(hair) / (4000.0 * 0.5625 * 0.004 * 5e-5) - 0.98) < 0.02);
    float reach = 0.0f;
    for (uint32_t k = 0; k < hair->vertex_count; k++) {
        const Vec3 p = vec3_load(hair->position + 3 * (size_t)k);
        reach = fmaxf(reach, p.y);
        assert_true(fabsf(p.x) < 0.105f && fabsf(p.z) < 0.105f && p.y < 0.0041f);
    }
    assert_true(reach > 0.0035f);
    WeftSceneInfo info = weft_scene_info(scene); /* the scene's own */
    assert_int_equal(info.mesh_count, 1);
    assert_int_equal(info.material_count, 1);
    assert_int_equal(info.triangle_count, 2);
    static const char *const none[][2] = {{"*.hair_length", "0"}, {"*.hair_density", "0"}, {"*.hair_thickness", "0"}};
    for (int k = 0; k < 3; k++) {
        const float kept = scene->materials[0].hair[k];
        char value[32];
        snprintf(value, sizeof value, "%.9g", (double)kept);
        set(scene, none[k][0], none[k][1]);
        assert_int_equal(scene->mesh_count, 1);
        assert_int_equal(scene->material_count, 1);
        set(scene, none[k][0], value);
        assert_int_equal(scene->mesh_count, 2);
    }
    weft_scene_free(scene);
}

static void holes_have_no_hair(void **state) {
    (void)state;
    WeftScene *scene = square();
    set(scene, "*.hair_length", "0.004");
    const uint32_t all = scene->meshes[1].triangle_count;
    set(scene, "*.opacity", "0.25");
    print_message("%.3f of the fibres stand on a cloth of opacity 0.25\n",
                  (double)scene->meshes[1].triangle_count / (double)all);
    assert_true(fabs((double)scene->meshes[1].triangle_count / (double)all - 0.25) < 0.03);
    set(scene, "*.opacity", "0");
    assert_int_equal(scene->meshes[1].triangle_count, 0);
    weft_scene_free(scene);
}

/* Checks that own meshes, hair and lights follow each other, each with its material. */
static void holds_together(const WeftScene *scene, int hairs, int lights) {
    assert_int_equal(scene->hair_count, hairs);
    assert_int_equal(scene->mesh_count, 1 + hairs + lights);
    assert_int_equal(scene->material_count, 1 + hairs + lights);
    for (int m = 1; m < scene->mesh_count; m++) assert_int_equal(scene->meshes[m].material, m);
    for (int k = 0; k < lights; k++) {
        WeftLight light;
        assert_int_equal(weft_scene_light(scene, k, &light, NULL), WEFT_OK);
        assert_float_equal(scene->materials[1 + hairs + k].inputs[INPUT_emission].value[0], light.color[0], 0.0f);
        assert_int_equal(scene->meshes[1 + hairs + k].vertex_count, light.corners);
    }
}

static void lights_come_and_go_beside_hair(void **state) {
    (void)state;
    WeftScene *scene = square();
    WeftLight panel = {.kind = WEFT_LIGHT_POLYGON,
                       .position = {0.0f, 1.0f, 0.0f},
                       .direction = {0.0f, -1.0f, 0.0f},
                       .size = {0.3f, 0.3f}};
    int lights = 0;
    for (int step = 0; step < 12; step++) {
        panel.color[0] = 1.0f + (float)step;
        panel.corners = 3 + step % 6;
        assert_int_equal(weft_scene_add_light(scene, &panel, NULL), WEFT_OK);
        lights++;
        set(scene, "*.hair_length", step % 3 == 2 ? "0" : step % 3 ? "0.002" : "0.004");
        holds_together(scene, step % 3 != 2, lights);
        if (step % 4 != 3) continue;
        assert_int_equal(weft_scene_remove_light(scene, 1, NULL), WEFT_OK);
        holds_together(scene, step % 3 != 2, --lights);
    }
    weft_scene_free(scene);
}

static void saved_scene_has_the_hair_again(void **state) {
    (void)state;
    WeftScene *scene = square(), *again = NULL;
    WeftError error;
    char path[SCRATCH_SIZE + 16], material[SCRATCH_SIZE + 16];
    const WeftLight panel = {.kind = WEFT_LIGHT_POLYGON,
                             .position = {0.0f, 1.0f, 0.0f},
                             .direction = {0.0f, -1.0f, 0.0f},
                             .color = {3.0f, 3.0f, 3.0f},
                             .size = {0.3f, 0.3f}};
    assert_int_equal(weft_scene_add_light(scene, &panel, NULL), WEFT_OK);
    set(scene, "*.hair_length", "0.003");
    set(scene, "*.hair_thickness", "4e-5");
    snprintf(path, sizeof path, "%s/hair.glb", folder);
    snprintf(material, sizeof material, "%s/hair.json", folder);
    if (weft_scene_save(scene, path, &error) != WEFT_OK) fail_msg("%s", error.text);
    if (weft_scene_save_material(scene, 0, material, &error) != WEFT_OK) fail_msg("%s", error.text);
    if (weft_scene_load(path, &again, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(again->hair_count, 1);
    assert_int_equal(weft_scene_info(again).mesh_count, 2); /* a saved light is an own mesh */
    const Mesh *is = &again->meshes[2], *was = &scene->meshes[1];
    assert_int_equal(is->triangle_count, was->triangle_count);
    for (size_t k = 0; k < 3 * (size_t)was->vertex_count; k++)
        assert_float_equal(is->position[k], was->position[k], 0.0f);
    set(again, "*.hair_length", "0");
    set(again, "*.hair_thickness", "6e-5");
    assert_int_equal(again->hair_count, 0);
    if (weft_scene_assign_material(again, "0", material, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(again->hair_count, 1);
    assert_int_equal(again->meshes[2].triangle_count, was->triangle_count);
    weft_scene_free(again);
    weft_scene_free(scene);
}

static void count_warning(void *user, WeftMessage message, const char *text) {
    (void)message;
    (void)text;
    ++*(int *)user;
}

static void hair_beyond_reason_is_refused(void **state) {
    (void)state;
    WeftScene *scene = square();
    WeftError error = {0};
    int warnings = 0;
    const WeftLog log = {count_warning, &warnings};
    set(scene, "*.hair_length", "0.003");
    const uint32_t before = scene->meshes[1].triangle_count;
    assert_int_not_equal(weft_scene_set(scene, "*.hair_density", "1e12", &log, &error), WEFT_OK);
    print_message("%s\n", error.text);
    assert_non_null(strstr(error.text, "hair_density"));
    assert_non_null(strstr(error.text, "or less"));
    assert_int_equal(warnings, 1); /* beyond the plausible */
    assert_int_equal(scene->meshes[1].triangle_count, before);
    set(scene, "*.hair_density", "200000");
    assert_int_equal(scene->meshes[1].triangle_count, before);
    assert_int_not_equal(weft_scene_set(scene, "*.hair_length", "long", NULL, &error), WEFT_OK);
    assert_non_null(strstr(error.text, "hair_length is a number"));
    assert_int_not_equal(weft_scene_set(scene, "*.hair_length", "nan", NULL, &error), WEFT_OK);
    assert_int_not_equal(weft_scene_set(scene, "*.hair_lenght", "0.1", NULL, &error), WEFT_OK);
    static const char wrong[] = "{\"hair_length\": \"long\"}", below[] = "{\"hair_length\": -1}";
    assert_int_not_equal(
        weft_scene_assign_material_memory(scene, "0", wrong, sizeof wrong - 1, "wrong.json", NULL, &error), WEFT_OK);
    assert_non_null(strstr(error.text, "hair_length"));
    warnings = 0;
    assert_int_equal(weft_scene_assign_material_memory(scene, "0", below, sizeof below - 1, "below.json", &log, &error),
                     WEFT_OK);
    assert_int_equal(warnings, 1); /* 0 is used */
    assert_int_equal(scene->hair_count, 0);
    WeftMaterial material;
    assert_int_equal(weft_scene_material(scene, 0, &material, &error), WEFT_OK);
    material.hair[WEFT_HAIR_LENGTH] = NAN;
    assert_int_not_equal(weft_scene_put_material(scene, 0, &material, &error), WEFT_OK);
    weft_scene_free(scene);
}

/* A file with more hair than memory holds is read without it, and says so. */
static void file_with_too_much_hair_is_read_bald(void **state) {
    (void)state;
    WeftScene *scene = square(), *again = NULL;
    WeftError error;
    int warnings = 0;
    char path[SCRATCH_SIZE + 16];
    scene->materials[0].hair[WEFT_HAIR_LENGTH] = 0.003f;
    scene->materials[0].hair[WEFT_HAIR_DENSITY] = 1e12f;
    snprintf(path, sizeof path, "%s/much.glb", folder);
    if (weft_scene_save(scene, path, &error) != WEFT_OK) fail_msg("%s", error.text);
    const WeftLog log = {count_warning, &warnings};
    if (weft_scene_load(path, &again, &log, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(again->hair_count, 0);
    assert_int_equal(warnings, 1);
    weft_scene_free(again);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(fibres_are_as_many_and_as_long_as_asked),
                                       cmocka_unit_test(holes_have_no_hair),
                                       cmocka_unit_test(lights_come_and_go_beside_hair),
                                       cmocka_unit_test(saved_scene_has_the_hair_again),
                                       cmocka_unit_test(hair_beyond_reason_is_refused),
                                       cmocka_unit_test(file_with_too_much_hair_is_read_bald)};
    return cmocka_run_group_tests(tests, begin, end);
}
