/* audit.c - compares a given table of E with quadrature: the errors, and what would explain them */
#include <stdio.h>
#include <stdlib.h>

#include "base/equal.h"
#include "base/fail.h"
#include "base/memory.h"
#include "measure/audit/audit_probe.h"
#include "measure/audit/audit_words.h"
#include "measure/bsdf/exceeds.h"

/* An explanation must leave less than this fraction of the error. */
static const double explained = 0.25;

typedef struct AuditWork {
    const WeftAuditDesc *desc;
    double most, tolerance;
    int width, height;
    int step;      /* width of a cell of the map, in texels */
    float *values; /* values of the channel, times scale */
    Lobe lobe;
    TableProbe probe;
    ProbeReading reading; /* the reading by which the table is judged */
    BakePlane plane;
    WeftImage *errors;            /* error, table, E; E below 0 while a texel is not judged */
    double met[WEFT_THREADS_MAX]; /* the largest estimate of the quadrature's error, by thread */
} AuditWork;

/* ---- reading ---- */

static WeftResult check(const WeftAuditDesc *desc, AuditWork *work, WeftError *error) {
    const WeftImage *image = desc->image;
    if (!image || !image->pixels || desc->channel < 0 || desc->channel >= image->channels)
        return fail(error, WEFT_MESSAGE_DESC, "table", "it has %d channels, and no channel %d",
                    image ? image->channels : 0, desc->channel);
    if ((int64_t)image->width * image->height > WEFT_BAKE_TEXELS_MAX)
        return fail(error, WEFT_MESSAGE_DESC, "table", "%d x %d; at most %d texels are audited", image->width,
                    image->height, WEFT_BAKE_TEXELS_MAX);
    if (desc->lobe && !lobe_of(desc->lobe, &work->lobe))
        return fail(error, WEFT_MESSAGE_DESC, "table", "the lobe to compare it with does not exist");
    if (desc->threads < 0 || desc->threads > WEFT_THREADS_MAX)
        return fail(error, WEFT_MESSAGE_DESC, "threads", "%d", desc->threads);
    return WEFT_OK;
}

static WeftResult values_take(AuditWork *work, WeftError *error) {
    const WeftImage *image = work->desc->image;
    const size_t count = (size_t)image->width * (size_t)image->height;
    WeftImage floats;
    WeftResult result = weft_image_convert_f32(image, 0, &floats, error);
    if (result != WEFT_OK) return result;
    work->values = alloc_array(count, sizeof(float));
    for (size_t n = 0; work->values && n < count; n++)
        work->values[n] =
            (float)(work->desc->scale *
                    (double)((float *)floats.pixels)[n * (size_t)image->channels + (size_t)work->desc->channel]);
    weft_image_free(&floats);
    return work->values ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, "table", NULL);
}

/* ---- the map ---- */

static float *map_at(const AuditWork *work, int x, int y) {
    return (float *)work->errors->pixels + 3 * ((size_t)y * (size_t)work->width + (size_t)x);
}

enum { CELL = 64, NODES = (CELL + 1) * (CELL + 1), EXACT_TEXELS = 128 * 128 };

/* Returns the number of texels along a side of a cell: a sixteenth of the shorter side of a large table,
 * within bounds. */
static int cell_size(const AuditWork *work) {
    const int side = work->width < work->height ? work->width : work->height;
    if (work->width * work->height <= EXACT_TEXELS) return 1;
    return side / 16 < CELL / 2 ? CELL / 2 : side / 16 > CELL ? CELL : side / 16;
}

/* A square of a large table. Its last column and row are the first of its neighbours. */
typedef struct Cell {
    AuditWork *work;
    int thread, x, y; /* of its first texel */
    float e[NODES];   /* below 0 if a texel is not judged */
    bool done[NODES];
} Cell;

