#include "weave/cloth_base.h"

#include "shading/dialect/loop.h"

/* The samples of a pixel average points and crossings, without an error: so the mean takes their place from 1.7
 * threads a pixel on, completely at four, and its colours are those of a quarter of the pixel. Fibres fade until they are a
 * quarter as wide as a pixel. */
enum { LATER = 2, FINER = 4, POINTS = 4 };

/* Rows of picks run up the cloth, v runs down it. */
FN Dir place_of(const float per_uv[2], float u, float v) {
    return dir(weave_bounded(u * per_uv[WEFT_WARP]), weave_bounded(-v * per_uv[WEFT_WEFT]), 0.0f);
}

bool cloth_is_gap(const WeftCloth *cloth, const float uv[2]) {
    const Dir at = place_of(cloth->per_uv, uv[0], uv[1]);
    return weave_gap(&cloth->weave, at.x, at.y);
}

WeaveBase cloth_base_far(const WeftCloth *cloth, bool weft) {
    int w, h;
    const float *once = cloth_far_level(&cloth->far, cloth->far.levels - 1, &w, &h) +
                        4 * (weft ? FAR_WEFT_ONCE : FAR_WARP_ONCE),
                *again = once + 4;
    WeaveBase base = weave_far(&cloth->weave, weft, rgb(once[0], once[1], once[2]),
                               rgb(again[0], again[1], again[2]), once[3], 1.0f);
    const float part =
        1.0f / base.lobe.params[WOVEN_SHARE]; /* the colours have the share, and so has the lobe */
    base.once = rgb_scale(base.once, part);
    base.again = rgb_scale(base.again, part);
    return base;
}

/* Those of the looks that are all near, or all far, one behind the other, and what is there. */
typedef struct Part {
    int count, at[ROW_ROOM]; /* their places among all */
    float x[ROW_ROOM], y[ROW_ROOM], footprint_x[ROW_ROOM], footprint_y[ROW_ROOM], facet[ROW_ROOM];
    float spacing[ROW_ROOM], height[ROW_ROOM], hair[ROW_ROOM]; /* of points near by; the loose fibre on top */
    YarnRows yarn;
} Part;

LOOP(place_n,
     (const ClothLooks *looks, const float per_uv[2], int n, float *restrict x, float *restrict y,
      float *restrict far),
     (looks, per_uv, n, x, y, far)) {
    float per_u[2] = {per_uv[0], per_uv[1]};
    EACH(k, (size_t)n) {
        Dir at = place_of(per_u, looks->uv[0][k], looks->uv[1][k]);
        WeaveFootprint f;
        f.x = looks->footprint_x[k] / LATER;
        f.y = looks->footprint_y[k] / LATER;
        f.longest = looks->longest[k] / LATER;
        x[k] = at.x;
        y[k] = at.y;
        far[k] = looks->level[k] < weave_far_weight(f) ? 1.0f : 0.0f;
    }
}

/* Fills the last group of lanes with the first look again. */
static void pad(Part *part) {
    for (int k = part->count; k < row_whole(part->count); k++) {
        part->x[k] = part->x[0], part->y[k] = part->y[0], part->facet[k] = part->facet[0];
        part->footprint_x[k] = part->footprint_x[0], part->footprint_y[k] = part->footprint_y[0];
        part->spacing[k] = part->spacing[0];
    }
}

static void split(const WeftCloth *cloth, const ClothLooks *looks, int n, Part parts[2]) {
    float x[ROW_ROOM], y[ROW_ROOM], far[ROW_ROOM];
    place_n(looks, cloth->per_uv, n, x, y, far);
    parts[0].count = parts[1].count = 0;
    for (int k = 0; k < n; k++) {
        Part *part = &parts[far[k] > 0.0f];
        const int to = part->count++;
        part->at[to] = k;
        part->x[to] = x[k], part->y[to] = y[k], part->facet[to] = looks->facet[k];
        part->footprint_x[to] = looks->footprint_x[k], part->footprint_y[to] = looks->footprint_y[k];
        part->spacing[to] = looks->longest[k] / POINTS;
    }
    pad(&parts[0]), pad(&parts[1]);
}

