/* Materials that share a program look as each does with its own; several programs at once are as those made
 * one by one
 *
 * Labels: slow unsanitized */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <time.h>

#include <cmocka.h>

#include "raster/gl.h"
#include "shading/cases.h"
#include "trace/scenes.h"

/* Of the squares the last are brushed, which one program does for and the table of another does not. */
enum { SIDE = 128, KINDS = 8, ROUND = 6 };
static const float STEP = 1.8f / KINDS;

/* Of noise, with a fixed seed. */
static void add_texture(WeftScene *scene, int side, int channels) {
    WeftImage *image = &scene->images[scene->image_count];
    uint32_t state = 7u + (uint32_t)side;
    WeftError error;
    assert_int_equal(weft_image_create(side, side, channels, WEFT_PIXEL_U8, image, &error), WEFT_OK);
    unsigned char *p = image->pixels;
    for (int k = 0; k < side * side * channels; k++) {
        state = state * 1664525u + 1013904223u;
        p[k] = (unsigned char)(state >> 24);
    }
    scene->textures[scene->texture_count++] = (Texture){.image = scene->image_count++};
}

static void set_map(Material *material, InputId input, int texture, int channel) {
    material->inputs[input].texture = texture + 1;
    material->inputs[input].channel = (uint8_t)channel;
}

static void add_texcoords(WeftScene *scene, Mesh *quad) {
    static const float uv[8] = {0.1f, 0.1f, 0.9f, 0.1f, 0.9f, 0.9f, 0.1f, 0.9f};
    quad->texcoord[0] = arena_array(&scene->arena, 8, sizeof(float));
    memcpy(quad->texcoord[0], uv, sizeof uv);
}

/* One of KINDS squares side by side, or with -1 all of them: numbers, and maps of different inputs, sizes and
 * channels. */
static WeftScene *squares(int only) {
    WeftScene *scene = test_scene();
    scene->images = arena_array(&scene->arena, 3, sizeof(WeftImage));
    scene->textures = arena_array(&scene->arena, 3, sizeof(Texture));
    add_texture(scene, 4, 3);
    add_texture(scene, 8, 4);
    add_texture(scene, 4, 4);
    for (int k = 0; k < KINDS; k++) {
        if (only >= 0 && only != k) continue;
        Material *m = test_material(scene, 0.3f + 0.1f * (float)k);
        m->inputs[INPUT_specular].value[0] = 1.0f;
        m->inputs[INPUT_roughness].value[0] = k == 0 ? 1.0f : 0.5f;
        m->inputs[INPUT_metallic].value[0] = k < 2 ? 0.0f : 0.75f;
        if (k == 1 || k == 4) set_map(m, INPUT_base_color, k == 1 ? 0 : 1, 0);
        if (k == 2 || k == 4) set_map(m, INPUT_metallic, 2, 2);
        if (k >= ROUND) m->inputs[INPUT_anisotropy].value[0] = 0.7f;
        if ((k >= 2 && k <= 4) || k == 7) set_map(m, INPUT_roughness, 2, 1);
        if (k == 5) set_map(m, INPUT_occlusion, 1, 0);
        Mesh *mesh = test_quad(scene, vec3(-0.9f + STEP * (float)k, -0.5f, 0.0f), vec3(STEP, 0.0f, 0.0f),
                               vec3(0.0f, 1.0f, 0.0f));
        add_texcoords(scene, mesh);
    }
    scene_bounds(scene);
    test_environment(scene, 0.4f);
    const WeftLight light = {.direction = {-0.2f, -0.3f, -1.0f}, .color = {2.0f, 2.0f, 2.0f}};
    assert_int_equal(weft_scene_add_light(scene, &light, NULL), WEFT_OK);
    return scene;
}

