/* Fine normal maps from afar: first frames beside a supersampled picture, with a few texels to a pixel and with many; the
 * moments that stand for what a pixel does not resolve
 *
 * Labels: unsanitized */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "raster/gl.h"
#include "raster/material/slopes.h"
#include "raster/square.h"
#include "scratch.h"

enum { TEXELS = 64, PERIOD = 16, SIDE = 64, SAMPLES = 256 };
static const char *const CAMERA = "0,2,0.001;0,0,0;43.6"; /* sees 1.6 m */

/* The slopes of a map at a texel. */
typedef void (*Relief)(int x, int y, float slope[2]);

static float wave(int at) { return sinf(2.0f * PI_FLOAT * (float)at / (float)PERIOD); }

static void ribs(int x, int y, float slope[2]) {
    (void)y;
    slope[0] = -0.7f * wave(x);
    slope[1] = 0.0f;
}

static void twill(int x, int y, float slope[2]) { slope[0] = slope[1] = 0.5f * wave(x + y); }

static void crate(int x, int y, float slope[2]) {
    slope[0] = 0.5f * wave(x);
    slope[1] = 0.5f * wave(y);
}

/* Threads that cross over and under in checks, each round as an arc. */
static void basket(int x, int y, float slope[2]) {
    const int half = PERIOD / 2;
    const bool warp = (x / half + y / half) % 2 != 0;
    slope[0] = warp ? 0.2f * ((float)(x % half) - 3.5f) : 0.0f;
    slope[1] = warp ? 0.0f : 0.2f * ((float)(y % half) - 3.5f);
}

static void fill(Relief relief, WeftImage *image) {
    assert_int_equal(weft_image_create(TEXELS, TEXELS, 3, WEFT_PIXEL_U8, image, NULL), WEFT_OK);
    unsigned char *to = image->pixels;
    for (int k = 0; k < TEXELS * TEXELS; k++, to += 3) {
        float s[2];
        relief(k % TEXELS, k / TEXELS, s);
        const float z = 1.0f / sqrtf(1.0f + s[0] * s[0] + s[1] * s[1]), n[3] = {s[0] * z, s[1] * z, z};
        for (int c = 0; c < 3; c++) to[c] = (unsigned char)(127.5f * (n[c] + 1.0f) + 0.5f);
    }
}

static void put_corners(WeftScene *scene, Mesh *mesh, float repeats) {
    static const float tangent[4] = {1.0f, 0.0f, 0.0f, 1.0f}, normal[3] = {0.0f, 1.0f, 0.0f};
    mesh->normal = arena_array(&scene->arena, 4, sizeof normal);
    mesh->tangent = arena_array(&scene->arena, 4, sizeof tangent);
    mesh->texcoord[0] = arena_array(&scene->arena, 8, sizeof(float));
    for (int k = 0; k < 4; k++) {
        memcpy(mesh->normal + 3 * k, normal, sizeof normal);
        memcpy(mesh->tangent + 4 * k, tangent, sizeof tangent);
        mesh->texcoord[0][2 * k] = k == 1 || k == 2 ? repeats : 0.0f;
        mesh->texcoord[0][2 * k + 1] = k == 2 || k == 3 ? repeats : 0.0f;
    }
}

/* A square of a dielectric with a sheen under a normal map and a sun; across: texels of the map across a pixel. */
static WeftScene *square(Relief relief, float roughness, float across) {
    WeftScene *scene = test_scene();
    scene->images = arena_array(&scene->arena, 1, sizeof(WeftImage));
    scene->textures = arena_array(&scene->arena, 1, sizeof(Texture));
    fill(relief, &scene->images[scene->image_count++]);
    scene->textures[scene->texture_count++] = (Texture){.image = 0};
    Material *m = test_material(scene, 0.2f);
    m->inputs[INPUT_specular].value[0] = 1.0f;
    m->inputs[INPUT_roughness].value[0] = roughness;
    test_color(m, INPUT_sheen_color, 0.2f);
    m->inputs[INPUT_sheen_roughness].value[0] = 0.3f;
    m->inputs[INPUT_normal].texture = 1;
    Mesh *quad = test_quad(scene, vec3(-1.0f, 0.0f, 1.0f), vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -2.0f));
    put_corners(scene, quad, across * (float)SIDE / 1.6f * 2.0f / (float)TEXELS);
    scene_bounds(scene);
    test_environment(scene, 0.0f);
    const WeftLight sun = {.direction = {-0.5f, -1.0f, 0.0f}, .color = {3.0f, 3.0f, 3.0f}};
    assert_int_equal(weft_scene_add_light(scene, &sun, NULL), WEFT_OK);
    return scene;
}