FN void put_base(YarnRows *restrict out, size_t k, Yarn y, Rgb once, Rgb again) {
#define PUT_PARAM(type, name, def, low, high, hard_low, hard_high, help) out->params[p++][k] = y.name;
    int p = 0;
    YARN_PARAMS(PUT_PARAM)
    out->once[0][k] = once.r, out->once[1][k] = once.g, out->once[2][k] = once.b;
    out->again[0][k] = again.r, out->again[1][k] = again.g, out->again[2][k] = again.b;
}

/* The weave as it is, since only maps come again; but known before a loop, which then asks for it nowhere. */
FN Weave without_cycle(const Weave *weave) {
    Weave m = *weave;
    m.cycle_x = m.cycle_y = 0.0f;
    return m;
}

FN void put_point(YarnRows *restrict out, size_t k, const Weave *m, WeavePoint p) {
    put_base(out, k, weave_yarn(m, p), weave_once_rgb(m, p), weave_again_rgb(m, p));
}

LOOP(bind_n, (const Weave *weave, Part *restrict part, int n), (weave, part, n)) {
    Weave m = without_cycle(weave);
    EACH(k, (size_t)n) {
        WeavePoint p =
            weave_bound(&m, part->x[k], part->y[k], part->spacing[k], 2.0f * part->facet[k] - 1.0f);
        part->height[k] = p.height;
        put_point(&part->yarn, k, &m, p);
    }
}

LOOP(find_n, (const Weave *weave, Part *restrict part, int n), (weave, part, n)) {
    Weave m = without_cycle(weave);
    EACH(k, (size_t)n) {
        float radius = weave_hair_reach(&m, part->height[k], part->spacing[k]);
        part->hair[k] = to_float(weave_hair_at(&m, part->x[k], part->y[k], radius, WEAVE_HAIRS_NEAR));
    }
}

/* Lays loose fibres over points, of which a few are under any. */
static void loosen(const Weave *m, Part *part) {
    bool seen = false;
    for (int k = 0; k < part->count; k++)
        seen |= weave_hair_reach(m, part->height[k], part->spacing[k]) > 0.0f;
    if (!seen) return;
    find_n(m, part, row_whole(part->count));
    for (int k = 0; k < part->count; k++) {
        WeavePoint p = {.height = part->height[k]};
        if (part->hair[k] < 0.0f) continue;
        const float radius = weave_hair_reach(m, p.height, part->spacing[k]);
        weave_lay(weave_hair(m, (int)part->hair[k], part->x[k], part->y[k], radius), &p);
        put_point(&part->yarn, (size_t)k, m, p);
    }
}

/* Four numbers in a row. */
FN Rgb color_at(const float *texels, int at) { return rgb(texels[at], texels[at + 1], texels[at + 2]); }

/* The texel of so many in a row that is that part of a repeat from the first. */
FN int texel_at(float part, int side) {
    int texel = to_int((part - floor(part)) * to_float(side));
    return texel < side ? texel : side - 1;
}

/* Returns what a system reflects, in parts of the cloth, with so much more dye. */
FN Rgb dyed(const float *texels, int at, float covers, float dye, float scale) {
    return rgb_scale(weave_dyed_rgb(color_at(texels, at), covers, dye), scale);
}

