#include "cli/fit/fit_sheet.h"
#include "base/pi.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "cli/console/report.h"

/* A slice: theta_h from left to right, theta_d from the bottom up, 0 .. 90 degrees; colours are f cos_i, scaled
 * so that the 98th percentile of the data is white. */
enum { SIDE = 220, ROWS = 2, COLUMNS = 3, PANELS = 2 * ROWS * COLUMNS };
static const double azimuths[ROWS] = {90.0, 0.0};

/* Computes the directions of a pixel. Returns their number, which is 0 where one of them is below the horizon or
 * grazes. */
static int directions(int column, int row, double phi_d, float wo[3], float wi[1][3]) {
    const double quarter = 0.5 * PI_DOUBLE;
    double th = (column + 0.5) / SIDE * quarter, td = (SIDE - row - 0.5) / SIDE * quarter;
    double pd = phi_d / 90.0 * quarter, x = sin(td) * cos(pd), y = sin(td) * sin(pd), z = cos(td);
    const double i[3] = {cos(th) * x + sin(th) * z, y, cos(th) * z - sin(th) * x};
    const double h[3] = {sin(th), 0.0, cos(th)};
    for (int c = 0; c < 3; c++) {
        wi[0][c] = (float)i[c];
        wo[c] = (float)(2.0 * z * h[c] - i[c]);
    }
    return wo[2] > 0.1736f && wi[0][2] > 0.1736f;
}

static WeftResult draw(const WeftReflection *drawn, double phi_d, WeftImage *out, WeftError *error) {
    WeftResult result = weft_image_create(SIDE, SIDE, 4, WEFT_PIXEL_F32, out, error);
    for (int k = 0; k < SIDE * SIDE && result == WEFT_OK; k++) {
        float wo[3], wi[1][3], f[1][3];
        float *pixel = (float *)out->pixels + (size_t)4 * (size_t)k;
        if (!directions(k % SIDE, k / SIDE, phi_d, wo, wi)) continue;
        weft_reflection_eval(drawn, WEFT_PART_ALL, wo, 1, (const float(*)[3])wi, f);
        for (int c = 0; c < 3; c++) pixel[c] = f[0][c] * wi[0][2];
        pixel[3] = 1.0f;
    }
    return result;
}

/* Computes the angles theta_h, theta_d and |phi_d| of the half vector and difference vector, each as a fraction of 90
 * degrees. */
static void half_difference(const float wo[3], const float wi[3], double at[3]) {
    const double quarter = 0.5 * PI_DOUBLE;
    double h[3], d[3], length = 0.0;
    for (int c = 0; c < 3; c++) h[c] = (double)wo[c] + (double)wi[c], length += h[c] * h[c];
    for (int c = 0; c < 3; c++) h[c] /= sqrt(length);
    double flat = hypot(h[0], h[1]), x = flat > 1e-9 ? h[0] / flat : 1.0, y = flat > 1e-9 ? h[1] / flat : 0.0;
    d[0] = h[2] * (x * (double)wi[0] + y * (double)wi[1]) - flat * (double)wi[2];
    d[1] = x * (double)wi[1] - y * (double)wi[0];
    d[2] = flat * (x * (double)wi[0] + y * (double)wi[1]) + h[2] * (double)wi[2];
    double phi = fabs(atan2(d[1], d[0]));
    at[0] = acos(fmin(h[2], 1.0)) / quarter;
    at[1] = acos(fmin(fmax(d[2], 0.0), 1.0)) / quarter;
    at[2] = fmin(phi, 2.0 * quarter - phi) / quarter;
}

enum { CELLS = 30 };

/* Draws the mean over the samples in each cell of a slice; pixels of cells without samples stay empty. */
static WeftResult draw_samples(const WeftData *data, const WeftReflection *drawn, double phi_d, WeftImage *out,
                               WeftError *error) {
    float sum[CELLS][CELLS][4] = {{{0.0f}}};
    for (int k = 0; k < weft_data_count(data, NULL); k++) {
        float wo[3], wi[1][3], f[1][3];
        double at[3];
        weft_data_sample(data, k, wo, wi[0], f[0]);
        half_difference(wo, wi[0], at);
        if ((phi_d > 45.0) != (at[2] > 0.5)) continue;
        if (drawn) weft_reflection_eval(drawn, WEFT_PART_ALL, wo, 1, (const float(*)[3])wi, f);
        float *cell = sum[(int)fmin(at[1] * CELLS, CELLS - 1)][(int)fmin(at[0] * CELLS, CELLS - 1)];
        for (int c = 0; c < 3; c++) cell[c] += f[0][c] * wi[0][2];
        cell[3] += 1.0f;
    }
    WeftResult result = weft_image_create(SIDE, SIDE, 4, WEFT_PIXEL_F32, out, error);
    for (int k = 0; k < SIDE * SIDE && result == WEFT_OK; k++) {
        const float *cell = sum[(SIDE - 1 - k / SIDE) * CELLS / SIDE][k % SIDE * CELLS / SIDE];
        float *pixel = (float *)out->pixels + (size_t)4 * (size_t)k;
        for (int c = 0; c < 3 && cell[3] > 0.0f; c++) pixel[c] = cell[c] / cell[3];
        pixel[3] = cell[3] > 0.0f ? 1.0f : 0.0f;
    }
    return result;
}

