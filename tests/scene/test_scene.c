/* Scenes: built-in ones, dressing, cameras, and refusals. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/pi.h"
#include "scene/record/camera.h"
#include "scene/record/scene.h"
#include "weave/weft_cloth.h"
#include "weft/weft.h"

static WeftScene *load(const char *name) {
    WeftScene *scene = NULL;
    WeftError error;
    if (weft_scene_load(name, &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

static void every_builtin_scene_loads(void **state) {
    (void)state;
    int count = 0;
    for (; weft_builtin_name(count); count++) {
        char path[64];
        snprintf(path, sizeof path, "builtin:%s", weft_builtin_name(count));
        WeftScene *scene = load(path);
        WeftSceneInfo info = weft_scene_info(scene);
        if (strcmp(weft_builtin_name(count), "bend") == 0) /* a cloth and nothing else */
            assert_true(info.triangle_count == 300 && info.camera_count == 0 && info.material_count == 1);
        else
            assert_true(info.triangle_count > 1000 && info.camera_count >= 1 && info.material_count >= 2);
        assert_true(strlen(weft_builtin_help(count)) > 10);
        for (int m = 0; m < scene->mesh_count; m++) {
            const Mesh *mesh = &scene->meshes[m];
            assert_in_range(mesh->material, 0, scene->material_count - 1);
            for (uint32_t k = 0; k < 3 * mesh->triangle_count; k++) assert_true(mesh->index[k] < mesh->vertex_count);
            for (uint32_t k = 0; mesh->normal && k < mesh->vertex_count; k++)
                assert_true(fabsf(vec3_length(vec3_load(mesh->normal + 3 * (size_t)k)) - 1.0f) < 1e-3f);
        }
        weft_scene_free(scene);
    }
    assert_true(count >= 2);
    WeftScene *scene;
    WeftError error;
    assert_int_equal(weft_scene_load("builtin:nothing", &scene, NULL, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_SCENE_NAME);
    assert_null(scene);
}

typedef struct Warnings {
    int count;
    WeftMessage last;
} Warnings;

static void note(void *user, WeftMessage message, const char *text) {
    Warnings *warnings = user;
    assert_non_null(text);
    warnings->count++;
    warnings->last = message;
}

static void material_inputs_are_set_by_name(void **state) {
    (void)state;
    WeftScene *scene = load("builtin:spheres");
    Warnings warnings = {0};
    WeftLog log = {note, &warnings};
    WeftError error;
    assert_int_equal(weft_scene_set(scene, "dark-1.roughness", "0.25", &log, &error), WEFT_OK);
    assert_true(scene->materials[1].inputs[INPUT_roughness].value[0] == 0.25f);
    assert_true(scene->materials[0].inputs[INPUT_roughness].value[0] != 0.25f);
    assert_int_equal(weft_scene_set(scene, "*.base_color", "0.1,0.2,0.3", &log, &error), WEFT_OK);
    for (int k = 0; k < scene->material_count; k++)
        assert_true(scene->materials[k].inputs[INPUT_base_color].value[2] == 0.3f);
    assert_int_equal(weft_scene_set(scene, "2.sheen_color", "0.5", &log, &error), WEFT_OK);
    assert_true(scene->materials[2].inputs[INPUT_sheen_color].value[1] == 0.5f);
    assert_int_equal(warnings.count, 0);
    assert_int_equal(weft_scene_set(scene, "floor.roughness", "1.5", &log, &error), WEFT_OK);
    assert_int_equal(warnings.count, 1);
    assert_int_equal(warnings.last, WEFT_MESSAGE_PARAM_RANGE);
    /* beyond the hard range no value can make light */
    assert_int_equal(weft_scene_set(scene, "floor.metallic", "-2", &log, &error), WEFT_OK);
    assert_true(scene->materials[scene->material_count - 1].inputs[INPUT_metallic].value[0] == 0.0f);
    assert_int_equal(warnings.count, 2);
    scene->materials[3].inputs[INPUT_roughness].texture = 1;
    assert_int_equal(weft_scene_set(scene, "dark-3.roughness", "0.5", &log, &error), WEFT_OK);
    assert_int_equal(scene->materials[3].inputs[INPUT_roughness].texture, 0); /* a number replaces the texture */

    static const struct {
        const char *target, *value;
        WeftMessage message;
    } wrong[] = {
        {"floor.roughnes", "1", WEFT_MESSAGE_PARAM_NAME},
        {"floor", "1", WEFT_MESSAGE_PARAM_NAME},
        {"ceiling.roughness", "1", WEFT_MESSAGE_MATERIAL_NAME},
        {"floor.roughness", "x", WEFT_MESSAGE_PARAM_VALUE},
        {"floor.roughness", "nan", WEFT_MESSAGE_PARAM_VALUE},
        {"floor.roughness", "1,2,3", WEFT_MESSAGE_PARAM_VALUE},
        {"floor.base_color", "1,2", WEFT_MESSAGE_PARAM_VALUE},
        {"floor.base_color", "1,2,inf", WEFT_MESSAGE_PARAM_VALUE},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        assert_int_equal(weft_scene_set(scene, wrong[k].target, wrong[k].value, &log, &error), WEFT_USAGE);
        assert_int_equal(error.message, wrong[k].message);
        assert_null(strchr(error.text, '\n'));
    }
    weft_scene_free(scene);
}