static WeftImage traced(const WeftScene *scene) { return square_traced(scene, SIDE, CAMERA, SAMPLES); }

static WeftImage drawn(const WeftScene *scene) { return square_drawn(scene, SIDE, CAMERA); }

static int by_size(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Mean of the middle two thirds of a picture, and the number that 99 % of its pixels do not exceed. */
typedef struct Brightness {
    double mean, high;
} Brightness;

static Brightness brightness(const WeftImage *image) {
    float all[SIDE * SIDE];
    int count = 0;
    double sum = 0.0;
    for (int y = SIDE / 6; y < SIDE - SIDE / 6; y++)
        for (int x = SIDE / 6; x < SIDE - SIDE / 6; x++)
            all[count++] = ((const float *)image->pixels)[4 * (y * SIDE + x) + 1];
    for (int k = 0; k < count; k++) sum += (double)all[k];
    qsort(all, (size_t)count, sizeof(float), by_size);
    return (Brightness){sum / (double)count, (double)all[99 * count / 100]};
}

/* A map, and the largest errors of mean and high at roughness .25, and from .6 on. */
typedef struct Case {
    const char *name;
    Relief relief;
    double glossy[2], matt[2];
} Case;

static void check(const Case *at, float roughness, float across) {
    WeftScene *scene = square(at->relief, roughness, across);
    WeftImage a = drawn(scene), b = traced(scene);
    const Brightness x = brightness(&a), y = brightness(&b);
    const double mean = x.mean / y.mean - 1.0, high = x.high / y.high - 1.0;
    const double *most = roughness < 0.5f ? at->glossy : at->matt;
    print_message("%-6s roughness %.2f, %3.0f texels: mean %+5.1f %%, 99th percentile %+5.1f %%\n", at->name,
                  (double)roughness, (double)across, 100.0 * mean, 100.0 * high);
    weft_image_free(&a);
    weft_image_free(&b);
    weft_scene_free(scene);
    assert_true(fabs(mean) < most[0] && fabs(high) < most[1]);
}

/* By mean normals alone the means are 8 to 21 % too bright from 10 texels on at roughness .6 and .8. */
static void bumps_are_as_supersampled(void **state) {
    static const Case cases[] = {{"ribs", ribs, {0.05, 0.55}, {0.03, 0.1}},
                                 {"twill", twill, {0.05, 0.35}, {0.03, 0.1}},
                                 {"crate", crate, {0.03, 0.25}, {0.03, 0.1}},
                                 {"basket", basket, {0.03, 0.3}, {0.03, 0.1}}};
    static const float across[] = {1.0f, 3.0f, 10.0f, 30.0f, 100.0f}, roughness[] = {0.25f, 0.6f, 0.8f};
    (void)state;
    need_gl();
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        for (size_t r = 0; r < sizeof roughness / sizeof *roughness; r++)
            for (size_t t = 0; t < sizeof across / sizeof *across; t++) check(&cases[k], roughness[r], across[t]);
}

/* Writes shaders into a folder that take normal maps for their mean normals, as if nothing were known of their slopes. */
static void write_mean_normals(const char *folder) {
    static const char variance[] = "return texture_levels.x * mix(";
    static char text[65536];
    char path[SCRATCH_SIZE + 64];
    FILE *file = fopen(WEFT_SOURCE_DIR "/src/raster/glsl/slopes.glsl", "rb");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    assert_int_equal(fclose(file), 0);
    char *at = strstr(text, variance);
    assert_non_null(at);
    memcpy(at, "return 0.0 *              mix(", sizeof variance - 1);
    static const char *const parts[] = {"/raster", "/raster/glsl", "/raster/glsl/slopes.glsl"};
    for (int k = 0; k < 2; k++) {
        snprintf(path, sizeof path, "%s%s", folder, parts[k]);
        assert_int_equal(mkdir(path, 0700), 0);
    }
    snprintf(path, sizeof path, "%s%s", folder, parts[2]);
    file = fopen(path, "wb");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

/* Returns the mean square of what changes in a pixel from frame to frame of a turntable, over the square of the mean.
 * folder: of shaders, or NULL. */
static double shimmer(const WeftScene *scene, const char *folder) {
    enum { WIDTH = 320, HEIGHT = 240, FRAMES = 10 };
    const WeftRasterDesc desc = {.no_cache = 1, .shader_dir = folder};
    WeftRaster *raster;
    WeftImage last = {0};
    double sum = 0.0, squares = 0.0, count = 0.0;
    assert_int_equal(weft_raster_create(scene, &desc, &raster, NULL, NULL), WEFT_OK);
    for (int frame = 0; frame < FRAMES; frame++) {
        const double angle = 0.5 * frame * 3.14159265 / 180.0;
        char camera[128];
        WeftImage image;
        snprintf(camera, sizeof camera, "%.7g,1.8,%.7g;0,0,0;43", 1.2 * sin(angle), 1.2 * cos(angle));
        const WeftRasterView view = {.width = WIDTH,
                                     .height = HEIGHT,
                                     .samples = 4,
                                     .camera = camera,
                                     .background = WEFT_BACKGROUND_TRANSPARENT,
                                     .no_shadows = 1};
        assert_int_equal(weft_raster_draw(raster, &view, NULL), WEFT_OK);
        assert_int_equal(weft_raster_image(raster, &image, NULL), WEFT_OK);
        for (size_t k = 0; k < (size_t)WIDTH * HEIGHT && last.pixels; k++) {
            const float *a = (const float *)image.pixels + 4 * k, *b = (const float *)last.pixels + 4 * k;
            if (a[3] < 0.99f || b[3] < 0.99f) continue;
            const double change = (double)a[1] - (double)b[1];
            squares += change * change;
            sum += (double)a[1];
            count += 1.0;
        }
        weft_image_free(&last);
        last = image;
    }
    weft_image_free(&last);
    weft_raster_free(raster);
    return squares * count / (sum * sum);
}

/* Ribs that are 1.6 pixels wide. */
static void ribs_on_a_turntable_do_not_shimmer(void **state) {
    (void)state;
    need_gl();
    char folder[SCRATCH_SIZE];
    assert_true(scratch_make(folder));
    write_mean_normals(folder);
    for (int matt = 0; matt < 2; matt++) {
        WeftScene *scene = square(ribs, matt ? 0.6f : 0.25f, 32.0f);
        assert_int_equal(weft_scene_set_environment_studio(scene, NULL), WEFT_OK);
        const double now = shimmer(scene, NULL), before = shimmer(scene, folder);
        print_message("roughness %s: changes from frame to frame %.6f, by mean normals %.6f: %.2f\n",
                      matt ? "0.6" : "0.25", now, before, now / before);
        weft_scene_free(scene);
        assert_true(now < 0.4 * before);
    }
    assert_true(scratch_remove(folder));
}

/* Slopes of a sine of amplitude A: variance A^2 / 2, fourth moment 3 A^4 / 8. Those of damaged maps are cut. */
static void moments_are_those_of_the_relief(void **state) {
    enum { ALL = 32 * 32 + 16 * 16 + 8 * 8 + 4 * 4 + 2 * 2 + 1 };
    static float levels[4 * ALL];
    (void)state;
    WeftImage map;
    int width = TEXELS, height = TEXELS;
    fill(ribs, &map);
    slopes_size(&width, &height);
    assert_int_equal(width, TEXELS / 2);
    slopes_make(&map, width, height, levels);
    const float should[4] = {0.245f, 0.0f, 0.0f, 0.09f}, *last = levels + 4 * (ALL - 1);
    for (int c = 0; c < 4; c++) assert_float_equal(last[c], should[c], 0.004f);
    weft_image_free(&map);
    for (int size = 1; size <= 3; size++) {
        int w = size, h = 1;
        assert_int_equal(weft_image_create(size, 1, 3, WEFT_PIXEL_U8, &map, NULL), WEFT_OK);
        slopes_size(&w, &h); /* black: (-1, -1, -1) */
        assert_true(w == 1 && h == 1);
        slopes_make(&map, w, h, levels);
        assert_float_equal(levels[0], 32.0f, 0.1f);
        weft_image_free(&map);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(moments_are_those_of_the_relief),
                                       cmocka_unit_test(ribs_on_a_turntable_do_not_shimmer),
                                       cmocka_unit_test(bumps_are_as_supersampled)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
