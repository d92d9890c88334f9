/* albedo.c - E over the angle of wo, and over an artist's roughness */
#include <math.h>

#include "base/thread.h"
#include "plot/making.h"

enum { ANGLES = 24, ROUGHS = 20, QUICK = 3 }; /* QUICK: only every third */

static const float angles[ANGLES] = {0.0f,  5.0f,  10.0f, 15.0f, 20.0f, 25.0f, 30.0f, 35.0f,
                                     40.0f, 45.0f, 50.0f, 55.0f, 60.0f, 65.0f, 70.0f, 74.0f,
                                     78.0f, 81.0f, 84.0f, 86.0f, 87.5f, 88.5f, 89.3f, 89.8f};

typedef struct AlbedoRow {
    const Making *making;
    const WeftPlotModel *model;
    float view; /* over roughness */
    const float *x;
    float *y;
} AlbedoRow;

static float albedo_of(const Making *making, const WeftReflection *reflection, float degrees) {
    float w[3], e[3];
    direction_of_view(degrees, w);
    weft_reflection_albedo(reflection, WEFT_PART_ALL, w[2], e);
    float value = making_value(making, e);
    return isfinite(value) ? value : NAN;
}

static void over_angle(void *user, int k, int thread) {
    (void)thread;
    const AlbedoRow *row = user;
    row->y[k] = albedo_of(row->making, row->model->reflection, row->x[k]);
}

static void over_roughness(void *user, int k, int thread) {
    (void)thread;
    const AlbedoRow *row = user;
    Rough rough;
    row->y[k] = NAN;
    if (rough_make(row->model, row->x[k], &rough)) row->y[k] = albedo_of(row->making, rough.reflection, row->view);
    rough_free(&rough);
}

static bool angle_series(Making *making, WeftPlotPanel *panel, int model) {
    float *x, *y;
    const int step = making->desc->quick ? QUICK : 1, count = ANGLES / step;
    if (!making_series(making, panel, model, count, &x, &y)) return false;
    for (int k = 0; k < count; k++) x[k] = angles[(k + 1) * step - 1];
    AlbedoRow row = {.making = making, .model = &making->desc->models[model], .x = x, .y = y};
    parallel_for(0, count, over_angle, &row);
    return true;
}

/* Adds the curves of a model that has a roughness. */
static bool rough_series(Making *making, WeftPlotPanel *panel, int model, float view) {
    float *x, *y;
    if (!rough_is_there(&making->desc->models[model])) return true;
    const int count = making->desc->quick ? ROUGHS / 4 : ROUGHS;
    if (!making_series(making, panel, model, count, &x, &y)) return false;
    for (int k = 0; k < count; k++) x[k] = (float)(k + 1) / (float)count;
    AlbedoRow row = {.making = making, .model = &making->desc->models[model], .view = view, .x = x, .y = y};
    parallel_for(0, count, over_roughness, &row);
    return true;
}

/* Sets the range of E from 0 to above 1 and all values. */
static void range_of_albedo(WeftPlotData *data, bool logarithmic) {
    double most = 1.0, least = 1.0;
    for (int p = 0; p < data->count; p++)
        for (int s = 0; s < data->panels[p].series_count; s++)
            for (int k = 0; k < data->panels[p].series[s].count; k++) {
                double y = (double)data->panels[p].series[s].y[k];
                if (y > most) most = y;
                if (y > 0.0 && y < least) least = y;
            }
    for (int p = 0; p < data->count; p++) {
        WeftPlotAxis *axis = &data->panels[p].y;
        axis->logarithmic = logarithmic;
        axis->high = (float)(1.05 * most);
        if (!logarithmic) continue;
        axis->high = (float)pow(10.0, ceil(log10(most)));
        axis->low = (float)pow(10.0, fmax(floor(log10(fmin(least, 0.5))), -4.0));
    }
}

WeftResult kind_albedo(Making *making) {
    const int views = making_view_count(making);
    if (!making_panels(making, 1 + views, 2)) return making_short(making);
    making_models(making);
    for (int p = 0; p < 1 + views; p++) {
        const float view = p ? making_view(making, p - 1, 60.0f) : NAN;
        WeftPlotPanel *panel = p ? making_panel(making, WEFT_PLOT_CURVES,
                                                "E over roughness, \xce\xb8\xe2\x82\x92 = %g\xc2\xb0", (double)view)
                                 : making_panel(making, WEFT_PLOT_CURVES, "E over the angle of view");
        if (p)
            making_axis(&panel->x, "an artist's roughness", "", 0.0f, 1.0f);
        else
            making_axis(&panel->x, "\xce\xb8\xe2\x82\x92", "\xc2\xb0", 0.0f, 90.0f);
        making_axis(&panel->y, "directional albedo E", "", 0.0f, 1.0f);
        if (!making_series_space(making, panel, making->desc->count)) return making_short(making);
        for (int n = 0; n < making->desc->count; n++)
            if (!(p ? rough_series(making, panel, n, view) : angle_series(making, panel, n)))
                return making_short(making);
        if (p && panel->series_count == 0) making->data->count--;
    }
    range_of_albedo(making->data, making->desc->logarithmic != 0);
    return WEFT_OK;
}
