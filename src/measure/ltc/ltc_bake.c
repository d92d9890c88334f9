#include <stdatomic.h>
#include <stdlib.h>

#include "measure/ltc/ltc_bake.h"

#include "base/fail.h"
#include "base/memory.h"
#include "base/pi.h"
#include "base/thread.h"
#include "measure/bsdf/draw.h"
#include "measure/bsdf/grid.h"
#include "measure/ltc/ltc_fit.h"

/* The error is measured on more directions than the fit uses. */
enum { FIT_CELLS = 96, ERROR_CELLS = 192 };

/* A lobe with a smaller E reflects nothing whose shape could matter, and underflow is near. */
static const double nothing = 1e-20;

bool ltc_create(WeftLtc *ltc) {
    ltc->texels = alloc_array((size_t)ltc_cells(ltc) * WEFT_LTC_CHANNELS, sizeof(float));
    return ltc->texels != NULL;
}

float ltc_cos_o(const WeftLtc *ltc, int column) {
    float x = (float)column / (float)(ltc->columns - 1);
    return max(x * x, 1e-5f); /* a lobe has no value at the horizon itself */
}

Lobe ltc_lobe(const WeftLtc *ltc, int row) {
    Lobe lobe = ltc->lobe;
    float root = sqrt(ltc->low);
    if (ltc->rows > 1) root = mix(root, sqrt(ltc->high), (float)row / (float)(ltc->rows - 1));
    if (weft_lobe_info(lobe.id)->param_count) lobe_set(&lobe, 0, root * root);
    return lobe;
}

LtcTable ltc_table_ref(const WeftLtc *ltc) {
    return (LtcTable){ltc->texels, ltc->rows, ltc->columns, sqrt(ltc->low), sqrt(ltc->high)};
}

bool ltc_isotropic(const WeftLtc *ltc) {
    if (!(weft_lobe_info(ltc->lobe.id)->traits & TRAIT_ANISOTROPIC)) return true;
    Draw draw = draw_start(5, 0);
    for (int k = 0; k < 1000; k++) {
        Lobe lobe = ltc_lobe(ltc, k % ltc->rows);
        double z[2], phi = 0.0, f[2];
        for (int d = 0; d < 2; d++) z[d] = 1.0 - (double)draw_unit(&draw);
        double between = 2.0 * PI_DOUBLE * (double)draw_unit(&draw);
        for (int rotation = 0; rotation < 2; rotation++, phi = 2.0 * PI_DOUBLE * (double)draw_unit(&draw))
            f[rotation] = (double)lobe_eval(
                &lobe, angles_between(grid_direction(z[0], phi), grid_direction(z[1], phi + between)));
        /* floats leave a few thousandths where a sharp lobe is steep */
        if (fabs(f[0] - f[1]) > 0.02 * fmax(f[0], f[1]) + 1e-6) return false;
    }
    return true;
}

typedef struct Bake {
    WeftLtc *ltc;
    int diagonal;
    atomic_bool short_of_memory;
} Bake;

static float *texel(const WeftLtc *ltc, int plane, int row, int column) {
    return &ltc->texels[(plane * ltc->rows + row) * ltc->columns + column];
}

static LtcEntries entries(const WeftLtc *ltc, int row, int column) {
    return (LtcEntries){*texel(ltc, WEFT_LTC_Z, row, column), *texel(ltc, WEFT_LTC_Q, row, column),
                        *texel(ltc, WEFT_LTC_B, row, column), *texel(ltc, WEFT_LTC_R, row, column)};
}

static void set_entries(WeftLtc *ltc, int row, int column, LtcEntries e) {
    *texel(ltc, WEFT_LTC_Z, row, column) = e.z;
    *texel(ltc, WEFT_LTC_Q, row, column) = e.q;
    *texel(ltc, WEFT_LTC_B, row, column) = e.b;
    *texel(ltc, WEFT_LTC_R, row, column) = e.r;
}

/* Bakes a cell. The fit starts from the neighbours towards rough and towards normal incidence, which belong
 * to earlier diagonals. */
