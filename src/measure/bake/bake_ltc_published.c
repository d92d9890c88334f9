/* bake_ltc_published.c - kind "ltc-fibre-published", the table of that lobe (fibre/truncated_walk.h)
 *
 * Columns are uniform in cos_o and rows in alpha, both from 0 to 1, with 0.01 as the least value. A texel is
 *
 *           ( a  0  b )
 *   M^-1 =  ( 0  a  0 )    and R,    f cos_i = R D,  D = a^2 w'_z / (pi |w'|^4),  w' = M^-1 wi
 *           ( 0  0  1 )
 *
 * with x along wo. R is counted. a and b have the least sum of |f cos_i - R D|^3 over the middles of cells of
 * equal theta and phi. The table was made in this way, from the roughest row to the first, by Tizian Zeltner,
 * Brent Burley, Matt Jen-Yuan Chiang, "Practical Multiple-Scattering Sheen Using Linearly Transformed
 * Cosines", SIGGRAPH Talks 2022. */
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>

#include <nlopt.h>

#include "base/fail.h"
#include "base/pi.h"
#include "base/thread.h"
#include "fibre/truncated_walk.h"
#include "measure/bake/bake_texels.h"

/* With fewer than `SEEN_LEAST` walks that leave upwards a texel has no shape: it keeps that of the row before. */
enum { WALKS = 1000000, SEEN_LEAST = 1000, EVALUATIONS_MOST = 2000, CHANNELS = 3 };
static const double least = 0.01;

typedef struct TalkTable {
    const WeftBakeDesc *desc;
    float *texels;
    atomic_int done;
    atomic_bool stopped, unfitted; /* unfitted: memory was short */
} TalkTable;

static double transformed(double a, double b, double theta, double phi) {
    double x = a * (sin)(theta) * (cos)(phi) + b * (cos)(theta), y = a * (sin)(theta) * (sin)(phi), z = (cos)(theta);
    double square = x * x + y * y + z * z;
    return a * a * z / (PI_DOUBLE * square * square);
}

static double cubes(unsigned n, const double *at, double *gradient, void *user) {
    const TruncatedSlab *slab = user;
    double sum = 0.0;
    for (int row = 0; row < TRUNCATED_SIDE; row++)
        for (int c = 0; c < TRUNCATED_SIDE; c++) {
            double d = transformed(at[0], at[1], truncated_theta(row), truncated_phi(c));
            double off = fabs(slab->reflected * d - slab->f[row][c]);
            sum += off * off * off;
        }
    return sum;
}

/* Fits from `at`. Returns false if memory is short. */
static bool fit(const TruncatedSlab *slab, double at[2]) {
    static const double low[] = {1e-3, -2.0}, high[] = {4.0, 2.0}, step[] = {0.1, 0.05};
    nlopt_opt method = nlopt_create(NLOPT_LN_NELDERMEAD, 2);
    if (!method) return false;
    nlopt_set_min_objective(method, cubes, (void *)slab);
    nlopt_set_lower_bounds(method, low);
    nlopt_set_upper_bounds(method, high);
    nlopt_set_initial_step(method, step);
    nlopt_set_maxeval(method, EVALUATIONS_MOST);
    nlopt_set_xtol_rel(method, 1e-6);
    double found, there[] = {at[0], at[1]};
    if (nlopt_optimize(method, there, &found) > 0) at[0] = there[0], at[1] = there[1];
    nlopt_destroy(method);
    return true;
}

static double along(int k, int count) { return fmax((double)k / (count - 1), least); }

/* Bakes one column, from the roughest row to the first. At normal incidence x has no direction, and b is 0. */
static void column(void *user, int x, int thread) {
    TalkTable *table = user;
    const WeftBakeDesc *desc = table->desc;
    double at[2] = {1.0, 0.0};
    for (int row = desc->height - 1; row >= 0 && !atomic_load(&table->stopped) && !atomic_load(&table->unfitted);
         row--) {
        TruncatedSlab slab;
        truncated_walk(along(row, desc->height), along(x, desc->width), WALKS, &slab);
        if (slab.seen >= SEEN_LEAST && !fit(&slab, at)) atomic_store(&table->unfitted, true);
        if (x == desc->width - 1) at[1] = 0.0;
        float *texel = table->texels + CHANNELS * (row * desc->width + x);
        texel[0] = (float)at[0], texel[1] = (float)at[1], texel[2] = (float)slab.reflected;
        int done = atomic_fetch_add(&table->done, 1) + 1;
        if (thread == 0 && desc->progress && desc->progress(desc->user, (double)done / (desc->width * desc->height)))
            atomic_store(&table->stopped, true);
    }
}

WeftResult bake_ltc_published(const WeftBakeDesc *desc, WeftBakeInfo *info, WeftImage *out, WeftError *error) {
    if (desc->width < 2 || desc->height < 2)
        return fail(error, WEFT_MESSAGE_DESC, "size", "%d x %d; it has at least 2 nodes a side", desc->width,
                    desc->height);
    WeftResult result = weft_image_create(desc->width, desc->height, CHANNELS, WEFT_PIXEL_F32, out, error);
    if (result != WEFT_OK) return result;
    TalkTable table = {.desc = desc, .texels = out->pixels};
    parallel_for(desc->threads, desc->width, column, &table);
    if (atomic_load(&table.stopped) || atomic_load(&table.unfitted)) {
        weft_image_free(out);
        *out = (WeftImage){0};
        return atomic_load(&table.unfitted) ? fail(error, WEFT_MESSAGE_MEMORY, "a fit", NULL) : WEFT_INTERRUPTED;
    }
    snprintf(info->words, sizeof info->words,
             "transformed cosines of upright white fibres by walks of at most 16 flakes, cos_o to the right, "
             "alpha downwards, from 0 to 1, with the error of R");
    snprintf(info->channels, sizeof info->channels, "a, b, R");
    info->error = 0.5 / (sqrt)((double)WALKS);
    return WEFT_OK;
}