static WeftImage picture_of(const WeftScene *scene, WeftGl gl, int threads, int *programs) {
    const WeftRasterView view = {
        .width = SIDE, .height = SIDE, .samples = 1, .camera = "0,0,4;0,0,0;30", .no_shadows = 1};
    WeftRaster *raster;
    WeftImage image = {0};
    WeftError error;
    if (weft_raster_create(scene, &(WeftRasterDesc){.gl = gl, .threads = threads, .no_cache = 1}, &raster, NULL,
                           &error) != WEFT_OK ||
        weft_raster_draw(raster, &view, &error) != WEFT_OK || weft_raster_image(raster, &image, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    *programs = weft_raster_info(raster).programs;
    weft_raster_free(raster);
    return image;
}

/* In the columns of that square; largest difference of any channel there. */
static float difference(const WeftImage *a, const WeftImage *b, int square) {
    float most = 0.0f, across = 2.0f * 4.0f * 0.267949192f; /* of the picture, in the plane of the squares */
    int begin = (int)((0.5f + (-0.9f + STEP * (float)square) / across) * SIDE) + 2;
    int end = (int)((0.5f + (-0.9f + STEP * (float)(square + 1)) / across) * SIDE) - 2;
    assert_true(end > begin + 5);
    for (int y = SIDE / 3; y < SIDE - SIDE / 3; y++)
        for (int x = begin; x < end; x++)
            for (int c = 0; c < 4; c++) {
                size_t at = 4 * ((size_t)y * SIDE + (size_t)x) + (size_t)c;
                most = fmaxf(most, fabsf(((float *)a->pixels)[at] - ((float *)b->pixels)[at]));
            }
    return most;
}

static void materials_drawn_together_look_as_each_alone(void **state) {
    (void)state;
    need_gl();
    for (int gl = WEFT_GL_DESKTOP; gl <= WEFT_GL_ES; gl++) {
        int programs;
        WeftScene *scene = squares(-1);
        WeftImage together = picture_of(scene, (WeftGl)gl, 2, &programs);
        assert_int_equal(programs, 3);
        weft_scene_free(scene);
        for (int k = gl; k < KINDS; k += test_long() ? 1 : 3) {
            scene = squares(k);
            WeftImage alone = picture_of(scene, (WeftGl)gl, 2, &programs);
            float most = difference(&together, &alone, k);
            if (most > 2e-3f) fail_msg("square %d differs by %g", k, (double)most);
            weft_image_free(&alone);
            weft_scene_free(scene);
        }
        weft_image_free(&together);
    }
}

/* A square with maps that are 128 of 255 all over, or the numbers that come out of that. */
static WeftScene *even_square(bool mapped) {
    static const InputId colors[] = {INPUT_base_color, INPUT_sheen_color, INPUT_specular_color};
    static const InputId scalars[] = {INPUT_metallic, INPUT_clearcoat, INPUT_specular, INPUT_anisotropy};
    WeftScene *scene = test_scene();
    scene->images = arena_array(&scene->arena, 1, sizeof(WeftImage));
    scene->textures = arena_array(&scene->arena, 1, sizeof(Texture));
    add_texture(scene, 4, 3);
    memset(scene->images[0].pixels, 128, 4 * 4 * 3);
    Material *m = test_material(scene, 1.0f);
    m->inputs[INPUT_specular].value[0] = 1.0f;
    for (size_t k = 0; k < sizeof colors / sizeof colors[0]; k++) {
        test_color(m, colors[k], mapped ? 1.0f : 0.21586050f); /* decoded */
        if (mapped) set_map(m, colors[k], 0, 0);
    }
    for (size_t k = 0; k < sizeof scalars / sizeof scalars[0]; k++) {
        m->inputs[scalars[k]].value[0] = mapped ? 1.0f : 128.0f / 255.0f;
        if (mapped) set_map(m, scalars[k], 0, 0);
    }
    m->inputs[INPUT_roughness].value[0] = m->inputs[INPUT_sheen_roughness].value[0] = 0.6f;
    Mesh *mesh = test_quad(scene, vec3(-1.0f, -1.0f, 0.0f), vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 2.0f, 0.0f));
    add_texcoords(scene, mesh);
    scene_bounds(scene);
    test_environment(scene, 1.0f);
    return scene;
}

/* A factor of 1 on a map leaves nothing out that the map brings. */
static void even_map_with_a_factor_of_one_is_its_number(void **state) {
    (void)state;
    need_gl();
    WeftImage images[2];
    for (int mapped = 0; mapped < 2; mapped++) {
        int programs;
        WeftScene *scene = even_square(mapped);
        images[mapped] = picture_of(scene, WEFT_GL_DESKTOP, 2, &programs);
        weft_scene_free(scene);
    }
    const float *a = images[0].pixels, *b = images[1].pixels;
    size_t middle = 4 * (SIDE / 2 * SIDE + SIDE / 2);
    for (size_t c = 0; c < 3; c++) {
        assert_true(a[middle + c] > 0.1f);
        assert_float_equal(a[middle + c], b[middle + c], 4e-3f * a[middle + c]);
    }
    weft_image_free(&images[0]);
    weft_image_free(&images[1]);
}

/* Squares that are seen from one side or cut out: six programs. */
static void compiling_in_any_number_of_threads_gives_the_same_picture(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = squares(-1);
    int programs;
    test_environment(scene, 0.0f);
    for (int k = 0; k < KINDS; k++) scene->materials[k].alpha_mode = k % 2 ? WEFT_ALPHA_MASK : WEFT_ALPHA_OPAQUE;
    for (int k = 0; k < KINDS; k++) scene->materials[k].double_sided = k % 4 < 2;
    WeftImage one = picture_of(scene, WEFT_GL_DESKTOP, 1, &programs);
    assert_int_equal(programs, 6);
    WeftImage four = picture_of(scene, WEFT_GL_DESKTOP, 4, &programs);
    assert_int_equal(programs, 6);
    assert_memory_equal(one.pixels, four.pixels, SIDE * SIDE * 4 * sizeof(float));
    weft_image_free(&one);
    weft_image_free(&four);
    weft_scene_free(scene);
}

/* Numbers alone differ: one program does, and no table is fitted for each. Seconds are of the processor. */
static void thousands_of_materials_are_drawn_in_seconds(void **state) {
    (void)state;
    need_gl();
    enum { COUNT = 1000 };
    WeftScene *scene = scene_create("many");
    WeftRaster *raster;
    WeftError error;
    scene->meshes = arena_array(&scene->arena, COUNT, sizeof(Mesh));
    scene->materials = arena_array(&scene->arena, COUNT, sizeof(Material));
    scene->material_names = arena_array(&scene->arena, COUNT, sizeof(char *));
    for (int k = 0; k < COUNT; k++) {
        Material *m = test_material(scene, 0.5f);
        m->inputs[INPUT_roughness].value[0] = 0.2f + 0.7f * (float)k / COUNT;
        m->inputs[INPUT_sheen_roughness].value[0] = 0.9f - 0.7f * (float)k / COUNT;
        test_color(m, INPUT_sheen_color, 0.3f);
        test_quad(scene, vec3((float)(k % 32), (float)(k / 32), 0.0f), vec3(0.8f, 0.0f, 0.0f), vec3(0.0f, 0.8f, 0.0f));
    }
    scene_bounds(scene);
    clock_t start = clock();
    assert_int_equal(weft_raster_create(scene, &(WeftRasterDesc){0}, &raster, NULL, &error), WEFT_OK);
    assert_int_equal(weft_raster_draw(raster, &(WeftRasterView){.width = 64, .height = 64}, &error), WEFT_OK);
    weft_raster_finish(raster);
    double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    assert_in_range(weft_raster_info(raster).programs, 1, 2);
    if (!(seconds < 10.0)) fail_msg("%.1f s", seconds);
    print_message("%d materials: %.1f s\n", COUNT, seconds);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(materials_drawn_together_look_as_each_alone),
                                       cmocka_unit_test(even_map_with_a_factor_of_one_is_its_number),
                                       cmocka_unit_test(compiling_in_any_number_of_threads_gives_the_same_picture),
                                       cmocka_unit_test(thousands_of_materials_are_drawn_in_seconds)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
