/* bake_form.c - a closed form of E: a polynomial, or the exponential of one, of the least largest error
 *
 * Weights that grow with the errors make the least squares of a polynomial its best uniform fit: Charles Lawson,
 * "Contributions to the Theory of Linear Least Maximum Approximation", 1961. An exponential is made linear anew in each
 * round (Gauss and Newton). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/matrix.h"
#include "base/memory.h"
#include "base/thread.h"
#include "measure/bake/bake_texels.h"

enum { COLUMNS = 36, ROWS = 24, CHECK_COLUMNS = 61, CHECK_ROWS = 41, DEGREE = 6, ROUNDS = 40, FIRST_ROUNDS = 8 };

/* E at points of a grid: cosines denser towards grazing, and roughnesses denser towards both ends. */
typedef struct FormGrid {
    int columns, rows;
    double cos_o[CHECK_COLUMNS], roughness[CHECK_ROWS];
    double e[CHECK_COLUMNS * CHECK_ROWS];
} FormGrid;

typedef struct FormWork {
    const WeftAlbedoFormDesc *desc;
    Lobe lobe;
    FormGrid fit, check;
    double weight[COLUMNS * ROWS];
} FormWork;

static void grid_place(FormGrid *grid, int columns, int rows, double lowest, double offset) {
    grid->columns = columns;
    grid->rows = rows;
    for (int k = 0; k < columns; k++) {
        const double t = (k + offset) / (columns - 1 + 2.0 * offset);
        grid->cos_o[k] = t * t;
    }
    for (int k = 0; k < rows; k++) {
        const double t = 0.5 - 0.5 * (cos)((acos)(-1.0) * (k + offset) / (rows - 1 + 2.0 * offset));
        grid->roughness[k] = lowest + (1.0 - lowest) * t;
    }
}

/* Computes E at one point, the grids' one after the other. */
static void point_find(void *user, int x, int y, int thread) {
    FormWork *work = user;
    (void)y;
    (void)thread;
    const int first = work->fit.columns * work->fit.rows, n = x < first ? x : x - first;
    FormGrid *grid = x < first ? &work->fit : &work->check;
    const WeftTableForm form = {0};
    const float z = (float)fmax(grid->cos_o[n % grid->columns], 1e-6);
    const Dir wo = {(float)(sqrt)(1.0 - (double)z * (double)z), 0.0f, z};
    Lobe lobe = work->lobe;
    double error;
    lobe_set(&lobe, 0, form_parameter(&form, lobe.id, grid->roughness[n / grid->columns]));
    const Albedo e = albedo_quadrature_error(&lobe, wo, 1e-4, &error);
    grid->e[n] = work->desc->part == WEFT_TABLE_F0    ? (double)e.f0
                 : work->desc->part == WEFT_TABLE_F90 ? (double)e.f90
                                                      : (double)(e.f0 + e.f90 * lobe_second(&lobe, 1.0f, 1.0f));
}

static int term_count(const WeftAlbedoForm *form) { return (form->across + 1) * (form->along + 1); }

/* Fills the products of powers at a point. */
static void powers(const WeftAlbedoForm *form, double cos_o, double roughness, double *row) {
    const double x = form->root ? (sqrt)(cos_o) : cos_o;
    double along = 1.0;
    for (int j = 0; j <= form->along; j++, along *= roughness) {
        double across = along;
        for (int i = 0; i <= form->across; i++, across *= x) row[j * (form->across + 1) + i] = across;
    }
}

float weft_form_at(const WeftAlbedoForm *form, float cos_o, float roughness) {
    const float x = form->root ? (sqrtf)(cos_o) : cos_o;
    float p = 0.0f;
    for (int j = form->along; j >= 0; j--) {
        float row = 0.0f;
        for (int i = form->across; i >= 0; i--) row = row * x + form->terms[j * (form->across + 1) + i];
        p = p * roughness + row;
    }
    return form->exponential ? (expf)(p) : (fmaxf)(p, 0.0f);
}

/* Finds the largest error over a grid. */
static void error_find(const FormGrid *grid, WeftAlbedoForm *form) {
    form->error = 0.0;
    for (int n = 0; n < grid->columns * grid->rows; n++) {
        const float cos_o = (float)grid->cos_o[n % grid->columns], r = (float)grid->roughness[n / grid->columns];
        const double error = fabs((double)weft_form_at(form, cos_o, r) - grid->e[n]);
        if (error <= form->error) continue;
        form->error = error;
        form->cos_o = cos_o;
        form->roughness = r;
    }
}

