/* cloth_base.c - points of a woven cloth, a vertex a lane: near ones are points of threads, far ones facets */
#include "weave/cloth_base.h"

#include "shading/dialect/loop.h"

/* The samples of a pixel average points without an error. So facets stand for points only at LATER times the pixel size
 * at which the raster engine goes over: from 1.7 threads a pixel on, completely at 4. Their colours are averaged over a
 * FINER-th of the pixel, and those that guide a denoiser over a SHOWN-th, which has less noise. Fibres fade as if points
 * were a POINTS-th of the pixel apart. */
enum { LATER = 2, FINER = 4, POINTS = 4, SHOWN = 2 };

bool cloth_is_gap(const WeftCloth *cloth, const float uv[2]) {
    const Dir at = weave_place_of(cloth_placing(cloth), uv[0], uv[1]);
    return weave_gap(&cloth->weave, at.x, at.y);
}

Rgb cloth_fibre_albedo(const WeftCloth *cloth, const float uv[2]) {
    const Weave *m = &cloth->weave;
    const Dir at = weave_place_of(cloth_placing(cloth), uv[0], uv[1]);
    const WeavePoint p = weave_top(m, at.x, at.y);
    return rgb(weave_albedo(m, p, 0), weave_albedo(m, p, 1), weave_albedo(m, p, 2));
}

WeaveBase cloth_base_far(const WeftCloth *cloth, bool weft) {
    int w, h;
    const float *single = cloth_far_level(&cloth->far, cloth->far.levels - 1, &w, &h) +
                          4 * (weft ? FAR_WEFT_SINGLE : FAR_WARP_SINGLE),
                *multiple = single + 4;
    WeaveBase base = weave_far(&cloth->weave, weft, rgb(single[0], single[1], single[2]),
                               rgb(multiple[0], multiple[1], multiple[2]), single[3], 1.0f, 0.0f);
    const float part =
        1.0f / base.lobe.params[WOVEN_SHARE]; /* the colours contain the share, which the lobe applies too */
    base.single = rgb_scale(base.single, part);
    base.multiple = rgb_scale(base.multiple, part);
    return base;
}

/* The points that are near, or those that are far, side by side. */
typedef struct Part {
    int count, at[ROW_CAPACITY];                                /* indices among all points */
    float x[ROW_CAPACITY], y[ROW_CAPACITY];                     /* place, in threads */
    float footprint_x[ROW_CAPACITY], footprint_y[ROW_CAPACITY]; /* as ClothLooks has them */
    float facet[ROW_CAPACITY];   /* the random number; then the index among both systems' facets */
    float wear[ROW_CAPACITY];    /* as ClothLooks has it */
    float coarser[ROW_CAPACITY]; /* far: random, in [0, 1): chooses between two levels of the colours */
    float spacing[ROW_CAPACITY]; /* near: from point to point, in threads */
    float height[ROW_CAPACITY];  /* near: of the thread */
    float hair[ROW_CAPACITY];    /* near: number of the loose fibre on top; -1: none */
    YarnRows yarn;
} Part;

/* Sets the places, and `far` to a new random number in [0, 1) where a facet is to stand for the cloth, to -1 elsewhere. */
LOOP(place_n,
     (const ClothLooks *looks, const WeftCloth *cloth, int n, float *restrict x, float *restrict y,
      float *restrict far),
     (looks, cloth, n, x, y, far)) {
    WeavePlacing placing = cloth_placing(cloth);
    EACH(k, (size_t)n) {
        Dir at = weave_place_of(placing, looks->uv[0][k], looks->uv[1][k]);
        WeaveFootprint f;
        f.x = looks->footprint_x[k] / LATER;
        f.y = looks->footprint_y[k] / LATER;
        f.longest = looks->longest[k] / LATER;
        x[k] = at.x;
        y[k] = at.y;
        float weight = weave_far_weight(f);
        far[k] = looks->level[k] < weight ? min(looks->level[k] / max(weight, 1e-6f), 1.0f - 1e-6f) : -1.0f;
    }
}

/* Fills the last group of lanes with copies of the first point. */
static void pad(Part *part) {
    for (int k = part->count; k < row_whole(part->count); k++) {
        part->x[k] = part->x[0], part->y[k] = part->y[0], part->facet[k] = part->facet[0];
        part->footprint_x[k] = part->footprint_x[0], part->footprint_y[k] = part->footprint_y[0];
        part->spacing[k] = part->spacing[0], part->coarser[k] = part->coarser[0], part->wear[k] = part->wear[0];
    }
}

