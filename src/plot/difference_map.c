/* difference_map.c - the difference of two reflections over theta_o and theta_i in one plane */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "plot/making.h"

/* Cells of theta_i from -90 to 90 degrees and theta_o from 0 to 90; f is evaluated at their middles. */
enum { COLUMNS = 180, ROWS = 90, WALKS = 64 };

static bool fill(Making *making, int model, float *values) {
    float(*wi)[3] = arena_array(making->arena, COLUMNS, sizeof *wi);
    float(*f)[3] = arena_array(making->arena, COLUMNS, sizeof *f);
    if (!wi || !f) return false;
    for (int k = 0; k < COLUMNS; k++) direction_in_plane(180.0f * ((float)k + 0.5f) / COLUMNS - 90.0f, wi[k]);
    for (int row = 0; row < ROWS; row++) {
        float wo[3];
        direction_of_view(90.0f * ((float)row + 0.5f) / ROWS, wo);
        making_eval(&making->desc->models[model], wo, COLUMNS, (const float(*)[3])wi, making_walks(making, WALKS), f);
        for (int k = 0; k < COLUMNS; k++) values[row * COLUMNS + k] = making_value(making, f[k]);
    }
    return true;
}

static int compare(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Returns a round number that 98 of 100 differences do not exceed. */
static float reach(const float *values, float *scratch) {
    int count = 0;
    for (int k = 0; k < COLUMNS * ROWS; k++)
        if (isfinite(values[k])) scratch[count++] = fabsf(values[k]);
    if (count == 0) return 1.0f;
    qsort(scratch, (size_t)count, sizeof *scratch, compare);
    float high = scratch[(int)(0.98 * (count - 1))];
    if (!(high > 0.0f)) high = scratch[count - 1];
    return high > 0.0f ? (float)round_up((double)high) : 1.0f;
}

/* Adds the mean and the largest absolute difference, and the place of the largest. */
static void add_figures(WeftPlotPanel *panel, const char *unit) {
    double sum = 0.0, most = 0.0;
    int count = 0, at = 0;
    for (int k = 0; k < COLUMNS * ROWS; k++) {
        double size = fabs((double)panel->values[k]);
        if (!isfinite(size)) continue;
        sum += size;
        count++;
        if (size > most) at = k;
        most = fmax(most, size);
    }
    making_figure(panel, "mean", unit, sum / (count > 0 ? count : 1));
    making_figure(panel, "most", unit, most);
    const int row = at / COLUMNS;
    making_figure(panel, "at \xce\xb8\xe2\x82\x92", "\xc2\xb0", 90.0 * (row + 0.5) / ROWS);
    making_figure(panel, "\xce\xb8\xe1\xb5\xa2", "\xc2\xb0", 180.0 * (at % COLUMNS + 0.5) / COLUMNS - 90.0);
}

static WeftPlotPanel *one_panel(Making *making, bool relative) {
    WeftPlotPanel *panel = relative ? making_panel(making, WEFT_PLOT_MAP, "(A \xe2\x88\x92 B) / max(A, B)")
                                    : making_panel(making, WEFT_PLOT_MAP, "A \xe2\x88\x92 B");
    making_axis(&panel->x, "\xce\xb8\xe1\xb5\xa2 in the plane of \xcf\x89\xe2\x82\x92", "\xc2\xb0", -90.0f, 90.0f);
    making_axis(&panel->y, "\xce\xb8\xe2\x82\x92", "\xc2\xb0", 0.0f, 90.0f);
    panel->center = 0.0f;
    return panel;
}

WeftResult kind_difference(Making *making) {
    const int cells = COLUMNS * ROWS;
    if (!making_panels(making, 2, 2)) return making_short(making);
    making_models(making);
    WeftPlotPanel *panels[2] = {one_panel(making, false), one_panel(making, true)};
    float *f[2], *values[2], *scratch = arena_array(making->arena, (size_t)cells, sizeof *scratch);
    for (int k = 0; k < 2; k++) {
        f[k] = arena_array(making->arena, (size_t)cells, sizeof *f[k]);
        values[k] = making_grid(making, panels[k], COLUMNS, ROWS, 1);
        if (!f[k] || !values[k] || !fill(making, k, f[k])) return making_short(making);
    }
    if (!scratch) return making_short(making);
    for (int k = 0; k < cells; k++) {
        float larger = fmaxf(f[0][k], f[1][k]);
        values[0][k] = f[0][k] - f[1][k];
        values[1][k] = larger > 0.0f ? values[0][k] / larger : 0.0f;
    }
    float high = reach(values[0], scratch);
    making_axis(&panels[0]->z, "A \xe2\x88\x92 B", "1/sr", -high, high);
    making_axis(&panels[1]->z, "relative", "", -1.0f, 1.0f);
    add_figures(panels[0], "1/sr");
    add_figures(panels[1], "");
    snprintf(making->data->note, sizeof making->data->note, "A: %.100s;  B: %.100s;  red: A is more, blue: less",
             making_label(making, 0), making_label(making, 1));
    return WEFT_OK;
}
