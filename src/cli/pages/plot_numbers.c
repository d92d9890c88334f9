#include "cli/pages/plot_numbers.h"

#include <math.h>

#include "cli/console/json_writer.h"

static void axis_json(Json *json, const char *key, const WeftPlotAxis *axis) {
    if (!axis->label[0]) return;
    json_open(json, key, '{');
    json_text(json, "label", axis->label);
    json_text(json, "unit", axis->unit);
    json_float(json, "low", axis->low);
    json_float(json, "high", axis->high);
    json_bool(json, "logarithmic", axis->logarithmic != 0);
    json_close(json, '}');
}

static void series_json(Json *json, const WeftPlotData *data, const WeftPlotPanel *panel) {
    json_open(json, "series", '[');
    for (int k = 0; k < panel->series_count; k++) {
        const WeftPlotSeries *series = &panel->series[k];
        json_open(json, NULL, '{');
        json_text(json, "label", data->legend[series->entry]);
        json_floats(json, "x", series->x, series->count);
        json_floats(json, "y", series->y, series->count);
        json_close(json, '}');
    }
    json_close(json, ']');
}

static void grid_json(Json *json, const WeftPlotPanel *panel) {
    const int row = panel->columns * panel->channels;
    json_whole(json, "columns", panel->columns);
    json_whole(json, "rows", panel->rows);
    json_whole(json, "channels", panel->channels);
    json_open(json, "values", '[');
    for (int k = 0; k < panel->rows; k++) json_floats(json, NULL, panel->values + (size_t)k * (size_t)row, row);
    json_close(json, ']');
}

static void panel_json(Json *json, const WeftPlotData *data, const WeftPlotPanel *panel) {
    static const char *const forms[] = {"curves", "polar", "map", "surface", "picture"};
    json_open(json, NULL, '{');
    json_text(json, "title", panel->title);
    json_text(json, "form", forms[panel->form]);
    axis_json(json, "x_axis", &panel->x);
    axis_json(json, "y_axis", &panel->y);
    axis_json(json, "value_axis", &panel->z);
    json_open(json, "figures", '{');
    for (int k = 0; k < panel->figure_count; k++) json_number(json, panel->figures[k].name, panel->figures[k].value);
    json_close(json, '}');
    if (panel->series_count) series_json(json, data, panel);
    if (panel->values) grid_json(json, panel);
    json_close(json, '}');
}

void plot_json(const WeftPlotData *data, WeftPlotKind kind) {
    Json json = {.stream = stdout};
    json_open(&json, NULL, '{');
    json_text(&json, "kind", weft_plot_kind_name((int)kind));
    json_text(&json, "title", data->title);
    json_open(&json, "panels", '[');
    for (int k = 0; k < data->count; k++) panel_json(&json, data, &data->panels[k]);
    json_close(&json, ']');
    json_close(&json, '}');
}

/* Prints a CSV field in quotes; quotes inside it are doubled (RFC 4180). */
static void field(const char *text) {
    putchar('"');
    for (const char *s = text; *s; s++) {
        if (*s == '"') putchar('"');
        putchar(*s);
    }
    putchar('"');
}

static void number(float value, char after) {
    if (isfinite(value)) printf("%.9g", (double)value);
    putchar(after);
}

static void curves_csv(const WeftPlotData *data, const WeftPlotPanel *panel) {
    for (int s = 0; s < panel->series_count; s++)
        for (int k = 0; k < panel->series[s].count; k++) {
            field(panel->title);
            putchar(',');
            field(data->legend[panel->series[s].entry]);
            putchar(',');
            number(panel->series[s].x[k], ',');
            number(panel->series[s].y[k], '\n');
        }
}

/* Returns the coordinate of a node of a grid: the middle of a cell in maps, a node in surfaces, a pixel in
 * pictures. */
static float place(const WeftPlotPanel *panel, const WeftPlotAxis *axis, int k, int count) {
    if (panel->form == WEFT_PLOT_PICTURE || count < 2) return (float)k;
    float share = panel->form == WEFT_PLOT_SURFACE ? (float)k / (float)(count - 1) : ((float)k + 0.5f) / (float)count;
    return axis->low + share * (axis->high - axis->low);
}

static void grid_csv(const WeftPlotPanel *panel) {
    static const char *const channels[] = {"r", "g", "b"};
    for (int row = 0; row < panel->rows; row++)
        for (int k = 0; k < panel->columns; k++)
            for (int c = 0; c < panel->channels && c < 3; c++) {
                field(panel->title);
                printf(",%s,", panel->channels == 3 ? channels[c] : "");
                number(place(panel, &panel->x, k, panel->columns), ',');
                number(place(panel, &panel->y, row, panel->rows), ',');
                number(panel->values[((size_t)row * (size_t)panel->columns + (size_t)k) * (size_t)panel->channels +
                                     (size_t)c],
                       '\n');
            }
}

void plot_csv(const WeftPlotData *data) {
    bool curves = false;
    for (int k = 0; k < data->count; k++) curves = curves || data->panels[k].series_count > 0;
    puts(curves ? "panel,series,x,y" : "panel,channel,x,y,value");
    for (int k = 0; k < data->count; k++)
        if (curves)
            curves_csv(data, &data->panels[k]);
        else
            grid_csv(&data->panels[k]);
}
