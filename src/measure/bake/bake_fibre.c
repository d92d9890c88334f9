/* bake_fibre.c - kind "fibre-table": the numbers of the lobe fibre-table (fibre/fitted_table.h)
 *
 * Columns run from the horizon to normal incidence, rows are uniform in the logarithm of alpha over the range
 * of the lobe. */
#include <stdio.h>

#include "base/fail.h"
#include "fibre/fitted_table.h"
#include "measure/bake/bake_texels.h"

enum { SIDE_MOST = 64, ROUNDS = 60 };
static const double alpha_low = 0.19; /* the least alpha of the lobe */

/* Progress over two phases, solved sets and rounds: a phase ends when its count is full. */
typedef struct Counter {
    const WeftBakeDesc *desc;
    int phases;
    bool stopped;
} Counter;

static bool count(void *user, int done, int all) {
    Counter *counter = user;
    double fraction = (counter->phases + (double)done / all) / 2.0;
    if (done == all) counter->phases++;
    counter->stopped = counter->desc->progress && counter->desc->progress(counter->desc->user, fraction) != 0;
    return !counter->stopped;
}

WeftResult bake_fibre_table(const WeftBakeDesc *desc, WeftBakeInfo *info, WeftImage *out, WeftError *error) {
    Counter counter = {desc, 0, false};
    const FibreTableDesc table = {desc->width, desc->height, alpha_low, 1.0, ROUNDS, desc->threads, count, &counter};
    FitError off;
    if (desc->width < 2 || desc->height < 2 || desc->width > SIDE_MOST || desc->height > SIDE_MOST)
        return fail(error, WEFT_MESSAGE_DESC, "size", "%d x %d; a fibre-table has 2 to %d nodes a side", desc->width,
                    desc->height, SIDE_MOST);
    WeftResult result = weft_image_create(desc->width, desc->height, 4, WEFT_PIXEL_F32, out, error);
    if (result != WEFT_OK) return result;
    if (!fibre_table_fit(&table, out->pixels, &off)) {
        weft_image_free(out);
        *out = (WeftImage){0};
        return counter.stopped ? WEFT_INTERRUPTED : fail(error, WEFT_MESSAGE_MEMORY, "fibre-table", NULL);
    }
    snprintf(info->words, sizeof info->words,
             "functions of upright white fibres, sqrt(cos_o + 0.001) to the right, log alpha downwards from "
             "%g to 1; "
             "off by %.2f %% of R, %.1f %% at worst",
             table.low, 100.0 * off.mean, 100.0 * off.worst);
    snprintf(info->channels, sizeof info->channels, "A, h, g, k");
    info->error = off.albedo;
    return WEFT_OK;
}
