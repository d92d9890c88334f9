/* lobe3d.c - f as a length over all directions of wi */
#include <math.h>
#include <stdlib.h>

#include "base/pi.h"
#include "plot/making.h"

/* Nodes: phi from 0 to 360 degrees, theta from 0 to 90, every two degrees and every one. */
enum { PHIS = 181, THETAS = 91, WALKS = 200 };
static int phis_of(const Making *making) { return making->desc->quick ? 73 : PHIS; }
static int thetas_of(const Making *making) { return making->desc->quick ? 31 : THETAS; }

static int compare(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static bool one_surface(Making *making, WeftPlotPanel *panel, int model, float view) {
    const int phis = phis_of(making), thetas = thetas_of(making), count = phis * thetas;
    float *values = making_grid(making, panel, phis, thetas, 1), wo[3];
    float(*wi)[3] = arena_array(making->arena, (size_t)count, sizeof *wi);
    float(*f)[3] = arena_array(making->arena, (size_t)count, sizeof *f);
    if (!values || !wi || !f) return false;
    for (int row = 0; row < thetas; row++)
        for (int k = 0; k < phis; k++) {
            /* f is 0 at the horizon itself: the last row is just above it */
            double theta = fmin(90.0 * row / (thetas - 1), 89.7) * RADIANS;
            double phi = 360.0 * k / (phis - 1) * RADIANS, s = sin(theta);
            float *w = wi[row * phis + k];
            w[0] = (float)(s * cos(phi)), w[1] = (float)(s * sin(phi)), w[2] = (float)cos(theta);
        }
    direction_of_view(view, wo);
    making_eval(&making->desc->models[model], wo, count, (const float(*)[3])wi, making_walks(making, WALKS), f);
    for (int k = 0; k < count; k++) values[k] = making_value(making, f[k]) * (making->desc->cosine ? wi[k][2] : 1.0f);
    return true;
}

/* Sets the range of lengths. A peak of which less than two in a thousand nodes are in the upper half would be an
 * invisible needle: it is cut off at the height where it is that wide. */
static void set_range(const Making *making, WeftPlotPanel *panel, float *scratch) {
    int count = 0;
    for (int k = 0; k < panel->columns * panel->rows; k++)
        if (panel->values[k] > 0.0f) scratch[count++] = panel->values[k];
    qsort(scratch, (size_t)count, sizeof *scratch, compare);
    double most = count ? (double)scratch[count - 1] : 0.0;
    double high = count ? fmin(most, 2.0 * (double)scratch[count - 1 - count / 500]) : 1.0;
    making_figure(panel, "largest", "1/sr", most);
    if (high < most && !making->desc->logarithmic) making_figure(panel, "cut off at", "1/sr", high);
    if (making->desc->logarithmic && count) high = most;
    making_axis(&panel->z, making_f(making), "1/sr", 0.0f, (float)high);
    if (!making->desc->logarithmic) return;
    double low = count ? (double)scratch[count / 100] : high;
    panel->z.logarithmic = 1;
    panel->z.high = (float)pow(10.0, ceil(log10(high)));
    panel->z.low = (float)pow(10.0, fmin(fmax(floor(log10(low)), ceil(log10(high)) - 4.0), ceil(log10(high)) - 1.0));
}

WeftResult kind_lobe3d(Making *making) {
    const int views = making_view_count(making), count = making->desc->count;
    float *scratch = arena_array(making->arena, (size_t)PHIS * THETAS, sizeof *scratch);
    int columns = views > 1 ? views : count > 3 ? 3 : count;
    if (!scratch || !making_panels(making, views * count, columns > 3 ? 3 : columns)) return making_short(making);
    making_models(making);
    for (int n = 0; n < count; n++)
        for (int k = 0; k < views; k++) {
            const float view = making_view(making, k, 60.0f);
            WeftPlotPanel *panel = making_panel(making, WEFT_PLOT_SURFACE, "%s, %s, \xce\xb8\xe2\x82\x92 = %g\xc2\xb0",
                                                making_label(making, n), making_f(making), (double)view);
            making_axis(&panel->x, "phi", "\xc2\xb0", 0.0f, 360.0f);
            making_axis(&panel->y, "theta_i", "\xc2\xb0", 0.0f, 90.0f);
            panel->view = view;
            panel->entry = n;
            if (!one_surface(making, panel, n, view)) return making_short(making);
            set_range(making, panel, scratch);
        }
    return WEFT_OK;
}