static bool bake_cell(WeftLtc *ltc, int row, int column) {
    LtcTarget coarse, fine;
    bool made = ltc_target_create(&coarse, FIT_CELLS), both = ltc_target_create(&fine, ERROR_CELLS) && made;
    if (both) {
        Lobe lobe = ltc_lobe(ltc, row);
        LtcEntries starts[3];
        int count = 0;
        if (column + 1 < ltc->columns) starts[count++] = entries(ltc, row, column + 1);
        if (row + 1 < ltc->rows) starts[count++] = entries(ltc, row + 1, column);
        coarse.level = fine.level = ltc->level;
        ltc_target_fill(&coarse, ltc_cos_o(ltc, column));
        ltc_target_fill(&fine, ltc_cos_o(ltc, column));
        ltc_target_lobe(&coarse, &lobe, ltc->f0, ltc->second);
        ltc_target_lobe(&fine, &lobe, ltc->f0, ltc->second);
        LtcEntries found = count ? starts[count - 1] : (LtcEntries){1.0f, 1.0f, 0.0f, ltc->level ? 0.0f : 1.0f};
        if (coarse.e > nothing && fine.e > nothing) {
            starts[count++] = ltc_guess(&coarse);
            found = ltc_fit(&coarse, starts, count, ltc->norm);
            float above = ltc_above(ltc_of(found.z, found.q, found.b, found.r, fine.o.z), fine.o);
            *texel(ltc, WEFT_LTC_AMPLITUDE, row, column) = (float)fine.e0 / above;
            *texel(ltc, WEFT_LTC_AMPLITUDE_F90, row, column) = (float)fine.e90 / above;
            *texel(ltc, WEFT_LTC_ERROR, row, column) = (float)ltc_error(&fine, found, 1);
        }
        set_entries(ltc, row, column, found);
    }
    ltc_target_free(&coarse);
    ltc_target_free(&fine);
    return both;
}

/* Bakes cell `item` of a diagonal: rows from the last, columns from normal incidence. */
static void bake_item(void *user, int item, int thread) {
    Bake *bake = user;
    WeftLtc *ltc = bake->ltc;
    int first = bake->diagonal < ltc->columns ? 0 : bake->diagonal - ltc->columns + 1;
    int up = first + item, left = bake->diagonal - up;
    if (!bake_cell(ltc, ltc->rows - 1 - up, ltc->columns - 1 - left)) bake->short_of_memory = true;
}

/* Extrapolates q, b and r to normal incidence, where only z matters, in a straight line over the nodes of the columns
 * beside it, since interpolation with the next column reads them. If the lobe reflects nothing there, z is copied. */
static void continue_to_normal(WeftLtc *ltc, int row) {
    int last = ltc->columns - 1;
    LtcEntries own = entries(ltc, row, last), a = entries(ltc, row, last - 1), b = a;
    if (last > 1) b = entries(ltc, row, last - 2);
    bool none = !(*texel(ltc, WEFT_LTC_AMPLITUDE, row, last) + *texel(ltc, WEFT_LTC_AMPLITUDE_F90, row, last) > 0.0f);
    set_entries(
        ltc, row, last,
        (LtcEntries){none ? a.z : own.z, max(2.0f * a.q - b.q, 0.0f), 2.0f * a.b - b.b, max(2.0f * a.r - b.r, 0.0f)});
}

WeftResult ltc_bake(WeftLtc *ltc, const WeftLtcDesc *desc, WeftError *error) {
    Bake bake = {.ltc = ltc};
    int diagonals = ltc->rows + ltc->columns - 1, done = 0;
    for (bake.diagonal = 0; bake.diagonal < diagonals; bake.diagonal++) {
        int d = bake.diagonal, first = d < ltc->columns ? 0 : d - ltc->columns + 1;
        int last = d < ltc->rows ? d : ltc->rows - 1, items = last - first + 1;
        parallel_for(desc->threads, items, bake_item, &bake);
        if (bake.short_of_memory) return fail(error, WEFT_MESSAGE_MEMORY, "an LTC table", NULL);
        done += items;
        if (desc->progress && desc->progress(desc->user, (double)done / ltc_cells(ltc))) return WEFT_INTERRUPTED;
    }
    for (int row = 0; row < ltc->rows; row++) continue_to_normal(ltc, row);
    return WEFT_OK;
}
