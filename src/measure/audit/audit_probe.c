#include "measure/audit/audit_probe.h"

#include "base/thread.h"
#include "image/srgb.h"

/* Returns index k of `count` evenly spread over [0, size), symmetric about the middle. */
static int spread(int k, int count, int size) {
    if (k >= count - k) return size - 1 - spread(count - 1 - k, count, size);
    return count > 1 ? (int)((double)k * (size - 1) / (count - 1) + 0.5) : 0;
}

void probe_take(TableProbe *probe, const float *values, int width, int height) {
    probe->width = width;
    probe->height = height;
    probe->columns = width < PROBE_SIDE ? width : PROBE_SIDE;
    probe->rows = height < PROBE_SIDE ? height : PROBE_SIDE;
    for (int i = 0; i < probe->columns; i++) probe->x[i] = spread(i, probe->columns, width);
    for (int j = 0; j < probe->rows; j++) probe->y[j] = spread(j, probe->rows, height);
    for (int j = 0; j < probe->rows; j++)
        for (int i = 0; i < probe->columns; i++)
            probe->table[j * probe->columns + i] = values[(size_t)probe->y[j] * (size_t)width + (size_t)probe->x[i]];
}

/* Returns the probe of every other column and row, which costs a quarter. */
static TableProbe coarse_of(const TableProbe *probe) {
    TableProbe coarse = *probe;
    coarse.columns = (probe->columns + 1) / 2;
    coarse.rows = (probe->rows + 1) / 2;
    for (int n = 0; n < coarse.columns * coarse.rows; n++) {
        const int i = n % coarse.columns, j = n / coarse.columns, x = spread(i, coarse.columns, probe->columns),
                  y = spread(j, coarse.rows, probe->rows);
        coarse.x[i] = probe->x[x];
        coarse.y[j] = probe->y[y];
        coarse.table[n] = probe->table[y * probe->columns + x];
    }
    return coarse;
}

/* A reading whose distance by a coarse probe exceeds the least by this factor is dropped. */
static const double hopeless = 2.0;

/* E at the probed texels of a form without flips, which only permute them. */
typedef struct Albedos {
    const TableProbe *probe;
    BakePlane plane;
    BakeTexel at[PROBE_TEXELS];
} Albedos;

static void albedo_find(void *user, int item, int thread) {
    (void)thread;
    Albedos *e = user;
    const int i = item % e->probe->columns, j = item / e->probe->columns;
    e->at[item] = bake_texel(&e->plane, e->probe->x[i], e->probe->y[j]);
}

/* Evaluates E with form and late of the reading. `form` must outlive the result. */
static void albedos_find(const TableProbe *probe, const ProbeReading *reading, WeftTableForm *form, Albedos *e) {
    *form = reading->form;
    form->flip_x = form->flip_y = 0;
    e->probe = probe;
    e->plane = (BakePlane){.form = form,
                           .width = probe->width,
                           .height = probe->height,
                           .lobe = reading->lobe,
                           .tolerance = 3e-3, /* the distances of wrong readings are larger */
                           .late = reading->late};
    parallel_for(probe->threads, probe->columns * probe->rows, albedo_find, e);
}

/* Works as albedos_find for reading, whose axes are those of the last one exchanged. The texels of a square table
 * have the same cosines and parameters then, with rows and columns exchanged. */
static void albedos_exchange(const TableProbe *probe, const ProbeReading *reading, WeftTableForm *form, Albedos *e) {
    const int side = probe->columns;
    if (probe->width != probe->height) {
        albedos_find(probe, reading, form, e);
        return;
    }
    *form = reading->form;
    form->flip_x = form->flip_y = 0;
    for (int j = 0; j < side; j++)
        for (int i = 0; i < j; i++) {
            const BakeTexel kept = e->at[j * side + i];
            e->at[j * side + i] = e->at[i * side + j];
            e->at[i * side + j] = kept;
        }
}

/* Returns the place of the E of probed texel n, under the flips of a form. */
static int flipped(const TableProbe *probe, const WeftTableForm *form, int n) {
    const int i = n % probe->columns, j = n / probe->columns;
    return (form->flip_y ? probe->rows - 1 - j : j) * probe->columns + (form->flip_x ? probe->columns - 1 - i : i);
}

static bool judged(const BakeTexel *texel) { return !texel->beyond && texel->cos_o > 0.0f; }

static double value_read(const ProbeReading *reading, float value) {
    return reading->factor * (double)(reading->decoded ? srgb_decode(value) : value);
}

static double distance(const TableProbe *probe, const Albedos *e, const ProbeReading *reading) {
    double sum = 0.0;
    int count = 0;
    for (int n = 0; n < probe->columns * probe->rows; n++) {
        const BakeTexel *texel = &e->at[flipped(probe, &reading->form, n)];
        if (!judged(texel)) continue;
        sum += fabs(value_read(reading, probe->table[n]) - (double)texel->part[reading->part]);
        count++;
    }
    return count ? sum / count : HUGE_VAL;
}

