#include "measure/fit/lobe_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "measure/fit/blend.h"
#include "measure/fit/search.h"
#include "weft/arrays.h"

enum { TINTS = 6 }; /* albedos of a tinted lobe that a point of the grid tries */
static const float tints[TINTS] = {0.1f, 0.3f, 0.5f, 0.7f, 0.85f, 0.97f};

typedef struct LobeWalker {
    const LobeSearch *search;
    WeftLobe start;
    bool tinted, second; /* tinted: colour is no factor; second: there are two colours */
    int free[WEFT_LOBE_PARAMS_MAX], frees;
    WeftLobe white_base;
    int base_free[WEFT_LOBE_PARAMS_MAX], base_frees, base_first; /* index in x of the first parameter of the base */
    /* [f0, f90, neither], or the channels of a colour, or the tints: x of the samples */
    float *column[TINTS];
    float *base, *fixed[3], *work, *block;
    double weights[3][BLEND_MOST]; /* of the latest evaluation: [channel], base, f0, f90 */
} LobeWalker;

static const WeftLobeInfo *info_of(const LobeWalker *self) { return weft_lobe_info(self->start.lobe); }

/* Evaluates x of a lobe in three channels, or in the first alone. */
static void eval(const Samples *s, const WeftLobe *lobe, int count, float *r, float *g, float *b) {
    const WeftDirections o = {s->o[0], s->o[1], s->o[2]}, i = {s->i[0], s->i[1], s->i[2]};
    weft_eval_n(lobe, (size_t)count, o, i, (WeftColors){r, g, b}, NULL);
    float *const x[3] = {r, g, b};
    for (int c = 0; c < 3; c++)
        for (int k = 0; x[c] && k < count; k++) x[c][k] *= s->i[2][k];
}

/* Adds the contribution of a locked colour. A free one is a column of the blend. */
static void add_color(const LobeWalker *self, Blend *blend, int part, int count) {
    bool locked = (self->search->hold & (part ? WEFT_HOLD_COLOR_2 : WEFT_HOLD_COLOR)) != 0;
    const float *color = part ? self->start.f90 : self->start.f0, *column = self->column[part];
    for (int c = 0; c < 3; c++) {
        if (!locked) blend->column[blend->columns][c] = column;
        for (int k = 0; locked && k < count; k++) self->fixed[c][k] += color[c] * column[k];
    }
    if (!locked) blend->columns++;
}

static Blend blend_of(const LobeWalker *self, int count) {
    Blend blend = {.work = self->work};
    if (self->search->base) {
        for (int c = 0; c < 3; c++) blend.column[0][c] = self->base;
        blend.columns = 1;
    }
    for (int c = 0; c < 3; c++) {
        memcpy(self->fixed[c], self->column[self->tinted ? c : 2], (size_t)count * sizeof(float));
        blend.fixed[c] = self->fixed[c];
    }
    if (!self->tinted) add_color(self, &blend, 0, count);
    if (self->second) add_color(self, &blend, 1, count);
    return blend;
}

/* Cosines at which E is kept within 1. E is smooth between them. */
static const float bound_cosines[BLEND_LIMITS] = {1.0f, 0.8f, 0.6f, 0.4f, 0.25f, 0.15f, 0.1f, 0.05f, 0.02f, 0.005f};

/* Limits the colours of a blend: E of base and lobe is at most 1 in each channel. The parts of a lobe are as in
 * eval_parts, and its columns in the order of blend_of. */
static void add_limits(const LobeWalker *self, Blend *blend, WeftLobe lobe) {
    float e[3][BLEND_LIMITS], base[BLEND_LIMITS] = {0.0f};
    const unsigned hold = self->search->hold;
    const bool locked[2] = {(hold & WEFT_HOLD_COLOR) != 0, (hold & WEFT_HOLD_COLOR_2) != 0};
    for (int c = 0; c < 3 && !self->tinted; c++) lobe.f0[c] = c == 0, lobe.f90[c] = c == 1;
    weft_albedo_n(&lobe, BLEND_LIMITS, bound_cosines, (WeftColors){e[0], e[1], e[2]}, NULL);
    if (self->search->base)
        weft_albedo_n(&self->white_base, BLEND_LIMITS, bound_cosines, (WeftColors){base, NULL, NULL}, NULL);
    blend->limits = BLEND_LIMITS;
    for (int l = 0; l < BLEND_LIMITS; l++) {
        int column = 0;
        if (self->search->base) blend->limit[l][column++] = (double)base[l];
        for (int c = 0; c < 3; c++) blend->room[l][c] = 1.0 - (double)e[self->tinted ? c : 2][l];
        for (int part = 0; part < (self->tinted ? 0 : self->second ? 2 : 1); part++) {
            const double of_part = fmax((double)e[part][l] - (double)e[2][l], 0.0);
            const float *color = part ? self->start.f90 : self->start.f0;
            if (!locked[part]) blend->limit[l][column++] = of_part;
            for (int c = 0; c < 3 && locked[part]; c++) blend->room[l][c] -= (double)color[c] * of_part;
        }
        for (int c = 0; c < 3; c++) blend->room[l][c] = fmax(blend->room[l][c], 0.0);
    }
}

