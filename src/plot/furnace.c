/* furnace.c - the white furnace: the light that a white lobe over a white Lambert base returns under each
 * layer rule, and that of whole materials */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/pi.h"
#include "base/thread.h"
#include "measure/bsdf/grid.h"
#include "measure/check/furnace.h"
#include "plot/making.h"

/* WALKS: at most, for a rule or a lobe that walks at random. QUICK: only every third angle. */
enum { ANGLES = 14, CELLS = 80, WALKS = 40000, QUICK = 3 };

static const float angles[ANGLES] = {0.0f,  15.0f, 30.0f, 40.0f, 50.0f, 60.0f, 67.0f,
                                     73.0f, 78.0f, 82.0f, 85.0f, 87.0f, 88.5f, 89.5f};

typedef struct FurnaceWork {
    Lobe lobe;
    float roughness;
    const AlbedoTable *table;
    float *y[LAYER_COUNT];
    const float *x;
    int cells, walks;
} FurnaceWork;

static int count_of(const Making *making) { return making->desc->quick ? ANGLES / QUICK : ANGLES; }

/* Returns angle k of count_of, degrees. */
static float angle_of(const Making *making, int k) { return angles[making->desc->quick ? QUICK * k + 2 : k]; }

/* Returns the roughness for which lobe_rough gives the lobe's first parameter, which is monotonic, by bisection. */
static float roughness_of(const Lobe *lobe) {
    float low = 0.0f, high = 1.0f, wanted = lobe->params[0];
    bool rises = lobe_rough(lobe->id, 1.0f).params[0] >= lobe_rough(lobe->id, 0.0f).params[0];
    for (int k = 0; k < 40; k++) {
        float middle = 0.5f * (low + high), value = lobe_rough(lobe->id, middle).params[0];
        if ((value < wanted) == rises)
            low = middle;
        else
            high = middle;
    }
    return 0.5f * (low + high);
}

static void measure(void *user, int item, int thread) {
    (void)thread;
    const FurnaceWork *work = user;
    int layer = item % LAYER_COUNT, k = item / LAYER_COUNT;
    Dir o = grid_direction((cos)((double)work->x[k] * RADIANS), 0.0);
    work->y[layer][k] =
        (float)furnace_measure(&work->lobe, work->roughness, layer, work->table, o, work->cells, work->walks).e;
}

static bool of_lobe(Making *making, WeftPlotPanel *panel, const WeftLobe *given, int first_entry) {
    const int count = count_of(making);
    FurnaceWork work = {.cells = making->desc->quick ? CELLS / 2 : CELLS,
                        .walks = making->desc->quick ? WALKS / 4 : WALKS};
    AlbedoTable *table = malloc(sizeof *table);
    bool ready = table && making_series_space(making, panel, LAYER_COUNT);
    lobe_of(given, &work.lobe);
    work.roughness = roughness_of(&work.lobe);
    work.table = table;
    for (int layer = 0; ready && layer < LAYER_COUNT; layer++) {
        float *x;
        ready = making_series(making, panel, first_entry + layer, count, &x, &work.y[layer]) != NULL;
        for (int k = 0; ready && k < count; k++) x[k] = angle_of(making, k);
        work.x = x;
    }
    if (ready) {
        albedo_table_fill(table, &work.lobe, work.lobe.params[0], work.lobe.params[0], 0);
        parallel_for(0, LAYER_COUNT * count, measure, &work);
    }
    free(table);
    return ready;
}

static bool as_a_whole(Making *making, WeftPlotPanel *panel, int model, int entry) {
    float *x, *y;
    const int count = count_of(making);
    if (!making_series(making, panel, entry, count, &x, &y)) return false;
    for (int k = 0; k < count; k++) {
        float w[3], e[3];
        x[k] = angle_of(making, k);
        direction_of_view(x[k], w);
        weft_reflection_albedo(making->desc->models[model].reflection, WEFT_PART_ALL, w[2], e);
        y[k] = making_value(making, e);
    }
    return true;
}

static WeftPlotPanel *one_panel(Making *making, const char *title) {
    WeftPlotPanel *panel = making_panel(making, WEFT_PLOT_CURVES, "%s", title);
    making_axis(&panel->x, "\xce\xb8\xe2\x82\x92", "\xc2\xb0", 0.0f, 90.0f);
    making_axis(&panel->y, "share of light that returns", "", 0.0f, 1.0f);
    return panel;
}

/* Sets the range to round numbers that enclose 1 and all values. */
static void set_range(WeftPlotData *data) {
    double low = 0.95, high = 1.05;
    for (int p = 0; p < data->count; p++)
        for (int s = 0; s < data->panels[p].series_count; s++)
            for (int k = 0; k < data->panels[p].series[s].count; k++) {
                double y = (double)data->panels[p].series[s].y[k];
                if (isfinite(y)) low = fmin(low, y), high = fmax(high, y);
            }
    double step = round_up((high - low) / 8.0);
    for (int p = 0; p < data->count; p++) {
        data->panels[p].y.low = (float)(step * (floor)(low / step));
        data->panels[p].y.high = (float)(step * (ceil)(high / step));
    }
}

WeftResult kind_furnace(Making *making) {
    const WeftPlotDesc *desc = making->desc;
    int lobes = 0, wholes = 0;
    for (int n = 0; n < desc->count; n++) lobes += desc->models[n].lobe != NULL;
    wholes = desc->count - lobes;
    if (!making_panels(making, lobes + (wholes > 0), 2)) return making_short(making);
    for (int layer = 0; lobes && layer < LAYER_COUNT; layer++) making_legend(making, weft_layer_name(layer));
    for (int n = 0; n < desc->count; n++)
        if (desc->models[n].lobe &&
            !of_lobe(making, one_panel(making, making_label(making, n)), desc->models[n].lobe, 0))
            return making_short(making);
    WeftPlotPanel *panel = wholes ? one_panel(making, "whole materials, as they are") : NULL;
    if (panel && !making_series_space(making, panel, wholes)) return making_short(making);
    for (int n = 0; n < desc->count; n++)
        if (!desc->models[n].lobe && !as_a_whole(making, panel, n, making_legend(making, making_label(making, n))))
            return making_short(making);
    set_range(making->data);
    if (lobes)
        snprintf(making->data->note, sizeof making->data->note,
                 "white lobe on a white Lambert base under each layer rule; 1 returns all light");
    return WEFT_OK;
}
