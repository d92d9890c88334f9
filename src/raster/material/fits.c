#include <math.h>
#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "raster/material/fits.h"

#include "base/cache.h"
#include "base/memory.h"
#include "weft/version.h"

typedef struct Fit {
    struct Fit *next;
    AmbientFit fit;
} Fit;

/* Version of the fit: raised whenever the same lobe would give other tables. */
enum { FITS = 7 };

/* Returns a hash of everything that a table depends on: see ambient_fit_serves. */
static uint64_t fit_key(const Lobe *lobe, float low, float high) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->id);
    int azimuth = ambient_lean_azimuth(lobe->id);
    const int sizes[] = {FITS, AMBIENT_COLUMNS, AMBIENT_ROWS, AMBIENT_PLANES, AMBIENT_HEADINGS, info->param_count};
    const float range[] = {low, high};
    uint64_t hash = cache_hash(CACHE_HASH, sizes, sizeof sizes);
    hash = cache_hash(hash, WEFT_VERSION, sizeof WEFT_VERSION);
    hash = cache_hash(hash, info->id, strlen(info->id));
    const OutsideLobe *outside = outside_lobe(lobe->id);
    if (outside) hash = cache_hash(hash, outside->text, strlen(outside->text));
    hash = cache_hash(hash, range, sizeof range);
    for (int k = 1; k < info->param_count; k++)
        if (k != azimuth) hash = cache_hash(hash, &lobe->params[k], sizeof lobe->params[k]);
    return hash;
}

static bool is_sound(const AmbientFit *fit) {
    const float *p = fit->texels[0];
    bool sound = true;
    for (size_t k = 0; k < sizeof fit->texels / sizeof *p; k++) sound = sound && fabsf(p[k]) < 1e6f;
    return sound;
}

/* Fits the tables of a lobe, or reads them from the user's cache. */
static void make(AmbientFit *fit, const Lobe *lobe, float low, float high, const Fits *how) {
    uint64_t key = fit_key(lobe, low, high);
    ambient_fit_shape(fit, lobe, low, high);
    if (!how->no_cache && cache_find(key, "fit", fit->texels, sizeof fit->texels, NULL) && is_sound(fit)) {
        ambient_fit_finish(fit);
        return;
    }
    memset(fit->texels, 0, sizeof fit->texels);
    ambient_fit(fit, lobe, low, high, how->threads);
    if (!how->no_cache) cache_keep(key, "fit", fit->texels, sizeof fit->texels, NULL);
}

const AmbientFit *fits_get(Fits *self, const Lobe *lobe) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->id);
    float low = info->param_count ? info->params[0].low : 0.0f;
    float high = info->param_count ? info->params[0].high : 0.0f;
    for (const Fit *k = self->first; k; k = k->next)
        if (ambient_fit_serves(&k->fit, lobe, low, high)) return &k->fit;
    Fit *made = alloc_array(1, sizeof *made);
    if (!made) return NULL;
    make(&made->fit, lobe, low, high, self);
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
