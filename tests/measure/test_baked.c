/* Baked cloth: textures and a material that were made of a weave are shaded as the weave is. An arc of cloth, +-75 degrees,
 * is seen from far away, so that the columns of a picture are slices of the BRDF, 16 texels a pixel in its middle. Path
 * traced with direct light alone: head-on, 60 degrees aside, 110 degrees round and behind, each bent about the warp and
 * about the weft; and an even sky. No such direction is among those of the fit.
 *
 * Labels: slow unsanitized */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/pi.h"
#include "scratch.h"
#include "weft/weft.h"
#include "woven_presets.h"

#define BEND (75.0 * PI_DOUBLE / 180.0)
enum { STEPS = 150, WIDTH = 80, HEIGHT = 40, SIDE = 512, SLICE = 4, SETUPS = 7 };

/* A light and the direction of the bend: about the warp, whose threads then run along the axis, or about the weft. */
static const struct {
    const char *name;
    double degrees; /* off the viewer; below 0: the sky */
    bool weft;
} setups[SETUPS] = {{"head-on", 0.0, false},    {"head-on, weft", 0.0, true}, {"side", 60.0, false},
                    {"side, weft", 60.0, true}, {"behind", 110.0, false},     {"behind, weft", 110.0, true},
                    {"sky", -1.0, false}};

/* A vertex of the arc. */
typedef struct Corner {
    float position[3], normal[3], uv[2];
} Corner;

/* Writes arc.gltf with arc.bin: a radius of 1 m, and higher than the picture. Bent about the weft the cloth lies on its
 * side, so that the picture has the same columns. zoom: units of texture coordinates along a metre of the arc. */
