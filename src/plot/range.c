/* range.c - the range of f on an axis */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "plot/making.h"

double round_up(double x) {
    const double steps[] = {1.0, 2.0, 2.5, 5.0}, power = pow(10.0, floor(log10(fmax(x, 1e-30))));
    for (int k = 0; k < 4; k++)
        if (steps[k] * power >= 0.9999 * x) return steps[k] * power;
    return 10.0 * power;
}

/* The range that one curve needs. */
typedef struct Reach {
    double most, least; /* least: above 0 */
} Reach;

/* Returns the range of a curve. Its top is at most four times the largest f within 85 degrees of the normal, unless
 * `view` is above 80 degrees. */
static Reach reach_of(const WeftPlotSeries *series, float view) {
    double most = 0.0, inner = 0.0, least = HUGE_VAL;
    for (int k = 0; k < series->count; k++) {
        double y = (double)series->y[k];
        if (!(y > 0.0) || !isfinite(y)) continue;
        most = fmax(most, y);
        least = fmin(least, y);
        if (fabsf(series->x[k]) <= 85.0f) inner = fmax(inner, y);
    }
    if (inner > 0.0 && !(view > 80.0f)) most = fmin(most, 4.0 * inner);
    return (Reach){most, least};
}

static int compare(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Returns the range of the panels that plot one quantity; with `whole` that of all values. All curves of one entry of
 * the legend count as high as the highest. If a gap separates the lower half or more from higher entries, these are
 * left out. */
static Reach reach_of_all(const WeftPlotData *data, WeftPlotForm form, const char *label, bool whole) {
    double tops[WEFT_PLOT_LEGEND_MAX] = {0.0}, sorted[WEFT_PLOT_LEGEND_MAX], least = HUGE_VAL, most = 0.0;
    const double gap = 30.0;
    int count = 0;
    for (int p = 0; p < data->count; p++) {
        const WeftPlotPanel *panel = &data->panels[p];
        if (panel->form != form || strcmp(panel->y.label, label) != 0) continue;
        for (int k = 0; k < panel->series_count; k++) {
            Reach reach = reach_of(&panel->series[k], whole ? 90.0f : panel->view);
            int entry = panel->series[k].entry;
            least = fmin(least, reach.least);
            tops[entry] = fmax(tops[entry], reach.most);
        }
    }
    for (int k = 0; k < WEFT_PLOT_LEGEND_MAX; k++)
        if (tops[k] > 0.0) sorted[count++] = tops[k];
    qsort(sorted, (size_t)count, sizeof *sorted, compare);
    for (int k = 0; k < count; k++) {
        if (!whole && 2 * k >= count && sorted[k] > gap * sorted[k - 1]) break;
        most = sorted[k];
    }
    return (Reach){most > 0.0 ? most : 1.0, least};
}

/* Returns true if a panel of that quantity has values above the top. */
static bool goes_beyond(const WeftPlotData *data, const char *label, double top) {
    for (int p = 0; p < data->count; p++) {
        const WeftPlotPanel *panel = &data->panels[p];
        for (int s = 0; s < panel->series_count && strcmp(panel->y.label, label) == 0; s++)
            for (int k = 0; k < panel->series[s].count; k++)
                if ((double)panel->series[s].y[k] > 1.04 * top) return true;
    }
    return false;
}

void range_of_f(WeftPlotData *data, WeftPlotForm form, bool logarithmic) {
    const double decades = 6.0;
    for (int p = 0; p < data->count; p++) {
        WeftPlotAxis *axis = &data->panels[p].y;
        if (data->panels[p].form != form) continue;
        Reach reach = reach_of_all(data, form, axis->label, logarithmic);
        axis->low = 0.0f;
        axis->high = (float)(1.04 * reach.most);
        if (form == WEFT_PLOT_CURVES && goes_beyond(data, axis->label, reach.most))
            axis->high *= 1.15f; /* space for a mark */
        axis->logarithmic = logarithmic;
        if (!logarithmic) continue;
        double high = ceil(log10(reach.most)), low = floor(log10(fmin(reach.least, reach.most)));
        axis->high = (float)pow(10.0, high);
        axis->low = (float)pow(10.0, fmin(fmax(low, high - decades), high - 1.0));
    }
}
