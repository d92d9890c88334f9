/* Occlusion of the lights of an environment: a wall's shadow on a floor is where the path tracer has it, also on a floor
 * of two triangles, and a map that is turned takes it along. Lights of a moving picture are fewer, and lose no light. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "raster/gl.h"
#include "raster/light/merged_lights.h"
#include "shading/cases.h"
#include "trace/scenes.h"

enum { SIDE = 64, CELLS = 60, MAP_WIDTH = 64, MAP_HEIGHT = 32 };

/* A floor of small cells. */
static void add_floor(WeftScene *scene) {
    enum { ACROSS = CELLS + 1 };
    Mesh *mesh = test_mesh(scene, ACROSS * ACROSS, 2 * CELLS * CELLS);
    mesh->normal = arena_array(&scene->arena, mesh->vertex_count, 3 * sizeof(float));
    uint32_t *index = mesh->index;
    for (uint32_t k = 0; k < ACROSS * ACROSS; k++) {
        float x = (float)(k % ACROSS) / CELLS - 0.5f, z = (float)(k / ACROSS) / CELLS - 0.5f;
        Vec3 p = {3.0f * x, 0.0f, 3.0f * z};
        memcpy(mesh->position + 3 * k, &p, sizeof p);
        mesh->normal[3 * k + 1] = 1.0f;
        if (k % ACROSS == CELLS || k / ACROSS == CELLS) continue;
        const uint32_t corners[6] = {k, k + ACROSS, k + 1, k + 1, k + ACROSS, k + ACROSS + 1};
        memcpy(index, corners, sizeof corners);
        index += 6;
    }
}

/* A dim sky with a small bright window and a wide one over a matt floor; a wall that hides both from some of its cells,
 * or a slab so far above a floor of two triangles that these are cut large. */
static WeftScene *shaded(bool slab) {
    WeftScene *scene = test_scene();
    WeftImage sky;
    test_material(scene, 0.7f);
    if (slab)
        test_quad(scene, vec3(-3.0f, 0.0f, 3.0f), vec3(6.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -6.0f));
    else
        add_floor(scene);
    test_material(scene, 0.0f);
    if (slab)
        test_quad(scene, vec3(-0.5f, 1.2f, 0.5f), vec3(1.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -1.0f));
    else
        test_quad(scene, vec3(-0.5f, 0.0f, 0.025f), vec3(1.0f, 0.0f, 0.0f), vec3(0.0f, 0.7f, 0.0f));
    scene_bounds(scene);
    assert_int_equal(weft_image_create(MAP_WIDTH, MAP_HEIGHT, 3, WEFT_PIXEL_F32, &sky, NULL), WEFT_OK);
    float *p = sky.pixels;
    for (int k = 0; k < MAP_WIDTH * MAP_HEIGHT; k++, p += 3) {
        int x = k % MAP_WIDTH, y = k / MAP_WIDTH;
        bool small = x >= 30 && x < 32 && y >= 7 && y < 9, wide = x >= 2 && x < 8 && y >= 6 && y < 11;
        p[0] = p[1] = p[2] = small ? 150.0f : wide ? 6.0f : 0.3f;
    }
    weft_image_free(&scene->environment.image);
    scene->environment.image = sky;
    scene->environment.kind = ENVIRONMENT_IMAGE;
    scene->environment.version++;
    return scene;
}

