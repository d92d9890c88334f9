#include "plot/making.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/pi.h"
#include "base/random.h"
#include "base/thread.h"

WeftResult making_short(const Making *making) { return fail(making->error, WEFT_MESSAGE_MEMORY, "plot", NULL); }

bool making_panels(Making *making, int most, int columns) {
    making->panels_max = most;
    making->data->columns = columns;
    making->data->panels = arena_array(making->arena, (size_t)most, sizeof *making->data->panels);
    return making->data->panels != NULL;
}

WeftPlotPanel *making_panel(Making *making, WeftPlotForm form, const char *title, ...) {
    if (making->data->count >= making->panels_max) return NULL;
    WeftPlotPanel *panel = &making->data->panels[making->data->count++];
    panel->form = form;
    panel->view = panel->center = NAN;
    va_list arguments;
    va_start(arguments, title);
    vsnprintf(panel->title, sizeof panel->title, title, arguments);
    va_end(arguments);
    return panel;
}

bool making_series_space(Making *making, WeftPlotPanel *panel, int most) {
    panel->series = arena_array(making->arena, (size_t)most, sizeof *panel->series);
    return panel->series != NULL;
}

WeftPlotSeries *making_series(Making *making, WeftPlotPanel *panel, int entry, int count, float **x, float **y) {
    *x = arena_array(making->arena, (size_t)count, sizeof **x);
    *y = arena_array(making->arena, (size_t)count, sizeof **y);
    if (!*x || !*y) return NULL;
    WeftPlotSeries *series = &panel->series[panel->series_count++];
    *series = (WeftPlotSeries){.entry = entry, .count = count, .x = *x, .y = *y};
    return series;
}

float *making_grid(Making *making, WeftPlotPanel *panel, int columns, int rows, int channels) {
    float *values = arena_array(making->arena, (size_t)columns * (size_t)rows, sizeof *values * (size_t)channels);
    panel->columns = columns;
    panel->rows = rows;
    panel->channels = channels;
    panel->values = values;
    return values;
}

int making_legend(Making *making, const char *text) {
    WeftPlotData *data = making->data;
    if (data->legend_count >= WEFT_PLOT_LEGEND_MAX) return WEFT_PLOT_LEGEND_MAX - 1;
    snprintf(data->legend[data->legend_count], sizeof data->legend[0], "%.120s", text);
    return data->legend_count++;
}

static const char *const numbers[WEFT_PLOT_MODELS_MAX] = {"1", "2", "3", "4", "5", "6", "7", "8"};

const char *making_label(const Making *making, int model) {
    const char *label = making->desc->models[model].label;
    return label ? label : numbers[model];
}

void making_models(Making *making) {
    for (int k = 0; k < making->desc->count; k++) making_legend(making, making_label(making, k));
}

void making_axis(WeftPlotAxis *axis, const char *label, const char *unit, float low, float high) {
    *axis = (WeftPlotAxis){.low = low, .high = high};
    snprintf(axis->label, sizeof axis->label, "%s", label);
    snprintf(axis->unit, sizeof axis->unit, "%s", unit);
}

void making_mark(WeftPlotPanel *panel, float x, const char *label, ...) {
    if (panel->mark_count >= WEFT_PLOT_MARKS_MAX) return;
    WeftPlotMark *mark = &panel->marks[panel->mark_count++];
    mark->x = x;
    va_list arguments;
    va_start(arguments, label);
    vsnprintf(mark->label, sizeof mark->label, label, arguments);
    va_end(arguments);
}

void making_figure(WeftPlotPanel *panel, const char *name, const char *unit, double value) {
    if (panel->figure_count >= WEFT_PLOT_FIGURES_MAX) return;
    WeftPlotFigure *figure = &panel->figures[panel->figure_count++];
    figure->value = value;
    snprintf(figure->name, sizeof figure->name, "%s", name);
    snprintf(figure->unit, sizeof figure->unit, "%s", unit);
}

int making_view_count(const Making *making) { return making->desc->view_count > 0 ? making->desc->view_count : 1; }

float making_view(const Making *making, int k, float usual) {
    return making->desc->view_count > 0 ? making->desc->views[k] : usual;
}

/* Computes sine and cosine of an angle; the cosine is the sine of the complement, so that it is exactly 0 at 90. */
static void polar(float degrees, float *sine, float *cosine) {
    const double radians = RADIANS;
    *sine = (float)sin((double)degrees * radians);
    *cosine = (float)sin((90.0 - fabs((double)degrees)) * radians);
}