float lobe_search_albedo(const WeftLobe *base, const WeftLobe *lobe) {
    enum { COSINES = 4 * (BLEND_LIMITS - 1) + 1 };
    float cosines[COSINES], of_base[3][COSINES] = {{0.0f}}, e[3][COSINES], most = 0.0f;
    for (int k = 0; k < COSINES; k++) {
        const float t = 0.25f * (float)(k % 4), low = bound_cosines[k / 4];
        cosines[k] = k % 4 ? low + t * (bound_cosines[k / 4 + 1] - low) : low;
    }
    weft_albedo_n(lobe, COSINES, cosines, (WeftColors){e[0], e[1], e[2]}, NULL);
    if (base) weft_albedo_n(base, COSINES, cosines, (WeftColors){of_base[0], of_base[1], of_base[2]}, NULL);
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < COSINES; k++) most = fmaxf(most, of_base[c][k] + e[c][k]);
    return most;
}

static WeftLobe lobe_at(const LobeWalker *self, const double *x) {
    WeftLobe lobe = self->start;
    for (int k = 0; k < self->frees; k++) lobe.params[self->free[k]] = (float)x[k];
    if (self->tinted && !(self->search->hold & WEFT_HOLD_COLOR))
        for (int c = 0; c < 3; c++) lobe.f0[c] = (float)x[self->frees + (c < self->search->samples->channels ? c : 0)];
    return lobe;
}

/* Evaluates the white base with the parameters in x. */
static void eval_base(LobeWalker *self, const double *x, int count) {
    for (int k = 0; k < self->base_frees; k++)
        self->white_base.params[self->base_free[k]] = (float)x[self->base_first + k];
    eval(self->search->samples, &self->white_base, count, self->base, NULL, NULL);
}

