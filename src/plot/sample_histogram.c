/* sample_histogram.c - histogram of a lobe's samples beside its pdf, and their ratio */
#include <math.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/pi.h"
#include "base/random.h"
#include "measure/check/chi_square.h"
#include "plot/making.h"
#include "shading/lobe/lobe_tables.h"

/* Cells over phi and theta; POINTS along each side of one, at which the pdf is evaluated. */
enum { PHIS = 60, THETAS = 30, POINTS = 12, COUNT = 1 << 20, COUNT_QUICK = 1 << 17, TESTED = 60000 };

typedef struct Histogram {
    int count, points;
    float *seen, *pdf, *ratio; /* 1/sr, 1/sr, 1 */
    double integral, weight;   /* of the pdf; mean of f cos / pdf */
} Histogram;

static double cell_solid_angle(int row) {
    const double step = 0.5 * PI_DOUBLE / THETAS;
    return ((cos)(row * step) - (cos)((row + 1) * step)) * 2.0 * PI_DOUBLE / PHIS;
}

/* Returns the cell of a direction; phi runs from -180 degrees, and 0 is beyond the normal. */
static int cell_of(const float w[3]) {
    double theta = (atan2)(hypot((double)w[0], (double)w[1]), (double)w[2]), phi = atan2(-(double)w[1], -(double)w[0]);
    int row = (int)(theta / (0.5 * PI_DOUBLE) * THETAS);
    int column = (int)((phi / (2.0 * PI_DOUBLE) + 0.5) * PHIS);
    row = row < 0 ? 0 : row >= THETAS ? THETAS - 1 : row;
    column = column < 0 ? 0 : column >= PHIS ? PHIS - 1 : column;
    return row * PHIS + column;
}

static void draw_all(const WeftPlotModel *model, const float wo[3], Histogram *out) {
    double sum = 0.0;
    for (uint32_t k = 0; k < (uint32_t)out->count; k++) {
        /* u is stratified, v is hashed: that makes less noise in the histogram */
        float u[2] = {((float)k + unit_float(hash_combine(k, 11))) / (float)out->count,
                      unit_float(hash_combine(k, 12))};
        float wi[1][3], f[1][3];
        u[0] = fminf(u[0], 0.99999994f);
        float pdf = weft_lobe_sample(model->lobe, wo, u, wi[0]);
        if (!(pdf > 0.0f) || !(wi[0][2] > 0.0f)) continue;
        out->seen[cell_of(wi[0])] += 1.0f;
        weft_reflection_eval(model->reflection, WEFT_PART_ALL, wo, 1, (const float(*)[3])wi, f);
        float value = (0.2126f * f[0][0] + 0.7152f * f[0][1] + 0.0722f * f[0][2]) * wi[0][2] / pdf;
        if (isfinite(value)) sum += (double)value;
    }
    out->weight = sum / out->count;
}

/* Returns the mean of the pdf over a cell. */
static double cell_pdf(const WeftLobe *lobe, const float wo[3], int points, int row, int column) {
    double sum = 0.0;
    const double low = (cos)(0.5 * PI_DOUBLE * row / THETAS), high = (cos)(0.5 * PI_DOUBLE * (row + 1) / THETAS);
    for (int k = 0; k < points * points; k++) {
        const int down = k / points;
        double z = low + (high - low) * (down + 0.5) / points, s = (sqrt)(fmax(1.0 - z * z, 0.0));
        double phi = 2.0 * PI_DOUBLE * ((column + (k % points + 0.5) / points) / PHIS - 0.5);
        const float wi[3] = {(float)-(s * (cos)(phi)), (float)-(s * (sin)(phi)), (float)z};
        sum += (double)weft_lobe_pdf(lobe, wo, wi);
    }
    return sum / (points * points);
}

static void compare_all(const WeftPlotModel *model, const float wo[3], Histogram *out) {
    const float least = 50.0f; /* expected samples in a cell, below which the ratio is only noise */
    for (int row = 0; row < THETAS; row++)
        for (int k = 0; k < PHIS; k++) {
            const int at = row * PHIS + k;
            const double angle = cell_solid_angle(row), pdf = cell_pdf(model->lobe, wo, out->points, row, k);
            out->integral += pdf * angle;
            out->pdf[at] = (float)pdf;
            out->ratio[at] = (float)((double)out->seen[at] / (pdf * angle * out->count));
            if (!(pdf * angle * out->count >= (double)least)) out->ratio[at] = NAN;
            out->seen[at] = (float)((double)out->seen[at] / (angle * out->count));
        }
}