static void sheen_and_layer_are_set_by_id(void **state) {
    (void)state;
    WeftScene *scene = load("builtin:spheres");
    WeftError error;
    assert_int_equal(weft_scene_set(scene, "*.sheen_lobe", "charlie-neubelt", NULL, &error), WEFT_OK);
    assert_int_equal(scene->materials[4].choices[CHOICE_sheen_lobe], weft_lobe_find("charlie-neubelt"));
    assert_int_equal(weft_scene_set(scene, "*.layer", "additive", NULL, &error), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "*.layer", "auto", NULL, &error), WEFT_OK);
    assert_int_equal(scene->materials[4].choices[CHOICE_layer], CHOICE_AUTO);
    assert_int_equal(weft_scene_set(scene, "*.sheen_lobe", "charlie", NULL, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_PARAM_VALUE);
    assert_int_equal(weft_scene_set(scene, "*.diffuse", "ggx", NULL, &error), WEFT_USAGE); /* no diffuse term */
    assert_int_equal(weft_scene_set(scene, "*.layer", "glue", NULL, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_PARAM_VALUE);
    assert_int_equal(weft_scene_set_variant(scene, "red", &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_VARIANT_NAME);
    assert_int_equal(weft_scene_set_environment_color(scene, (float[3]){1, -1, 0}, &error), WEFT_USAGE);
    assert_int_equal(weft_scene_set_environment_placement(scene, NAN, 1.0f, &error), WEFT_USAGE);
    assert_int_equal(weft_scene_set_environment_placement(scene, 30.0f, -2.0f, &error), WEFT_USAGE);
    assert_int_equal(weft_scene_set_environment_file(scene, "/nowhere/sky.hdr", NULL, &error), WEFT_INPUT);
    /* a sheen of its own for what has none: said, where the choice stands alone */
    Warnings warnings = {0};
    WeftLog log = {note, &warnings};
    assert_int_equal(weft_scene_set(scene, "*.sheen_lobe", "patry", &log, &error), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "floor.sheen_lobe", "auto", &log, &error), WEFT_OK);
    assert_int_equal(warnings.count, 0);
    assert_int_equal(weft_scene_set(scene, "floor.sheen_lobe", "patry", &log, &error), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "floor.layer", "additive", &log, &error), WEFT_OK);
    assert_int_equal(warnings.count, 2);
    assert_int_equal(warnings.last, WEFT_MESSAGE_PLAUSIBLE);
    weft_scene_free(scene);
}

/* The auto camera sees every vertex, and some vertex touches each side of one pair of borders up to the
 * margin. */
static void automatic_camera_frames_the_scene(void **state) {
    (void)state;
    static const float aspects[] = {0.5f, 1.0f, 1.7778f, 4.0f};
    WeftScene *scene = load("builtin:spheres");
    scene->mesh_count = 5; /* without the floor */
    for (int a = 0; a < 4; a++) {
        Camera camera;
        assert_int_equal(camera_find(scene, NULL, aspects[a], &camera, NULL), WEFT_OK);
        float t = tanf(0.5f * camera.yfov), reach_x = 0.0f, reach_y = 0.0f;
        for (int m = 0; m < scene->mesh_count; m++)
            for (uint32_t k = 0; k < scene->meshes[m].vertex_count; k++) {
                Vec3 p = vec3_sub(vec3_load(scene->meshes[m].position + 3 * (size_t)k), camera.eye);
                float z = vec3_dot(p, camera.forward);
                assert_true(z > 0.0f);
                reach_x = fmaxf(reach_x, fabsf(vec3_dot(p, camera.right)) / (z * t * aspects[a]));
                reach_y = fmaxf(reach_y, fabsf(vec3_dot(p, camera.up)) / (z * t));
            }
        assert_true(reach_x < 0.95f && reach_y < 0.95f);
        assert_true(fmaxf(reach_x, reach_y) > 0.85f);
    }
    weft_scene_free(scene);
}

