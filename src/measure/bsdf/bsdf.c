#include <stdlib.h>

#include "measure/bsdf/bsdf.h"

#include "base/equal.h"
#include "base/memory.h"
#include "base/thread.h"
#include "scene/material/material_numbers.h"
#include "scene/record/material_at.h"

/* ---- lobes ---- */

static bool is_number(const WeftLobeInfo *info) { return info->param_count > 0 && !info->params[0].choices; }

/* Sets *out to extreme k of a lobe: all parameters at their hard ends together, then each alone. A choice is
 * tried at each of its ids, with the others as they are. Returns false after the last. */
static bool extreme(const Lobe *lobe, int k, Lobe *out) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->id);
    *out = *lobe;
    if (k < 2) {
        for (int p = 0; p < info->param_count; p++)
            if (!info->params[p].choices) lobe_set(out, p, k ? info->params[p].hard_high : info->params[p].hard_low);
        return info->param_count > 0;
    }
    k -= 2;
    for (int p = 0; p < info->param_count; p++) {
        const WeftParamInfo *row = &info->params[p];
        int count = row->choices ? 1 + (int)row->hard_high : 2;
        if (k < count) {
            lobe_set(out, p, row->choices ? (float)k : k ? row->hard_high : row->hard_low);
            return true;
        }
        k -= count;
    }
    return false;
}

Lobe bsdf_lobe(const Bsdf *bsdf, int setting) {
    Lobe lobe = bsdf->lobe;
    if (setting >= bsdf->rows)
        extreme(&bsdf->lobe, setting - bsdf->rows, &lobe);
    else if (is_number(weft_lobe_info(lobe.id)))
        lobe_set(&lobe, 0, bsdf->values[setting]);
    return lobe;
}

static void lobe_view_from(const Bsdf *bsdf, int setting, Dir o, BsdfView *view) {
    view->bsdf = bsdf;
    view->o = o;
    view->lobe = bsdf_lobe(bsdf, setting);
    view->second = lobe_second(&view->lobe, 1.0f, 1.0f);
}

enum { BLOCK = 256 };

/* One wo repeated for a block of wi. */
typedef struct Ours {
    float x[BLOCK], y[BLOCK], z[BLOCK];
} Ours;

static void ours_fill(Ours *ours, Dir o) {
    for (int k = 0; k < BLOCK; k++) ours->x[k] = o.x, ours->y[k] = o.y, ours->z[k] = o.z;
}

static void lobe_f(const BsdfView *view, Dirs i, float *f) {
    Ours o;
    float share[BLOCK], same[2][BLOCK], w = view->bsdf->albedo;
    ours_fill(&o, view->o);
    unsigned traits = weft_lobe_info(view->lobe.id)->traits;
    bool mixes = (traits & TRAIT_TWO_COLORS) != 0, tinted = traits & TRAIT_TINTED && w < 1.0f;
    for (size_t at = 0; at < i.n; at += BLOCK) {
        size_t n = i.n - at < BLOCK ? i.n - at : BLOCK;
        if (tinted) {
            lobe_tinted_n(&view->lobe, (const float[3]){w, w, w}, n, o.x, o.y, o.z, i.x + at, i.y + at, i.z + at,
                          (float *const[3]){f + at, same[0], same[1]});
            continue;
        }
        lobe_eval_n(&view->lobe, n, o.x, o.y, o.z, i.x + at, i.y + at, i.z + at, f + at, mixes ? share : NULL);
        for (size_t k = 0; mixes && k < n; k++) f[at + k] *= fresnel_weight_mix(share[k], 1.0f, view->second);
    }
}

static void lobe_density(const BsdfView *view, Dirs i, float *pdf) {
    Ours o;
    ours_fill(&o, view->o);
    for (size_t at = 0; at < i.n; at += BLOCK)
        lobe_pdf_n(&view->lobe, i.n - at < BLOCK ? i.n - at : BLOCK, o.x, o.y, o.z, i.x + at, i.y + at, i.z + at,
                   pdf + at);
}

static Dir lobe_draw(const BsdfView *view, float u, float v) { return lobe_sample(&view->lobe, view->o, u, v); }

static int nearest_row(const Bsdf *bsdf, float value) {
    int best = 0;
    for (int k = 1; k < bsdf->rows; k++)
        if (fabsf(bsdf->values[k] - value) < fabsf(bsdf->values[best] - value)) best = k;
    return best;
}

