#include "measure/lobe_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "measure/search.h"
#include "weft/arrays.h"

enum { TINTS = 6 }; /* albedos of a tinted lobe that a point of the grid tries */
static const float tints[TINTS] = {0.1f, 0.3f, 0.5f, 0.7f, 0.85f, 0.97f};

typedef struct Walker {
    const LobeSearch *search;
    WeftLobe start;
    bool tinted, second; /* its colour is no factor; it has two */
    int free[WEFT_LOBE_PARAMS_MAX], frees;
    float *column[TINTS]; /* x: of f0 and f90, or of a colour's channels, or of tints */
    float *base, *fixed[3], *work, *block;
    double weights[3][BLEND_MOST]; /* of the latest evaluation: [channel], base, f0, f90 */
} Walker;

static const WeftLobeInfo *info_of(const Walker *self) { return weft_lobe_info(self->start.lobe); }

/* x of a lobe in three channels. */
static void ask(const Samples *s, const WeftLobe *lobe, int count, float *r, float *g, float *b) {
    const WeftDirections o = {s->o[0], s->o[1], s->o[2]}, i = {s->i[0], s->i[1], s->i[2]};
    weft_eval_n(lobe, (size_t)count, o, i, (WeftColors){r, g, b}, NULL);
    float *const x[3] = {r, g, b};
    for (int c = 0; c < 3; c++)
        for (int k = 0; x[c] && k < count; k++) x[c][k] *= s->i[2][k];
}

/* The columns of a blend that stand for what is free in colour; the rest is fixed. */
static Blend blend_of(Walker *self, int count) {
    const LobeSearch *search = self->search;
    bool held[2] = {(search->hold & WEFT_HOLD_COLOR) != 0, (search->hold & WEFT_HOLD_COLOR_2) != 0};
    Blend blend = {.work = self->work};
    if (search->base) {
        for (int c = 0; c < 3; c++) blend.column[0][c] = self->base;
        blend.columns = 1;
    }
    for (int c = 0; c < 3; c++) {
        bool any = self->tinted || held[0] || (self->second && held[1]);
        for (int k = 0; any && k < count; k++) self->fixed[c][k] = self->tinted ? self->column[c][k] : 0.0f;
        blend.fixed[c] = any ? self->fixed[c] : NULL;
    }
    for (int part = 0; part < (self->tinted ? 0 : self->second ? 2 : 1); part++) {
        const float *color = part ? self->start.f90 : self->start.f0;
        for (int c = 0; c < 3; c++) {
            if (!held[part]) blend.column[blend.columns][c] = self->column[part];
            for (int k = 0; held[part] && k < count; k++)
                self->fixed[c][k] += color[c] * self->column[part][k];
        }
        if (!held[part]) blend.columns++;
    }
    return blend;
}

static WeftLobe lobe_at(const Walker *self, const double *x) {
    WeftLobe lobe = self->start;
    for (int k = 0; k < self->frees; k++) lobe.params[self->free[k]] = (float)x[k];
    if (self->tinted && !(self->search->hold & WEFT_HOLD_COLOR))
        for (int c = 0; c < 3; c++)
            lobe.f0[c] = (float)x[self->frees + (c < self->search->samples->channels ? c : 0)];
    return lobe;
}

/* Of each channel, the best of some tints: into x. */
static double try_tints(Walker *self, double *x) {
    const Samples *s = self->search->samples;
    WeftLobe lobe = lobe_at(self, x);
    double sum = 0.0, weights[BLEND_MOST];
    for (int first = 0; first < TINTS; first += 3) {
        memcpy(lobe.f0, tints + first, sizeof lobe.f0);
        ask(s, &lobe, s->first, self->column[first], self->column[first + 1], self->column[first + 2]);
    }
    for (int c = 0; c < s->channels; c++) {
        double least = 1e30;
        for (int k = 0; k < TINTS; k++) {
            Blend blend = {.work = self->work, .columns = self->search->base ? 1 : 0};
            blend.column[0][c] = self->base;
            blend.fixed[c] = self->column[k];
            double error = blend_solve(s, s->first, c, &blend, weights);
            if (error < least) least = error, x[self->frees + c] = (double)tints[k];
        }
        sum += least;
    }
    return sum;
}

static double error_at(void *user, double *x, bool quick) {
    Walker *self = user;
    const Samples *s = self->search->samples;
    int count = quick ? s->first : s->count;
    bool painted = self->tinted && !(self->search->hold & WEFT_HOLD_COLOR);
    if (quick && painted) return try_tints(self, x);
    WeftLobe lobe = lobe_at(self, x);
    if (!self->tinted) { /* the first channel is all of f0, the second all of f90 */
        for (int c = 0; c < 3; c++) lobe.f0[c] = c == 0, lobe.f90[c] = c == 1;
        ask(s, &lobe, count, self->column[0], self->second ? self->column[1] : NULL, NULL);
    } else {
        ask(s, &lobe, count, self->column[0], self->column[1], self->column[2]);
    }
    Blend blend = blend_of(self, count);
    double sum = 0.0;
    for (int c = 0; c < s->channels; c++) sum += blend_solve(s, count, c, &blend, self->weights[c]);
    return sum;
}

