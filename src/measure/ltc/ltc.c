/* ltc.c - the public functions of LTC tables (weft/ltc.h) */
#include <stdlib.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/steady_clock.h"
#include "measure/ltc/ltc_cache.h"

static const char *const names[WEFT_LTC_CHANNELS] = {"z", "q", "b", "r", "amplitude", "amplitude_f90", "error"};

const char *weft_ltc_channel_name(int channel) {
    return channel >= 0 && channel < WEFT_LTC_CHANNELS ? names[channel] : NULL;
}

/* Sets the table from the descriptor and allocates it. */
static WeftResult describe(WeftLtc *ltc, const WeftLobe *lobe, const WeftLtcDesc *desc, WeftError *error) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    if (!info || !lobe_of(lobe, &ltc->lobe)) return fail(error, WEFT_MESSAGE_LOBE_NAME, "index", "%d", lobe->lobe);
    const WeftParamInfo *p = info->param_count ? &info->params[0] : NULL;
    const int sides[] = {desc->rows, desc->columns};
    for (int k = 0; k < 2; k++)
        if (sides[k] != 0 && (sides[k] < 2 || sides[k] > 256))
            return fail(error, WEFT_MESSAGE_DESC, k ? "columns" : "rows", "%d is not in 2 .. 256", sides[k]);
    if (desc->norm < 0 || desc->norm > 3)
        return fail(error, WEFT_MESSAGE_DESC, "norm", "%d is not in 1 .. 3", desc->norm);
    if (!(desc->f0 >= 0.0f && desc->f90 >= 0.0f && desc->f0 + desc->f90 < 1e3f))
        return fail(error, WEFT_MESSAGE_DESC, "f0 and f90", "%g and %g are no colours", (double)desc->f0,
                    (double)desc->f90);
    bool white = !(desc->f0 + desc->f90 > 0.0f);
    ltc->f0 = white ? 1.0f : desc->f0;
    ltc->second = lobe_second(&ltc->lobe, ltc->f0, white ? 1.0f : desc->f90);
    ltc->norm = desc->norm ? desc->norm : 1;
    ltc->level = desc->level != 0;
    ltc->columns = desc->columns ? desc->columns : 32;
    ltc->lobe.params[0] = 0.0f;
    if (p) {
        bool has_range = desc->low < 0.0f || desc->low > 0.0f || desc->high < 0.0f || desc->high > 0.0f;
        ltc->low = clamp(has_range ? desc->low : p->low, p->hard_low, p->hard_high);
        ltc->high = clamp(has_range ? desc->high : p->high, p->hard_low, p->hard_high);
        if (!(desc->low <= desc->high) || !(ltc->low >= 0.0f))
            return fail(error, WEFT_MESSAGE_DESC, p->name, "%g .. %g is no range of %s", (double)desc->low,
                        (double)desc->high, info->id);
    }
    ltc->rows = !p || !(ltc->low < ltc->high) ? 1 : desc->rows ? desc->rows : 32;
    if (info->traits & TRAIT_REFERENCE)
        return fail(error, WEFT_MESSAGE_LTC_LOBE, info->id, "it is for the path tracer only");
    if (!ltc_isotropic(ltc)) return fail(error, WEFT_MESSAGE_LTC_LOBE, info->id, "it turns with the tangent");
    return ltc_create(ltc) ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, "an LTC table", NULL);
}

static WeftResult make(WeftLtc *ltc, const WeftLtcDesc *desc, const WeftLog *log, WeftError *error) {
    uint64_t key = 0;
    double start = clock_now();
    WeftResult result = desc->no_cache ? WEFT_OK : ltc_key(ltc, &key, error);
    if (result != WEFT_OK) return result;
    ltc->cached = !desc->no_cache && ltc_cache_read(ltc, key, log);
    if (!ltc->cached) result = ltc_bake(ltc, desc, error);
    ltc->seconds = clock_now() - start;
    if (result == WEFT_OK && !ltc->cached && !desc->no_cache) ltc_cache_write(ltc, key, log);
    return result;
}

WeftResult weft_ltc_create(const WeftLobe *lobe, const WeftLtcDesc *desc, WeftLtc **out, const WeftLog *log,
                           WeftError *error) {
    *out = NULL;
    WeftLtc *ltc = alloc_array(1, sizeof *ltc);
    if (!ltc) return fail(error, WEFT_MESSAGE_MEMORY, "an LTC table", NULL);
    WeftResult result = describe(ltc, lobe, desc, error);
    if (result == WEFT_OK) result = make(ltc, desc, log, error);
    if (result == WEFT_OK)
        *out = ltc;
    else
        weft_ltc_free(ltc);
    return result;
}