/* Returns p of the passport's chi-square test, whose bins are denser where the lobe is narrow; NAN on failure. */
static double test(const WeftLobe *given, float view, int count) {
    Bsdf *model = alloc_array(1, sizeof *model);
    ChiSquare found = {.p = (double)NAN};
    BsdfView look;
    if (!model) return (double)NAN;
    Lobe lobe;
    lobe_of(given, &lobe);
    bsdf_of_lobe(model, &lobe, true);
    model->rows = 1;
    model->values[0] = lobe.params[0];
    model->prepare(model, 0, grid_direction((cos)((double)view * RADIANS), 0.0), &look);
    if (!chi_square_measure(&look, count, 20, 7, &found)) found.p = (double)NAN;
    bsdf_free(model);
    free(model);
    return found.p;
}

static WeftPlotPanel *one_panel(Making *making, const char *label, const char *what, double view) {
    WeftPlotPanel *panel =
        making_panel(making, WEFT_PLOT_MAP, "%s: %s, \xce\xb8\xe2\x82\x92 = %g\xc2\xb0", label, what, view);
    making_axis(&panel->x, "\xcf\x86 from the mirror's side", "\xc2\xb0", -180.0f, 180.0f);
    making_axis(&panel->y, "\xce\xb8\xe1\xb5\xa2", "\xc2\xb0", 0.0f, 90.0f);
    return panel;
}

/* Sets one colour range for histogram and pdf. */
static void set_ranges(const Making *making, WeftPlotPanel *const panels[3]) {
    double most = 0.0;
    for (int k = 0; k < THETAS * PHIS; k++) most = fmax(most, (double)panels[1]->values[k]);
    if (!(most > 0.0)) most = 1.0;
    for (int k = 0; k < 2; k++) {
        making_axis(&panels[k]->z, "density", "1/sr", 0.0f, (float)most);
        if (!making->desc->logarithmic) continue;
        panels[k]->z.logarithmic = 1;
        panels[k]->z.high = (float)(pow)(10.0, (ceil)(log10(most)));
        panels[k]->z.low = panels[k]->z.high * 1e-4f;
    }
    making_axis(&panels[2]->z, "histogram / pdf", "", 0.7f, 1.3f);
    panels[2]->center = 1.0f;
}

static bool one_row(Making *making, int n, float view) {
    static const char *const words[3] = {"drawn", "pdf", "ratio"};
    WeftPlotPanel *panels[3];
    float *values[3], wo[3];
    for (int k = 0; k < 3; k++) {
        panels[k] = one_panel(making, making_label(making, n), words[k], (double)view);
        values[k] = making_grid(making, panels[k], PHIS, THETAS, 1);
        if (!values[k]) return false;
    }
    const bool quick = making->desc->quick != 0;
    Histogram found = {.count = quick ? COUNT_QUICK : COUNT,
                       .points = quick ? 4 : POINTS,
                       .seen = values[0],
                       .pdf = values[1],
                       .ratio = values[2]};
    direction_of_view(view, wo);
    draw_all(&making->desc->models[n], wo, &found);
    compare_all(&making->desc->models[n], wo, &found);
    set_ranges(making, panels);
    making_figure(panels[0], "samples", "", found.count);
    making_figure(panels[0], "mean f cos / pdf", "", found.weight);
    making_figure(panels[1], "integral", "", found.integral);
    making_figure(panels[2], "p of chi-square", "",
                  test(making->desc->models[n].lobe, view, quick ? TESTED / 6 : TESTED));
    return true;
}

WeftResult kind_samples(Making *making) {
    const int views = making_view_count(making), count = making->desc->count;
    if (!making_panels(making, 3 * views * count, 3)) return making_short(making);
    making_models(making);
    for (int n = 0; n < count; n++)
        for (int k = 0; k < views; k++)
            if (!one_row(making, n, making_view(making, k, 60.0f))) return making_short(making);
    return WEFT_OK;
}