/* Returns the mean of E over the texels that are judged. */
static double mean_albedo(const TableProbe *probe, const Albedos *e, const ProbeReading *reading) {
    double sum = 0.0;
    int count = 0;
    for (int n = 0; n < probe->columns * probe->rows; n++)
        if (judged(&e->at[n])) {
            sum += fabs((double)e->at[n].part[reading->part]);
            count++;
        }
    return count ? sum / count : 0.0;
}

/* Returns the factor that minimises the mean square of factor value - E. */
static double factor_find(const TableProbe *probe, const Albedos *e, const ProbeReading *reading) {
    double across = 0.0, along = 0.0;
    for (int n = 0; n < probe->columns * probe->rows; n++) {
        const BakeTexel *texel = &e->at[flipped(probe, &reading->form, n)];
        if (!judged(texel)) continue;
        across += (double)probe->table[n] * (double)texel->part[reading->part];
        along += (double)probe->table[n] * (double)probe->table[n];
    }
    return along > 0.0 ? across / along : 1.0;
}

/* Finds the nearest part, with the best factor if `scaled`. Then a distance counts by E where that is small, since any
 * table times 0 is near to an E of nothing. */
static void part_find(const TableProbe *probe, const Albedos *e, ProbeReading *reading, bool scaled) {
    const bool two = weft_lobe_info(reading->lobe.id)->traits & TRAIT_TWO_COLORS;
    ProbeReading best = *reading;
    for (int part = 0; part < (two ? WEFT_TABLE_PARTS : 1); part++) {
        ProbeReading now = *reading;
        now.part = (WeftTablePart)part;
        if (scaled) now.factor = factor_find(probe, e, &now);
        now.distance = distance(probe, e, &now);
        if (scaled) now.distance /= fmin(10.0 * mean_albedo(probe, e, &now) + 1e-9, 1.0);
        if (part == 0 || now.distance < best.distance) best = now;
    }
    *reading = best;
}

void probe_read(const TableProbe *probe, ProbeReading *reading) {
    Albedos e;
    WeftTableForm form;
    albedos_find(probe, reading, &form, &e);
    part_find(probe, &e, reading, false);
}

ProbeReading probe_scaled(const TableProbe *probe, const ProbeReading *reading) {
    Albedos e;
    WeftTableForm form;
    ProbeReading scaled = *reading;
    albedos_find(probe, reading, &form, &e);
    part_find(probe, &e, &scaled, true);
    return scaled;
}

/* Returns true if an engine uses these axes, apart from flips. */
static bool is_base(WeftTableForm form) {
    for (int k = 0; weft_table_form_name(k); k++) {
        WeftTableForm engine = weft_table_form_at(k);
        engine.flip_x = engine.flip_y = 0;
        if (form_same(&form, &engine)) return true;
    }
    return false;
}

/* Returns the margin by which a reading must be nearer to count as nearer. */
static double nothing(const TableProbe *probe) { return 1e-5 + 0.02 * probe->step; }

ProbeReading probe_best_form(const TableProbe *probe, const ProbeReading *reading, bool engines, bool scaled) {
    ProbeReading best = *reading;
    best.distance = HUGE_VAL;
    for (int base = 0; base < 16 && best.distance > nothing(probe); base++) {
        Albedos e;
        WeftTableForm form;
        ProbeReading now = *reading;
        now.form = (WeftTableForm){
            .transposed = base & 1, .alpha = base >> 1 & 1, .edges = base >> 2 & 1, .root = base >> 3 & 1};
        if (engines && !is_base(now.form)) continue;
        albedos_find(probe, &now, &form, &e);
        for (int flips = 0; flips < 4; flips++) {
            now.form.flip_x = flips & 1;
            now.form.flip_y = flips >> 1;
            if (engines && weft_table_form_find(&now.form) < 0) continue;
            part_find(probe, &e, &now, scaled);
            if (now.distance < 0.95 * best.distance - nothing(probe)) best = now;
        }
    }
    return best;
}

/* Returns true for a lobe whose tables are looked for, with its later parameters at their defaults. Lobes of woven
 * cloth have so many that no engine has a table of them. */
static bool is_candidate(int id) {
    enum { PARAMS_MOST = 4 };
    const WeftLobeInfo *info = weft_lobe_info(id);
    return !(info->traits & TRAIT_REFERENCE) && info->param_count <= PARAMS_MOST;
}

ProbeReading probe_best_lobe(const TableProbe *probe, const ProbeReading *reading, bool forms) {
    const TableProbe coarse = coarse_of(probe);
    ProbeReading best = *reading;
    best.distance = HUGE_VAL;
    for (int id = 0; id < weft_lobe_count() && best.distance > nothing(probe); id++) {
        if (id == reading->lobe.id || !is_candidate(id)) continue;
        ProbeReading now = *reading, rough;
        now.lobe = lobe_default(id);
        rough = now;
        probe_read(&coarse, &rough);
        if (forms && rough.distance > hopeless * best.distance) rough = probe_best_form(&coarse, &now, true, false);
        if (rough.distance > hopeless * best.distance) continue;
        probe_read(probe, &now);
        if (forms) {
            const ProbeReading other = probe_best_form(probe, &now, true, false);
            if (other.distance < now.distance) now = other;
        }
        if (now.distance < best.distance) best = now;
    }
    return best;
}