static void arc_write(bool weft, double zoom) {
    static Corner corners[2 * (STEPS + 1)];
    static uint16_t index[6 * STEPS];
    for (int k = 0; k < 2 * (STEPS + 1); k++) {
        const int step = k / 2;
        const double a = BEND * (2.0 * step / STEPS - 1.0), along = k % 2 - 0.5;
        const float right = (float)(zoom * a), up = (float)(zoom * along);
        corners[k] = (Corner){{(float)sin(a), (float)along, (float)cos(a)},
                              {(float)sin(a), 0.0f, (float)cos(a)},
                              {weft ? -up : right, weft ? -right : -up}};
    }
    for (int k = 0; k < 6 * STEPS; k++) {
        static const int six[6] = {0, 2, 3, 0, 3, 1};
        index[k] = (uint16_t)(2 * (k / 6) + six[k % 6]);
    }
    FILE *file = fopen("arc.bin", "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(corners, sizeof corners, 1, file) + fwrite(index, sizeof index, 1, file), 2);
    assert_int_equal(fclose(file), 0);
    file = fopen("arc.gltf", "wb");
    assert_non_null(file);
    fprintf(file,
            "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
            "\"materials\":[{\"name\":\"arc\"}],\"meshes\":[{\"primitives\":[{\"attributes\":"
            "{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},\"indices\":3,\"material\":0}]}],\"accessors\":["
            "{\"bufferView\":0,\"byteOffset\":0,\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\","
            "\"min\":[-1,-0.5,0],\"max\":[1,0.5,1]},"
            "{\"bufferView\":0,\"byteOffset\":12,\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\"},"
            "{\"bufferView\":0,\"byteOffset\":24,\"componentType\":5126,\"count\":%d,\"type\":\"VEC2\"},"
            "{\"bufferView\":1,\"componentType\":5123,\"count\":%d,\"type\":\"SCALAR\"}],\"bufferViews\":["
            "{\"buffer\":0,\"byteLength\":%zu,\"byteStride\":32},"
            "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}],\"buffers\":["
            "{\"byteLength\":%zu,\"uri\":\"arc.bin\"}]}",
            2 * (STEPS + 1), 2 * (STEPS + 1), 2 * (STEPS + 1), 6 * STEPS, sizeof corners, sizeof corners, sizeof index,
            sizeof corners + sizeof index);
    assert_int_equal(fclose(file), 0);
}

static void light_scene(WeftScene *scene, double degrees) {
    static const float black[3] = {0.0f, 0.0f, 0.0f}, white[3] = {1.0f, 1.0f, 1.0f};
    const double a = degrees * PI_DOUBLE / 180.0;
    WeftError error;
    WeftLight light = {.kind = WEFT_LIGHT_DIRECTIONAL,
                       .direction = {(float)-sin(a), 0.0f, (float)-cos(a)},
                       .color = {3.0f, 3.0f, 3.0f}};
    WeftResult result = weft_scene_set_environment_color(scene, degrees < 0.0 ? white : black, &error);
    if (result == WEFT_OK && degrees >= 0.0) result = weft_scene_add_light(scene, &light, &error);
    if (result != WEFT_OK) fail_msg("%s", error.text);
}

/* A weave of which a unit of texture coordinates is a metre, without the bars and patches over many threads that textures
 * which repeat do not have: the arc is a centimetre of cloth, in which they are all of one kind. */
static const char *const evens[][2] = {{"metres", "1"},      {"warp.barre", "0"},  {"weft.barre", "0"},
                                       {"warp.uneven", "0"}, {"weft.uneven", "0"}, {NULL, NULL}};

/* Path traces the arc of the material, a preset or a file. Sets pixels to linear RGBA. */
static void arc_render(const char *material, bool woven, double zoom, int setup, WeftImage *image) {
    char camera[128];
    WeftScene *scene;
    WeftRender *render;
    WeftError error;
    const double half = sin(BEND) * HEIGHT / WIDTH, far = 60.0;
    snprintf(camera, sizeof camera, "0,0,%g;0,0,0;%.9g", far, 2.0 * atan(half / (far - 0.5)) * 180.0 / PI_DOUBLE);
    arc_write(setups[setup].weft, zoom);
    WeftResult result = weft_scene_load("arc.gltf", &scene, NULL, &error);
    if (result == WEFT_OK) result = weft_scene_assign_material(scene, NULL, material, NULL, &error);
    for (int k = 0; result == WEFT_OK && woven && evens[k][0]; k++)
        result = weft_scene_weave(scene, "arc", evens[k][0], evens[k][1], NULL, &error);
    if (result == WEFT_OK && !woven) result = weft_scene_set(scene, "arc.profile", "khronos", NULL, &error);
    if (result != WEFT_OK) fail_msg("%s", error.text);
    light_scene(scene, setups[setup].degrees);
    const WeftRenderDesc desc = {.width = WIDTH, .height = HEIGHT, .max_depth = 1, .camera = camera};
    result = weft_render_create(scene, &desc, &render, &error);
    if (result == WEFT_OK) result = weft_render_run(render, 48, 0.0, NULL, NULL);
    if (result != WEFT_OK) fail_msg("%s", error.text);
    if (weft_render_image(render, image, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(image->type, WEFT_PIXEL_F32);
    weft_render_free(render);
    weft_scene_free(scene);
}

static double pixel(const WeftImage *image, int column, int row, int c) {
    return (double)((const float *)image->pixels)[(row * WIDTH + column) * image->channels + c];
}

/* Returns the mean of some columns, about a thread wide. */
static double slice_mean(const WeftImage *image, int slice, int c) {
    double sum = 0.0;
    for (int k = 0; k < SLICE * HEIGHT; k++) sum += pixel(image, SLICE * slice + k % SLICE, k / SLICE, c);
    return sum / (SLICE * HEIGHT);
}

/* What is found of one preset under one light. */
typedef struct Apart {
    double profile; /* sum |difference| of the slices over their sum */
    double mean;    /* of the sums, as a signed part */
} Apart;

static Apart compare(const WeftImage *made, const WeftImage *truth) {
    double away = 0.0, sum = 0.0, more = 0.0;
    for (int slice = 0; slice < WIDTH / SLICE; slice++)
        for (int c = 0; c < 3; c++) {
            const double a = slice_mean(made, slice, c), b = slice_mean(truth, slice, c);
            away += fabs(a - b), more += a - b, sum += b;
        }
    assert_true(sum > 0.0);
    return (Apart){away / sum, more / sum};
}

/* Returns the deviation of pixels from the mean of their column, over that mean. */
static double contrast(const WeftImage *image) {
    double away = 0.0, sum = 0.0;
    for (int column = WIDTH / 8; column < WIDTH - WIDTH / 8; column++) {
        double mean = 0.0, square = 0.0;
        for (int row = 0; row < HEIGHT; row++) {
            const double value =
                (pixel(image, column, row, 0) + pixel(image, column, row, 1) + pixel(image, column, row, 2));
            mean += value / HEIGHT, square += value * value / HEIGHT;
        }
        away += sqrt(fmax(square - mean * mean, 0.0)), sum += mean;
    }
    return away / sum;
}

/* Returns the side of a texel of maps of SIDE^2 texels over whole repeats of at least 16 threads. */
static double texel_of(const WeftCloth *cloth) {
    const WeftClothInfo info = weft_cloth_info(cloth);
    double area = 1.0;
    for (int t = 0; t < 2; t++) {
        const double threads = rint((double)info.size[t] * 100.0 * (double)info.sett[t]);
        area *= (double)info.size[t] * ceil(16.0 / threads);
    }
    return sqrt(area) / SIDE;
}

/* What is found of a preset: errors of the profile and of the sum of the sky as parts, the contrast near by over that of
 * the threads. */
typedef struct Found {
    double profile, worst, sky, contrast;
} Found;

static Found find(const char *path, double zoom) {
    Found found = {.profile = 0.0};
    for (int k = 0; k < SETUPS; k++) {
        WeftImage truth, made;
        arc_render(path, true, zoom, k, &truth);
        arc_render("maps/material.json", false, zoom, k, &made);
        const Apart apart = compare(&made, &truth);
        print_message(" %5.1f", 100.0 * apart.profile);
        if (setups[k].degrees < 0.0) found.sky = apart.mean;
        if (setups[k].degrees >= 0.0) found.profile += apart.profile / (SETUPS - 1);
        if (setups[k].degrees >= 0.0) found.worst = fmax(found.worst, apart.profile);
        weft_image_free(&truth);
        weft_image_free(&made);
    }
    double contrasts[2];
    for (int k = 0; k < 2; k++) {
        WeftImage image;
        arc_render(k ? "maps/material.json" : path, !k, 0.25 * zoom, 2, &image);
        contrasts[k] = contrast(&image);
        weft_image_free(&image);
    }
    found.contrast = contrasts[1] / contrasts[0];
    return found;
}

/* The most that the profile of a preset may be off, in the mean over the lights, in percent. Silk has two crossed
 * highlights, and pile stands up, which one highlight along the surface cannot follow. */
static const struct {
    const char *preset;
    double most;
} limits[] = {{"woven-charmeuse", 20.0},
              {"woven-shantung", 24.5},
              {"woven-shot-silk", 28.0},
              {"woven-velvet", 22.0},
              {"woven-corduroy", 20.0}};

static double limit_of(const char *preset) {
    for (size_t k = 0; k < sizeof limits / sizeof *limits; k++)
        if (strcmp(limits[k].preset, preset) == 0) return limits[k].most;
    return 10.0;
}

static void check_preset(const char *name) {
    char path[128];
    WeftMaterial material;
    WeftCloth *cloth;
    WeftBaked fit;
    WeftError error;
    snprintf(path, sizeof path, "preset:%s", name);
    if (weft_material_read_woven(path, &material, &cloth, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    if (weft_material_bake(&material, cloth, &(WeftBaking){.pixels = SIDE}, "maps", &fit, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    print_message("%-16s", name);
    const Found found = find(path, 16.0 * texel_of(cloth) * WIDTH / (2.0 * sin(BEND)));
    print_message(" | mean %4.1f  sky %+5.1f  contrast %4.2f | fit %4.1f, copied %5.1f\n", 100.0 * found.profile,
                  100.0 * found.sky, found.contrast, 100.0 * fit.fitted, 100.0 * fit.copied);
    weft_cloth_free(cloth);
    assert_true(100.0 * found.profile <= limit_of(name));
    assert_true(fabs(found.sky) <= 0.05);
    assert_true(found.contrast >= 0.6 && found.contrast <= 1.6);
    assert_true(fit.fitted < 0.75 * fit.copied);
}

/* Prints a line a preset: percent of the profile under each light, and their mean. */
static void baked_presets_are_shaded_as_their_threads(void **state) {
    (void)state;
    print_message("%-16s  head, weft; side, weft; behind, weft; sky\n", "");
    for (int k = 0; weft_preset_name(k); k++)
        if (woven_family(weft_preset_name(k)) == 0) check_preset(weft_preset_name(k));
}

static void wrong_bakes_are_refused(void **state) {
    (void)state;
    WeftMaterial material;
    WeftCloth *cloth;
    WeftError error;
    if (weft_material_read_woven("preset:woven-denim", &material, &cloth, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    const struct {
        WeftBaking baking;
        const char *words;
    } wrong[] = {{{.pixels = 8}, "16 to 8192"},
                 {{.metres = -1.0}, "metres"},
                 {{.metres = (double)NAN}, "metres"},
                 {{.profile = "treacle"}, "no profile treacle"},
                 {{.profile = "filament-cloth"}, "metallic"}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        assert_int_equal(weft_material_bake(&material, cloth, &wrong[k].baking, "none", NULL, &error), WEFT_USAGE);
        if (!strstr(error.text, wrong[k].words)) fail_msg("%s", error.text);
    }
    assert_int_equal(weft_material_bake(&material, NULL, &(WeftBaking){.pixels = 64}, "none", NULL, &error),
                     WEFT_USAGE);
    assert_non_null(strstr(error.text, "not woven"));
    assert_int_equal(access("none", F_OK), -1);
    weft_cloth_free(cloth);
}

/* Viewers that read glTF find no index of refraction in what is saved: it is the usual one. */
static void no_ior_is_written(void **state) {
    (void)state;
    WeftMaterial material;
    WeftCloth *cloth;
    WeftScene *scene = NULL;
    WeftError error;
    char text[65536];
    if (weft_material_read_woven("preset:woven-twill", &material, &cloth, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    WeftResult result = weft_material_bake(&material, cloth, &(WeftBaking){.pixels = 64}, "plain", NULL, &error);
    if (result == WEFT_OK) result = weft_scene_load("builtin:cloth", &scene, NULL, &error);
    if (result == WEFT_OK) result = weft_scene_assign_material(scene, NULL, "plain/material.json", NULL, &error);
    if (result == WEFT_OK) result = weft_scene_save(scene, "plain/cloth.gltf", &error);
    if (result != WEFT_OK) fail_msg("%s", error.text);
    FILE *file = fopen("plain/cloth.gltf", "rb");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    assert_int_equal(fclose(file), 0);
    assert_non_null(strstr(text, "KHR_materials_specular"));
    assert_null(strstr(text, "KHR_materials_ior"));
    weft_scene_free(scene);
    weft_cloth_free(cloth);
}

static int enter(void **state) {
    static char folder[SCRATCH_SIZE];
    *state = folder;
    return scratch_enter(folder) ? 0 : -1;
}
static int leave(void **state) { return chdir("/") == 0 && scratch_remove(*state) ? 0 : -1; }

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_bakes_are_refused),
        cmocka_unit_test(no_ior_is_written),
        cmocka_unit_test(baked_presets_are_shaded_as_their_threads),
    };
    return cmocka_run_group_tests(tests, enter, leave);
}