/* Sets x to the best of some tints for each channel. */
static double try_tints(LobeWalker *self, double *x) {
    const Samples *s = self->search->samples;
    WeftLobe lobe = lobe_at(self, x);
    double sum = 0.0, weights[BLEND_MOST];
    for (int first = 0; first < TINTS; first += 3) {
        memcpy(lobe.f0, tints + first, sizeof lobe.f0);
        eval(s, &lobe, s->first, self->column[first], self->column[first + 1], self->column[first + 2]);
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

/* Evaluates x without colour, and what f0 and f90 add: f is the sum of the three. */
static void eval_parts(const LobeWalker *self, WeftLobe lobe, int count) {
    for (int c = 0; c < 3; c++) lobe.f0[c] = c == 0, lobe.f90[c] = c == 1;
    eval(self->search->samples, &lobe, count, self->column[0], self->column[1], self->column[2]);
    for (int part = 0; part < 2; part++)
        for (int k = 0; k < count; k++) self->column[part][k] = fmaxf(self->column[part][k] - self->column[2][k], 0.0f);
}

static double error_at(void *user, double *x, SearchCare care) {
    LobeWalker *self = user;
    const Samples *s = self->search->samples;
    int count = care == SEARCH_FULL ? s->count : s->first;
    /* one evaluation of a million samples takes seconds, so it can end halfway */
    if (!progress_report(self->search->item_progress, 0.0)) return 1e30;
    if (self->base_frees) eval_base(self, x, count);
    bool painted = self->tinted && !(self->search->hold & WEFT_HOLD_COLOR);
    if (care == SEARCH_GLANCE && painted) return try_tints(self, x);
    WeftLobe lobe = lobe_at(self, x);
    if (self->tinted)
        eval(s, &lobe, count, self->column[0], self->column[1], self->column[2]);
    else
        eval_parts(self, lobe, count);
    Blend blend = blend_of(self, count);
    if (self->search->bound) add_limits(self, &blend, lobe);
    double sum = 0.0;
    for (int c = 0; c < s->channels && progress_report(self->search->item_progress, 0.0); c++)
        sum += blend_solve(s, count, c, &blend, self->weights[c]);
    return sum;
}

/* Evaluates x of some samples, or of the same pairs rotated about the normal. Returns their number. */
enum { TRIED = 64 };
static int eval_some(const Samples *s, const WeftLobe *lobe, bool rotated, float x[TRIED]) {
    const float c = 0.28f, t = 0.96f;
    float o[2][TRIED], i[2][TRIED];
    int count = s->count < TRIED ? s->count : TRIED;
    for (int k = 0; k < count; k++) {
        o[0][k] = rotated ? c * s->o[0][k] - t * s->o[1][k] : s->o[0][k];
        o[1][k] = rotated ? t * s->o[0][k] + c * s->o[1][k] : s->o[1][k];
        i[0][k] = rotated ? c * s->i[0][k] - t * s->i[1][k] : s->i[0][k];
        i[1][k] = rotated ? t * s->i[0][k] + c * s->i[1][k] : s->i[1][k];
    }
    weft_eval_n(lobe, (size_t)count, (WeftDirections){o[0], o[1], s->o[2]}, (WeftDirections){i[0], i[1], s->i[2]},
                (WeftColors){x, NULL, NULL}, NULL);
    return count;
}

static bool differ(const float *a, const float *b, int count, float most) {
    for (int k = 0; k < count; k++)
        if (fabsf(a[k] - b[k]) > most * (fabsf(a[k]) + 1e-6f)) return true;
    return false;
}

static bool is_anisotropic(const Samples *s, const WeftLobe *lobe) {
    float x[TRIED], y[TRIED];
    int count = eval_some(s, lobe, false, x);
    eval_some(s, lobe, true, y);
    return differ(x, y, count, 1e-3f);
}

/* Returns the parameters to lock: also those that would make an isotropic lobe anisotropic, if the goal is
 * isotropic. */
static unsigned locked_params(const LobeWalker *self) {
    const WeftLobeInfo *info = info_of(self);
    unsigned hold = self->search->hold;
    if (!self->search->isotropic || is_anisotropic(self->search->samples, &self->start)) return hold;
    for (int k = 0; k < info->param_count; k++) {
        WeftLobe lobe = self->start;
        if (info->params[k].choices) continue;
        lobe.params[k] = info->params[k].high;
        if (is_anisotropic(self->search->samples, &lobe)) hold |= 1u << k;
    }
    return hold;
}

/* Returns true if the parameter changes f at any of a fixed set of values of the other free parameters. */
static bool has_influence(const Samples *s, const WeftLobe *start, int param, unsigned hold) {
    enum { SETTINGS = 3 };
    const WeftLobeInfo *info = weft_lobe_info(start->lobe);
    float x[TRIED], y[TRIED];
    for (int setting = 0; setting < SETTINGS; setting++) {
        WeftLobe lobe = *start;
        lobe.f90[0] = 0.5f * lobe.f0[0]; /* a parameter may only mix two colours */
        float t = 0.3f + 0.25f * (float)setting;
        for (int k = 0; k < info->param_count; k++)
            if (!info->params[k].choices && !(hold >> k & 1u))
                lobe.params[k] = info->params[k].low + t * (info->params[k].high - info->params[k].low);
        int count = eval_some(s, &lobe, false, x);
        lobe.params[param] = info->params[param].high;
        eval_some(s, &lobe, false, y);
        if (differ(x, y, count, 1e-6f)) return true;
    }
    return false;
}

/* Finds out whether f is linear in f0 and f90, and whether it depends on f90. */
static void examine_colors(LobeWalker *self) {
    const Samples *s = self->search->samples;
    int count = s->count < TRIED ? s->count : TRIED;
    float f[2][3][TRIED];
    WeftLobe lobe = self->start;
    for (int second = 0; second < 2; second++) {
        for (int c = 0; c < 3; c++) lobe.f0[c] = 0.5f * (float)c, lobe.f90[c] = (float)second;
        eval(s, &lobe, count, f[second][0], f[second][1], f[second][2]);
    }
    for (int k = 0; k < count; k++) {
        float middle = 0.5f * (f[0][0][k] + f[0][2][k]);
        self->tinted |= fabsf(f[0][1][k] - middle) > 1e-4f * middle;
        self->second |= fabsf(f[0][0][k] - f[1][0][k]) > 1e-6f * middle;
    }
    self->second = self->second && !self->tinted;
}

static SearchAxis axis_of(double low, double high, double start) {
    return (SearchAxis){fmin(low, start), fmax(high, start)};
}

/* Adds an axis for each free parameter of a lobe that has an influence. Returns their number. */
static int add_axes(const Samples *s, const WeftLobe *lobe, unsigned hold, Search *search, double *x,
                    int free[WEFT_LOBE_PARAMS_MAX]) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    int count = 0;
    for (int k = 0; k < info->param_count && search->axes < SEARCH_MOST; k++) {
        const WeftParamInfo *p = &info->params[k];
        if (p->choices || hold >> k & 1u || !has_influence(s, lobe, k, hold)) continue;
        double start = fmin(fmax((double)lobe->params[k], (double)p->hard_low), (double)p->hard_high);
        x[search->axes] = start;
        search->axis[search->axes++] = axis_of((double)p->low, (double)p->high, start);
        free[count++] = k;
    }
    return count;
}

static Search make_search(LobeWalker *self, double *x) {
    static const int grids[] = {0, 24, 120, 300, 500, 700, 900};
    const Samples *s = self->search->samples;
    Search search = {
        .error = error_at, .user = self, .descents = 3, .most = 1000, .item_progress = self->search->item_progress};
    self->frees = add_axes(s, &self->start, locked_params(self), &search, x, self->free);
    bool painted = self->tinted && !(self->search->hold & WEFT_HOLD_COLOR);
    for (int c = 0; painted && c < s->channels; c++) {
        x[search.axes] = (double)self->start.f0[c];
        search.axis[search.axes] = axis_of(0.0, 1.0, x[search.axes]);
        search.axes++;
    }
    self->base_first = search.axes;
    if (self->search->base)
        self->base_frees = add_axes(s, &self->white_base, self->search->hold_base, &search, x, self->base_free);
    int numbers = self->frees + self->base_frees;
    search.grid = grids[numbers < 6 ? numbers : 6];
    if (painted && search.grid < 24) search.grid = 24;
    return search;
}

static bool walker_make(LobeWalker *self, const LobeSearch *search, const WeftLobe *start) {
    size_t n = (size_t)search->samples->count;
    *self = (LobeWalker){.search = search, .start = *start};
    examine_colors(self);
    self->block = alloc_array((TINTS + 7) * n, sizeof(float));
    if (!self->block) return false;
    for (int k = 0; k < TINTS; k++) self->column[k] = self->block + (size_t)k * n;
    for (int c = 0; c < 3; c++) self->fixed[c] = self->block + (size_t)(TINTS + c) * n;
    self->base = self->block + (TINTS + 3) * n;
    self->work = self->base + n;
    if (!search->base) return true;
    self->white_base = *search->base;
    for (int c = 0; c < 3; c++) self->white_base.f0[c] = self->white_base.f90[c] = 1.0f;
    eval(search->samples, &self->white_base, search->samples->count, self->base, NULL, NULL);
    return true;
}

/* Sets the colours that the last evaluation found, and how many numbers were free. */
static void colors_of(const LobeWalker *self, LobeFound *out) {
    const LobeSearch *search = self->search;
    bool painted = !(search->hold & WEFT_HOLD_COLOR);
    bool second = self->second && !(search->hold & WEFT_HOLD_COLOR_2);
    int colors = (search->base != NULL) + painted + second;
    out->numbers = self->frees + self->base_frees + colors * search->samples->channels;
    if (search->base) out->base = self->white_base;
    for (int c = 0; c < 3; c++) {
        const double *weights = self->weights[c < search->samples->channels ? c : 0];
        int k = 0;
        if (search->base) out->base.f0[c] = out->base.f90[c] = (float)weights[k++];
        if (self->tinted) continue;
        if (painted) out->lobe.f0[c] = (float)weights[k++];
        if (second) out->lobe.f90[c] = (float)weights[k];
    }
}

WeftResult lobe_search_run(const LobeSearch *search, LobeFound *out) {
    LobeWalker self;
    double x[SEARCH_MOST] = {0.0};
    if (!walker_make(&self, search, &out->lobe)) return WEFT_RESOURCES;
    const Search walk = make_search(&self, x);
    out->start = error_at(&self, x, SEARCH_FULL);
    search_run(&walk, x, &out->evaluations);
    out->error = error_at(&self, x, SEARCH_FULL);
    out->lobe = lobe_at(&self, x);
    colors_of(&self, out);
    free(self.block);
    bool whole = progress_report(search->item_progress, 0.0);
    return whole ? WEFT_OK : WEFT_INTERRUPTED;
}

WeftResult lobe_search_glance(const LobeSearch *search, LobeFound *out) {
    enum { POINTS = 8 }; /* an axis */
    LobeWalker self;
    double x[SEARCH_MOST] = {0.0};
    if (!walker_make(&self, search, &out->lobe)) return WEFT_RESOURCES;
    const Search walk = make_search(&self, x);
    out->error = search_glance(&walk, walk.axes > 0 ? POINTS * walk.axes : 1, &out->evaluations);
    free(self.block);
    return progress_report(search->item_progress, 0.0) ? WEFT_OK : WEFT_INTERRUPTED;
}