static float cell_exact(Cell *cell, int i, int j) {
    AuditWork *work = cell->work;
    const int n = j * (CELL + 1) + i;
    if (cell->done[n]) return cell->e[n];
    cell->done[n] = true;
    if (!bake_judges(&work->plane, cell->x + i, cell->y + j)) return cell->e[n] = -1.0f;
    const BakeTexel texel = bake_texel(&work->plane, cell->x + i, cell->y + j);
    if (exceeds_or_nan(texel.error, work->met[cell->thread])) work->met[cell->thread] = texel.error;
    return cell->e[n] = texel.part[work->reading.part];
}

/* Columns i[0] .. i[2] and rows j[0] .. j[2] of a cell, the middle ones at 1. E is evaluated where they
 * cross, and interpolated biquadratically between. */
typedef struct TexelPatch {
    int i[3], j[3];
} TexelPatch;

static TexelPatch patch_of(int i0, int i1, int j0, int j1) {
    return (TexelPatch){{i0, (i0 + i1) / 2, i1}, {j0, (j0 + j1) / 2, j1}};
}

/* Computes Lagrange's weights of three places at x, or of two if the middle one is the first. */
static void weights_at(const int places[3], int x, float weight[3]) {
    const float a = (float)(x - places[0]), b = (float)(x - places[1]), c = (float)(x - places[2]),
                ab = (float)(places[1] - places[0]), bc = (float)(places[2] - places[1]), ac = ab + bc;
    const bool two = places[1] == places[0];
    weight[1] = two ? 0.0f : -a * c / (ab * bc);
    weight[2] = two ? (ac > 0.0f ? a / ac : 0.0f) : a * b / (ac * bc);
    weight[0] = 1.0f - weight[1] - weight[2];
}

static float patch_at(Cell *cell, const TexelPatch *p, int i, int j) {
    float across[3], along[3], e = 0.0f;
    weights_at(p->i, i, across);
    weights_at(p->j, j, along);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            e += along[row] * across[column] * cell_exact(cell, p->i[column], p->j[row]);
    return e;
}

/* Returns the difference of E at a place of the cell from the interpolation over the patch. */
static float patch_error(Cell *cell, const TexelPatch *p, int i, int j) {
    return fabsf(cell_exact(cell, i, j) - patch_at(cell, p, i, j));
}

static int quarter(const int places[3], int k) { return (places[k] + places[k + 1]) / 2; }

/* Returns the largest error of a patch half-way between its places, in each row or in each column. These are
 * places of its halves. */
static float patch_curvature(Cell *cell, const TexelPatch *p, bool down) {
    float most = 0.0f;
    for (int k = 0; k < 6; k++)
        most = fmaxf(most, down ? patch_error(cell, p, p->i[k >> 1], quarter(p->j, k & 1))
                                : patch_error(cell, p, quarter(p->i, k & 1), p->j[k >> 1]));
    return most;
}

/* Returns true if the interpolation over the patch holds in the middles of its quarters. If it has no rows or
 * columns between its places, each line is tested by itself, since neighbours may be unrelated. */
static bool patch_holds(Cell *cell, const TexelPatch *p, bool wide, bool high) {
    const float allowed = (float)(2.0 * cell->work->tolerance);
    bool holds = true;
    if (!wide || !high) return patch_curvature(cell, p, high) <= allowed;
    for (int k = 0; k < 4; k++) holds &= patch_error(cell, p, quarter(p->i, k & 1), quarter(p->j, k >> 1)) <= allowed;
    return holds;
}

/* Returns true if, in a row or, with `below`, in a column of the patch, some places are judged and some are not. */
static bool patch_is_mixed(Cell *cell, const TexelPatch *p, bool below) {
    bool mixed = false;
    for (int k = 0; k < 3; k++) {
        int judged = 0;
        for (int m = 0; m < 3; m++) judged += cell_exact(cell, p->i[below ? k : m], p->j[below ? m : k]) >= 0.0f;
        mixed |= judged % 3 != 0;
    }
    return mixed;
}

static void patch_take(Cell *cell, const TexelPatch *p) {
    for (int j = p->j[0]; j <= p->j[2]; j++)
        for (int i = p->i[0]; i <= p->i[2]; i++) {
            const int n = j * (CELL + 1) + i;
            if (!cell->done[n]) cell->e[n] = patch_at(cell, p, i, j);
            cell->done[n] = true;
        }
}

