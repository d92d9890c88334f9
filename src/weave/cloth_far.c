/* cloth_far.c - a cloth from afar: yarns of lobe woven that reflect as the visible points of either system do on the
 * mean, and the colours of its crossings, ever coarser
 *
 *   E[s_x^2] = across^2 / 3,  E[s_y^2] = along^2 / 3
 *
 * are solved for the slopes by which yarns hide each other. The lobe is fitted (woven_fit.c) to the mean of what points
 * reflect between pairs of directions, in which threads hide the ends of others, crevices are dark and fibres rise or
 * lie loose. What is left is one factor for each system and each kind of light, which goes into the colours. */
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "weave/weft_cloth.h"
#include "weave/woven_fit.h"

enum {
    PIECE = 4800,  /* threads of a piece of cloth, */
    LOOKS = 48000, /* places at which it is looked at */
    FAR_SIDE_MAX = 512,
};
_Static_assert(1 << (FAR_LEVELS_MOST - 1) == FAR_SIDE_MAX, "a level for each halving, and the first");

/* The spacing of points from afar, in threads. */
static const float FAR_SPACING = 1.0f;

/* The points of one system that were seen. */
typedef struct SystemSeen {
    int count, crossings[2], on[2]; /* places where it is above or below, and those at which it is seen */
    double run, across, along;      /* sums of k, s_x^2 and s_y^2 */
    double height, square;          /* of heights, and of their squares */
} SystemSeen;

/* Returns about how many threads are looked at, in whole repeats. */
static double looked_at(int count) {
    const int repeats = (PIECE + count - 1) / count;
    return (double)(count * repeats);
}

/* Place k of evenly spread ones, and the thread there, its fibres told by their slopes alone: the root of 2 spreads places
 * across them. Martin Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018. */
static WeavePoint look(const Weave *m, int k, float *x, float *y) {
    *x = (float)(fmod(0.7548776662466927 * (k + 1), 1.0) * looked_at(m->warps));
    *y = (float)(fmod(0.5698402909980532 * (k + 1), 1.0) * looked_at(m->picks));
    return weave_bound(m, *x, *y, FAR_SPACING, 2.0f * (float)fmod(1.4142135623730951 * (k + 1), 1.0) - 1.0f);
}

static int is_up(const Weave *m, float x, float y, int weft) {
    const WeaveCell cell = weave_cell(m, floorf(x), floorf(y));
    return (weft ? cell.weft_run : cell.warp_run) > 0.0f;
}

static void see(Weave *m, SystemSeen seen[2]) {
    m->low = HUGE_VALF;
    m->high = -HUGE_VALF;
    for (int k = 0; k < LOOKS; k++) {
        float x, y;
        const WeavePoint p = look(m, k, &x, &y);
        for (int t = 0; t < 2; t++) seen[t].crossings[is_up(m, x, y, t)]++;
        if (p.height <= WEAVE_NONE) continue;
        SystemSeen *of = &seen[p.weft];
        const float across = p.weft ? p.slope_y : p.slope_x, along = p.weft ? p.slope_x : p.slope_y;
        of->count++;
        of->on[is_up(m, x, y, p.weft)]++;
        of->run += (double)p.k;
        of->across += (double)(across * across);
        of->along += (double)(along * along);
        of->height += (double)p.height;
        of->square += (double)p.height * (double)p.height;
        m->low = fminf(m->low, p.height);
        m->high = fmaxf(m->high, p.height);
    }
    if (m->low > m->high) m->low = m->high = 0.0f;
}

/* The mean of weave_depth, 1 - WEAVE_SHADE ((high - z) / (high - low))^2, from the sums of z and z^2. */
static float open_mean(const Weave *m, const SystemSeen seen[2]) {
    const double count = (double)(seen[0].count + seen[1].count), high = (double)m->high;
    const double range = fmax(high - (double)m->low, 1e-6);
    if (count < 1.0) return 1.0f;
    const double z = (seen[0].height + seen[1].height) / count,
                 z2 = (seen[0].square + seen[1].square) / count;
    return (float)(1.0 - (double)WEAVE_SHADE * (high * high - 2.0 * high * z + z2) / (range * range));
}