void bsdf_of_lobe(Bsdf *bsdf, const Lobe *lobe, bool quick) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->id);
    *bsdf = (Bsdf){.lobe = *lobe,
                   .albedo = 1.0f,
                   .parameter = "",
                   .prepare = lobe_view_from,
                   .f = lobe_f,
                   .pdf = lobe_density,
                   .sample = lobe_draw};
    if (is_number(info)) {
        const WeftParamInfo *p = &info->params[0];
        bsdf->parameter = p->name;
        for (int k = 0; k < WEFT_PASSPORT_ROWS; k += quick ? 3 : 1) {
            float value = lobe_rough(lobe->id, (float)k / (WEFT_PASSPORT_ROWS - 1)).params[0];
            value = clamp(value, p->low, p->high);
            if (bsdf->rows > 0 && value < 1.001f * bsdf->values[bsdf->rows - 1]) continue;
            bsdf->values[bsdf->rows++] = value;
        }
        bsdf->row_default = nearest_row(bsdf, p->def);
    } else {
        bsdf->rows = 1;
    }
    Lobe ignored;
    int extremes = 0;
    while (extremes < BSDF_EXTREMES && extreme(lobe, extremes, &ignored)) extremes++;
    bsdf->settings = bsdf->rows + extremes;
}

/* Materials. */

const char bsdf_velvet[] = "white velvet: base_color, sheen_color and specular_color 1, roughness 1, ior 1.5, "
                           "no metal, no coat";

static Surface white_velvet(void) {
    Surface s = surface_default();
    s.base_color = s.sheen_color = s.specular_color = (Rgb){1.0f, 1.0f, 1.0f};
    s.roughness = 1.0f;
    s.ior = 1.5f;
    return s;
}

/* Returns extreme k of the velvet: roughnesses at their ends, metal or not, a coat or not, a sheen or not. */
static Surface extreme_velvet(int k) {
    static const float ends[4] = {0.0f, 1.0f, 0.02f, 2.0f};
    Surface s = white_velvet();
    s.roughness = ends[k & 3];
    s.sheen_roughness = ends[k >> 2 & 3];
    s.clearcoat_roughness = ends[k & 1];
    s.metallic = (float)(k >> 4 & 1);
    s.clearcoat = (float)(k >> 5 & 1);
    if (k % 7 == 3) s.sheen_color = (Rgb){0.0f, 0.0f, 0.0f};
    return s;
}

static void whole_prepare(const Bsdf *bsdf, int setting, Dir o, BsdfView *view) {
    view->bsdf = bsdf;
    view->o = o;
    const TableRef e = albedo_table_ref(&bsdf->tables[bsdf->table_of[setting]]);
    for (int base = 0; base < bsdf->sum.bases; base++)
        weave_sum_see(&bsdf->sum, base, &bsdf->surfaces[setting], &bsdf->choices, e, o, &view->whole[base]);
}

static void whole_f(const BsdfView *view, Dirs i, float *f) {
    const Slots slots = weave_sum_slots(1, slots_all());
    const SeenStack *second = &view->whole[1];
    for (size_t k = 0; k < i.n; k++) {
        const Dir w = dir(i.x[k], i.y[k], i.z[k]);
        Rgb f_cos = seen_eval(&view->whole[0], w, 0).f_cos;
        if (view->bsdf->sum.bases > 1)
            f_cos = rgb_add(f_cos, stack_eval_of(&second->stack, &second->view, slots, w).f_cos);
        f[k] = w.z > 0.0f ? rgb_max3(f_cos) / w.z : rgb_max3(f_cos);
    }
}

static void whole_pdf(const BsdfView *view, Dirs i, float *pdf) {
    for (size_t k = 0; k < i.n; k++) {
        const Dir w = dir(i.x[k], i.y[k], i.z[k]);
        pdf[k] = seen_eval(&view->whole[0], w, 0).pdf;
        if (view->bsdf->sum.bases > 1) pdf[k] = mix(seen_eval(&view->whole[1], w, 0).pdf, pdf[k], view->bsdf->first);
    }
}

