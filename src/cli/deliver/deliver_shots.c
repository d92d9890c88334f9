/* deliver_shots.c - pictures of a delivered file and of the reference, and how they differ */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/console/report.h"
#include "cli/deliver/delivery.h"

/* A near picture of woven cloth shows so many warp threads in a row; of anything else, so much of the distance is left. */
static const double NEAR_THREADS = 40.0, NEAR_SHARE = 1.0 / 6.0;
static const float LUMINANCE[3] = {0.2126f, 0.7152f, 0.0722f};

static void camera_text(const float eye[3], const float target[3], float fov, char text[WEFT_CAMERA_TEXT]) {
    snprintf(text, WEFT_CAMERA_TEXT, "%.9g,%.9g,%.9g;%.9g,%.9g,%.9g;%.9g", (double)eye[0], (double)eye[1],
             (double)eye[2], (double)target[0], (double)target[1], (double)target[2], (double)fov);
}

/* Finds the surface nearest to the middle of the far picture. Returns false where there is none. */
static bool middle_find(const Delivery *delivery, const WeftPick *pick, WeftPicked *out) {
    enum { GRID = 15 };
    double best = 1.0; /* the square of the distance from the middle, of 1 across */
    *out = (WeftPicked){.mesh = -1};
    for (int k = 0; k < GRID * GRID; k++) {
        const int row = k / GRID;
        const double x = ((k % GRID) + 0.5) / GRID, y = (row + 0.5) / GRID;
        const double off = (x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5);
        WeftPicked picked;
        if (off < best && weft_pick_at(pick, delivery->cameras[VIEW_FAR], delivery->width, delivery->height,
                                       (float)(x * delivery->width), (float)(y * delivery->height), &picked)) {
            best = off;
            *out = picked;
        }
    }
    return best < 1.0;
}

/* Returns the distance of the near camera, m. */
static double near_distance(const Delivery *delivery, const WeftScene *scene, const WeftPicked *at, double fov) {
    WeftMaterial material;
    const double half = tan(0.5 * fov * acos(-1.0) / 180.0), aspect = (double)delivery->width / delivery->height;
    const double far = NEAR_SHARE * (double)at->distance;
    if (weft_scene_material(scene, at->material, &material, NULL) != WEFT_OK || !material.cloth) return far;
    const WeftClothInfo info = weft_scene_cloth_info(scene, material.cloth);
    const double thread = 0.01 / fmax((double)info.sett[0], 1e-3);
    const double width = NEAR_THREADS * thread / fmax((double)info.metres * (double)at->uv_per_metre, 1e-9);
    return fmin(width / (2.0 * half * aspect), far);
}

int shots_aim(Delivery *delivery, const WeftScene *scene) {
    WeftCamera camera;
    WeftPick *pick = NULL;
    WeftPicked at;
    WeftError error;
    const float aspect = (float)delivery->width / (float)delivery->height;
    if (weft_scene_camera(scene, "auto", aspect, &camera, &error) != WEFT_OK) return report_error(&error);
    camera_text(camera.eye, camera.target, camera.fov, delivery->cameras[VIEW_FAR]);
    snprintf(delivery->cameras[VIEW_NEAR], WEFT_CAMERA_TEXT, "%s", delivery->cameras[VIEW_FAR]);
    if (weft_pick_create(scene, &pick, &error) != WEFT_OK) return report_error(&error);
    if (middle_find(delivery, pick, &at)) {
        const double distance = near_distance(delivery, scene, &at, (double)camera.fov);
        float eye[3];
        for (int c = 0; c < 3; c++)
            eye[c] =
                at.position[c] + (float)(distance / (double)at.distance * (double)(camera.eye[c] - at.position[c]));
        camera_text(eye, at.position, camera.fov, delivery->cameras[VIEW_NEAR]);
    }
    weft_pick_free(pick);
    return 0;
}

static WeftResult shot_take(Delivery *delivery, const WeftScene *scene, const WeftRenderDesc *desc, int spp,
                            WeftImage *out, WeftError *error) {
    WeftRender *render = NULL;
    WeftResult result = weft_render_create(scene, desc, &render, error);
    if (result == WEFT_OK) result = weft_render_run(render, spp, 0.0, delivery_heed, delivery);
    if (result == WEFT_OK) result = weft_render_image(render, out, error);
    weft_render_free(render);
    return result;
}