/* Fibres turn by 0.35 streaks times noise whose variance is 0.18 (weave_finish), which widens D. */
static WeaveFar far_of(const WeaveYarn *y, const SystemSeen *seen) {
    const float turn = 0.35f * y->streaks, a2 = y->alpha * y->alpha;
    WeaveFar far = {.alpha = sqrtf(a2 + (1.0f - a2) * fminf(0.18f * turn * turn, 1.0f)),
                    .crimp = fminf(y->crimp, CRIMP_MOST),
                    .roundness = y->roundness,
                    .floats = 1.0f,
                    .slope_across = y->roundness,
                    .slope_along = y->crimp,
                    .share = (float)seen->count / LOOKS,
                    .once = 1.0f,
                    .again = 1.0f};
    if (!seen->count) return far;
    far.floats = fminf((float)(seen->run / seen->count), FLOATS_MOST);
    far.slope_across = fminf((float)(sqrt)(3.0 * seen->across / seen->count), ROUNDNESS_MOST);
    far.roundness = far.slope_across;
    far.slope_along = (float)(sqrt)(3.0 * seen->along / seen->count);
    far.crimp = fminf(far.slope_along * sqrtf((2.0f * far.floats + 1.0f) / 3.0f), CRIMP_MOST);
    return far;
}

/* The share that a system covers of crossings where it is below, or above. */
static float covers(const SystemSeen *seen, int up) {
    return seen->crossings[up] ? (float)seen->on[up] / (float)seen->crossings[up] : 0.0f;
}

/* A thread's colour in light that met one fibre, and in all other, without irregular dye. */
static float color_of(const Weave *m, int t, int thread, int c, bool again) {
    const float a = m->albedos[3 * ((t ? m->warps : 0) + thread) + c],
                white = t ? m->weft.white : m->warp.white;
    return again ? yarn_reflectance(a) : fminf(a + white, 1.0f);
}

/* Adds a crossing to the texels of the first level that it overlaps. */
static void add_crossing(ClothFar *far, const Weave *m, const SystemSeen seen[2], int i, int j) {
    const float across = (float)far->width / (float)m->warps, along = (float)far->height / (float)m->picks;
    const float x0 = (float)i * across, x1 = x0 + across, y0 = (float)j * along, y1 = y0 + along;
    float color[FAR_LAYERS][4];
    for (int layer = 0; layer < FAR_LAYERS; layer++) {
        const int t = layer / 2;
        const float part = covers(&seen[t], is_up(m, (float)i, (float)j, t));
        for (int c = 0; c < 3; c++) color[layer][c] = part * color_of(m, t, t ? j : i, c, layer % 2 == 1);
        color[layer][3] = part;
    }
    for (int row = (int)y0; row < far->height && (float)row < y1; row++)
        for (int column = (int)x0; column < far->width && (float)column < x1; column++) {
            const float part = (fminf(x1, (float)column + 1.0f) - fmaxf(x0, (float)column)) *
                               (fminf(y1, (float)row + 1.0f) - fmaxf(y0, (float)row));
            for (int layer = 0; layer < FAR_LAYERS; layer++)
                for (int c = 0; c < 4; c++)
                    far->texels[4 * ((size_t)(layer * far->height + row) * (size_t)far->width +
                                     (size_t)column) +
                                (size_t)c] += fmaxf(part, 0.0f) * color[layer][c];
        }
}

const float *cloth_far_level(const ClothFar *far, int level, int *width, int *height) {
    *width = cloth_far_side(far->width, level);
    *height = cloth_far_side(far->height, level);
    return far->texels + far->starts[level];
}

/* Makes a level of the one before it. */
static void halve(ClothFar *far, int level) {
    int w, h, width, height;
    const float *from = cloth_far_level(far, level - 1, &width, &height);
    float *to = far->texels + far->starts[level];
    (void)cloth_far_level(far, level, &w, &h);
    for (int row = 0; row < FAR_LAYERS * h; row++)
        for (int column = 0; column < w; column++)
            for (int c = 0; c < 4; c++) {
                float sum = 0.0f;
                for (int k = 0; k < 4; k++) {
                    const int right = width > 1 ? 2 * column + (k & 1) : 0, up = k / 2;
                    const int layer = row / h, at = height > 1 ? 2 * (row % h) + up : 0;
                    sum += from[4 * ((layer * height + at) * width + right) + c];
                }
                to[4 * (row * w + column) + c] = 0.25f * sum;
            }
}

/* A power of 2 that has a texel for each thread, as far as there is room. */
static int far_side(int threads) {
    int side = 1;
    while (side < threads && side < FAR_SIDE_MAX) side *= 2;
    return side;
}