/* Sorts points into near (0) and far (1). */
static void split(const WeftCloth *cloth, const ClothLooks *looks, int n, Part parts[2]) {
    float x[ROW_CAPACITY], y[ROW_CAPACITY], far[ROW_CAPACITY];
    place_n(looks, cloth, n, x, y, far);
    parts[0].count = parts[1].count = 0;
    for (int k = 0; k < n; k++) {
        Part *part = &parts[far[k] >= 0.0f];
        const int to = part->count++;
        part->at[to] = k;
        part->x[to] = x[k], part->y[to] = y[k], part->facet[to] = looks->facet[k], part->coarser[to] = far[k];
        part->footprint_x[to] = looks->footprint_x[k], part->footprint_y[to] = looks->footprint_y[k];
        part->spacing[to] = looks->longest[k] / POINTS, part->wear[to] = looks->wear[k];
    }
    pad(&parts[0]), pad(&parts[1]);
}

FN void put_base(YarnRows *restrict out, size_t k, Yarn y, Rgb single, Rgb multiple) {
#define PUT_PARAM(type, name, def, low, high, hard_low, hard_high, help) out->params[p++][k] = y.name;
    int p = 0;
    YARN_PARAMS(PUT_PARAM)
    out->single[0][k] = single.r, out->single[1][k] = single.g, out->single[2][k] = single.b;
    out->multiple[0][k] = multiple.r, out->multiple[1][k] = multiple.g, out->multiple[2][k] = multiple.b;
}

/* Returns the weave. Only maps have a cycle, so it is 0 already: as a constant it costs a loop nothing. */
FN Weave without_cycle(const Weave *weave) {
    Weave m = *weave;
    m.cycle_x = m.cycle_y = 0.0f;
    return m;
}

FN void put_point(YarnRows *restrict out, size_t k, const Weave *m, WeavePoint p, float wear) {
    put_base(out, k, weave_yarn(m, p), weave_worn_single(m, p, wear), weave_worn_multiple(m, p, wear));
}

/* Sets points of threads, without loose fibres. */
LOOP(bind_n, (const Weave *weave, Part *restrict part, int n), (weave, part, n)) {
    Weave m = without_cycle(weave);
    EACH(k, (size_t)n) {
        WeavePoint p = weave_point_bound(&m, part->x[k], part->y[k], part->spacing[k], 2.0f * part->facet[k] - 1.0f);
        part->height[k] = p.height;
        put_point(&part->yarn, k, &m, p, part->wear[k]);
    }
}

/* Finds the loose fibres on top. */
LOOP(find_n, (const Weave *weave, Part *restrict part, int n), (weave, part, n)) {
    Weave m = without_cycle(weave);
    EACH(k, (size_t)n) {
        float radius = weave_hair_radius_over(&m, part->height[k], part->spacing[k]);
        part->hair[k] = to_float(weave_hair_at(&m, part->x[k], part->y[k], radius, WEAVE_HAIRS_NEAR));
    }
}

/* Lays loose fibres over the points that are below one, which are few. */
static void add_hairs(const Weave *m, Part *part) {
    bool seen = false;
    for (int k = 0; k < part->count; k++) seen |= weave_hair_radius_over(m, part->height[k], part->spacing[k]) > 0.0f;
    if (!seen) return;
    find_n(m, part, row_whole(part->count));
    for (int k = 0; k < part->count; k++) {
        WeavePoint p = {.height = part->height[k]};
        if (part->hair[k] < 0.0f) continue;
        const float radius = weave_hair_radius_over(m, p.height, part->spacing[k]);
        weave_lay(weave_hair(m, (int)part->hair[k], part->x[k], part->y[k], radius), &p);
        put_point(&part->yarn, (size_t)k, m, p, part->wear[k]);
    }
}

FN Rgb color_at(const float *texels, int at) { return rgb(texels[at], texels[at + 1], texels[at + 2]); }

/* Returns the texel at a fraction of the repeat, among `side` texels. */
FN int texel_at(float part, int side) {
    int texel = to_int((part - floor(part)) * to_float(side));
    return texel < side ? texel : side - 1;
}

/* The colours of both systems at a texel. */
typedef struct FarColors {
    Rgb warp_single, warp_multiple, weft_single, weft_multiple;
} FarColors;

/* Returns the colours of the texel at `at` of a level whose layers have so many floats, with dye times as much dye, and
 * worn. */
FN FarColors far_colors(const Weave *m, const float *texels, int at, int layer, float warp_dye, float weft_dye,
                        float wear) {
    float warp_covers = texels[at + 3], weft_covers = texels[at + FAR_WEFT_SINGLE * layer + 3];
    Rgb warp_multiple = color_at(texels, at + FAR_WARP_MULTIPLE * layer),
        weft_single = color_at(texels, at + FAR_WEFT_SINGLE * layer),
        weft_multiple = color_at(texels, at + FAR_WEFT_MULTIPLE * layer);
    FarColors c;
    c.warp_single = weave_far_single(m, false, color_at(texels, at), warp_covers, warp_dye, wear);
    c.warp_multiple = weave_far_multiple(m, false, warp_multiple, warp_covers, warp_dye, wear);
    c.weft_single = weave_far_single(m, true, weft_single, weft_covers, weft_dye, wear);
    c.weft_multiple = weave_far_multiple(m, true, weft_multiple, weft_covers, weft_dye, wear);
    return c;
}