static WeftRaster *raster_of(const WeftScene *scene, int occlusion) {
    WeftRaster *raster;
    WeftError error;
    const WeftRasterDesc desc = {.threads = 2, .occlusion = occlusion, .no_cache = 1};
    if (weft_raster_create(scene, &desc, &raster, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return raster;
}

static WeftImage drawn(WeftRaster *raster, const char *camera) {
    WeftImage image;
    const WeftRasterView view = {.width = SIDE, .height = SIDE, .samples = 4, .camera = camera};
    assert_int_equal(weft_raster_wait(raster, NULL), WEFT_OK);
    assert_int_equal(weft_raster_draw(raster, &view, NULL), WEFT_OK);
    assert_int_equal(weft_raster_image(raster, &image, NULL), WEFT_OK);
    return image;
}

/* Sum of differences over sum of the reference, of means over blocks, in which its noise is small. */
static double error_of(const WeftImage *image, const WeftImage *reference) {
    enum { BLOCK = 4 };
    const float *p = image->pixels, *q = reference->pixels;
    double off = 0.0, all = 0.0;
    for (int block = 0; block < SIDE * SIDE / (BLOCK * BLOCK); block++) {
        int x = block % (SIDE / BLOCK) * BLOCK, y = block / (SIDE / BLOCK) * BLOCK;
        double difference = 0.0;
        for (int k = 0; k < BLOCK * BLOCK; k++) {
            int at = 4 * ((y + k / BLOCK) * SIDE + x + k % BLOCK);
            difference += (double)(p[at] - q[at]);
            all += (double)q[at];
        }
        off += fabs(difference);
    }
    return off / all;
}

static void compare(WeftScene *scene, WeftRaster *raster, WeftRaster *without, const char *camera, float turn,
                    double most) {
    const WeftRenderDesc desc = {.width = SIDE, .height = SIDE, .max_depth = 1, .camera = camera, .threads = 2};
    assert_int_equal(weft_scene_set_environment_placement(scene, turn, 1.0f, NULL), WEFT_OK);
    assert_int_equal(weft_raster_update(raster, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_raster_update(without, NULL, NULL), WEFT_OK);
    WeftImage reference = test_render(scene, desc, 256), image = drawn(raster, camera), plain = drawn(without, camera);
    double off = error_of(&image, &reference), off_plain = error_of(&plain, &reference);
    print_message("turned by %g: %.1f %%, without %.1f %%\n", (double)turn, 100.0 * off, 100.0 * off_plain);
    assert_true(off < most);
    assert_true(off_plain > 2.0 * off);
    weft_image_free(&reference);
    weft_image_free(&image);
    weft_image_free(&plain);
}

/* veil: the part of the floor's light that comes through. */
static void compare_turned(bool slab, float veil, const char *camera, double most) {
    need_gl();
    WeftScene *scene = shaded(slab);
    scene->materials[0].inputs[INPUT_diffuse_transmission].value[0] = veil;
    WeftRaster *raster = raster_of(scene, 64), *without = raster_of(scene, 0);
    compare(scene, raster, without, camera, 20.0f, most);
    compare(scene, raster, without, camera, 200.0f, most);
    weft_raster_free(raster);
    weft_raster_free(without);
    weft_scene_free(scene);
}

static void shadows_of_environment_lights_are_those_of_the_path_tracer(void **state) {
    (void)state;
    compare_turned(false, 0.0f, "0,6,0.01;0,0,0;24", 0.04);
}

/* The floor is cut at the rims of the shadows, and cut anew where they lie once the map is turned. */
static void shadows_on_two_triangles_are_those_of_the_path_tracer(void **state) {
    (void)state;
    compare_turned(true, 0.0f, "0,9,0.01;0,0,0;30", 0.012);
}

/* A veil in place of the floor is seen from below: it shows the wall's shadows, not light through the wall. */
static void shadows_show_through_a_veil(void **state) {
    (void)state;
    compare_turned(false, 0.8f, "0,-6,0.01;0,0,0;24", 0.04);
}

/* Of six lights two pairs are a tenth of a radian from each other: these become one light each. */
static void merged_lights_keep_light_and_directions(void **state) {
    (void)state;
    static const Vec3 directions[] = {{1.0f, 0.0f, 0.0f}, {0.995f, 0.0998f, 0.0f}, {0.0f, 1.0f, 0.0f},
                                      {0.0f, 0.0f, 1.0f}, {0.0998f, 0.0f, 0.995f}, {-1.0f, 0.0f, 0.0f}};
    AmbientParts parts = {.env_light_count = 6};
    MergedLight merged[MERGED_LIGHTS];
    float sum = 0.0f, of[MERGED_OF] = {0.0f};
    for (int k = 0; k < 6; k++)
        parts.env_lights[k] = (EnvLight){directions[k], {1.0f, 2.0f, 3.0f + (float)k}, 0.01f, 1};
    assert_int_equal(merged_lights(&parts, merged), MERGED_LIGHTS);
    for (int j = 0; j < MERGED_LIGHTS; j++) {
        float nearest = -1.0f, whole = 0.0f;
        for (int k = 0; k < 6; k++) nearest = fmaxf(nearest, vec3_dot(merged[j].light.direction, directions[k]));
        assert_true(nearest > 0.995f); /* pairs were merged, and no others */
        sum += merged[j].light.color[2];
        for (int k = 0; k < MERGED_OF; k++) {
            whole += merged[j].of[k];
            of[k] += merged[j].of[k];
        }
        assert_float_equal(whole, 1.0f, 1e-5f);
    }
    assert_float_equal(sum, 18.0f + 15.0f, 1e-4f);
    for (int k = 0; k < 6; k++) assert_true(of[k] > 0.3f); /* each counts in one */
    parts.env_light_count = 2;
    assert_int_equal(merged_lights(&parts, merged), 2);
    assert_float_equal(merged[1].of[1], 1.0f, 1e-6f);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(shadows_of_environment_lights_are_those_of_the_path_tracer),
                                       cmocka_unit_test(shadows_on_two_triangles_are_those_of_the_path_tracer),
                                       cmocka_unit_test(shadows_show_through_a_veil),
                                       cmocka_unit_test(merged_lights_keep_light_and_directions)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