/* Returns the brightness that 98 of 100 pixels of the data do not exceed. */
static float bright(const WeftImage *image) {
    float low = 0.0f, high = 1e4f;
    for (int halving = 0; halving < 40; halving++) {
        float middle = 0.5f * (low + high);
        int above = 0, all = 0;
        for (int k = 0; k < SIDE * SIDE; k++) {
            const float *pixel = (const float *)image->pixels + (size_t)4 * (size_t)k;
            all += pixel[3] > 0.0f;
            above += fmaxf(pixel[0], fmaxf(pixel[1], pixel[2])) > middle;
        }
        if (50 * above > all)
            low = middle;
        else
            high = middle;
    }
    return fmaxf(high, 1e-6f);
}

/* Rounds x up to one significant digit: 0.033 is 0.04. */
static float to_figure(float x) {
    float unit = powf(10.0f, floorf(log10f(x)));
    return ceilf(x / unit) * unit;
}

typedef struct Slices {
    WeftImage linear[ROWS][COLUMNS], shown[ROWS][COLUMNS], difference[ROWS][COLUMNS];
    float scale;  /* what is white */
    float differ; /* where the colours of differences end */
} Slices;

/* Draws all slices. `samples` is NULL if every function can be evaluated for any directions. */
static WeftResult draw_all(Slices *all, const WeftData *samples, WeftReflection *const drawn[COLUMNS],
                           WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int r = 0; r < ROWS && result == WEFT_OK; r++) {
        for (int c = 0; c < COLUMNS && result == WEFT_OK; c++)
            result = samples ? draw_samples(samples, drawn[c], azimuths[r], &all->linear[r][c], error)
                             : draw(drawn[c], azimuths[r], &all->linear[r][c], error);
        if (r == 0 && result == WEFT_OK) {
            all->scale = bright(&all->linear[0][0]);
            all->differ = to_figure(0.25f * all->scale);
        }
        for (int c = 0; c < COLUMNS && result == WEFT_OK; c++) {
            result =
                weft_image_tonemap(&all->linear[r][c], WEFT_TONEMAP_NONE, -log2f(all->scale), &all->shown[r][c], error);
            if (c > 0 && result == WEFT_OK)
                result = weft_difference_image(&all->linear[r][c], &all->linear[r][0], all->differ,
                                               &all->difference[r][c], error);
        }
    }
    return result;
}

static WeftResult compose(const Slices *all, const char *path, const WeftFit *fit, const char *output,
                          WeftError *error) {
    char names[COLUMNS][64], notes[ROWS][64], caption[320];
    WeftPanel panels[PANELS] = {{0}};
    WeftImage sheet = {0};
    snprintf(names[0], sizeof names[0], "data");
    snprintf(names[1], sizeof names[1], "%s, error %.4f", weft_lobe_info(fit->fitted[0].lobe.lobe)->id,
             fit->fitted[0].error);
    snprintf(names[2], sizeof names[2], "baseline ggx, error %.4f", fit->baseline.error);
    for (int r = 0; r < ROWS; r++) {
        snprintf(notes[r], sizeof notes[r], "phi_d %.0f\xc2\xb0", azimuths[r]);
        WeftPanel *shown = panels + (ptrdiff_t)2 * r * COLUMNS, *difference = shown + COLUMNS;
        for (int c = 0; c < COLUMNS; c++)
            shown[c] = (WeftPanel){.image = &all->shown[r][c], .title = names[c], .note = notes[r]};
        difference[0] = (WeftPanel){.scale = all->differ,
                                    .title = "difference from the data",
                                    .note = "of f cos, the channel that differs most"};
        difference[1] = (WeftPanel){.image = &all->difference[r][1], .title = "fit \xe2\x88\x92 data"};
        difference[2] = (WeftPanel){.image = &all->difference[r][2], .title = "baseline \xe2\x88\x92 data"};
    }
    snprintf(caption, sizeof caption, "%.200s: f cos, theta_h to the right, theta_d upwards, 0 to 90\xc2\xb0", path);
    const WeftSheetDesc desc = {.caption = caption, .panels = panels, .count = PANELS, .columns = COLUMNS};
    WeftResult result = weft_sheet_compose(&desc, &sheet, error);
    if (result == WEFT_OK) result = weft_image_write(output, &sheet, error);
    weft_image_free(&sheet);
    return result;
}

int fit_sheet_write(const char *path, const WeftData *data, const WeftFit *fit, const char *output) {
    WeftError error;
    Slices all = {.scale = 1.0f};
    WeftReflection *of[COLUMNS] = {NULL};
    const bool whole = weft_reflection_readable(path) != 0;
    WeftResult result = whole ? weft_reflection_read(path, &of[0], &error) : WEFT_OK;
    if (result == WEFT_OK) result = weft_fitted_reflection(&fit->fitted[0], &of[1], &error);
    if (result == WEFT_OK) result = weft_fitted_reflection(&fit->baseline, &of[2], &error);
    if (result == WEFT_OK) result = draw_all(&all, whole ? NULL : data, of, &error);
    if (result == WEFT_OK) result = compose(&all, path, fit, output, &error);
    for (int r = 0; r < ROWS; r++)
        for (int c = 0; c < COLUMNS; c++) {
            weft_image_free(&all.linear[r][c]);
            weft_image_free(&all.shown[r][c]);
            weft_image_free(&all.difference[r][c]);
        }
    for (int c = 0; c < COLUMNS; c++) weft_reflection_free(of[c]);
    return result == WEFT_OK ? 0 : report_error(&error);
}