static bool make_colors(WeftCloth *cloth, const SystemSeen seen[2]) {
    const Weave *m = &cloth->weave;
    ClothFar *far = &cloth->far;
    far->width = far_side(m->warps);
    far->height = far_side(m->picks);
    int numbers = 0;
    for (int level = 0; level == 0 || far->width >> level > 0 || far->height >> level > 0; level++) {
        far->starts[level] = numbers;
        numbers += 4 * FAR_LAYERS * cloth_far_side(far->width, level) * cloth_far_side(far->height, level);
        far->levels = level + 1;
    }
    far->texels = alloc_array((size_t)numbers, sizeof(float));
    if (!far->texels) return false;
    for (int j = 0; j < m->picks; j++)
        for (int i = 0; i < m->warps; i++) add_crossing(far, m, seen, i, j);
    for (int level = 1; level < far->levels; level++) halve(far, level);
    return true;
}

static void yarn_pairs(YarnPrepared p, const Lit *lit, PairsLit *restrict out) { EACH_LIT(yarn, Yarn) }

/* Light that points of one system reflect between pairs of directions, loose fibres among them, the mean over channels; and
 * the mean colours of its points without loose fibres, in parts of the cloth, since textures and facets have these. What loose
 * fibres add is in the factors of WeaveFar. Over a gap there are none. */
typedef struct SystemLit {
    Lit lit;
    double once[3], again[3];
} SystemLit;

static double channel_mean(const double color[3]) { return (color[0] + color[1] + color[2]) / 3.0; }

static void color_of_point(const Weave *m, WeavePoint p, double once[3], double again[3]) {
    for (int c = 0; c < 3; c++) {
        once[c] = (double)weave_once(m, p, c);
        again[c] = (double)weave_reflectance(m, p, c);
    }
}

/* Adds a point to those that stand for its system. Its colours are in parts of its thread's. */
static void add_facet(WeftCloth *cloth, WeavePoint p, double once, double again) {
    const Weave *m = &cloth->weave;
    const Yarn yarn = weave_yarn(m, p);
    int *count = &cloth->facet_count[p.weft];
    if (*count == FACETS_MOST) return;
    const int threads = p.weft ? m->picks : m->warps, thread = (int)weave_mod(p.thread, (float)threads);
    double own[2] = {0.0, 0.0};
    for (int c = 0; c < 3; c++)
        for (int kind = 0; kind < 2; kind++)
            own[kind] += (double)color_of(m, p.weft, thread, c, kind == 1) / 3.0;
    cloth->facets[p.weft][(*count)++] = (ClothFacet){.slope_x = yarn.slope_x,
                                                     .slope_y = yarn.slope_y,
                                                     .azimuth = yarn.azimuth,
                                                     .once = (float)(once / fmax(own[0], 1e-9)),
                                                     .again = (float)(again / fmax(own[1], 1e-9))};
}

static int order_of(float a, float b) { return (a > b) - (a < b); }

/* Facets of equal slopes have an order too, so that it is the same with any C library. */
static int by_rest(const ClothFacet *a, const ClothFacet *b) {
    const int azimuth = order_of(a->azimuth, b->azimuth), once = order_of(a->once, b->once);
    return azimuth ? azimuth : once ? once : order_of(a->again, b->again);
}
static int by_slope_x(const void *p, const void *q) {
    const ClothFacet *a = p, *b = q;
    const int x = order_of(a->slope_x, b->slope_x), y = order_of(a->slope_y, b->slope_y);
    return x ? x : y ? y : by_rest(a, b);
}
static int by_slope_y(const void *p, const void *q) {
    const ClothFacet *a = p, *b = q;
    const int y = order_of(a->slope_y, b->slope_y);
    return y ? y : by_slope_x(p, q);
}

/* Orders facets as the leaves of a k-d tree of their slopes, so that those side by side have like slopes, and numbers that are
 * evenly spread, as those of a pixel's samples, choose facets that are. Jon Louis Bentley, "Multidimensional Binary Search
 * Trees Used for Associative Searching", 1975. */
static void order_facets(ClothFacet *facets, int count) {
    if (count < 3) return;
    float low[2] = {facets->slope_x, facets->slope_y}, high[2] = {low[0], low[1]};
    for (int k = 1; k < count; k++) {
        low[0] = fminf(low[0], facets[k].slope_x), high[0] = fmaxf(high[0], facets[k].slope_x);
        low[1] = fminf(low[1], facets[k].slope_y), high[1] = fmaxf(high[1], facets[k].slope_y);
    }
    qsort(facets, (size_t)count, sizeof *facets,
          high[0] - low[0] > high[1] - low[1] ? by_slope_x : by_slope_y);
    order_facets(facets, count / 2);
    order_facets(facets + count / 2, count - count / 2);
}