/* Fills a patch by interpolation if that holds, and otherwise half by half, down to the texel. E may be
 * curved in one direction only, as at grazing views, or end in one, as beyond the range of a lobe: the halves
 * are cut there. A patch of which nothing is judged is not cut. */
static void patch_fill(Cell *cell, TexelPatch p) {
    const bool wide = p.i[2] - p.i[0] > 2, high = p.j[2] - p.j[0] > 2;
    const bool mixed = wide && patch_is_mixed(cell, &p, false), mixed_down = high && patch_is_mixed(cell, &p, true);
    if (!mixed && !mixed_down && ((!wide && !high) || patch_holds(cell, &p, wide, high))) {
        patch_take(cell, &p);
        return;
    }
    const bool cut_down = mixed != mixed_down
                              ? mixed_down
                              : high && (!wide || patch_curvature(cell, &p, true) > patch_curvature(cell, &p, false));
    for (int half = 0; half < 2; half++)
        patch_fill(cell, cut_down ? patch_of(p.i[0], p.i[2], p.j[half], p.j[half + 1])
                                  : patch_of(p.i[half], p.i[half + 1], p.j[0], p.j[2]));
}

static void map_put(AuditWork *work, int x, int y, float e) {
    const float value = work->values[(size_t)y * (size_t)work->width + (size_t)x];
    float *to = map_at(work, x, y);
    const bool judged = e >= 0.0f;
    to[0] = judged ? value - e : 0.0f;
    to[1] = judged ? value : 0.0f;
    to[2] = e;
}

/* Measures the texels of a small table one by one, and those of a large one where E is curved. */
static void map_cell(void *user, int column, int row, int thread) {
    AuditWork *work = user;
    const int step = work->step, x = column * step, y = row * step;
    Cell cell = {.work = work, .thread = thread, .x = x, .y = y};
    const int wide = x + step < work->width ? step : work->width - 1 - x,
              high = y + step < work->height ? step : work->height - 1 - y;
    if (step == 1)
        cell_exact(&cell, 0, 0);
    else
        patch_fill(&cell, patch_of(0, wide, 0, high));
    for (int j = 0; j < step && y + j < work->height; j++)
        for (int i = 0; i < step && x + i < work->width; i++) map_put(work, x + i, y + j, cell.e[j * (CELL + 1) + i]);
}

static void measure(const AuditWork *work, WeftAudit *out) {
    double sum = 0.0, squares = 0.0, products = 0.0, sizes = 0.0;
    long long beyond = 0;
    out->largest = -1.0;
    for (int y = 0; y < work->height; y++)
        for (int x = 0; x < work->width; x++) {
            const float *here = map_at(work, x, y);
            const double e = (double)here[0];
            if (here[2] < 0.0f) {
                out->left_out++;
                continue;
            }
            out->texels++;
            sum += e;
            squares += e * e;
            beyond += !(fabs(e) <= work->most);
            if (exceeds_or_nan(fabs(e), out->largest)) {
                out->largest = fabs(e);
                out->place = (WeftTablePlace){.x = x, .y = y, .table = here[1], .albedo = here[2]};
            }
            for (int side = 0; side < 2; side++) { /* the neighbours to the right and below */
                if (side ? y + 1 == work->height : x + 1 == work->width) continue;
                const float *other = map_at(work, x + !side, y + side);
                if (other[2] < 0.0f) continue;
                products += e * (double)other[0];
                sizes += 0.5 * (e * e + (double)other[0] * (double)other[0]);
            }
        }
    for (int k = 0; k < WEFT_THREADS_MAX; k++)
        if (exceeds_or_nan(work->met[k], out->error)) out->error = work->met[k];
    if (out->texels == 0) return;
    weft_table_form_texel(&out->form, work->lobe.id, work->width, work->height, out->place.x, out->place.y,
                          &out->place.cos_o, &out->place.value);
    out->mean = sum / (double)out->texels;
    out->rms = (sqrt)(squares / (double)out->texels);
    out->beyond = (double)beyond / (double)out->texels;
    out->together = sizes > 0.0 ? products / sizes : 0.0;
}

