/* sphere.c - an image of a sphere with a reflection, under three lights without size */
#include <math.h>
#include <stdio.h>

#include "base/fail.h"
#include "base/thread.h"
#include "weft/reflection.h"

/* RAYS: of a pixel along each side, for smooth edges. */
enum { LIGHTS = 3, RAYS = 2 };

typedef struct SphereLight {
    double direction[3], irradiance;
} SphereLight;

/* x right, y up, z towards the viewer */
static const SphereLight lights[LIGHTS] = {
    {{0.424264, 0.565685, 0.707107}, 2.0}, {{-0.692820, 0.519615, -0.5}, 2.0}, {{0.0, 0.0, 1.0}, 0.6}};

typedef struct Sphere {
    const WeftReflection *reflection;
    const WeftImage *image;
} Sphere;

/* Adds the radiance that a point of the unit sphere sends to the viewer. */
static void shade(const WeftReflection *reflection, double x, double y, double radiance[3]) {
    double z = sqrt(fmax(1.0 - x * x - y * y, 0.0)), s = fmax(hypot(x, z), 1e-9);
    const double n[3] = {x, y, z}, t[3] = {z / s, 0.0, -x / s};
    const double b[3] = {n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]};
    const float wo[3] = {(float)t[2], (float)b[2], (float)n[2]};
    float wi[LIGHTS][3], f[LIGHTS][3];
    for (int l = 0; l < LIGHTS; l++) {
        double local[3] = {0.0};
        for (int c = 0; c < 3; c++) {
            local[0] += t[c] * lights[l].direction[c];
            local[1] += b[c] * lights[l].direction[c];
            local[2] += n[c] * lights[l].direction[c];
        }
        for (int c = 0; c < 3; c++) wi[l][c] = (float)local[c];
    }
    weft_reflection_eval(reflection, 0, wo, LIGHTS, (const float(*)[3])wi, f);
    for (int l = 0; l < LIGHTS; l++)
        for (int c = 0; c < 3; c++) radiance[c] += (double)f[l][c] * fmax((double)wi[l][2], 0.0) * lights[l].irradiance;
}

static void row_draw(void *user, int row, int thread) {
    (void)thread;
    const Sphere *sphere = user;
    int size = sphere->image->width;
    float *pixel = (float *)sphere->image->pixels + (size_t)row * (size_t)size * 4;
    for (int column = 0; column < size; column++, pixel += 4) {
        double sum[3] = {0.0};
        int hits = 0;
        for (int ray = 0; ray < RAYS * RAYS; ray++) {
            int across = ray % RAYS, down = ray / RAYS;
            double u = column + (across + 0.5) / RAYS, v = row + (down + 0.5) / RAYS;
            double x = (2.0 * u / size - 1.0) * 1.04, y = (1.0 - 2.0 * v / size) * 1.04;
            if (x * x + y * y >= 1.0) continue;
            shade(sphere->reflection, x, y, sum);
            hits++;
        }
        for (int c = 0; c < 3; c++) pixel[c] = hits ? (float)(sum[c] / hits) : 0.0f;
        pixel[3] = (float)hits / (RAYS * RAYS);
    }
}

WeftResult weft_reflection_sphere(const WeftReflection *reflection, int size, WeftImage *out, WeftError *error) {
    char number[16];
    *out = (WeftImage){0};
    snprintf(number, sizeof number, "%d", size);
    if (size < 8 || size > 4096) return fail(error, WEFT_MESSAGE_DESC, number, "a sphere of so many pixels");
    WeftResult result = weft_image_create(size, size, 4, WEFT_PIXEL_F32, out, error);
    if (result == WEFT_OK) parallel_for(0, size, row_draw, &(Sphere){reflection, out});
    return result;
}
