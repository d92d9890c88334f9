/* What vertices see of the sky: all of it, half of it; and from the cache what was found before */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "trace/scenes.h"

#include "base/pi.h"
#include "raster/geometry/occlusion.h"
#include "scratch.h"

enum { RAYS = 256, LIGHTS = 4, ALL = 8 * OCCLUSION_VALUES };
static char folder[SCRATCH_SIZE];

static void count(void *user, WeftMessage message, const char *text) {
    (void)message, (void)text;
    ++*(int *)user;
}

/* A small floor before a wall so large that it hides half of the sky. */
static WeftScene *corner(WeftAlphaMode mode) {
    WeftScene *scene = test_scene();
    test_material(scene, 0.5f)->alpha_mode = mode;
    Mesh *floor = test_quad(scene, vec3(-0.01f, 0.0f, 0.02f), vec3(0.02f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -0.02f));
    floor->normal = arena_array(&scene->arena, 4, 3 * sizeof(float));
    for (int k = 0; k < 4; k++) floor->normal[3 * k + 1] = 1.0f;
    test_quad(scene, vec3(-1e3f, 0.0f, -0.02f), vec3(2e3f, 0.0f, 0.0f), vec3(0.0f, 1e3f, 0.0f));
    scene_bounds(scene);
    scene->low = vec3(-0.05f, 0.0f, -0.05f); /* rays start a part of the scene's size off */
    scene->high = vec3(0.05f, 0.05f, 0.05f);
    return scene;
}

/* rest: NULL is even; turned by the rotation. */
static void look_by(int rays, const WeftScene *scene, const AmbientRest *rest, float rotation, bool no_cache,
                    float values[ALL], int *warnings) {
    const WeftLog log = {count, warnings};
    Occlusion *occlusion;
    WeftError error;
    /* overhead; behind the wall; about its edge, in front of the wall and behind it; below the floor */
    const EnvLight env_lights[LIGHTS] = {{.direction = {0.0f, 1.0f, 0.0f}},
                                         {.direction = {0.0f, 0.6f, -0.8f}, .spread = 0.01f},
                                         {.direction = {0.0f, 1.0f, 0.0f}, .spread = 0.05f},
                                         {.direction = {0.0f, -0.8f, 0.6f}, .spread = 0.01f}};
    const Refinement unrefined = {0};
    const OcclusionHow how = {.rays = rays,
                              .threads = 2,
                              .no_cache = no_cache,
                              .env_lights = env_lights,
                              .env_light_count = LIGHTS,
                              .rest = rest,
                              .rotation = rotation};
    assert_int_equal(occlusion_start(scene, &unrefined, &how, &occlusion, &log, &error), WEFT_OK);
    memcpy(values, occlusion_values(occlusion, true), ALL * sizeof *values);
    occlusion_free(occlusion);
}

static void look_under(const WeftScene *scene, const AmbientRest *rest, float rotation, bool no_cache,
                       float values[ALL], int *warnings) {
    look_by(RAYS, scene, rest, rotation, no_cache, values, warnings);
}

static void look(const WeftScene *scene, bool no_cache, float values[ALL], int *warnings) {
    look_under(scene, NULL, 0.0f, no_cache, values, warnings);
}

static int files(void) {
    char command[128];
    snprintf(command, sizeof command, "test -z \"$(find %s -name '*.sky')\"", folder);
    return system(command) != 0;
}

static void occlusion_of_a_corner_is_found_in_the_cache(void **state) {
    (void)state;
    WeftScene *scene = corner(WEFT_ALPHA_OPAQUE);
    float first[ALL], again[ALL];
    int warnings = 0;
    look(scene, true, first, &warnings);
    assert_int_equal(files(), 0);
    for (int k = 0; k < 4; k++) {
        const float *at = first + OCCLUSION_VALUES * k, half = 0.5f;
        assert_float_equal(at[0], half, 0.02f);
        const float *open = at + OCCLUSION_OPEN, *env_lights = at + OCCLUSION_LIGHT;
        /* along the horizon all of one side and nothing of the other */
        assert_true(open[0] + open[3] > 0.95f && open[0] - open[3] < 0.05f);
        assert_float_equal(open[0], half, 0.1f);
        assert_float_equal(open[1], 0.0f, 0.1f);
        assert_float_equal(env_lights[0], 1.0f, 0.0f);
        assert_float_equal(env_lights[1], 0.0f, 0.0f);
        assert_float_equal(env_lights[2], half, 0.1f);
        assert_float_equal(env_lights[3], 1.0f, 0.0f); /* by the back */
        assert_true(env_lights[LIGHTS] < 0.0f);
    }
    look(scene, false, again, &warnings);
    assert_int_equal(files(), 1);
    assert_memory_equal(first, again, sizeof first);
    look(scene, false, again, &warnings);
    assert_memory_equal(first, again, sizeof first);
    scene->meshes[1].position[0] -= 1.0f; /* another scene */
    for (int k = 0; k < 12; k++) scene->meshes[1].position[k] += k % 3 == 1 ? 1e4f : 0.0f;
    look(scene, false, again, &warnings);
    assert_float_equal(again[0], 1.0f, 0.0f);
    assert_int_equal(warnings, 0);
    weft_scene_free(scene);
}

