/* arc.h - an arc of cloth, +-75 degrees, seen from far away, so that the columns of a picture are slices of the BRDF. Path
 * traced with direct light alone: head-on, 60 degrees aside, 110 degrees round and behind, each bent about the warp and
 * about the weft; and an even sky. For one source file each, after one that has fail_msg and assert_true. */
#ifndef WEFT_TEST_ARC_H
#define WEFT_TEST_ARC_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/pi.h"
#include "weft/weft.h"

#define BEND (75.0 * PI_DOUBLE / 180.0)
enum { STEPS = 150, WIDTH = 80, HEIGHT = 40, SIDE = 512, SLICE = 4, SETUPS = 7 };

/* What is drawn on the arc, and how. */
typedef struct ArcView {
    const char *material, *profile; /* a preset or a file; profile: NULL: it is woven */
    double zoom;                    /* units of texture coordinates along a metre of the arc */
    double shift[2];                /* of the cloth, in pixels of the middle */
    int setup, samples;
} ArcView;

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
 * side, so that the picture has the same columns. */
static inline void arc_write(const ArcView *view) {
    const bool weft = setups[view->setup].weft;
    const double pixel = 2.0 * sin(BEND) / WIDTH;
    static Corner corners[2 * (STEPS + 1)];
    static uint16_t index[6 * STEPS];
    for (int k = 0; k < 2 * (STEPS + 1); k++) {
        const int step = k / 2;
        const double a = BEND * (2.0 * step / STEPS - 1.0), along = k % 2 - 0.5;
        const float right = (float)(view->zoom * (a + view->shift[0] * pixel)),
                    up = (float)(view->zoom * (along + view->shift[1] * pixel));
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

/* Lights a scene by one setup alone. */
static inline void light_scene(WeftScene *scene, double degrees) {
    static const float black[3] = {0.0f, 0.0f, 0.0f}, white[3] = {1.0f, 1.0f, 1.0f};
    const double a = degrees * PI_DOUBLE / 180.0;
    WeftError error;
    WeftLight light = {.kind = WEFT_LIGHT_DIRECTIONAL,
                       .direction = {(float)-sin(a), 0.0f, (float)-cos(a)},
                       .color = {3.0f, 3.0f, 3.0f}};
    WeftResult result = weft_scene_set_environment_color(scene, degrees < 0.0 ? white : black, &error);
    while (result == WEFT_OK && weft_scene_info(scene).light_count > 0)
        result = weft_scene_remove_light(scene, 0, &error);
    if (result == WEFT_OK && degrees >= 0.0) result = weft_scene_add_light(scene, &light, &error);
    if (result != WEFT_OK) fail_msg("%s", error.text);
}

/* A weave of which a unit of texture coordinates is a metre, without the bars and patches over many threads that textures
 * which repeat do not have: the arc is a centimetre of cloth, in which they are all of one kind. */
static const char *const evens[][2] = {{"metres", "1"},      {"warp.barre", "0"},  {"weft.barre", "0"},
                                       {"warp.uneven", "0"}, {"weft.uneven", "0"}, {NULL, NULL}};

/* Makes the arc of a view, bent as its setup has it, without light. Release with weft_scene_free. */
static inline WeftScene *arc_scene(const ArcView *view) {
    WeftScene *scene;
    WeftError error;
    arc_write(view);
    WeftResult result = weft_scene_load("arc.gltf", &scene, NULL, &error);
    if (result == WEFT_OK) result = weft_scene_assign_material(scene, NULL, view->material, NULL, &error);
    for (int k = 0; result == WEFT_OK && !view->profile && evens[k][0]; k++)
        result = weft_scene_weave(scene, "arc", evens[k][0], evens[k][1], NULL, &error);
    if (result == WEFT_OK && view->profile) result = weft_scene_set(scene, "arc.profile", view->profile, NULL, &error);
    if (result != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

/* Path traces an arc under the light of a setup. Sets pixels to linear RGBA: of half of the samples, and of the other half
 * where that is not NULL. */
static inline void arc_trace(WeftScene *scene, const ArcView *view, WeftImage *image, WeftImage *other) {
    char camera[128];
    WeftRender *render;
    WeftError error;
    const double half = sin(BEND) * HEIGHT / WIDTH, far = 60.0;
    snprintf(camera, sizeof camera, "0,0,%g;0,0,0;%.9g", far, 2.0 * atan(half / (far - 0.5)) * 180.0 / PI_DOUBLE);
    light_scene(scene, setups[view->setup].degrees);
    const WeftRenderDesc desc = {.width = WIDTH, .height = HEIGHT, .max_depth = 1, .camera = camera};
    WeftResult result = weft_render_create(scene, &desc, &render, &error);
    for (WeftImage *out = image; out && result == WEFT_OK; out = out == image ? other : NULL) {
        result = weft_render_run(render, view->samples, 0.0, NULL, NULL);
        if (result == WEFT_OK) result = weft_render_image(render, out, &error);
    }
    if (result != WEFT_OK) fail_msg("%s", error.text);
    float *later = other ? other->pixels : NULL;
    for (int k = 0; later && k < WIDTH * HEIGHT * image->channels; k++)
        later[k] = 2.0f * later[k] - ((const float *)image->pixels)[k];
    weft_render_free(render);
}

static inline void arc_render(const ArcView *view, WeftImage *image, WeftImage *other) {
    WeftScene *scene = arc_scene(view);
    arc_trace(scene, view, image, other);
    weft_scene_free(scene);
}

static inline double pixel(const WeftImage *image, int column, int row, int c) {
    return (double)((const float *)image->pixels)[(row * WIDTH + column) * image->channels + c];
}

/* Returns the mean of some columns, about a thread wide. */
static inline double slice_mean(const WeftImage *image, int slice, int c) {
    double sum = 0.0;
    for (int k = 0; k < SLICE * HEIGHT; k++) sum += pixel(image, SLICE * slice + k % SLICE, k / SLICE, c);
    return sum / (SLICE * HEIGHT);
}

/* What is found of one preset under one light. */
typedef struct Apart {
    double profile; /* sum |difference| of the slices over their sum */
    double mean;    /* of the sums, as a signed part */
} Apart;

static inline Apart compare(const WeftImage *made, const WeftImage *truth) {
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
static inline double contrast(const WeftImage *image) {
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

/* Returns how two pictures go together: the correlation of pixels, without the means of their columns. */
static inline double correlation(const WeftImage *a, const WeftImage *b) {
    double aa = 0.0, bb = 0.0, ab = 0.0;
    for (int column = WIDTH / 8; column < WIDTH - WIDTH / 8; column++)
        for (int c = 0; c < 3; c++) {
            double mean_a = 0.0, mean_b = 0.0;
            for (int row = 0; row < HEIGHT; row++)
                mean_a += pixel(a, column, row, c) / HEIGHT, mean_b += pixel(b, column, row, c) / HEIGHT;
            for (int row = 0; row < HEIGHT; row++) {
                const double x = pixel(a, column, row, c) - mean_a, y = pixel(b, column, row, c) - mean_b;
                aa += x * x, bb += y * y, ab += x * y;
            }
        }
    return ab / sqrt(fmax(aa * bb, 1e-30));
}

/* Returns the side of a texel of maps of SIDE^2 texels over whole repeats of at least 16 threads. */
static inline double texel_of(const WeftCloth *cloth) {
    const WeftClothInfo info = weft_cloth_info(cloth);
    double area = 1.0;
    for (int t = 0; t < 2; t++) {
        const double threads = rint((double)info.size[t] * 100.0 * (double)info.sett[t]);
        area *= (double)info.size[t] * ceil(16.0 / threads);
    }
    return sqrt(area) / SIDE;
}

#endif