int shots_take(Delivery *delivery, WeftScene *scene, Shots *out) {
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    enum { SMALLER = 4 };
    const double low = delivery->low, high = delivery->high;
    WeftError error;
    WeftResult result = WEFT_OK;
    WeftRenderDesc desc = {
        .width = delivery->width, .height = delivery->height, .background = WEFT_BACKGROUND_TRANSPARENT};
    for (int v = 0; v < VIEW_COUNT && result == WEFT_OK; v++) {
        desc.camera = delivery->cameras[v];
        delivery_part(delivery, low + (high - low) * 0.5 * v, low + (high - low) * 0.5 * (v + 1));
        result = shot_take(delivery, scene, &desc, delivery->spp, &out->views[v], &error);
    }
    delivery_part(delivery, high, high);
    desc.width = delivery->width / SMALLER;
    desc.height = delivery->height / SMALLER;
    for (int k = weft_scene_info(scene).light_count; k-- > 0 && result == WEFT_OK;)
        result = weft_scene_remove_light(scene, k, &error);
    if (result == WEFT_OK) result = weft_scene_set_environment_color(scene, white, &error);
    if (result == WEFT_OK) result = shot_take(delivery, scene, &desc, delivery->spp, &out->sky, &error);
    return result == WEFT_OK || result == WEFT_INTERRUPTED ? (int)result : report_error(&error);
}

void shots_free(Shots *shots) {
    for (int v = 0; v < VIEW_COUNT; v++) weft_image_free(&shots->views[v]);
    weft_image_free(&shots->sky);
}

/* Adds up the colours of columns [begin, end). Transparent pixels have none. */
static void columns_sum(const WeftImage *image, int begin, int end, double sum[3]) {
    const float *pixels = image->pixels;
    memset(sum, 0, 3 * sizeof *sum);
    for (int y = 0; y < image->height; y++)
        for (int x = begin; x < end; x++) {
            const float *pixel = pixels + 4 * ((size_t)y * (size_t)image->width + (size_t)x);
            for (int c = 0; c < 3; c++) sum[c] += (double)pixel[c] * (double)pixel[3];
        }
}

/* Returns the sum of |a - b| over sums of columns of that width, over the sum of b. */
static double profile_error(const WeftImage *a, const WeftImage *b, int width) {
    double off = 0.0, all = 0.0;
    for (int x = 0; x < a->width; x += width) {
        double of[3], as[3];
        columns_sum(a, x, x + width < a->width ? x + width : a->width, of);
        columns_sum(b, x, x + width < a->width ? x + width : a->width, as);
        for (int c = 0; c < 3; c++) {
            off += fabs(of[c] - as[c]);
            all += as[c];
        }
    }
    return off / fmax(all, 1e-9);
}

/* Returns the standard deviation of the luminance over its mean, of what is covered. */
static double contrast_of(const WeftImage *image) {
    const float *pixel = image->pixels;
    double weight = 0.0, sum = 0.0, squares = 0.0;
    for (size_t k = (size_t)image->width * (size_t)image->height; k-- > 0; pixel += 4) {
        double y = 0.0;
        for (int c = 0; c < 3; c++) y += (double)(LUMINANCE[c] * pixel[c]);
        weight += (double)pixel[3];
        sum += (double)pixel[3] * y;
        squares += (double)pixel[3] * y * y;
    }
    const double mean = sum / fmax(weight, 1e-9);
    return (sqrt)(fmax(squares / fmax(weight, 1e-9) - mean * mean, 0.0)) / fmax(mean, 1e-9);
}

static WeftResult view_compare(const WeftImage *image, const WeftImage *reference, ViewErrors *out, WeftError *error) {
    const WeftDiffDesc desc = {.image = image, .reference = reference, .metric = WEFT_METRIC_FLIP, .exposed = 1};
    WeftDiff diff = {.value = 0.0};
    const WeftResult result = weft_diff(&desc, &diff, NULL, error);
    *out = (ViewErrors){.color = profile_error(image, reference, image->width),
                        .profile = profile_error(image, reference, 1),
                        .flip = diff.value,
                        .contrast = contrast_of(image) / fmax(contrast_of(reference), 1e-9)};
    return result;
}

int shots_compare(const Shots *shots, const Shots *reference, Errors *out) {
    WeftError error;
    double of[3], as[3];
    columns_sum(&shots->sky, 0, shots->sky.width, of);
    columns_sum(&reference->sky, 0, reference->sky.width, as);
    out->sky = (of[0] + of[1] + of[2]) / fmax(as[0] + as[1] + as[2], 1e-9) - 1.0;
    for (int v = 0; v < VIEW_COUNT; v++)
        if (view_compare(&shots->views[v], &reference->views[v], &out->views[v], &error) != WEFT_OK)
            return report_error(&error);
    return 0;
}
