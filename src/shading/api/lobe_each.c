/* lobe_each.c - the public face of the loops in which each element is a lobe of its own */
#include "base/fail.h"
#include "shading/catalogue/registry.h"
#include "shading/lobe/each.h"
#include "weft/arrays.h"

/* Loops run over whole groups of LANES, as in lobe_arrays.c, so that a result does not depend on its
 * place. */
enum { LANES = EACH_GROUP, BLOCK = 256 };

/* Rows that the loops read where the caller's are missing, too short, or not within their range; and rows
 * that they write where nobody wants them. */
typedef struct Stage {
    Each each;
    size_t used, n; /* used: how many of the n count */
    float params[LOBE_PARAMS_MAX][BLOCK], f0[3][BLOCK], f90[3][BLOCK];
    float o[3][BLOCK], i[3][BLOCK], u[BLOCK], v[BLOCK];
    float f[3][BLOCK], pdf[BLOCK], drawn[3][BLOCK];
} Stage;

static void fill(float *row, size_t from, float value) {
    for (size_t k = from; k < BLOCK; k++) row[k] = value;
}

/* Returns the caller's row if its n elements all count; otherwise fills `row` with a copy of those that count, then
 * with `rest`, and returns it. */
static const float *staged(const Stage *stage, float *row, const float *from, float rest) {
    if (stage->used == stage->n) return from;
    memcpy(row, from, stage->used * sizeof *row);
    fill(row, stage->used, rest);
    return row;
}

static void stage_params(Stage *stage, const WeftLobes *lobes, size_t k) {
    const WeftLobeInfo *info = weft_lobe_info(lobes->lobe.lobe);
    for (int p = 0; p < info->param_count; p++) {
        const WeftParamInfo *param = &info->params[p];
        const float *from = lobes->params[p] ? lobes->params[p] + k : NULL;
        stage->each.params[p] = stage->params[p];
        for (size_t j = 0; from && j < stage->used; j++)
            stage->params[p][j] = clamp(from[j], param->hard_low, param->hard_high);
        fill(stage->params[p], from ? stage->used : 0, stage->each.lobe.params[p]);
    }
}

static void stage_colors(Stage *stage, const WeftLobes *lobes, size_t k) {
    for (int c = 0; c < 3; c++) {
        const float *f0 = lobes->f0[c], *f90 = lobes->f90[c];
        stage->each.f0[c] = stage->f0[c];
        stage->each.f90[c] = stage->f90[c];
        if (f0) stage->each.f0[c] = staged(stage, stage->f0[c], f0 + k, 1.0f);
        if (f90) stage->each.f90[c] = staged(stage, stage->f90[c], f90 + k, 1.0f);
        if (!f0) fill(stage->f0[c], 0, lobes->lobe.f0[c]);
        if (!f90) fill(stage->f90[c], 0, lobes->lobe.f90[c]);
    }
}

/* Takes the next elements, from k on, at most BLOCK. */
static void stage_take(Stage *stage, const WeftLobes *lobes, size_t k, size_t n, WeftDirections o) {
    size_t left = n - k;
    stage->used = left >= BLOCK ? BLOCK : left >= LANES ? left - left % LANES : left;
    stage->n = left >= LANES ? stage->used : LANES;
    const float *const from[] = {o.x + k, o.y + k, o.z + k};
    for (int c = 0; c < 3; c++) stage->each.o[c] = staged(stage, stage->o[c], from[c], c == 2 ? 1.0f : 0.0f);
    stage_params(stage, lobes, k);
}

/* Returns the array that the loop writes: the caller's own if it takes all n. */
static float *target(const Stage *stage, float *row, float *to, size_t k) {
    return to && stage->used == stage->n ? to + k : row;
}

static void put(const Stage *stage, float *to, size_t k, const float *from) {
    if (to && from != to + k) memcpy(to + k, from, stage->used * sizeof *to);
}

static void clear(float *array, size_t n) {
    if (array) memset(array, 0, n * sizeof *array);
}

static WeftResult missing(WeftError *error, const char *array) {
    return fail(error, WEFT_MESSAGE_DESC, array, "is NULL");
}

static bool given(WeftDirections w) { return w.x && w.y && w.z; }