/* Returns the part of light from all around that comes back from fibres of these colours. Three tenths of it met one
 * fibre, about as at the default roughness. */
FN Rgb reflected(Rgb single, Rgb multiple) { return rgb_add(rgb_scale(single, 0.3f), rgb_scale(multiple, 0.7f)); }

/* Chooses a level of the colours: t of the way to the coarser one, that one with the chance 1 - (1 - t)^2, so that the
 * noise of the finer one fades evenly. Then a system by what it reflects, and one of its facets, and sets colours and
 * the yarn without its slopes. A system that is chosen with chance c has colours / c. scale: factor of all colours. */
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
        float x = part->x[k], y = part->y[k], wear = part->wear[k];
        float fine = min(weave_far_level(f, finer_x, finer_y), last), between = fine - floor(fine);
        int level = to_int(fine) + (part->coarser[k] < between * (2.0f - between) ? 1 : 0);
        int w = cloth_far_side(width, level), h = cloth_far_side(height, level);
        int layer = 4 * w * h, at = starts[level] + 4 * (texel_at(y / picks, h) * w + texel_at(x / warps, w));
        WeaveFootprint finer;
        finer.x = f.x / FINER;
        finer.y = f.y / FINER;
        finer.longest = 0.0f;
        float warp_dye = weave_far_dye(&m, false, x, y, finer), weft_dye = weave_far_dye(&m, true, x, y, finer);
        FarColors c = far_colors(&m, texels, at, layer, warp_dye, weft_dye, wear);
        float a = rgb_mean(reflected(c.warp_single, c.warp_multiple)),
              b = rgb_mean(reflected(c.weft_single, c.weft_multiple));
        float chance = a + b > 0.0f ? a / (a + b) : 1.0f, u = part->facet[k];
        bool weft = u >= chance;
        float per_chance = 1.0f / max(weft ? 1.0f - chance : chance, 1e-6f),
              rest = (weft ? u - chance : u) * per_chance;
        float count = weft ? weft_count : warp_count, facet = floor(min(rest * count, count - 1.0f));
        part->facet[k] = weft ? to_float(FACETS_MOST) + facet : facet;
        WeavePoint p;
        p.weft = weft;
        p.slope_x = p.slope_y = 0.0f;
        p.fibre = dir(1.0f, 0.0f, 0.0f);
        Rgb single = rgb(weft ? c.weft_single.r : c.warp_single.r, weft ? c.weft_single.g : c.warp_single.g,
                         weft ? c.weft_single.b : c.warp_single.b);
        Rgb multiple = rgb(weft ? c.weft_multiple.r : c.warp_multiple.r, weft ? c.weft_multiple.g : c.warp_multiple.g,
                           weft ? c.weft_multiple.b : c.warp_multiple.b);
        put_base(yarn, k, weave_yarn(&m, p), rgb_scale(single, scale * per_chance),
                 rgb_scale(multiple, scale * per_chance));
    }
}

/* Gives each yarn the slopes of its facet, and its factors on the colours. */
LOOP(lay_n, (const ClothFacet *facets, Part *restrict part, int n), (facets, part, n)) {
    YarnRows *yarn = &part->yarn;
    EACH(k, (size_t)n) {
        int at = to_int(part->facet[k]);
        float single = facets[at].single, multiple = facets[at].multiple;
        yarn->params[YARN_SLOPE_X][k] = facets[at].slope_x;
        yarn->params[YARN_SLOPE_Y][k] = facets[at].slope_y;
        yarn->params[YARN_AZIMUTH][k] = facets[at].azimuth;
        yarn->single[0][k] *= single;
        yarn->single[1][k] *= single;
        yarn->single[2][k] *= single;
        yarn->multiple[0][k] *= multiple;
        yarn->multiple[1][k] *= multiple;
        yarn->multiple[2][k] *= multiple;
    }
}

/* Writes the yarns to their places among all points. */
static void put_all(const Part *part, YarnRows *out) {
    for (int p = 0; p < LOBE_PARAMS_MAX; p++)
        for (int k = 0; k < part->count; k++) out->params[p][part->at[k]] = part->yarn.params[p][k];
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < part->count; k++) {
            out->single[c][part->at[k]] = part->yarn.single[c][k];
            out->multiple[c][part->at[k]] = part->yarn.multiple[c][k];
        }
}

