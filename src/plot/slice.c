/* slice.c - f over theta_h and theta_d at phi_d = 90 degrees
 *
 * One slice shows the main features of a measured BRDF: the specular peak at the left, the Fresnel peak at the top, the
 * sheen at the right (Brent Burley, "Physically-Based Shading at Disney", 2012, section 3; angles: Szymon Rusinkiewicz,
 * "A New Change of Variables for Efficient BRDF Representation", 1998). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/pi.h"
#include "plot/making.h"

enum { SIDE = 128, SIDE_QUICK = 48, WALKS = 128 };
static int side_of(const Making *making) { return making->desc->quick ? SIDE_QUICK : SIDE; }

/* Computes wo and wi of a cell: h = (sin theta_h, 0, cos theta_h), and both lie on either side of the plane of h and
 * the normal. */
static void pair(int side, int row, int column, float wo[3], float wi[3]) {
    const double step = 0.5 * PI_DOUBLE / side, h = (column + 0.5) * step, d = (row + 0.5) * step;
    wi[0] = wo[0] = (float)(sin(h) * cos(d));
    wi[1] = (float)sin(d);
    wo[1] = (float)-sin(d);
    wi[2] = wo[2] = (float)(cos(h) * cos(d));
}

static bool one_map(Making *making, WeftPlotPanel *panel, int model) {
    const bool colored = panel->colored != 0;
    const int side = side_of(making);
    float *values = making_grid(making, panel, side, side, colored ? 3 : 1);
    if (!values) return false;
    for (int row = 0; row < side; row++)
        for (int k = 0; k < side; k++) {
            float wo[3], wi[1][3], f[1][3];
            pair(side, row, k, wo, wi[0]);
            making_eval(&making->desc->models[model], wo, 1, (const float(*)[3])wi, making_walks(making, WALKS), f);
            float *to = values + (colored ? 3 : 1) * (row * side + k);
            *to = making_value(making, f[0]);
            for (int c = 0; colored && c < 3; c++)
                to[c] = making->desc->channel == WEFT_PLOT_LUMINANCE ? f[0][c]
                                                                     : f[0][making->desc->channel - WEFT_PLOT_RED];
        }
    return true;
}

static int compare(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Returns a quantile, 0 .. 1, of the positive values of all panels; 0 if there are none. */
static float quantile_of_all(const Making *making, double quantile) {
    int count = 0, all = making->data->count * SIDE * SIDE * 3;
    float *sorted = arena_array(making->arena, (size_t)all, sizeof *sorted);
    if (!sorted) return 0.0f;
    for (int p = 0; p < making->data->count; p++) {
        const WeftPlotPanel *panel = &making->data->panels[p];
        for (int k = 0; k < panel->columns * panel->rows * panel->channels; k++)
            if (panel->values[k] > 0.0f) sorted[count++] = panel->values[k];
    }
    if (count == 0) return 0.0f;
    qsort(sorted, (size_t)count, sizeof *sorted, compare);
    return sorted[(int)(quantile * (count - 1))];
}

/* Sets one exposure, in whole stops, and one range for all panels. */
static void set_ranges(Making *making) {
    float middle = quantile_of_all(making, 0.8), least = quantile_of_all(making, 0.02),
          most = quantile_of_all(making, 0.98);
    float stops = middle > 0.0f ? fminf(fmaxf(roundf(log2f(0.5f / middle)), -12.0f), 12.0f) + 0.0f : 0.0f;
    double high = most > 0.0f ? ceil(log10((double)most)) : 0.0;
    double low = least > 0.0f ? fmax(floor(log10((double)least)), high - 5.0) : high - 3.0;
    for (int p = 0; p < making->data->count; p++) {
        WeftPlotPanel *panel = &making->data->panels[p];
        making_axis(&panel->z, "f", "1/sr", (float)pow(10.0, fmin(low, high - 1.0)), (float)pow(10.0, high));
        panel->z.logarithmic = 1;
        panel->exposure = stops;
    }
}

WeftResult kind_slice(Making *making) {
    const int count = making->desc->count;
    if (!making_panels(making, count, count > 2 ? 3 : count)) return making_short(making);
    making_models(making);
    for (int n = 0; n < count; n++) {
        WeftPlotPanel *panel = making_panel(making, WEFT_PLOT_MAP,
                                            "%s, \xcf\x86"
                                            "d = 90\xc2\xb0",
                                            making_label(making, n));
        making_axis(&panel->x, "\xce\xb8h, normal to half vector", "\xc2\xb0", 0.0f, 90.0f);
        making_axis(&panel->y,
                    "\xce\xb8"
                    "d, half vector to \xcf\x89\xe1\xb5\xa2",
                    "\xc2\xb0", 0.0f, 90.0f);
        panel->colored = !making->desc->logarithmic;
        if (!one_map(making, panel, n)) return making_short(making);
    }
    set_ranges(making);
    if (!making->desc->logarithmic)
        snprintf(making->data->note, sizeof making->data->note,
                 "f as a picture: exposure %+g stops, tone-mapped (PBR Neutral)",
                 (double)making->data->panels[0].exposure);
    return WEFT_OK;
}
