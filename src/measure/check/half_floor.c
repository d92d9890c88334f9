#include "measure/check/half_floor.h"

#include <pthread.h>

#include "base/pi.h"
#include "base/random.h"
#include "base/thread.h"
#include "measure/check/half_precision.h"
#include "measure/check/sweep.h"
#include "shading/lobe/lobe_tables.h"

static void set_tables(void) {
    enum { COUNT = sizeof lobe_table_refs / sizeof lobe_table_refs[0] };
    HalfTable tables[COUNT];
    lobe_tables_make();
    for (int k = 0; k < COUNT; k++)
        tables[k] = (HalfTable){.texels = lobe_table_refs[k].texels,
                                .kind = lobe_table_refs[k].kind,
                                .rows = lobe_table_refs[k].rows,
                                .columns = lobe_table_refs[k].columns,
                                .low = lobe_table_refs[k].low,
                                .high = lobe_table_refs[k].high};
    half_tables(tables, COUNT);
}

/* Returns the direction with its cosine raised to the floor and its tangential part shortened to match. */
static Dir raised(Dir w, double floor_z) {
    double z = (double)w.z;
    if (z >= floor_z) return w;
    double s = hypot((double)w.x, (double)w.y), k = s > 0.0 ? (sqrt)(1.0 - floor_z * floor_z) / s : 0.0;
    return dir((float)((double)w.x * k), (float)((double)w.y * k), (float)floor_z);
}

/* Counts the pairs of the sweep whose f is not finite or negative; `place` becomes the one farthest from
 * grazing. If place is NULL, stops at the first. */
static long long bad_pairs(const Lobe *lobe, double floor_z, WeftPlace *place) {
    long long bad = 0;
    for (int k = 0; k < SWEEP_DIRS && (place || !bad); k++) {
        Partners p;
        float ox[SWEEP_PARTNERS], oy[SWEEP_PARTNERS], oz[SWEEP_PARTNERS], f[SWEEP_PARTNERS];
        Dir o = sweep_dir(k), seen = raised(o, floor_z);
        sweep_partners(o, k, false, &p);
        for (int j = 0; j < p.count; j++) {
            Dir i = raised(dir(p.x[j], p.y[j], p.z[j]), floor_z);
            ox[j] = seen.x, oy[j] = seen.y, oz[j] = seen.z;
            p.x[j] = i.x, p.y[j] = i.y, p.z[j] = i.z;
        }
        half_eval(lobe->id, lobe->params, (size_t)p.count, ox, oy, oz, p.x, p.y, p.z, f);
        for (int j = 0; j < p.count; j++) {
            if (sweep_finite(f[j]) && f[j] >= 0.0f) continue;
            bad++;
            if (!place || !(min(seen.z, p.z[j]) > min(place->cos_o, place->cos_i))) continue;
            double phi = atan2((double)p.y[j], (double)p.x[j]) - atan2((double)seen.y, (double)seen.x);
            *place = (WeftPlace){lobe->params[0], seen.z, p.z[j], (float)(phi * (180.0 / PI_DOUBLE))};
        }
    }
    return bad;
}

/* Returns the exponent of the smallest floor that helps, WEFT_HALF_FREE if none is needed, 0 if none helps. */
static int least_floor(const Lobe *lobe) {
    for (int e = WEFT_HALF_FREE; e >= WEFT_HALF_MOST; e--)
        if (bad_pairs(lobe, e == WEFT_HALF_FREE ? 0.0 : ldexp(1.0, -e), NULL) == 0) return e;
    return 0;
}

/* Returns a direction of cosine 0.1 to 1, uniform in solid angle. */
static Dir ordinary_dir(uint32_t k) {
    float z = 0.1f + 0.9f * unit_float(hash32(k)), phi = 2.0f * PI_FLOAT * unit_float(hash32(k + 1u));
    float s = (sqrtf)(1.0f - z * z);
    return dir(s * (cosf)(phi), s * (sinf)(phi), z);
}