/* ---- what is wrong ---- */

static void find(WeftAudit *out, WeftTableFault fault) {
    if (out->faults < WEFT_AUDIT_FINDINGS) out->found[out->faults++].fault = fault;
}

static char *last_text(WeftAudit *out) { return out->found[out->faults - 1].text; }

static double mean_value(const AuditWork *work) {
    const size_t count = (size_t)work->width * (size_t)work->height;
    double sum = 0.0;
    for (size_t n = 0; n < count; n++) sum += (double)work->values[n];
    return sum / (double)count;
}

/* Returns true if the table is one value. */
static bool is_constant(const AuditWork *work) {
    const size_t count = (size_t)work->width * (size_t)work->height;
    bool same = true;
    for (size_t n = 1; n < count && same; n++) same = is_equal(work->values[n], work->values[0]);
    return same;
}

/* Reports a table that is one value, where E of the lobe that is given is not. */
static bool find_constant(const AuditWork *work, WeftAudit *out) {
    if (!is_constant(work) || (work->desc->lobe && probe_flat(&work->lobe, work->desc->threads))) return false;
    find(out, WEFT_TABLE_CONSTANT);
    words_constant(last_text(out), (double)work->values[0], (size_t)work->width * (size_t)work->height);
    return true;
}

/* Returns the form of an engine that fits best; if none fits, the commonest, unless another is much nearer. */
static ProbeReading guess_form(const AuditWork *work, double enough) {
    ProbeReading common = work->reading;
    probe_read(&work->probe, &common);
    if (common.distance <= 1e-5) return common;
    const ProbeReading best = probe_best_form(&work->probe, &common, true, false);
    return best.distance <= enough || best.distance < 0.5 * common.distance ? best : common;
}

/* Decides how the table is read: as stated, or as it fits best. */
static void choose_form(AuditWork *work, WeftAudit *out) {
    const double enough = 1e-3 + work->probe.step;
    const bool stated = work->desc->form;
    ProbeReading *reading = &work->reading;
    if (stated) {
        reading->form = *work->desc->form;
        probe_read(&work->probe, reading);
    } else {
        *reading = guess_form(work, enough);
    }
    out->fits = reading->distance <= enough;
    if (out->fits) return;
    ProbeReading best = probe_best_form(&work->probe, reading, false, false);
    if (!stated && best.distance >= explained * reading->distance) /* a factor may hide the axes */
        best = probe_best_form(&work->probe, reading, true, true);
    if (best.distance >= explained * reading->distance) return;
    if (stated) {
        find(out, WEFT_TABLE_FORM);
        words_form(last_text(out), reading, &best, enough);
    } else {
        out->fits = best.distance <= enough;
        reading->form = best.form;
        probe_read(&work->probe, reading);
    }
}

/* Chooses the lobe and the axes to which the table is nearest, encoded or not, or else shifted or times a factor;
 * find_cause then decides which. Returns true if one of these is the whole difference. */
static bool choose_lobe(AuditWork *work) {
    const double enough = 1e-3 + work->probe.step;
    ProbeReading best = probe_any(&work->probe, work->desc->form);
    if (best.distance > enough && !is_constant(work)) {
        const ProbeReading hidden = probe_any_hidden(&work->probe, work->desc->form);
        if (hidden.distance <= enough) best = hidden;
    }
    work->lobe = best.lobe;
    work->reading = (ProbeReading){.lobe = best.lobe, .form = best.form, .factor = 1.0};
    return best.distance <= enough;
}