/* Returns what both systems reflect at a level of the colours, with dye times as much dye, worn. */
FN Rgb level_albedo(const Weave *m, const ClothFar *far, int level, float across, float along, const float dye[2],
                    float wear) {
    int w = cloth_far_side(far->width, level), h = cloth_far_side(far->height, level), layer = 4 * w * h;
    int at = far->starts[level] + 4 * (texel_at(along, h) * w + texel_at(across, w));
    FarColors c = far_colors(m, far->texels, at, layer, dye[0], dye[1], wear);
    return rgb_add(reflected(c.warp_single, c.warp_multiple), reflected(c.weft_single, c.weft_multiple));
}

/* Sets what is seen where pixels see several threads: the colours of the crossings in half a pixel, between two levels
 * of them, and no slope; and `far`, the part of it that counts beside what the point itself shows. */
LOOP(guide_n, (const WeftCloth *cloth, const ClothLooks *looks, float scale, int n, float *far, ClothGuide *guide),
     (cloth, looks, scale, n, far, guide)) {
    Weave m = without_cycle(&cloth->weave);
    WeavePlacing placing = cloth_placing(cloth);
    float last = to_float(cloth->far.levels - 1), warps = to_float(m.warps), picks = to_float(m.picks);
    float finer_x = SHOWN * warps / to_float(cloth->far.width), finer_y = SHOWN * picks / to_float(cloth->far.height);
    EACH(k, (size_t)n) {
        Dir at = weave_place_of(placing, looks->uv[0][k], looks->uv[1][k]);
        WeaveFootprint f, shown;
        f.x = looks->footprint_x[k];
        f.y = looks->footprint_y[k];
        f.longest = looks->longest[k];
        float fine = min(weave_far_level(f, finer_x, finer_y), last), between = fine - floor(fine);
        int level = to_int(fine), coarser = level + (between > 0.0f ? 1 : 0);
        shown.x = f.x / SHOWN;
        shown.y = f.y / SHOWN;
        shown.longest = 0.0f;
        float dye[2] = {weave_far_dye(&m, false, at.x, at.y, shown), weave_far_dye(&m, true, at.x, at.y, shown)};
        Rgb a = level_albedo(&m, &cloth->far, level, at.x / warps, at.y / picks, dye, looks->wear[k]),
            b = level_albedo(&m, &cloth->far, coarser, at.x / warps, at.y / picks, dye, looks->wear[k]);
        Rgb albedo = rgb_scale(rgb_add(rgb_scale(a, 1.0f - between), rgb_scale(b, between)), scale);
        far[k] = weave_far_weight(f);
        guide->albedo[0][k] = albedo.r;
        guide->albedo[1][k] = albedo.g;
        guide->albedo[2][k] = albedo.b;
        guide->slope[0][k] = guide->slope[1][k] = 0.0f;
    }
}

/* Adds what near points show. */
static void add_near_guide(const Part *part, const float *far, ClothGuide *guide) {
    const YarnRows *yarn = &part->yarn;
    for (size_t k = 0; k < (size_t)part->count; k++) {
        const int at = part->at[k];
        const float near = 1.0f - far[at];
        Rgb albedo = reflected(ROW_RGB(yarn->single, k), ROW_RGB(yarn->multiple, k));
        guide->albedo[0][at] = far[at] * guide->albedo[0][at] + near * albedo.r;
        guide->albedo[1][at] = far[at] * guide->albedo[1][at] + near * albedo.g;
        guide->albedo[2][at] = far[at] * guide->albedo[2][at] + near * albedo.b;
        guide->slope[0][at] = near * yarn->params[YARN_SLOPE_X][k];
        guide->slope[1][at] = near * yarn->params[YARN_SLOPE_Y][k];
    }
}

void cloth_bases(const WeftCloth *cloth, const ClothLooks *looks, int n, YarnRows *out, ClothGuide *guide) {
    Part parts[2];
    Part *near = &parts[0], *far = &parts[1];
    const Weave *m = &cloth->weave;
    const float scale = looks->holed ? 1.0f / max(m->warp_far.share + m->weft_far.share, 1e-3f) : 1.0f;
    split(cloth, looks, n, parts);
    if (near->count) bind_n(m, near, row_whole(near->count));
    add_hairs(m, near);
    if (far->count) choose_n(cloth, far, scale, row_whole(far->count));
    if (far->count) lay_n(cloth->facets[0], far, row_whole(far->count));
    put_all(near, out);
    put_all(far, out);
    if (!guide) return;
    float part[ROW_CAPACITY];
    guide_n(cloth, looks, scale, n, part, guide);
    add_near_guide(near, part, guide);
}
