/* bake_layer.c - the channels of a table that one lobe fills, and the loop over texels */
#include <stdatomic.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/thread.h"
#include "measure/bake/bake_texels.h"
#include "measure/bsdf/exceeds.h"

typedef struct Texels {
    int width, total;
    WeftProgress progress;
    void *progress_user, *user;
    void (*texel)(void *user, int x, int y, int thread);
    atomic_int done;
    atomic_bool stopped;
} Texels;

static void texel_run(void *user, int item, int thread) {
    Texels *texels = user;
    if (texels->stopped) return;
    texels->texel(texels->user, item % texels->width, item / texels->width, thread);
    const int done = atomic_fetch_add(&texels->done, 1) + 1;
    if (thread == 0 && texels->progress && texels->progress(texels->progress_user, (double)done / texels->total) != 0)
        texels->stopped = true;
}

WeftResult bake_texels(int width, int height, int threads, WeftProgress progress, void *progress_user,
                       void (*texel)(void *user, int x, int y, int thread), void *user) {
    Texels texels = {.width = width,
                     .total = width * height,
                     .progress = progress,
                     .progress_user = progress_user,
                     .texel = texel,
                     .user = user};
    parallel_for(threads, width * height, texel_run, &texels);
    return texels.stopped ? WEFT_INTERRUPTED : WEFT_OK;
}

/* Finds all of a texel except its parts, and the lobe there. */
static BakeTexel texel_place(const BakePlane *plane, int x, int y, Lobe *lobe) {
    BakeTexel texel = {0};
    *lobe = plane->lobe;
    if (plane->form->transposed)
        x += plane->form->flip_x ? -plane->late : plane->late;
    else
        y += plane->form->flip_y ? -plane->late : plane->late;
    weft_table_form_texel(plane->form, lobe->id, plane->width, plane->height, x, y, &texel.cos_o, &texel.value);
    if (weft_lobe_info(lobe->id)->param_count > 0) {
        lobe_set(lobe, 0, texel.value);
        texel.beyond = lobe->params[0] < texel.value || lobe->params[0] > texel.value;
    }
    return texel;
}

bool bake_judges(const BakePlane *plane, int x, int y) {
    Lobe lobe;
    const BakeTexel texel = texel_place(plane, x, y, &lobe);
    return !texel.beyond && texel.cos_o > 0.0f;
}

BakeTexel bake_texel(const BakePlane *plane, int x, int y) {
    Lobe lobe;
    BakeTexel texel = texel_place(plane, x, y, &lobe);
    const float z = max(texel.cos_o, 1e-6f);
    const Dir wo = {sqrt(max(1.0f - z * z, 0.0f)), 0.0f, z};
    const Albedo e = albedo_quadrature_error(&lobe, wo, plane->tolerance, &texel.error);
    texel.part[WEFT_TABLE_F0] = e.f0;
    texel.part[WEFT_TABLE_F90] = e.f90;
    texel.part[WEFT_TABLE_SUM] = e.f0 + e.f90 * lobe_second(&lobe, 1.0f, 1.0f);
    return texel;
}

BakeLayer bake_layer(const Lobe *lobe, const WeftTableForm *form) {
    if (!(weft_lobe_info(lobe->id)->traits & TRAIT_TWO_COLORS))
        return (BakeLayer){*lobe, 1, {WEFT_TABLE_SUM, WEFT_TABLE_SUM}};
    if (form->total) return (BakeLayer){*lobe, 2, {WEFT_TABLE_F90, WEFT_TABLE_SUM}};
    return (BakeLayer){*lobe, 2, {WEFT_TABLE_F0, WEFT_TABLE_F90}};
}

/* The extremes that one thread has found. Merged, they do not depend on how work was divided. */
typedef struct LayerExtremes {
    double error;
    long long unmet, beyond;
} LayerExtremes;

typedef struct LayerFill {
    const WeftBakeDesc *desc;
    const BakeLayer *layers;
    int count;
    WeftImage *out;
    LayerExtremes extremes[WEFT_THREADS_MAX];
} LayerFill;

static void fill_texel(void *user, int x, int y, int thread) {
    LayerFill *fill = user;
    LayerExtremes *extremes = &fill->extremes[thread];
    const WeftImage *out = fill->out;
    float *to = (float *)out->pixels + ((size_t)y * (size_t)out->width + (size_t)x) * (size_t)out->channels;
    bool beyond = false;
    for (int k = 0; k < fill->count; k++) {
        const BakeLayer *layer = &fill->layers[k];
        const BakePlane plane = {.form = &fill->desc->form,
                                 .width = out->width,
                                 .height = out->height,
                                 .lobe = layer->lobe,
                                 .tolerance = fill->desc->tolerance};
        const BakeTexel texel = bake_texel(&plane, x, y);
        for (int c = 0; c < layer->channels; c++) *to++ = texel.part[layer->parts[c]];
        if (exceeds_or_nan(texel.error, extremes->error)) extremes->error = texel.error;
        extremes->unmet += !(texel.error <= plane.tolerance);
        beyond |= texel.beyond;
    }
    extremes->beyond += beyond;
}

WeftResult bake_layers(const WeftBakeDesc *desc, const BakeLayer *layers, int count, WeftBakeInfo *info, WeftImage *out,
                       WeftError *error) {
    int channels = 0;
    for (int k = 0; k < count; k++) channels += layers[k].channels;
    WeftResult result = weft_image_create(desc->width, desc->height, channels, WEFT_PIXEL_F32, out, error);
    if (result != WEFT_OK) return result;
    LayerFill *fill = alloc_array(1, sizeof *fill);
    if (!fill) {
        weft_image_free(out);
        return fail(error, WEFT_MESSAGE_MEMORY, "table", NULL);
    }
    *fill = (LayerFill){.desc = desc, .layers = layers, .count = count, .out = out};
    result = bake_texels(desc->width, desc->height, desc->threads, desc->progress, desc->user, fill_texel, fill);
    for (int k = 0; k < WEFT_THREADS_MAX; k++) {
        const LayerExtremes *extremes = &fill->extremes[k];
        if (exceeds_or_nan(extremes->error, info->error)) info->error = extremes->error;
        info->unmet += extremes->unmet;
        info->beyond += extremes->beyond;
    }
    free(fill);
    if (result != WEFT_OK) weft_image_free(out);
    return result;
}