/* Tries the numbers as they are and decoded, and with `flips` in all flips. */
static void try_forms(const TableProbe *probe, const Albedos *e, ProbeReading now, bool flips, ProbeReading best[2]) {
    const WeftTableForm form = now.form;
    for (int k = 0; k < (flips ? 8 : 2); k++) {
        now.form = form;
        now.decoded = k & 1;
        if (flips) now.form.flip_x = k >> 1 & 1, now.form.flip_y = k >> 2;
        part_find(probe, e, &now, false);
        ProbeReading *nearest = &best[now.decoded];
        if (now.distance < 0.95 * nearest->distance - nothing(probe)) *nearest = now;
    }
}

/* Tries a form and, with `all`, the one with its axes exchanged, each in all flips. */
static void try_pair(const TableProbe *probe, ProbeReading now, bool all, ProbeReading best[2]) {
    Albedos e;
    WeftTableForm bare;
    albedos_find(probe, &now, &bare, &e);
    try_forms(probe, &e, now, all, best);
    if (!all) return;
    now.form.transposed = 1;
    albedos_exchange(probe, &now, &bare, &e);
    try_forms(probe, &e, now, all, best);
}

static bool is_hopeless(const TableProbe *coarse, const ProbeReading *now, bool all, const ProbeReading best[2]) {
    ProbeReading rough[2] = {{.distance = HUGE_VAL}, {.distance = HUGE_VAL}};
    try_pair(coarse, *now, all, rough);
    return rough[0].distance > hopeless * best[0].distance && rough[1].distance > hopeless * best[1].distance;
}

ProbeReading probe_any(const TableProbe *probe, const WeftTableForm *form) {
    const double explained = 0.25; /* as in audit.c */
    const TableProbe coarse = coarse_of(probe);
    ProbeReading best[2] = {{.distance = HUGE_VAL}, {.distance = HUGE_VAL}};
    for (int id = 0; id < weft_lobe_count(); id++) {
        if (!is_candidate(id)) continue;
        for (int base = 0; base < (form ? 1 : 8); base++) {
            ProbeReading now = {.lobe = lobe_default(id), .factor = 1.0};
            now.form = form ? *form : (WeftTableForm){.alpha = base & 1, .edges = base >> 1 & 1, .root = base >> 2};
            if (!is_hopeless(&coarse, &now, !form, best)) try_pair(probe, now, !form, best);
        }
    }
    return best[best[1].distance < explained * best[0].distance];
}

/* Tries a form, scaled or as it is, and with `all` the one with its axes exchanged too, each in all flips. */
static void try_hidden(const TableProbe *probe, ProbeReading now, bool all, bool scaled, ProbeReading *best) {
    Albedos e;
    WeftTableForm bare;
    for (int k = 0; k < (all ? 8 : 1); k++) {
        if (all) now.form.transposed = k >> 2, now.form.flip_x = k & 1, now.form.flip_y = k >> 1 & 1;
        if (k == 0) albedos_find(probe, &now, &bare, &e);
        if (k == 4) albedos_exchange(probe, &now, &bare, &e);
        part_find(probe, &e, &now, scaled);
        if (now.distance < 0.95 * best->distance - nothing(probe)) *best = now;
    }
}

ProbeReading probe_any_hidden(const TableProbe *probe, const WeftTableForm *form) {
    const TableProbe coarse = coarse_of(probe);
    ProbeReading best = {.distance = HUGE_VAL};
    for (int id = 0; id < weft_lobe_count(); id++)
        for (int base = 0; is_candidate(id) && base < (form ? 1 : 8); base++)
            for (int late = -1; late <= 1; late++) {
                ProbeReading now = {.lobe = lobe_default(id), .factor = 1.0, .late = late};
                now.form = form ? *form : (WeftTableForm){.alpha = base & 1, .edges = base >> 1 & 1, .root = base >> 2};
                try_hidden(&coarse, now, !form, late == 0, &best);
            }
    if (!isfinite(best.distance)) return best;
    if (best.late == 0) return probe_scaled(probe, &best);
    probe_read(probe, &best);
    return best;
}

bool probe_flat(const Lobe *lobe, int threads) {
    TableProbe probe = {.threads = threads};
    const float none[64] = {0};
    const ProbeReading reading = {.lobe = *lobe, .factor = 1.0};
    Albedos e;
    WeftTableForm form;
    probe_take(&probe, none, 8, 8);
    albedos_find(&probe, &reading, &form, &e);
    float low = e.at[0].part[WEFT_TABLE_SUM], high = low;
    for (int n = 1; n < probe.columns * probe.rows; n++) {
        low = fminf(low, e.at[n].part[WEFT_TABLE_SUM]);
        high = fmaxf(high, e.at[n].part[WEFT_TABLE_SUM]);
    }
    return high - low < 1e-3f;
}