/* The half of the sky about the middle of a column of the image is dark. */
static AmbientRest dark_about(int column) {
    AmbientRest rest;
    for (int y = 0; y < AMBIENT_REST_HEIGHT; y++)
        for (int x = 0; x < AMBIENT_REST_WIDTH; x++) {
            int off = (x - column + AMBIENT_REST_WIDTH) % AMBIENT_REST_WIDTH;
            bool dark = off < AMBIENT_REST_WIDTH / 4 || off >= 3 * AMBIENT_REST_WIDTH / 4;
            rest.luminance[y][x] = dark ? 0.02f : 1.0f;
        }
    return rest;
}

/* A wall, towards -z, before a dark half of the sky hides a part of the light that is as small as the half is dark, and
 * before the bright half all but that. */
static void wall_before_the_dark_hides_little(void **state) {
    (void)state;
    /* the middle column of the image is -z, from which turns by a positive angle lead to -x */
    static const struct {
        int column;
        float rotation;
        bool dark;
    } cases[] = {{AMBIENT_REST_WIDTH / 2, 0.0f, true},
                 {0, 0.0f, false},
                 {3 * AMBIENT_REST_WIDTH / 4, 0.5f * PI_FLOAT, true},
                 {3 * AMBIENT_REST_WIDTH / 4, -0.5f * PI_FLOAT, false}};
    WeftScene *scene = corner(WEFT_ALPHA_OPAQUE);
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        const AmbientRest rest = dark_about(cases[c].column);
        float values[ALL];
        int warnings = 0;
        look_under(scene, &rest, cases[c].rotation, true, values, &warnings);
        for (int k = 0; k < 4; k++) {
            float seen = values[OCCLUSION_VALUES * k];
            assert_true(cases[c].dark ? seen > 0.9f && seen < 1.0f : seen < 0.1f);
        }
    }
    weft_scene_free(scene);
}

/* A ramp lets through as much as is seen over a low wall, by the weight 1 / (w.y + .07) of a sheen's light, though it is
 * cut off at 0 and 1. */
static void ramp_lets_through_what_is_seen(void **state) {
    (void)state;
    enum { UP = 64, AROUND = 256 };
    const float height = 0.02f;
    WeftScene *scene = corner(WEFT_ALPHA_OPAQUE);
    float values[ALL], *wall = scene->meshes[1].position;
    int warnings = 0;
    for (int k = 0; k < 4; k++) wall[3 * k + 1] = fminf(wall[3 * k + 1], height);
    look(scene, true, values, &warnings);
    for (int v = 0; v < 4; v++) {
        const float *c = values + OCCLUSION_VALUES * v + OCCLUSION_OPEN;
        const float away = scene->meshes[0].position[3 * v + 2] + 0.02f; /* from the wall */
        float off = 0.0f, all = 0.0f;
        for (int k = 0; k < UP * AROUND; k++) {
            const float y = ((float)(k / AROUND) + 0.5f) / UP, s = sqrtf(1.0f - y * y),
                        phi = ((float)(k % AROUND) + 0.5f) * 2.0f * PI_FLOAT / AROUND, x = s * cosf(phi),
                        z = s * sinf(phi), g = 1.0f / (y + 0.07f);
            const bool seen = z > 0.0f || y * away > -z * height;
            off += g * (fminf(fmaxf(c[0] + c[1] * x + c[2] * y + c[3] * z, 0.0f), 1.0f) - (seen ? 1.0f : 0.0f));
            all += g;
        }
        print_message("ramp at vertex %d: %.4f more than is seen\n", v, (double)(off / all));
        assert_float_equal(off / all, 0.0f, 0.01f);
    }
    weft_scene_free(scene);
}

/* With fewer rays than a ramp has numbers it is some ramp all the same. */
static void few_rays_give_finite_ramps(void **state) {
    (void)state;
    WeftScene *scene = corner(WEFT_ALPHA_OPAQUE);
    const AmbientRest rest = dark_about(AMBIENT_REST_WIDTH / 2);
    float values[ALL];
    for (int rays = 1; rays < 6; rays++) {
        int warnings = 0;
        look_by(rays, scene, &rest, 0.0f, true, values, &warnings);
        for (int k = 0; k < ALL; k++) assert_true(isfinite(values[k]));
    }
    weft_scene_free(scene);
}

/* What is transparent by its textures is looked at anew each time. */
static void occlusion_of_transparent_scenes_is_not_cached(void **state) {
    (void)state;
    char command[96];
    snprintf(command, sizeof command, "rm -rf %s/weft", folder);
    assert_int_equal(system(command), 0);
    WeftScene *scene = corner(WEFT_ALPHA_BLEND);
    float values[ALL];
    int warnings = 0;
    look(scene, false, values, &warnings);
    assert_int_equal(files(), 0);
    weft_scene_free(scene);
}

static int begin(void **state) {
    (void)state;
    return scratch_cache(folder) ? 0 : -1;
}

static int end(void **state) {
    (void)state;
    return scratch_remove(folder) ? 0 : -1;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(occlusion_of_a_corner_is_found_in_the_cache),
        cmocka_unit_test(wall_before_the_dark_hides_little), cmocka_unit_test(ramp_lets_through_what_is_seen),
        cmocka_unit_test(few_rays_give_finite_ramps), cmocka_unit_test(occlusion_of_transparent_scenes_is_not_cached)};
    return cmocka_run_group_tests(tests, begin, end);
}