static void cameras_are_found_by_name_and_number(void **state) {
    (void)state;
    WeftScene *scene = load("builtin:spheres");
    Camera camera;
    WeftError error;
    assert_int_equal(camera_find(scene, "main", 1.0f, &camera, &error), WEFT_OK);
    assert_int_equal(camera_find(scene, "0", 1.0f, &camera, &error), WEFT_OK);
    assert_int_equal(camera_find(scene, "1,2,3;1,2,-5;40", 1.0f, &camera, &error), WEFT_OK);
    assert_true(fabsf(camera.forward.z + 1.0f) < 1e-6f && fabsf(camera.eye.y - 2.0f) < 1e-6f);
    View view = view_of(&camera, 2.0f);
    CameraRay ray = view_ray(&view, 1.0f, 0.0f);
    assert_true(fabsf(ray.direction.x / -ray.direction.z - 2.0f * tanf(20.0f * PI_FLOAT / 180.0f)) < 1e-5f);
    assert_int_equal(camera_find(scene, "0,5,0;0,0,0;40", 1.0f, &camera, &error), WEFT_OK); /* straight down */
    assert_true(fabsf(vec3_dot(camera.right, camera.forward)) < 1e-6f && fabsf(vec3_length(camera.up) - 1.0f) < 1e-5f);
    static const char *const wrong[] = {
        "", "1", "2,3;4,5;6", "0,0,0;0,0,0;40", "0,0,0;0,0,1;0", "0,0,0;0,0,1;180", "0,0,0;0,0,1;x"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        assert_int_equal(camera_find(scene, wrong[k], 1.0f, &camera, &error), WEFT_USAGE);
        assert_int_equal(error.message, WEFT_MESSAGE_CAMERA_NAME);
    }
    /* what is a view is told what is wrong with it */
    assert_int_equal(camera_find(scene, "0,0,0;0,0,1;180", 1.0f, &camera, &error), WEFT_USAGE);
    assert_non_null(strstr(error.text, "field of view"));
    assert_int_equal(camera_find(scene, "0,0,0;0,0,0;40", 1.0f, &camera, &error), WEFT_USAGE);
    assert_non_null(strstr(error.text, "its eye is where its target is"));
    weft_scene_free(scene);
}

/* The middle tenth of its pictures shows a tenth of the threads that they promise, but for folds. */
static void cameras_of_the_loom_see_so_many_threads(void **state) {
    (void)state;
    static const struct {
        const char *name;
        float threads;
    } cameras[] = {{"far", 5000.0f}, {"near", 500.0f}, {"close", 50.0f}, {"threads", 5.0f}};
    enum { WIDTH = 400, HEIGHT = 300 };
    WeftScene *scene;
    WeftPick *pick;
    assert_int_equal(weft_scene_load("builtin:loom", &scene, NULL, NULL), WEFT_OK);
    assert_int_equal(scene->cloth_count, 7);
    assert_int_equal(weft_pick_create(scene, &pick, NULL), WEFT_OK);
    for (size_t k = 0; k < sizeof cameras / sizeof *cameras; k++) {
        WeftPicked left, right;
        const float half = 0.05f * WIDTH, y = 0.5f * HEIGHT;
        assert_true(weft_pick_at(pick, cameras[k].name, WIDTH, HEIGHT, 0.5f * WIDTH - half, y, &left));
        assert_true(weft_pick_at(pick, cameras[k].name, WIDTH, HEIGHT, 0.5f * WIDTH + half, y, &right));
        const WeftCloth *denim = scene->cloths[scene->materials[left.material].cloth - 1];
        const float seen = (right.texcoord[0][0] - left.texcoord[0][0]) * denim->per_uv[WEFT_WARP];
        assert_float_equal(seen, 0.1f * cameras[k].threads, 0.01f * cameras[k].threads);
    }
    weft_pick_free(pick);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_builtin_scene_loads),
        cmocka_unit_test(material_inputs_are_set_by_name),
        cmocka_unit_test(sheen_and_layer_are_set_by_id),
        cmocka_unit_test(automatic_camera_frames_the_scene),
        cmocka_unit_test(cameras_are_found_by_name_and_number),
        cmocka_unit_test(cameras_of_the_loom_see_so_many_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