/* Makes the factors 1 on the mean, and orders the facets. */
static void finish_facets(ClothFacet *facets, int *count) {
    double once = 0.0, again = 0.0;
    for (int k = 0; k < *count; k++) {
        once += (double)facets[k].once / *count;
        again += (double)facets[k].again / *count;
    }
    for (int k = 0; k < *count; k++) {
        facets[k].once /= (float)fmax(once, 1e-9);
        facets[k].again /= (float)fmax(again, 1e-9);
    }
    order_facets(facets, *count);
    if (*count == 0) *count = 1; /* of a system that is never seen, black */
}

/* Adds a point, as it reflects its part of the light. */
static void light_point(Lit *near, const Weave *m, WeavePoint point) {
    double once[3], again[3];
    YarnPrepared p;
    PairsLit pairs;
    color_of_point(m, point, once, again);
    yarn_prepare(weave_yarn(m, point), &p);
    yarn_pairs(p, near, &pairs);
    lit_add(near, &pairs, channel_mean(once) / LOOKS, channel_mean(again) / LOOKS);
}

static void light_points(WeftCloth *cloth, SystemLit near[2]) {
    const Weave *m = &cloth->weave;
    for (int at = 0; at < LOOKS; at++) {
        float x, y;
        double once[3], again[3];
        const WeavePoint bound = look(m, at, &x, &y);
        if (bound.height <= WEAVE_NONE) continue;
        color_of_point(m, bound, once, again);
        for (int c = 0; c < 3; c++) {
            near[bound.weft].once[c] += once[c] / LOOKS;
            near[bound.weft].again[c] += again[c] / LOOKS;
        }
        add_facet(cloth, bound, channel_mean(once), channel_mean(again));
        const WeavePoint point = weave_point(m, x, y, 0.0f, 0.0f); /* with loose fibres */
        light_point(&near[point.weft].lit, m, point);
    }
    for (int t = 0; t < 2; t++) finish_facets(cloth->facets[t], &cloth->facet_count[t]);
}

static float ratio(double near, double far) { return near > 0.0 && far > 0.0 ? (float)(near / far) : 0.0f; }

/* Makes the mean of a layer over the repeat that colour. */
static void scale_layer(ClothFar *far, int layer, const double color[3]) {
    int w, h;
    float factor[3];
    const float *mean = cloth_far_level(far, far->levels - 1, &w, &h) + 4 * layer;
    for (int c = 0; c < 3; c++) factor[c] = ratio(color[c], (double)mean[c]);
    for (int level = 0; level < far->levels; level++) {
        (void)cloth_far_level(far, level, &w, &h);
        float *texels = far->texels + far->starts[level] + 4 * (size_t)layer * (size_t)w * (size_t)h;
        for (int k = 0; k < w * h; k++)
            for (int c = 0; c < 3; c++) texels[4 * k + c] *= factor[c];
    }
}

/* Scales the colours of a system to those of its points, and fits its lobe with factors on them. */
static void fit_system(WeftCloth *cloth, bool weft, const SystemLit *near) {
    WeaveFar *far = weft ? &cloth->weave.weft_far : &cloth->weave.warp_far;
    scale_layer(&cloth->far, weft ? FAR_WEFT_ONCE : FAR_WARP_ONCE, near->once);
    scale_layer(&cloth->far, weft ? FAR_WEFT_AGAIN : FAR_WARP_AGAIN, near->again);
    const Lit lobe = woven_fit(&cloth->weave, weft, &near->lit, &cloth->far.woven[weft]);
    const double share = (double)cloth->far.woven[weft].share;
    far->once = ratio(lit_sum(near->lit.once) * share, lit_sum(lobe.once) * channel_mean(near->once));
    far->again = ratio(lit_sum(near->lit.again) * share, lit_sum(lobe.again) * channel_mean(near->again));
}

static void fit_far(WeftCloth *cloth) {
    SystemLit near[2] = {{.once = {0.0}}};
    for (int t = 0; t < 2; t++) lit_start(&near[t].lit);
    light_points(cloth, near);
    for (int t = 0; t < 2; t++) fit_system(cloth, t == 1, &near[t]);
}

bool cloth_far_make(WeftCloth *cloth) {
    Weave *m = &cloth->weave;
    SystemSeen seen[2] = {{0}};
    see(m, seen);
    m->openness = open_mean(m, seen);
    m->warp_far = far_of(&m->warp, &seen[0]);
    m->weft_far = far_of(&m->weft, &seen[1]);
    if (!make_colors(cloth, seen)) return false;
    fit_far(cloth);
    return true;
}