/* Fills each->lobe. Fails if there is no such lobe, or if a choice of terms is given for each element. */
static WeftResult check(const WeftLobes *lobes, Each *each, WeftError *error) {
    const WeftLobeInfo *info = weft_lobe_info(lobes->lobe.lobe);
    if (!lobe_of(&lobes->lobe, &each->lobe))
        return fail(error, WEFT_MESSAGE_LOBE_NAME, "index", "%d", lobes->lobe.lobe);
    for (int p = 0; p < info->param_count; p++)
        if (info->params[p].choices && lobes->params[p])
            return fail(error, WEFT_MESSAGE_DESC, info->params[p].name, "is a choice, and one for all");
    return WEFT_OK;
}

WeftResult weft_eval_each(const WeftLobes *lobes, size_t n, WeftDirections wo, WeftDirections wi, WeftColors f,
                          float *pdf, WeftError *error) {
    float *const to[] = {f.r, f.g, f.b};
    Stage stage;
    stage.each = (Each){.pdf = NULL};
    if (n == 0) return WEFT_OK;
    if (!given(wo)) return missing(error, "wo");
    if (!given(wi)) return missing(error, "wi");
    WeftResult result = check(lobes, &stage.each, error);
    if (result != WEFT_OK) clear(f.r, n), clear(f.g, n), clear(f.b, n), clear(pdf, n);
    if (result != WEFT_OK) return result;
    for (size_t k = 0; k < n; k += stage.used) {
        stage_take(&stage, lobes, k, n, wo);
        stage_colors(&stage, lobes, k);
        const float *const from[] = {wi.x + k, wi.y + k, wi.z + k};
        for (int c = 0; c < 3; c++) {
            stage.each.i[c] = staged(&stage, stage.i[c], from[c], c == 2 ? 1.0f : 0.0f);
            stage.each.f[c] = target(&stage, stage.f[c], to[c], k);
        }
        stage.each.pdf = target(&stage, stage.pdf, pdf, k);
        each_eval(&stage.each, stage.n);
        for (int c = 0; c < 3; c++) put(&stage, to[c], k, stage.each.f[c]);
        put(&stage, pdf, k, stage.each.pdf);
    }
    return WEFT_OK;
}

static float in_unit(float u) { return u > 0.0f ? min(u, 0x1.fffffep-1f) : 0.0f; }

static void stage_numbers(Stage *stage, const float *u, const float *v) {
    for (size_t j = 0; j < stage->used; j++) stage->u[j] = in_unit(u[j]), stage->v[j] = in_unit(v[j]);
    fill(stage->u, stage->used, 0.5f);
    fill(stage->v, stage->used, 0.5f);
    stage->each.u = stage->u;
    stage->each.v = stage->v;
}

WeftResult weft_sample_each(const WeftLobes *lobes, size_t n, WeftDirections wo, const float *u, const float *v,
                            float *wi_x, float *wi_y, float *wi_z, float *pdf, WeftError *error) {
    float *const to[] = {wi_x, wi_y, wi_z};
    WeftDirections wi = {wi_x, wi_y, wi_z};
    Stage stage;
    stage.each = (Each){.pdf = NULL};
    if (n == 0) return WEFT_OK;
    if (!given(wo)) return missing(error, "wo");
    if (!u || !v) return missing(error, u ? "v" : "u");
    if (!given(wi)) return missing(error, "wi");
    if (!pdf) return missing(error, "pdf");
    WeftResult result = check(lobes, &stage.each, error);
    if (result != WEFT_OK) clear(wi_x, n), clear(wi_y, n), clear(wi_z, n), clear(pdf, n);
    if (result != WEFT_OK) return result;
    for (size_t k = 0; k < n; k += stage.used) {
        stage_take(&stage, lobes, k, n, wo);
        stage_numbers(&stage, u + k, v + k);
        for (int c = 0; c < 3; c++) stage.each.drawn[c] = target(&stage, stage.drawn[c], to[c], k);
        each_sample(&stage.each, stage.n);
        for (int c = 0; c < 3; c++) put(&stage, to[c], k, stage.each.drawn[c]);
    }
    return weft_eval_each(lobes, n, wo, wi, (WeftColors){NULL, NULL, NULL}, pdf, error);
}