void weft_ltc_free(WeftLtc *ltc) {
    if (!ltc) return;
    free(ltc->texels);
    free(ltc);
}

const float *weft_ltc_channel(const WeftLtc *ltc, int channel) {
    return weft_ltc_channel_name(channel) ? ltc->texels + (size_t)channel * (size_t)ltc_cells(ltc) : NULL;
}

float weft_ltc_cos_o(const WeftLtc *ltc, int column) { return ltc_cos_o(ltc, column); }
float weft_ltc_value(const WeftLtc *ltc, int row) { return ltc_lobe(ltc, row).params[0]; }

/* Returns E of a node, in the colours that were fitted. */
static float albedo(const WeftLtc *ltc, int cell) {
    const float *t = ltc->texels + cell;
    int plane = ltc_cells(ltc);
    float cos_o = ltc_cos_o(ltc, cell % ltc->columns), s = sqrt(max(1.0f - cos_o * cos_o, 0.0f));
    Ltc m = ltc_of(t[WEFT_LTC_Z * plane], t[WEFT_LTC_Q * plane], t[WEFT_LTC_B * plane], t[WEFT_LTC_R * plane], cos_o);
    return (ltc->f0 * t[WEFT_LTC_AMPLITUDE * plane] + ltc->second * t[WEFT_LTC_AMPLITUDE_F90 * plane]) *
           ltc_above(m, dir(s, 0.0f, cos_o));
}

WeftLtcInfo weft_ltc_info(const WeftLtc *ltc) {
    WeftLtcInfo info = {.rows = ltc->rows,
                        .columns = ltc->columns,
                        .low = ltc->low,
                        .high = ltc->high,
                        .cached = ltc->cached,
                        .seconds = ltc->seconds};
    const float *error = weft_ltc_channel(ltc, WEFT_LTC_ERROR);
    double sum = 0.0;
    int count = 0;
    for (int cell = 0; cell < ltc_cells(ltc); cell++) {
        if (!(albedo(ltc, cell) >= 1e-3f)) continue;
        sum += (double)error[cell];
        count++;
        if (error[cell] <= info.worst_error) continue;
        info.worst_error = error[cell];
        info.worst_cos_o = ltc_cos_o(ltc, cell % ltc->columns);
        info.worst_value = weft_ltc_value(ltc, cell / ltc->columns);
    }
    if (count) info.mean_error = (float)(sum / count);
    return info;
}

WeftLtcLobe weft_ltc_at(const WeftLtc *ltc, float cos_o, float value) {
    LtcTable t = ltc_table_ref(ltc);
    LtcSpot s = ltc_table_spot(t, cos_o, value);
    return (WeftLtcLobe){ltc_table_interpolate(t, s, LTC_Z),         ltc_table_interpolate(t, s, LTC_Q),
                         ltc_table_interpolate(t, s, LTC_B),         ltc_table_interpolate(t, s, LTC_R),
                         ltc_table_interpolate(t, s, LTC_AMPLITUDE), ltc_table_interpolate(t, s, LTC_AMPLITUDE_F90)};
}

static Ltc transform(const WeftLtcLobe *lobe, const float wo[3]) {
    return ltc_of(lobe->z, lobe->q, lobe->b, lobe->r, clamp(wo[2], 0.0f, 1.0f));
}

void weft_ltc_inverse(const WeftLtcLobe *lobe, const float wo[3], float m[9]) {
    Dir o = dir(wo[0], wo[1], wo[2]);
    for (int k = 0; k < 3; k++) {
        Dir v = ltc_inverse(transform(lobe, wo), o, dir(k == 0, k == 1, k == 2));
        m[k] = v.x, m[3 + k] = v.y, m[6 + k] = v.z;
    }
}

float weft_ltc_pdf(const WeftLtcLobe *lobe, const float wo[3], const float wi[3]) {
    if (!(wo[2] >= 0.0f && wi[2] > 0.0f)) return 0.0f;
    return ltc_pdf(transform(lobe, wo), dir(wo[0], wo[1], wo[2]), dir(wi[0], wi[1], wi[2]));
}

float weft_ltc_sample(const WeftLtcLobe *lobe, const float wo[3], const float u[2], float wi[3]) {
    if (!(wo[2] >= 0.0f)) return 0.0f;
    Dir i = ltc_sample(transform(lobe, wo), dir(wo[0], wo[1], wo[2]), u[0], u[1]);
    wi[0] = i.x, wi[1] = i.y, wi[2] = i.z;
    return weft_ltc_pdf(lobe, wo, wi);
}
