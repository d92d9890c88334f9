/* ambient.c - spheres of a lobe under a map, and as engines light it by that map; the error of each over the roughness */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/thread.h"
#include "plot/ambient_ways.h"

enum { SIDE = 64, SIDE_QUICK = 20, SIDE_ROUGH = 14, ROUGHS = 9, ROUGHS_QUICK = 3, CELLS = 1 + AMBIENT_WAYS };

/* The spheres of a model, of so many pixels across, and the sums of their rows. */
typedef struct Spheres {
    const AmbientModel *model;
    int side;
    float *values;         /* CELLS spheres beside each other, or NULL */
    double (*sums)[CELLS]; /* a row: of the reference, and of the differences from it */
} Spheres;

static void sphere_pixel(const Spheres *s, int row, int column) {
    static const float black[3] = {0.02f, 0.02f, 0.02f};
    const float radius = 0.47f * (float)s->side;
    const float x = ((float)column + 0.5f - 0.5f * (float)s->side) / radius;
    const float y = (0.5f * (float)s->side - (float)row - 0.5f) / radius, rest = 1.0f - x * x - y * y;
    float light[CELLS][3] = {{0.0f}};
    if (rest > 0.0f) ambient_model_light(s->model, vec3(x, y, sqrtf(rest)), light[0], light + 1);
    for (int k = 0; k < CELLS; k++) {
        for (int c = 0; c < 3 && rest > 0.0f; c++)
            s->sums[row][k] += fabs((double)light[k][c] - (k ? (double)light[0][c] : 0.0));
        for (int c = 0; c < 3 && s->values; c++)
            s->values[3 * ((row * CELLS + k) * s->side + column) + c] = rest > 0.0f ? light[k][c] : black[c];
    }
}

static void sphere_row(void *user, int row, int thread) {
    (void)thread;
    const Spheres *s = user;
    for (int k = 0; k < s->side; k++) sphere_pixel(s, row, k);
}

/* Draws the spheres of a model, and computes the error of each way: sum |difference| / sum of the reference, to a tenth of
 * a per cent. */
static bool spheres_make(const AmbientMap *map, const WeftPlotModel *model, int side, float *values,
                         double error[AMBIENT_WAYS]) {
    Spheres s = {.side = side, .values = values};
    AmbientModel *made = ambient_model_make(map, model);
    s.model = made;
    s.sums = calloc((size_t)side, sizeof *s.sums);
    const bool well = made && s.sums;
    if (well) parallel_for(0, side, sphere_row, &s);
    for (int way = 0; well && way < AMBIENT_WAYS; way++) {
        double off = 0.0, all = 0.0;
        for (int row = 0; row < side; row++) {
            off += s.sums[row][1 + way];
            all += s.sums[row][0];
        }
        error[way] = round(1000.0 * off / fmax(all, 1e-30)) / 10.0;
    }
    free(s.sums);
    ambient_model_free(made);
    return well;
}

static bool picture_make(Making *making, const AmbientMap *map, int model) {
    const int side = making->desc->quick ? SIDE_QUICK : SIDE;
    double error[AMBIENT_WAYS];
    WeftPlotPanel *panel =
        making_panel(making, WEFT_PLOT_PICTURE, "%s: as it is, and as engines light it", making_label(making, model));
    float *values = making_grid(making, panel, CELLS * side, side, 3);
    if (!values || !spheres_make(map, &making->desc->models[model], side, values, error)) return false;
    panel->colored = 1;
    panel->cell_count = CELLS;
    snprintf(panel->cells[0], sizeof panel->cells[0], "reference");
    for (int k = 0; k < AMBIENT_WAYS; k++) {
        snprintf(panel->cells[1 + k], sizeof panel->cells[1 + k], "%s", ambient_way_name(k));
        making_figure(panel, ambient_way_name(k), "%", error[k]);
    }
    return true;
}

/* Adds a curve for each way: its error over the roughness. */
static bool curves_make(Making *making, const AmbientMap *map, int model) {
    const int count = making->desc->quick ? ROUGHS_QUICK : ROUGHS;
    float *x[AMBIENT_WAYS], *y[AMBIENT_WAYS];
    double most = 0.0;
    WeftPlotPanel *panel =
        making_panel(making, WEFT_PLOT_CURVES, "%s: error over the roughness", making_label(making, model));
    making_axis(&panel->x, "an artist's roughness", "", 0.0f, 1.0f);
    making_axis(&panel->y, "sum of differences / sum", "%", 0.0f, 1.0f);
    if (!making_series_space(making, panel, AMBIENT_WAYS)) return false;
    for (int k = 0; k < AMBIENT_WAYS; k++)
        if (!making_series(making, panel, k, count, &x[k], &y[k])) return false;
    for (int k = 0; k < count; k++) {
        const float roughness = 0.2f + 0.8f * (float)k / (float)(count - 1);
        double error[AMBIENT_WAYS];
        Rough rough;
        const bool well = rough_make(&making->desc->models[model], roughness, &rough) &&
                          spheres_make(map, &rough.model, SIDE_ROUGH, NULL, error);
        rough_free(&rough);
        if (!well) return false;
        for (int way = 0; way < AMBIENT_WAYS; way++) {
            x[way][k] = roughness;
            y[way][k] = (float)error[way];
            most = fmax(most, error[way]);
        }
    }
    panel->y.high = (float)round_up(fmin(most, 200.0));
    return true;
}

WeftResult kind_ambient(Making *making) {
    const int count = making->desc->count;
    AmbientMap *map;
    WeftResult result = ambient_map_make(making->desc->environment, &map, making->error);
    if (result == WEFT_OK && !making_panels(making, 2 * count, 1)) result = making_short(making);
    for (int k = 0; k < AMBIENT_WAYS; k++) making_legend(making, ambient_way_name(k));
    for (int n = 0; n < count && result == WEFT_OK; n++)
        if (!picture_make(making, map, n) || (rough_is_there(&making->desc->models[n]) && !curves_make(making, map, n)))
            result = making_short(making);
    snprintf(making->data->note, sizeof making->data->note,
             "sums over 12288 directions; tone-mapped (PBR Neutral); the lobe alone, without a base");
    ambient_map_free(map);
    return result;
}
