#include "scene/light/backdrop.h"

#include "base/pi.h"
#include "scene/light/env_split.h"

enum { WIDTH = 128, FROM = 64 };
static const float kappa = 30.0f;

static void blur_at(const WeftImage *from, Vec3 toward, float color[3]) {
    const float *p = from->pixels;
    float sum[3] = {0.0f, 0.0f, 0.0f}, weights = 0.0f;
    for (int y = 0; y < from->height; y++) {
        float solid = sinf(PI_FLOAT * ((float)y + 0.5f) / (float)from->height);
        for (int x = 0; x < from->width; x++, p += 3) {
            Vec3 d = latlong_direction((x + 0.5) / from->width, (y + 0.5) / from->height);
            float w = solid * expf(kappa * (vec3_dot(d, toward) - 1.0f));
            for (int c = 0; c < 3; c++) sum[c] += w * p[c];
            weights += w;
        }
    }
    for (int c = 0; c < 3; c++) color[c] = sum[c] / weights;
}

WeftResult backdrop_blurred(const Environment *environment, WeftImage *out, WeftError *error) {
    WeftImage from;
    *out = (WeftImage){0};
    WeftResult result = latlong_resize(&environment->image, FROM, FROM / 2, &from, error);
    if (result != WEFT_OK) return result;
    result = weft_image_create(WIDTH, WIDTH / 2, 3, WEFT_PIXEL_F32, out, error);
    float *p = out->pixels;
    for (int y = 0; result == WEFT_OK && y < out->height; y++)
        for (int x = 0; x < out->width; x++, p += 3)
            blur_at(&from, latlong_direction((x + 0.5) / out->width, (y + 0.5) / out->height), p);
    weft_image_free(&from);
    return result;
}

void backdrop_at(const Environment *environment, const WeftImage *blurred, Vec3 d, float color[3]) {
    latlong_at(blurred, latlong_rotated(d, -environment->rotation), color);
    for (int k = 0; k < 3; k++) color[k] *= environment->strength;
}