/* Reports values cut off at the largest of the table, if they are almost all of those that are wrong. */
static bool find_clipped(const AuditWork *work, WeftAudit *out) {
    const size_t count = (size_t)work->width * (size_t)work->height;
    float top = work->values[0], highest = 0.0f;
    size_t wrong = 0, cut = 0;
    for (size_t n = 1; n < count; n++) top = fmaxf(top, work->values[n]);
    for (size_t n = 0; n < count; n++) {
        const float *texel = (const float *)work->errors->pixels + 3 * n;
        highest = fmaxf(highest, texel[2]);
        if (fabs((double)texel[0]) <= work->most) continue;
        wrong++;
        if (texel[0] < 0.0f && texel[1] >= top) cut++;
    }
    if (cut < 2 || (double)cut < 0.9 * (double)wrong) return false;
    find(out, WEFT_TABLE_CLIPPED);
    words_clipped(last_text(out), (double)top, (double)highest, cut);
    return true;
}

/* Tries one reading after another, for one that explains most of the error. */
static void find_cause(AuditWork *work, WeftAudit *out) {
    const ProbeReading *reading = &work->reading;
    const double enough = explained * reading->distance;
    if (find_clipped(work, out) || !(reading->distance > 2e-4 + work->probe.step)) return;
    for (int late = 1; late >= -1; late -= 2) {
        ProbeReading other = *reading;
        other.late = late;
        probe_read(&work->probe, &other);
        if (other.distance >= enough) continue;
        find(out, WEFT_TABLE_LATE);
        words_late(last_text(out), reading, &other);
        return;
    }
    ProbeReading decoded = *reading;
    decoded.decoded = true;
    probe_read(&work->probe, &decoded);
    if (decoded.distance < enough) {
        find(out, WEFT_TABLE_ENCODED);
        words_encoded(last_text(out), reading, &decoded);
        return;
    }
    const ProbeReading scaled = probe_scaled(&work->probe, reading);
    if (scaled.distance < enough) {
        find(out, WEFT_TABLE_SCALED);
        words_scaled(last_text(out), reading, &scaled);
        return;
    }
    if (!work->desc->lobe) return; /* all others are further away */
    const ProbeReading other = probe_best_lobe(&work->probe, reading, !work->desc->form);
    if (other.distance >= enough || other.distance > 0.1 * mean_value(work)) return;
    find(out, WEFT_TABLE_OTHER_LOBE);
    out->other = other.lobe.id;
    words_lobe(last_text(out), reading, &other);
}

