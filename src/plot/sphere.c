/* sphere.c - spheres of each model under a directional light, as given and at other roughnesses; spheres of a model
 * without a roughness, such as a measurement, under other lights
 *
 * The sphere is seen from far away. The light is above to the left and has irradiance pi, so that white Lambert is 1
 * where the light is normal to the surface. The tangent runs around the sphere's vertical axis. */
#include <math.h>
#include <stdio.h>

#include "base/pi.h"
#include "base/thread.h"
#include "plot/making.h"

enum { SIDE = 144, SIDE_QUICK = 40, FINE = 2, ROUGHS = 6, CELLS = 1 + ROUGHS, WALKS = 12 };

static const float roughs[ROUGHS] = {0.15f, 0.3f, 0.45f, 0.6f, 0.8f, 1.0f};
/* other lights for models without a roughness, degrees from the viewer */
static const float lights[ROUGHS] = {0.0f, 25.0f, 75.0f, 100.0f, 125.0f, 150.0f};
static const float backdrop = 0.02f;

typedef struct Ball {
    const Making *making;
    const WeftPlotModel *model;
    float light[3];
    int side, walks;
    float *values; /* of its corner */
} Ball;

static float dot(const float a[3], const float b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Computes the radiance towards the viewer from the point of the sphere at (x, y) of the unit disc. */
static void radiance(const Ball *ball, float x, float y, float color[3]) {
    const float view[3] = {0.0f, 0.0f, 1.0f};
    float n[3] = {x, y, sqrtf(fmaxf(1.0f - x * x - y * y, 0.0f))};
    float length = fmaxf(sqrtf(n[0] * n[0] + n[2] * n[2]), 1e-6f);
    float t[3] = {n[2] / length, 0.0f, -n[0] / length};
    float b[3] = {n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]};
    float wo[3] = {dot(view, t), dot(view, b), dot(view, n)};
    float wi[1][3] = {{dot(ball->light, t), dot(ball->light, b), dot(ball->light, n)}}, f[1][3];
    for (int c = 0; c < 3; c++) color[c] = 0.0f;
    if (!(wo[2] > 0.0f && wi[0][2] > 0.0f)) return;
    making_eval(ball->model, wo, 1, (const float(*)[3])wi, ball->walks, f);
    for (int c = 0; c < 3; c++) color[c] = isfinite(f[0][c]) ? f[0][c] * wi[0][2] * PI_FLOAT : 0.0f;
}

static void one_row(void *user, int row, int thread) {
    (void)thread;
    const Ball *ball = user;
    const int side = ball->side;
    const float radius = 0.47f * (float)side;
    for (int k = 0; k < side; k++) {
        float sum[3] = {0.0f}, color[3];
        for (int s = 0; s < FINE * FINE; s++) {
            const int down = s / FINE;
            float x = ((float)k + ((float)(s % FINE) + 0.5f) / FINE - 0.5f * (float)side) / radius;
            float y = (0.5f * (float)side - (float)row - ((float)down + 0.5f) / FINE) / radius;
            if (x * x + y * y < 1.0f)
                radiance(ball, x, y, color);
            else
                color[0] = color[1] = color[2] = backdrop;
            /* pixels much brighter than white would have jagged edges */
            for (int c = 0; c < 3; c++) sum[c] += fminf(color[c], 8.0f) / (FINE * FINE);
        }
        float value = making_value(ball->making, sum);
        for (int c = 0; c < 3; c++)
            ball->values[3 * (row * CELLS * side + k) + c] =
                ball->making->desc->channel == WEFT_PLOT_LUMINANCE ? sum[c] : value;
    }
}

static void set_light(Ball *ball, float angle) {
    const double radians = (double)angle * RADIANS, up = sin(radians) * 0.70710678118654752;
    ball->light[0] = (float)-up;
    ball->light[1] = (float)up;
    ball->light[2] = (float)cos(radians);
}

/* Draws one ball of a strip: the model as it is, then at other roughnesses or under other lights. */
static void one_ball(Ball *ball, WeftPlotPanel *panel, const WeftPlotModel *model, int k, float angle) {
    Rough rough = {.reflection = NULL};
    bool rougher = k > 0 && rough_make(model, roughs[k - 1], &rough);
    ball->model = rougher ? &rough.model : model;
    set_light(ball, k == 0 || rougher ? angle : lights[k - 1]);
    if (k == 0)
        snprintf(panel->cells[k], sizeof panel->cells[k], "as given");
    else if (rougher)
        snprintf(panel->cells[k], sizeof panel->cells[k], "roughness %g", (double)roughs[k - 1]);
    else
        snprintf(panel->cells[k], sizeof panel->cells[k], "light %g\xc2\xb0", (double)lights[k - 1]);
    parallel_for(0, ball->side, one_row, ball);
    rough_free(&rough);
}

static void one_strip(Making *making, WeftPlotPanel *panel, const WeftPlotModel *model, float angle, float *values) {
    Ball ball = {.making = making, .side = panel->rows, .walks = making_walks(making, WALKS)};
    panel->cell_count = CELLS;
    for (int k = 0; k < CELLS; k++) {
        ball.values = values + 3 * k * panel->rows;
        one_ball(&ball, panel, model, k, angle);
    }
}

WeftResult kind_sphere(Making *making) {
    const int views = making_view_count(making), count = making->desc->count;
    if (!making_panels(making, views * count, 1)) return making_short(making);
    making_models(making);
    const int side = making->desc->quick ? SIDE_QUICK : SIDE;
    for (int n = 0; n < count; n++)
        for (int k = 0; k < views; k++) {
            const float angle = making_view(making, k, 50.0f);
            WeftPlotPanel *panel = making_panel(making, WEFT_PLOT_PICTURE, "%s, light %g\xc2\xb0 from the viewer",
                                                making_label(making, n), (double)angle);
            float *values = making_grid(making, panel, CELLS * side, side, 3);
            if (!values) return making_short(making);
            panel->colored = 1;
            one_strip(making, panel, &making->desc->models[n], angle, values);
        }
    snprintf(making->data->note, sizeof making->data->note,
             "irradiance \xcf\x80, tone-mapped (PBR Neutral); roughness as an artist sets it");
    return WEFT_OK;
}