/* Whether a parameter changes f anywhere: at some settings of the others, chosen once and for all. */
static bool has_influence(const Walker *self, int param) {
    enum { LOOKS = 64, SETTINGS = 3 };
    const WeftLobeInfo *info = info_of(self);
    const Samples *s = self->search->samples;
    int count = s->count < LOOKS ? s->count : LOOKS;
    float f[2][LOOKS];
    for (int setting = 0; setting < SETTINGS; setting++) {
        WeftLobe lobe = self->start;
        float t = 0.3f + 0.25f * (float)setting;
        for (int k = 0; k < info->param_count; k++)
            if (!info->params[k].choices)
                lobe.params[k] = info->params[k].low + t * (info->params[k].high - info->params[k].low);
        for (int end = 0; end < 2; end++) {
            lobe.params[param] = end ? info->params[param].high : lobe.params[param];
            ask(s, &lobe, count, f[end], NULL, NULL);
        }
        for (int k = 0; k < count; k++)
            if (fabsf(f[0][k] - f[1][k]) > 1e-6f * fabsf(f[0][k])) return true;
    }
    return false;
}

static SearchAxis axis_of(double low, double high, double start) {
    return (SearchAxis){fmin(low, start), fmax(high, start)};
}

static Search make_search(Walker *self, double *x) {
    static const int grids[] = {0, 24, 120, 300, 500, 700, 900};
    const WeftLobeInfo *info = info_of(self);
    Search search = {.error = error_at, .user = self, .descents = 3, .most = 1500};
    for (int k = 0; k < info->param_count; k++) {
        const WeftParamInfo *p = &info->params[k];
        if (p->choices || self->search->hold >> k & 1u || !has_influence(self, k)) continue;
        double start = fmin(fmax((double)self->start.params[k], (double)p->hard_low), (double)p->hard_high);
        x[search.axes] = start;
        search.axis[search.axes++] = axis_of((double)p->low, (double)p->high, start);
        self->free[self->frees++] = k;
    }
    search.grid = grids[search.axes < 6 ? search.axes : 6];
    if (self->tinted && !(self->search->hold & WEFT_HOLD_COLOR))
        for (int c = 0; c < self->search->samples->channels; c++) {
            x[search.axes] = (double)self->start.f0[c];
            search.axis[search.axes] = axis_of(0.0, 1.0, x[search.axes]);
            search.axes++;
            search.grid = search.grid > 24 ? search.grid : 24;
        }
    return search;
}

static bool walker_make(Walker *self, const LobeSearch *search, const WeftLobe *start) {
    size_t n = (size_t)search->samples->count;
    *self = (Walker){.search = search, .start = *start};
    unsigned traits = info_of(self)->traits;
    self->tinted = (traits & WEFT_LOBE_TINTED) != 0;
    self->second = (traits & WEFT_LOBE_TWO_COLORS) != 0;
    self->block = alloc_array((TINTS + 7) * n, sizeof(float));
    if (!self->block) return false;
    for (int k = 0; k < TINTS; k++) self->column[k] = self->block + (size_t)k * n;
    for (int c = 0; c < 3; c++) self->fixed[c] = self->block + (size_t)(TINTS + c) * n;
    self->base = self->block + (TINTS + 3) * n;
    self->work = self->base + n;
    if (!search->base) return true;
    WeftLobe white = *search->base;
    for (int c = 0; c < 3; c++) white.f0[c] = white.f90[c] = 1.0f;
    ask(search->samples, &white, search->samples->count, self->base, NULL, NULL);
    return true;
}

/* What the last evaluation found for colours. */
static void colors_of(const Walker *self, LobeFound *out) {
    const LobeSearch *search = self->search;
    for (int c = 0; c < 3; c++) {
        const double *weights = self->weights[c < search->samples->channels ? c : 0];
        int k = 0;
        if (search->base) out->base[c] = (float)weights[k++];
        if (self->tinted) continue;
        if (!(search->hold & WEFT_HOLD_COLOR)) out->lobe.f0[c] = (float)weights[k++];
        if (self->second && !(search->hold & WEFT_HOLD_COLOR_2)) out->lobe.f90[c] = (float)weights[k];
    }
}

bool lobe_search_run(const LobeSearch *search, LobeFound *out) {
    Walker self;
    double x[SEARCH_MOST] = {0.0};
    if (!walker_make(&self, search, &out->lobe)) return false;
    const Search walk = make_search(&self, x);
    out->start = error_at(&self, x, false);
    search_run(&walk, x, &out->evaluations);
    out->error = error_at(&self, x, false);
    out->lobe = lobe_at(&self, x);
    colors_of(&self, out);
    free(self.block);
    return true;
}