static int compare_floats(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Computes table / E at a tenth, half and nine tenths of the texels whose E is not small. Returns false if
 * memory is short. */
static bool ratios_find(const AuditWork *work, double ratios[3]) {
    const size_t count = (size_t)work->width * (size_t)work->height;
    float *all = alloc_array(count, sizeof *all);
    if (!all) return false;
    size_t used = 0;
    for (size_t n = 0; n < count; n++) {
        const float *texel = (const float *)work->errors->pixels + 3 * n;
        if (texel[2] > 0.01f) all[used++] = texel[1] / texel[2];
    }
    qsort(all, used, sizeof *all, compare_floats);
    for (size_t k = 0; k < 3; k++) ratios[k] = used ? (double)all[(used - 1) * (1 + 4 * k) / 10] : 1.0;
    free(all);
    return true;
}

/* Classifies the errors by their pattern if nothing else explains them. */
static bool find_kind(const AuditWork *work, WeftAudit *out) {
    const double few = 0.02, both = 0.3, far = 0.05;
    double ratios[3];
    if (out->largest <= work->most) return true;
    if (!work->desc->lobe && !out->fits && out->together > both &&
        work->reading.distance > far * fabs(mean_value(work))) {
        find(out, WEFT_TABLE_OTHER_LOBE);
        words_no_lobe(last_text(out), &work->reading);
        return true;
    }
    if (out->beyond < few) {
        find(out, WEFT_TABLE_CORNER);
        words_corner(last_text(out), out, work->most, work->lobe.id);
        return true;
    }
    if (out->together > both) {
        if (!ratios_find(work, ratios)) return false;
        find(out, WEFT_TABLE_BIASED);
        words_biased(last_text(out), out, ratios);
    }
    if (out->together < 1.0 - both) {
        find(out, WEFT_TABLE_NOISY);
        words_noisy(last_text(out), out);
    }
    return true;
}

static WeftResult map_make(AuditWork *work, WeftError *error) {
    const WeftAuditDesc *desc = work->desc;
    WeftResult result = weft_image_create(work->width, work->height, 3, WEFT_PIXEL_F32, work->errors, error);
    if (result != WEFT_OK) return result;
    work->plane = (BakePlane){.form = &work->reading.form,
                              .width = work->width,
                              .height = work->height,
                              .lobe = work->lobe,
                              .tolerance = work->tolerance};
    work->step = cell_size(work);
    result = bake_texels((work->width + work->step - 1) / work->step, (work->height + work->step - 1) / work->step,
                         desc->threads, desc->progress, desc->user, map_cell, work);
    if (work->step > 1) work->met[0] += 2.0 * work->tolerance; /* of patches, which are tested in four places */
    return result;
}

static WeftResult audit(AuditWork *work, WeftAudit *out, WeftError *error) {
    out->step = work->probe.step;
    probe_take(&work->probe, work->values, work->width, work->height);
    if (work->desc->lobe)
        work->reading = (ProbeReading){.lobe = work->lobe, .factor = 1.0};
    else
        out->fits = choose_lobe(work);
    out->lobe = work->lobe.id;
    if (!work->desc->lobe) {
        probe_read(&work->probe, &work->reading);
        if (!out->fits) find_constant(work, out);
    } else if (!find_constant(work, out)) {
        choose_form(work, out);
    } else {
        if (work->desc->form) work->reading.form = *work->desc->form;
        probe_read(&work->probe, &work->reading);
    }
    out->form = work->reading.form;
    out->part = work->reading.part;
    WeftResult result = map_make(work, error);
    if (result != WEFT_OK) return result;
    measure(work, out);
    if (out->texels == 0)
        return fail(error, WEFT_MESSAGE_DESC, "table", "no texel is within the range of %s",
                    weft_lobe_info(work->lobe.id)->id);
    if (out->faults == 0) find_cause(work, out);
    if (out->faults == 0 && !find_kind(work, out)) return fail(error, WEFT_MESSAGE_MEMORY, "table", NULL);
    if (out->faults == 0) {
        find(out, WEFT_TABLE_NONE);
        words_none(last_text(out), out);
    }
    return WEFT_OK;
}

/* Sets texels that were not judged to 0 in all channels. */
static void map_finish(WeftImage *errors) {
    float *texel = errors->pixels;
    for (size_t n = (size_t)errors->width * (size_t)errors->height; n > 0; n--, texel += 3)
        texel[2] = fmaxf(texel[2], 0.0f);
}

WeftResult weft_audit(const WeftAuditDesc *desc, WeftAudit *out, WeftImage *errors, WeftError *error) {
    WeftImage own = {0};
    WeftAuditDesc full = *desc;
    AuditWork work = {.desc = &full, .errors = errors ? errors : &own};
    *out = (WeftAudit){.other = -1};
    *work.errors = (WeftImage){0};
    WeftResult result = check(desc, &work, error);
    if (result != WEFT_OK) return result;
    if (!(full.scale > 0.0)) full.scale = 1.0;
    work.most = full.most > 0.0 ? full.most : 0.01;
    work.tolerance = full.tolerance > 0.0 ? full.tolerance : 1e-4;
    work.width = full.image->width;
    work.height = full.image->height;
    work.probe.threads = full.threads;
    if (full.image->type != WEFT_PIXEL_F32)
        work.probe.step = full.scale / (full.image->type == WEFT_PIXEL_U8 ? 255.0 : 65535.0);
    result = values_take(&work, error);
    if (result == WEFT_OK) result = audit(&work, out, error);
    free(work.values);
    if (result == WEFT_OK && errors)
        map_finish(errors);
    else
        weft_image_free(work.errors);
    return result;
}

#define FAULT_NAME(id, name) name,
static const char *const fault_names[WEFT_TABLE_FAULT_COUNT] = {WEFT_TABLE_FAULTS(FAULT_NAME)};

const char *weft_table_fault_name(WeftTableFault fault) {
    return (unsigned)fault < WEFT_TABLE_FAULT_COUNT ? fault_names[fault] : "";
}