/* Chooses a system by what it reflects, and the facet that stands for it. scale: of all colours. */
LOOP(choose_n, (const WeftCloth *cloth, Part *restrict part, float scale, int n), (cloth, part, scale, n)) {
    Weave m = without_cycle(&cloth->weave);
    const float *texels = cloth->far.texels;
    const int *starts = cloth->far.starts;
    float warps = to_float(m.warps), picks = to_float(m.picks), last = to_float(cloth->far.levels - 1);
    int width = cloth->far.width, height = cloth->far.height;
    float finer_x = FINER * warps / to_float(width), finer_y = FINER * picks / to_float(height);
    float warp_count = to_float(cloth->facet_count[0]), weft_count = to_float(cloth->facet_count[1]);
    YarnRows *yarn = &part->yarn;
    EACH(k, (size_t)n) {
        WeaveFootprint f;
        f.x = part->footprint_x[k];
        f.y = part->footprint_y[k];
        f.longest = 0.0f;
        float x = part->x[k], y = part->y[k];
        int level = to_int(min(weave_far_level(f, finer_x, finer_y), last));
        int w = cloth_far_side(width, level), h = cloth_far_side(height, level);
        int layer = 4 * w * h, at = starts[level] + 4 * (texel_at(y / picks, h) * w + texel_at(x / warps, w));
        float warp_dye = weave_far_dye(&m, false, x, f.x / FINER),
              weft_dye = weave_far_dye(&m, true, y, f.y / FINER);
        float warp_covers = texels[at + 3], weft_covers = texels[at + FAR_WEFT_ONCE * layer + 3];
        Rgb warp_once = dyed(texels, at, warp_covers, warp_dye, scale),
            warp_again = dyed(texels, at + FAR_WARP_AGAIN * layer, warp_covers, warp_dye, scale),
            weft_once = dyed(texels, at + FAR_WEFT_ONCE * layer, weft_covers, weft_dye, scale),
            weft_again = dyed(texels, at + FAR_WEFT_AGAIN * layer, weft_covers, weft_dye, scale);
        float a = 0.3f * rgb_mean(warp_once) + 0.7f * rgb_mean(warp_again),
              b = 0.3f * rgb_mean(weft_once) + 0.7f * rgb_mean(weft_again);
        float chance = a + b > 0.0f ? a / (a + b) : 1.0f, u = part->facet[k];
        bool weft = u >= chance;
        float worth = 1.0f / max(weft ? 1.0f - chance : chance, 1e-6f),
              rest = (weft ? u - chance : u) * worth;
        float count = weft ? weft_count : warp_count, facet = floor(min(rest * count, count - 1.0f));
        part->facet[k] = weft ? to_float(FACETS_MOST) + facet : facet;
        WeavePoint p;
        p.weft = weft;
        p.slope_x = p.slope_y = 0.0f;
        p.fibre = dir(1.0f, 0.0f, 0.0f);
        Rgb once = rgb(weft ? weft_once.r : warp_once.r, weft ? weft_once.g : warp_once.g,
                       weft ? weft_once.b : warp_once.b);
        Rgb again = rgb(weft ? weft_again.r : warp_again.r, weft ? weft_again.g : warp_again.g,
                        weft ? weft_again.b : warp_again.b);
        put_base(yarn, k, weave_yarn(&m, p), rgb_scale(once, worth), rgb_scale(again, worth));
    }
}

/* Lays the yarns that were chosen as their facets lie. */
LOOP(lay_n, (const ClothFacet *facets, Part *restrict part, int n), (facets, part, n)) {
    YarnRows *yarn = &part->yarn;
    EACH(k, (size_t)n) {
        int at = to_int(part->facet[k]);
        float once = facets[at].once, again = facets[at].again;
        yarn->params[YARN_SLOPE_X][k] = facets[at].slope_x;
        yarn->params[YARN_SLOPE_Y][k] = facets[at].slope_y;
        yarn->params[YARN_AZIMUTH][k] = facets[at].azimuth;
        yarn->once[0][k] *= once;
        yarn->once[1][k] *= once;
        yarn->once[2][k] *= once;
        yarn->again[0][k] *= again;
        yarn->again[1][k] *= again;
        yarn->again[2][k] *= again;
    }
}

static void give(const Part *part, YarnRows *out) {
    for (int p = 0; p < LOBE_PARAMS_MAX; p++)
        for (int k = 0; k < part->count; k++) out->params[p][part->at[k]] = part->yarn.params[p][k];
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < part->count; k++) {
            out->once[c][part->at[k]] = part->yarn.once[c][k];
            out->again[c][part->at[k]] = part->yarn.again[c][k];
        }
}

void cloth_bases(const WeftCloth *cloth, const ClothLooks *looks, int n, YarnRows *out) {
    Part parts[2];
    Part *near = &parts[0], *far = &parts[1];
    const Weave *m = &cloth->weave;
    const float scale = looks->holed ? 1.0f / max(m->warp_far.share + m->weft_far.share, 1e-3f) : 1.0f;
    split(cloth, looks, n, parts);
    if (near->count) bind_n(m, near, row_whole(near->count));
    loosen(m, near);
    if (far->count) choose_n(cloth, far, scale, row_whole(far->count));
    if (far->count) lay_n(cloth->facets[0], far, row_whole(far->count));
    give(near, out);
    give(far, out);
}