void direction_of_view(float degrees, float w[3]) {
    w[1] = 0.0f;
    polar(degrees, &w[0], &w[2]);
}

void direction_in_plane(float degrees, float w[3]) { direction_of_view(-degrees, w); }

void direction_across(float degrees, float w[3]) {
    w[0] = 0.0f;
    polar(degrees, &w[1], &w[2]);
}

typedef struct Evaluation {
    const WeftPlotModel *model;
    const float *wo;
    const float (*wi)[3];
    float (*f)[3];
    int count, walks;
} Evaluation;

enum { BLOCK = 64 };

/* Moves w by up to a degree, as a point of the unit square selects. */
static void move(const float w[3], float u, float v, float moved[3]) {
    float radius = 0.0175f * sqrtf(u), angle = 2.0f * PI_FLOAT * v;
    moved[0] = w[0] + radius * cosf(angle);
    moved[1] = w[1] + radius * sinf(angle);
    moved[2] = fmaxf(w[2] + radius * cosf(angle + 2.0f), 1e-4f);
    float length = sqrtf(moved[0] * moved[0] + moved[1] * moved[1] + moved[2] * moved[2]);
    for (int c = 0; c < 3; c++) moved[c] /= length;
}

static void eval_mean(const Evaluation *self, const float wi[3], float f[3]) {
    double sum[3] = {0.0};
    for (int at = 0; at < self->walks; at += BLOCK) {
        float near[BLOCK][3], value[BLOCK][3];
        int count = self->walks - at < BLOCK ? self->walks - at : BLOCK;
        for (int k = 0; k < count; k++) {
            uint32_t n = (uint32_t)(at + k);
            move(wi, unit_float(hash_combine(n, 1)), unit_float(hash_combine(n, 2)), near[k]);
        }
        weft_reflection_eval(self->model->reflection, WEFT_PART_ALL, self->wo, count, (const float(*)[3])near, value);
        for (int k = 0; k < count; k++)
            for (int c = 0; c < 3; c++) sum[c] += (double)value[k][c] / self->walks;
    }
    for (int c = 0; c < 3; c++) f[c] = wi[2] > 0.0f ? (float)sum[c] : 0.0f;
}

static void eval_block(void *user, int item, int thread) {
    (void)thread;
    const Evaluation *self = user;
    int from = item * BLOCK, count = self->count - from < BLOCK ? self->count - from : BLOCK;
    if (self->walks > 1)
        for (int k = 0; k < count; k++) eval_mean(self, self->wi[from + k], self->f[from + k]);
    else
        weft_reflection_eval(self->model->reflection, WEFT_PART_ALL, self->wo, count, self->wi + from, self->f + from);
}

void making_eval(const WeftPlotModel *model, const float wo[3], int count, const float (*wi)[3], int walks,
                 float (*f)[3]) {
    bool random = model->lobe && weft_lobe_info(model->lobe->lobe)->traits & WEFT_LOBE_REFERENCE;
    Evaluation evaluation = {model, wo, wi, f, count, random ? walks : 1};
    parallel_for(count > BLOCK ? 0 : 1, (count + BLOCK - 1) / BLOCK, eval_block, &evaluation);
    for (int k = 0; k < count; k++)
        for (int c = 0; c < 3; c++)
            if (!isfinite(f[k][c])) f[k][c] = NAN;
}

int making_walks(const Making *making, int walks) { return making->desc->quick ? (walks + 7) / 8 : walks; }

float making_value(const Making *making, const float color[3]) {
    if (making->desc->channel != WEFT_PLOT_LUMINANCE) return color[making->desc->channel - WEFT_PLOT_RED];
    return 0.2126f * color[0] + 0.7152f * color[1] + 0.0722f * color[2];
}

const char *making_f(const Making *making) { return making->desc->cosine ? "f cos \xce\xb8\xe1\xb5\xa2" : "f"; }

static int compare_floats(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

void plane_angles(float mirror, float theta[PLANE_ANGLES]) {
    int n = 0;
    for (int k = 0; k < PLANE_STEPS; k++) theta[n++] = 180.0f * ((float)k + 0.5f) / (float)PLANE_STEPS - 90.0f;
    theta[n++] = mirror;
    for (int k = 0; k < PLANE_NEAR; k++) {
        float step = ldexpf(0.71f, -k);
        theta[n++] = fmaxf(mirror - step, -89.9f);
        theta[n++] = fminf(mirror + step, 89.9f);
    }
    qsort(theta, PLANE_ANGLES, sizeof *theta, compare_floats);
}
