/* bake_solved.c - kind "fibre-truth": what the solved slab of fibres reflects (fibre/slab.h), without noise
 *
 * R over cos_o and alpha, and T, the transmitted light. The density is that of the lobe, if one is given. */
#include <stdio.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/thread.h"
#include "fibre/slab.h"
#include "measure/bake/bake_texels.h"

typedef struct SolvedSets {
    const WeftBakeDesc *desc;
    WeftImage *out;
    double density;
    const double *mu;    /* cos_o of each column, or row if transposed */
    const double *alpha; /* alpha of each row, or column if transposed */
    int mus, alphas;
    double *found;                 /* [alphas][2][mus] */
    bool short_of_memory, stopped; /* set from any thread, never cleared */
    int done;
} SolvedSets;

static void raise(bool *flag) { __atomic_store_n(flag, true, __ATOMIC_RELAXED); }
static bool raised(const bool *flag) { return __atomic_load_n(flag, __ATOMIC_RELAXED); }

static void solve(void *user, int item, int thread) {
    SolvedSets *t = user;
    if (raised(&t->short_of_memory) || raised(&t->stopped)) return;
    double *up = t->found + (size_t)item * 2 * (size_t)t->mus;
    SlabEffort effort = slab_effort(t->alpha[item]);
    effort.halvings += 4;
    if (!slab_mode(&(Slab){t->alpha[item], 1.0, t->density}, effort, 0, 1, t->mus, t->mu,
                   &(Layered){.up = up, .down = up + t->mus}, NULL))
        raise(&t->short_of_memory);
    int done = __atomic_add_fetch(&t->done, 1, __ATOMIC_RELAXED);
    if (thread == 0 && t->desc->progress && t->desc->progress(t->desc->user, (double)done / t->alphas))
        raise(&t->stopped);
}

WeftResult bake_solved(const WeftBakeDesc *desc, WeftBakeInfo *info, WeftImage *out, WeftError *error) {
    int w = desc->width, h = desc->height, mus = desc->form.transposed ? h : w, alphas = desc->form.transposed ? w : h;
    Lobe lobe = lobe_default(LOBE_FIBRE);
    if (desc->lobe && (weft_lobe_param_find(desc->lobe->lobe, "density") != FIBRE_DENSITY ||
                       weft_lobe_param_find(desc->lobe->lobe, "tilt") != FIBRE_TILT))
        return fail(error, WEFT_MESSAGE_DESC, "fibre-truth", "density is that of fibre or fibre-walk");
    if (desc->lobe) lobe_of(desc->lobe, &lobe);
    if (lobe.params[FIBRE_TILT] > 0.0f) return fail(error, WEFT_MESSAGE_DESC, "tilt", "the table is of upright fibres");
    double *block = alloc_array((size_t)mus + (size_t)alphas * (1 + 2 * (size_t)mus), sizeof *block);
    if (!block) return fail(error, WEFT_MESSAGE_MEMORY, "fibre-truth", NULL);
    double *mu = block, *alpha = mu + mus;
    for (int k = 0; k < mus || k < alphas; k++) {
        float cos_o, value;
        int along = k < mus ? k : 0, across = k < alphas ? k : 0;
        weft_table_form_texel(&desc->form, LOBE_FIBRE, w, h, desc->form.transposed ? across : along,
                              desc->form.transposed ? along : across, &cos_o, &value);
        if (k < mus) mu[k] = fmax((double)cos_o, 1e-6);
        if (k < alphas) alpha[k] = fmin(fmax((double)value, 0.03), 1.0);
        info->beyond += k < alphas && value < 0.03f ? mus : 0;
    }
    SolvedSets t = {.desc = desc,
                    .out = out,
                    .density = (double)lobe.params[FIBRE_DENSITY],
                    .mu = mu,
                    .alpha = alpha,
                    .mus = mus,
                    .alphas = alphas,
                    .found = alpha + alphas};
    parallel_for(desc->threads, alphas, solve, &t);
    WeftResult result = t.short_of_memory ? fail(error, WEFT_MESSAGE_MEMORY, "fibre-truth", NULL)
                        : t.stopped       ? WEFT_INTERRUPTED
                                          : weft_image_create(w, h, 2, WEFT_PIXEL_F32, out, error);
    for (int a = 0; result == WEFT_OK && a < alphas; a++)
        for (int k = 0; k < mus; k++) {
            float *texel = (float *)out->pixels + 2 * (desc->form.transposed ? k * w + a : a * w + k);
            texel[0] = (float)t.found[(2 * a) * mus + k];
            texel[1] = (float)t.found[(2 * a + 1) * mus + k];
        }
    snprintf(info->words, sizeof info->words, "the solved slab of white fibres of density %g", t.density);
    snprintf(info->channels, sizeof info->channels, "reflected R, through T");
    info->error = 1e-4; /* for alpha from 0.065, see study_fibre */
    free(block);
    return result;
}
