#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "raster/fits.h"

#include "base/memory.h"

typedef struct Fit {
    struct Fit *next;
    AmbientFit fit;
} Fit;

const AmbientFit *fits_get(Fits *self, const Lobe *lobe) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->id);
    float low = info->param_count ? info->params[0].low : 0.0f;
    float high = info->param_count ? info->params[0].high : 0.0f;
    for (const Fit *k = self->first; k; k = k->next)
        if (ambient_fit_serves(&k->fit, lobe, low, high)) return &k->fit;
    Fit *made = alloc_array(1, sizeof *made);
    if (!made) return NULL;
    ambient_fit(&made->fit, lobe, low, high, self->threads);
    made->next = self->first;
    self->first = made;
    return &made->fit;
}

void fits_destroy(Fits *self) {
    for (Fit *k = self->first, *next; k; k = next) {
        next = k->next;
        free(k);
    }
    self->first = NULL;
}