static Dir whole_sample(const BsdfView *view, float u, float v) {
    const float first = view->bsdf->first;
    if (view->bsdf->sum.bases == 1) return seen_sample(&view->whole[0], u, v);
    return u < first ? seen_sample(&view->whole[0], min(u / first, 0x1.fffffep-1f), v)
                     : seen_sample(&view->whole[1], min((u - first) / (1.0f - first), 0x1.fffffep-1f), v);
}

/* A sheen's lobe, and the parameter at which E is looked up. */
typedef struct Sheen {
    Lobe lobe;
    float at;
} Sheen;

static bool same_sheen(const Sheen *a, const Sheen *b) {
    bool same = a->lobe.id == b->lobe.id && is_equal(a->at, b->at);
    for (int k = 0; k < LOBE_PARAMS_MAX; k++) same &= is_equal(a->lobe.params[k], b->lobe.params[k]);
    return same;
}

static Sheen sheen_of(const Bsdf *bsdf, int setting) {
    Stack stack;
    stack_make(&stack, &bsdf->surfaces[setting], &bsdf->choices, (TableRef){.kind = TABLE_NONE});
    return (Sheen){stack.sheen.lobe, stack.albedo_coord};
}

typedef struct TableFill {
    Bsdf *bsdf;
    Sheen sheens[WEFT_PASSPORT_ROWS + BSDF_EXTREMES]; /* of table k */
} TableFill;

static void fill_table(void *user, int k, int thread) {
    (void)thread;
    const TableFill *fill = user;
    albedo_table_fill(&fill->bsdf->tables[k], &fill->sheens[k].lobe, fill->sheens[k].at, fill->sheens[k].at, 1);
}

/* Fills one table for all settings of the same sheen. Returns false if memory is short. */
static bool fill_tables(Bsdf *bsdf, int threads) {
    TableFill fill = {.bsdf = bsdf};
    int count = 0;
    for (int k = 0; k < bsdf->settings; k++) {
        Sheen sheen = sheen_of(bsdf, k);
        int found = 0;
        while (found < count && !same_sheen(&fill.sheens[found], &sheen)) found++;
        if (found == count) fill.sheens[count++] = sheen;
        bsdf->table_of[k] = found;
    }
    bsdf->tables = alloc_array((size_t)count, sizeof *bsdf->tables);
    if (!bsdf->tables) return false;
    parallel_for(threads, count, fill_table, &fill);
    return true;
}

bool bsdf_of_profile(Bsdf *bsdf, int profile, bool quick, int threads) {
    *bsdf = (Bsdf){.whole = true,
                   .sum = weave_sum_of(NULL),
                   .parameter = "sheen_roughness",
                   .prepare = whole_prepare,
                   .f = whole_f,
                   .pdf = whole_pdf,
                   .sample = whole_sample};
    bsdf->choices = choices_unmade();
    bsdf->choices.profile = profile;
    for (int k = 1; k < WEFT_PASSPORT_ROWS; k += quick ? 3 : 1) {
        Surface *s = &bsdf->surfaces[bsdf->rows];
        *s = white_velvet();
        s->sheen_roughness = (float)k / (WEFT_PASSPORT_ROWS - 1);
        bsdf->values[bsdf->rows++] = s->sheen_roughness;
    }
    bsdf->row_default = nearest_row(bsdf, 0.5f);
    for (int k = 0; k < BSDF_EXTREMES; k++) bsdf->surfaces[bsdf->rows + k] = extreme_velvet(k);
    bsdf->settings = bsdf->rows + BSDF_EXTREMES;
    return fill_tables(bsdf, threads);
}

bool bsdf_of_weave(Bsdf *bsdf, const WeftMaterial *material, const WeftCloth *cloth, int threads) {
    const Material sound = material_sound(material);
    *bsdf = (Bsdf){.whole = true,
                   .sum = weave_sum_of(cloth),
                   .parameter = "",
                   .rows = 1,
                   .settings = 1,
                   .choices = material_choices(&sound),
                   .prepare = whole_prepare,
                   .f = whole_f,
                   .pdf = whole_pdf,
                   .sample = whole_sample};
    bsdf->surfaces[0] = material_plain(&sound);
    bsdf->first = clamp(weave_sum_first(&bsdf->sum), 0.05f, 0.95f);
    return fill_tables(bsdf, threads);
}

void bsdf_free(Bsdf *bsdf) {
    free(bsdf->tables);
    bsdf->tables = NULL;
}