/* Solves the least squares of one round. `terms` has the last one's solution, from which an exponential starts. */
static bool round_solve(const FormWork *work, const WeftAlbedoForm *form, bool first, double *terms) {
    const FormGrid *grid = &work->fit;
    const int count = term_count(form);
    double normal[WEFT_FORM_TERMS * WEFT_FORM_TERMS] = {0}, right[WEFT_FORM_TERMS] = {0}, row[WEFT_FORM_TERMS];
    for (int n = 0; n < grid->columns * grid->rows; n++) {
        double target = grid->e[n], slope = 1.0;
        powers(form, grid->cos_o[n % grid->columns], grid->roughness[n / grid->columns], row);
        if (form->exponential && first) {
            slope = fmax(target, 1e-3);
            target = (log)(slope);
        } else if (form->exponential) {
            double p = 0.0;
            for (int k = 0; k < count; k++) p += terms[k] * row[k];
            slope = fmax((exp)(fmin(p, 20.0)), 1e-4);
            target = p + fmax(fmin((target - slope) / slope, 2.0), -2.0);
        }
        const double weight = work->weight[n] * slope * slope;
        for (int k = 0; k < count; k++) {
            right[k] += weight * row[k] * target;
            for (int m = k; m < count; m++) normal[k * count + m] += weight * row[k] * row[m];
        }
    }
    for (int k = 0; k < count; k++) normal[k * count + k] *= 1.0 + 1e-12;
    if (!matrix_factor(count, normal, count) || !matrix_solve(count, normal, count, 1, right, count)) return false;
    memcpy(terms, right, (size_t)count * sizeof *terms);
    return true;
}

/* Fits a form of given degrees; rounds end early where it is far off. */
static void form_fit(FormWork *work, double enough, WeftAlbedoForm *form) {
    const FormGrid *grid = &work->fit;
    const int points = grid->columns * grid->rows;
    double terms[WEFT_FORM_TERMS] = {0};
    WeftAlbedoForm best = *form;
    best.error = HUGE_VAL;
    for (int n = 0; n < points; n++) work->weight[n] = 1.0 / points;
    for (int round = 0; round < ROUNDS && round_solve(work, form, round == 0, terms); round++) {
        double sum = 0.0;
        for (int k = 0; k < term_count(form); k++) form->terms[k] = (float)terms[k];
        error_find(grid, form);
        if (!(form->error < HUGE_VAL)) break;
        if (form->error < best.error) best = *form;
        if (round == FIRST_ROUNDS && best.error > 3.0 * enough) break;
        for (int n = 0; n < points && round >= 2; n++) {
            const float cos_o = (float)grid->cos_o[n % grid->columns], r = (float)grid->roughness[n / grid->columns];
            work->weight[n] *= 1e-4 + fabs((double)weft_form_at(form, cos_o, r) - grid->e[n]) / form->error;
            sum += work->weight[n];
        }
        for (int n = 0; n < points && sum > 0.0; n++) work->weight[n] /= sum;
    }
    *form = best;
    if (form->error < HUGE_VAL) error_find(&work->check, form);
}

/* Tries forms by their number of terms, a root counting as half of one and an exponential as two. */
static void form_search(FormWork *work, double enough, WeftAlbedoForm *out) {
    for (int cost = 4; cost <= 2 * WEFT_FORM_TERMS + 5 && out->error > enough; cost++)
        for (int across = 1; across <= DEGREE; across++)
            for (int along = 0; along <= DEGREE; along++)
                for (int kind = 0; kind < 4; kind++) {
                    WeftAlbedoForm form = {
                        .exponential = kind >> 1, .root = kind & 1, .across = across, .along = along};
                    if (2 * term_count(&form) + 4 * form.exponential + form.root != cost) continue;
                    form_fit(work, enough, &form);
                    if (form.error < out->error) *out = form;
                }
}

static WeftResult desc_check(const WeftAlbedoFormDesc *desc, WeftError *error) {
    const WeftLobeInfo *info = desc->lobe ? weft_lobe_info(desc->lobe->lobe) : NULL;
    if (!info) return fail(error, WEFT_MESSAGE_DESC, "form", "it needs a lobe");
    if (!(desc->lowest >= 0.0 && desc->lowest <= 0.9) || !(desc->error >= 0.0) ||
        (unsigned)desc->part >= WEFT_TABLE_PARTS)
        return fail(error, WEFT_MESSAGE_DESC, "form", "error %g, from roughness %g", desc->error, desc->lowest);
    const char *name = info->param_count ? info->params[0].name : "";
    if (strcmp(name, "alpha") != 0 && strcmp(name, "roughness") != 0)
        return fail(error, WEFT_MESSAGE_DESC, info->id, "its first parameter is no roughness, over which a form runs");
    return WEFT_OK;
}

WeftResult weft_bake_form(const WeftAlbedoFormDesc *desc, WeftAlbedoForm *out, WeftError *error) {
    *out = (WeftAlbedoForm){.error = HUGE_VAL};
    WeftResult result = desc_check(desc, error);
    FormWork *work = result == WEFT_OK ? alloc_array(1, sizeof *work) : NULL;
    if (result != WEFT_OK) return result;
    if (!work) return fail(error, WEFT_MESSAGE_MEMORY, "form", NULL);
    work->desc = desc;
    lobe_of(desc->lobe, &work->lobe);
    grid_place(&work->fit, COLUMNS, ROWS, desc->lowest, 0.0);
    grid_place(&work->check, CHECK_COLUMNS, CHECK_ROWS, desc->lowest, 0.25);
    result = bake_texels(COLUMNS * ROWS + CHECK_COLUMNS * CHECK_ROWS, 1, desc->threads, desc->progress, desc->user,
                         point_find, work);
    if (result == WEFT_OK) form_search(work, desc->error > 0.0 ? desc->error : 0.01, out);
    free(work);
    return result;
}