/* Finds the fractions of ordinary pairs whose f is 0 in half alone, and whose f is off by more than 1 %. */
static void find_losses(const Lobe *lobe, float *zero, float *off) {
    enum { PAIRS = 4096 };
    static const float tolerance = 0.01f;
    float o[3][PAIRS], i[3][PAIRS], f[PAIRS];
    int zeros = 0, offs = 0;
    for (int k = 0; k < PAIRS; k++) {
        Dir a = ordinary_dir(4u * (uint32_t)k), b = ordinary_dir(4u * (uint32_t)k + 2u);
        o[0][k] = a.x, o[1][k] = a.y, o[2][k] = a.z;
        i[0][k] = b.x, i[1][k] = b.y, i[2][k] = b.z;
    }
    half_eval(lobe->id, lobe->params, PAIRS, o[0], o[1], o[2], i[0], i[1], i[2], f);
    for (int k = 0; k < PAIRS; k++) {
        float right = lobe_eval(lobe, angles_between(dir(o[0][k], o[1][k], o[2][k]), dir(i[0][k], i[1][k], i[2][k])));
        zeros += right > 0.0f && f[k] <= 0.0f;
        offs += !(fabsf(f[k] - right) <= tolerance * right);
    }
    *zero = (float)zeros / PAIRS;
    *off = (float)offs / PAIRS;
}

typedef struct FloorRows {
    const Bsdf *bsdf;
    WeftPassport *out;
    long long bad[WEFT_PASSPORT_ROWS];
    WeftPlace place[WEFT_PASSPORT_ROWS];
} FloorRows;

static void measure_row(void *user, int row, int thread) {
    (void)thread;
    FloorRows *rows = user;
    Lobe lobe = bsdf_lobe(rows->bsdf, row);
    WeftPlace ignored = {0};
    rows->bad[row] = bad_pairs(&lobe, 0.0, &ignored);
    rows->out->half_floor[row] = least_floor(&lobe);
    find_losses(&lobe, &rows->out->half_zero[row], &rows->out->half_off[row]);
    if (!rows->out->half_floor[row]) bad_pairs(&lobe, ldexp(1.0, -WEFT_HALF_MOST), &rows->place[row]);
}

/* Searches the parameter from the high end of its plausible range downwards, in steps of 2^(1/4), or of 1/64
 * of the range if it starts at 0, to the end of the hard range or to the first value that no floor saves. */
static void find_pair(const Lobe *given, const WeftParamInfo *p, WeftPassport *out) {
    for (int k = 0; k < 256; k++) {
        float value = p->low > 0.0f ? p->high * (float)(exp2)(-0.25 * k) : p->high * (1.0f - (float)k / 64.0f);
        Lobe lobe = *given;
        value = max(value, p->hard_low);
        lobe_set(&lobe, 0, value);
        int e = least_floor(&lobe);
        if (!e) break;
        if (k == 0 || e < out->half_cosine) out->half_cosine = e;
        out->half_parameter = value;
        out->half_whole = value <= p->hard_low;
        if (out->half_whole) break;
    }
}

void half_floor_measure(const Bsdf *bsdf, WeftPassport *out, int threads) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    unsigned traits = bsdf->whole ? 0u : weft_lobe_info(bsdf->lobe.id)->traits;
    out->half_measured = half_here() && !bsdf->whole && !(traits & TRAIT_REFERENCE) &&
                         !outside_lobe(bsdf->lobe.id); /* outside lobes have no copy in half floats */
    if (!out->half_measured) return;
    if (traits & TRAIT_TABLE) pthread_once(&once, set_tables);
    FloorRows rows = {.bsdf = bsdf, .out = out};
    parallel_for(threads, bsdf->rows, measure_row, &rows);
    out->half_count = (long long)bsdf->rows * SWEEP_DIRS * (SWEEP_DIRS + 16);
    for (int k = bsdf->rows - 1; k >= 0; k--) {
        out->half_bad += rows.bad[k];
        if (!out->half_floor[k] && !(out->half_place.cos_o > 0.0f)) out->half_place = rows.place[k];
    }
    if (*bsdf->parameter) {
        find_pair(&bsdf->lobe, &weft_lobe_info(bsdf->lobe.id)->params[0], out);
    } else {
        out->half_cosine = out->half_floor[0];
        out->half_whole = 1;
    }
}
