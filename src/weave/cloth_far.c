/* cloth_far.c - a cloth from afar: a lobe woven for each system that reflects as its visible points do on the mean, and
 * the colours of the crossings as mipmaps
 *
 *   E[s_x^2] = across^2 / 3,  E[s_y^2] = along^2 / 3
 *
 * give the slopes `across` and `along` by which yarns hide each other, from the slopes s_x and s_y of points: uniform
 * slopes up to these have the same mean squares. The lobe is fitted (woven_fit.c) to the mean of what the points
 * reflect between pairs of directions. In these points threads hide the ends of others, crevices are dark, and fibres
 * rise or lie loose. The rest of the difference is one factor for each system and each kind of light, which goes into
 * the colours. */
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "weave/weft_cloth.h"
#include "weave/woven_fit.h"

enum {
    PIECE = 4800,       /* least threads along either side of the piece of cloth that is looked at */
    PLACES = 48000,     /* on that piece */
    FAR_SIDE_MAX = 512, /* texels */
};
_Static_assert(1 << (FAR_LEVELS_MOST - 1) == FAR_SIDE_MAX, "a level for each halving, and the first");

/* Spacing of the points, in threads: so far apart that single fibres fade. */
static const float FAR_SPACING = 1.0f;

/* Heights of visible points: how many, and sums of them and of their squares. */
typedef struct Heights {
    int count;
    double sum, square;
} Heights;

enum { RUN_MOST = 32 }; /* crossings of a run that are told apart */

/* One system at all places. [0] is where it is below at the crossing, [1] where it is on top. */
typedef struct SystemSeen {
    int count;          /* visible points */
    int crossings[2];   /* places by crossing */
    int on[2];          /* visible points by crossing */
    double k_sum;       /* of k, the power of the slope along the yarn */
    double across2_sum; /* of the squared slope across the yarn, */
    double along2_sum;  /* and along it */
    Heights heights;
    Heights places[RUN_MOST + 1][RUN_MOST]; /* by the length of the run on top and the crossing in it; [0][0]: below */
} SystemSeen;

/* Returns the threads along a side of the piece: whole repeats, at least PIECE. */
static double piece_side(int count) {
    const int repeats = (PIECE + count - 1) / count;
    return (double)(count * repeats);
}

/* Returns the point at place k of an evenly spread sequence, without loose fibres, and sets the place. Multiples of the
 * root of 2 are the places across a fibre. Martin Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences",
 * 2018. */
static WeavePoint point_at(const Weave *m, int k, float *x, float *y) {
    *x = (float)(fmod(0.7548776662466927 * (k + 1), 1.0) * piece_side(m->warps));
    *y = (float)(fmod(0.5698402909980532 * (k + 1), 1.0) * piece_side(m->picks));
    return weave_point_bound(m, *x, *y, FAR_SPACING, 2.0f * (float)fmod(1.4142135623730951 * (k + 1), 1.0) - 1.0f);
}

/* Returns 1 if the thread of a system is on top at the crossing there. */
static int is_up(const Weave *m, float x, float y, int weft) {
    const WeaveCell cell = weave_cell(m, floorf(x), floorf(y));
    return (weft ? cell.weft_run : cell.warp_run) > 0.0f;
}

/* Returns the heights of a system where it is at that place of its run. */
static Heights *heights_at(SystemSeen *seen, const Weave *m, float x, float y, int weft) {
    const WeaveCell cell = weave_cell(m, floorf(x), floorf(y));
    const int run = (int)(weft ? cell.weft_run : cell.warp_run),
              since = (int)(weft ? cell.weft_since : cell.warp_since);
    return run > 0 && run <= RUN_MOST ? &seen->places[run][since] : &seen->places[0][0];
}

static void add_height(Heights *to, float z) {
    to->count++;
    to->sum += (double)z;
    to->square += (double)z * (double)z;
}

/* Fills seen, and sets the heights of m. */
static void see(Weave *m, SystemSeen seen[2]) {
    m->low = HUGE_VALF;
    m->high = -HUGE_VALF;
    for (int k = 0; k < PLACES; k++) {
        float x, y;
        const WeavePoint p = point_at(m, k, &x, &y);
        for (int t = 0; t < 2; t++) seen[t].crossings[is_up(m, x, y, t)]++;
        if (p.height <= WEAVE_NONE) continue;
        SystemSeen *of = &seen[p.weft];
        const float across = p.weft ? p.slope_y : p.slope_x, along = p.weft ? p.slope_x : p.slope_y;
        of->count++;
        of->on[is_up(m, x, y, p.weft)]++;
        of->k_sum += (double)p.k;
        of->across2_sum += (double)(across * across);
        of->along2_sum += (double)(along * along);
        add_height(&of->heights, p.height);
        add_height(heights_at(of, m, x, y, p.weft), p.height);
        m->low = fminf(m->low, p.height);
        m->high = fmaxf(m->high, p.height);
    }
    if (m->low > m->high) m->low = m->high = 0.0f;
}

/* Returns the mean of weave_depth, 1 - WEAVE_SHADE ((high - z) / (high - low))^2, over points of these heights. */
static float depth_mean(const Weave *m, const Heights *heights) {
    const double high = (double)m->high, range = fmax(high - (double)m->low, 1e-6);
    if (heights->count < 1) return 1.0f;
    const double z = heights->sum / heights->count, z2 = heights->square / heights->count;
    return (float)(1.0 - (double)WEAVE_SHADE * (high * high - 2.0 * high * z + z2) / (range * range));
}

static float open_mean(const Weave *m, const SystemSeen seen[2]) {
    const Heights *a = &seen[0].heights, *b = &seen[1].heights;
    const Heights all = {a->count + b->count, a->sum + b->sum, a->square + b->square};
    return depth_mean(m, &all);
}

/* Returns the moments of visible points as parameters of lobe woven, or those of the yarn if no point is visible.
 * Fibres are rotated by 0.35 streaks times noise whose variance is 0.18 (weave_add_fibres), which widens the lobe. */
static WeaveFar far_of(const WeaveYarn *y, const SystemSeen *seen) {
    const float angle = 0.35f * y->streaks, a2 = y->alpha * y->alpha;
    WeaveFar far = {.alpha = sqrtf(a2 + (1.0f - a2) * fminf(0.18f * angle * angle, 1.0f)),
                    .crimp = fminf(y->crimp, CRIMP_MOST),
                    .roundness = y->roundness,
                    .floats = 1.0f,
                    .slope_across = y->roundness,
                    .slope_along = y->crimp,
                    .share = (float)seen->count / PLACES,
                    .single = 1.0f,
                    .multiple = 1.0f};
    if (!seen->count) return far;
    far.floats = fminf((float)(seen->k_sum / seen->count), FLOATS_MOST);
    far.slope_across = fminf((float)(sqrt)(3.0 * seen->across2_sum / seen->count), ROUNDNESS_MOST);
    far.roundness = far.slope_across;
    far.slope_along = (float)(sqrt)(3.0 * seen->along2_sum / seen->count);
    far.crimp = fminf(far.slope_along * sqrtf((2.0f * far.floats + 1.0f) / 3.0f), CRIMP_MOST);
    return far;
}

/* Returns the share that a system covers of the crossings where it is below (up 0) or on top (up 1). */
static float covers(const SystemSeen *seen, int up) {
    return seen->crossings[up] ? (float)seen->on[up] / (float)seen->crossings[up] : 0.0f;
}

/* Returns one channel of a thread's colour without irregular dye, in light that met one fibre or in all other light. t:
 * 1 for the weft. */
static float color_of(const Weave *m, int t, int thread, int c, bool multiple) {
    const float a = m->albedos[3 * ((t ? m->warps : 0) + thread) + c], white = t ? m->weft.white : m->warp.white;
    return multiple ? yarn_reflectance(a) : fminf(a + white, 1.0f);
}

/* Adds a crossing to the texels of level 0 that it overlaps, in proportion to the overlap. A long float is in the light
 * where it is high and in the shade where it dives, as the ribs of corduroy. */
static void add_crossing(ClothFar *far, const Weave *m, SystemSeen seen[2], int i, int j) {
    const float across = (float)far->width / (float)m->warps, along = (float)far->height / (float)m->picks;
    const float x0 = (float)i * across, x1 = x0 + across, y0 = (float)j * along, y1 = y0 + along;
    float color[FAR_LAYERS][4];
    for (int layer = 0; layer < FAR_LAYERS; layer++) {
        const int t = layer / 2;
        const float part = covers(&seen[t], is_up(m, (float)i, (float)j, t));
        const float light = depth_mean(m, heights_at(&seen[t], m, (float)i, (float)j, t)) / m->openness;
        for (int c = 0; c < 3; c++) color[layer][c] = part * light * color_of(m, t, t ? j : i, c, layer % 2 == 1);
        color[layer][3] = part;
    }
    for (int row = (int)y0; row < far->height && (float)row < y1; row++)
        for (int column = (int)x0; column < far->width && (float)column < x1; column++) {
            const float part = (fminf(x1, (float)column + 1.0f) - fmaxf(x0, (float)column)) *
                               (fminf(y1, (float)row + 1.0f) - fmaxf(y0, (float)row));
            for (int layer = 0; layer < FAR_LAYERS; layer++)
                for (int c = 0; c < 4; c++)
                    far->texels[4 * ((size_t)(layer * far->height + row) * (size_t)far->width + (size_t)column) +
                                (size_t)c] += fmaxf(part, 0.0f) * color[layer][c];
        }
}

const float *cloth_far_level(const ClothFar *far, int level, int *width, int *height) {
    *width = cloth_far_side(far->width, level);
    *height = cloth_far_side(far->height, level);
    return far->texels + far->starts[level];
}

/* Fills a level with means of the one before it. */
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

/* Returns a power of 2 that has a texel for each thread, up to FAR_SIDE_MAX. */
static int far_side(int threads) {
    int side = 1;
    while (side < threads && side < FAR_SIDE_MAX) side *= 2;
    return side;
}

/* Allocates and fills the colours. Returns false where memory is short. */
static bool make_colors(WeftCloth *cloth, SystemSeen seen[2]) {
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

/* The light that points of one system reflect, in parts of the cloth. Textures and facets have the mean colours, which
 * are without loose fibres. What loose fibres add becomes the factors of WeaveFar. */
typedef struct SystemLit {
    Lit lit; /* with loose fibres, the mean over channels */
    double single[3], multiple[3];
    double open, raised; /* sums of weave_open, and of that times weave_raised */
} SystemLit;

static double channel_mean(const double color[3]) { return (color[0] + color[1] + color[2]) / 3.0; }

static void color_of_point(const Weave *m, WeavePoint p, double single[3], double multiple[3]) {
    for (int c = 0; c < 3; c++) {
        single[c] = (double)weave_single(m, p, c);
        multiple[c] = (double)weave_multiple(m, p, c);
    }
}

/* The facets of one system: all of its visible points, of which FACETS_MOST are kept. */
typedef struct FacetList {
    ClothFacet *all;
    int count;
} FacetList;

/* Adds a point. single, multiple: its colours, which the facet has in parts of its thread's. */
static void add_facet(FacetList *to, const Weave *m, WeavePoint p, double single, double multiple) {
    const Yarn yarn = weave_yarn(m, p);
    const int threads = p.weft ? m->picks : m->warps, thread = (int)weave_mod(p.thread, (float)threads);
    double own[2] = {0.0, 0.0}; /* colours of the thread */
    for (int c = 0; c < 3; c++)
        for (int kind = 0; kind < 2; kind++) own[kind] += (double)color_of(m, p.weft, thread, c, kind == 1) / 3.0;
    to->all[to->count++] = (ClothFacet){.slope_x = yarn.slope_x,
                                        .slope_y = yarn.slope_y,
                                        .azimuth = yarn.azimuth,
                                        .single = (float)(single / fmax(own[0], 1e-9)),
                                        .multiple = (float)(multiple / fmax(own[1], 1e-9))};
}

static int order_of(float a, float b) { return (a > b) - (a < b); }

/* Compares facets of equal slopes too, so that their order is the same with any C library. */
static int by_rest(const ClothFacet *a, const ClothFacet *b) {
    const int azimuth = order_of(a->azimuth, b->azimuth), single = order_of(a->single, b->single);
    return azimuth ? azimuth : single ? single : order_of(a->multiple, b->multiple);
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

/* Orders facets as the leaves of a k-d tree of their slopes. Facets side by side then have similar slopes, so that
 * evenly spread numbers, as the samples of a pixel have them, choose evenly spread slopes. Jon Louis Bentley,
 * "Multidimensional Binary Search Trees Used for Associative Searching", 1975. */
static void order_facets(ClothFacet *facets, int count) {
    if (count < 3) return;
    float low[2] = {facets->slope_x, facets->slope_y}, high[2] = {low[0], low[1]};
    for (int k = 1; k < count; k++) {
        low[0] = fminf(low[0], facets[k].slope_x), high[0] = fmaxf(high[0], facets[k].slope_x);
        low[1] = fminf(low[1], facets[k].slope_y), high[1] = fmaxf(high[1], facets[k].slope_y);
    }
    qsort(facets, (size_t)count, sizeof *facets, high[0] - low[0] > high[1] - low[1] ? by_slope_x : by_slope_y);
    order_facets(facets, count / 2);
    order_facets(facets + count / 2, count - count / 2);
}

/* Orders all facets and keeps FACETS_MOST of them, evenly spread over that order: by chance alone the few steep facets
 * of a narrow highlight would be some percent too few or too many. Scales the factors to a mean of 1. Returns how many
 * there are. */
static int keep_facets(FacetList *from, ClothFacet kept[FACETS_MOST]) {
    const int count = from->count < FACETS_MOST ? from->count : FACETS_MOST;
    double single = 0.0, multiple = 0.0;
    order_facets(from->all, from->count);
    for (int k = 0; k < count; k++) {
        const double at = ((double)k + fmod(0.6180339887498949 * (k + 1), 1.0)) * from->count / count;
        kept[k] = from->all[(int)at];
        single += (double)kept[k].single / count;
        multiple += (double)kept[k].multiple / count;
    }
    for (int k = 0; k < count; k++) {
        kept[k].single /= (float)fmax(single, 1e-9);
        kept[k].multiple /= (float)fmax(multiple, 1e-9);
    }
    return count > 0 ? count : 1; /* one of a system that is never seen is black */
}

/* Adds what a point reflects, as one of PLACES. */
static void light_point(Lit *near, const Weave *m, WeavePoint point) {
    double single[3], multiple[3];
    YarnPrepared p;
    PairsLit pairs;
    color_of_point(m, point, single, multiple);
    yarn_prepare(weave_yarn(m, point), &p);
    yarn_pairs(p, near, &pairs);
    lit_add(near, &pairs, channel_mean(single) / PLACES, channel_mean(multiple) / PLACES);
}

/* Adds what all points reflect, and their facets. */
static void light_points(const WeftCloth *cloth, SystemLit near[2], FacetList facets[2]) {
    const Weave *m = &cloth->weave;
    for (int at = 0; at < PLACES; at++) {
        float x, y;
        double single[3], multiple[3];
        const WeavePoint bound = point_at(m, at, &x, &y);
        if (bound.height <= WEAVE_NONE) continue;
        color_of_point(m, bound, single, multiple);
        for (int c = 0; c < 3; c++) {
            near[bound.weft].single[c] += single[c] / PLACES;
            near[bound.weft].multiple[c] += multiple[c] / PLACES;
        }
        near[bound.weft].open += (double)weave_open(m, bound);
        near[bound.weft].raised += (double)(weave_open(m, bound) * weave_raised(m, bound));
        add_facet(&facets[bound.weft], m, bound, channel_mean(single), channel_mean(multiple));
        const WeavePoint point = weave_point(m, x, y, 0.0f, 0.0f); /* with loose fibres */
        light_point(&near[point.weft].lit, m, point);
    }
}

/* Returns near / far, 0 if either is. */
static float ratio(double near, double far) { return near > 0.0 && far > 0.0 ? (float)(near / far) : 0.0f; }

/* Scales a layer so that its mean over the repeat is that colour. */
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

/* Scales the colours of a system to those of its points, fits its lobe, and sets the factors that remain. */
static void fit_system(WeftCloth *cloth, bool weft, const SystemLit *near) {
    WeaveFar *far = weft ? &cloth->weave.weft_far : &cloth->weave.warp_far;
    scale_layer(&cloth->far, weft ? FAR_WEFT_SINGLE : FAR_WARP_SINGLE, near->single);
    scale_layer(&cloth->far, weft ? FAR_WEFT_MULTIPLE : FAR_WARP_MULTIPLE, near->multiple);
    const Lit lobe = woven_fit(&cloth->weave, weft, &near->lit, &cloth->far.woven[weft]);
    const double share = (double)cloth->far.woven[weft].share;
    far->single = ratio(lit_sum(near->lit.single) * share, lit_sum(lobe.single) * channel_mean(near->single));
    far->multiple = ratio(lit_sum(near->lit.multiple) * share, lit_sum(lobe.multiple) * channel_mean(near->multiple));
}

/* Returns false where memory is short. seen: how many points of each system are visible. */
static bool fit_far(WeftCloth *cloth, const SystemSeen seen[2]) {
    SystemLit near[2] = {{.single = {0.0}}};
    FacetList facets[2] = {{0}};
    bool made = true;
    for (int t = 0; t < 2; t++) {
        lit_start(&near[t].lit);
        facets[t].all = alloc_array((size_t)seen[t].count + 1, sizeof *facets[t].all);
        made &= facets[t].all != NULL;
    }
    if (made) light_points(cloth, near, facets);
    for (int t = 0; made && t < 2; t++) {
        cloth->facet_count[t] = keep_facets(&facets[t], cloth->facets[t]);
        fit_system(cloth, t == 1, &near[t]);
        WeaveFar *far = t ? &cloth->weave.weft_far : &cloth->weave.warp_far;
        far->open = seen[t].count ? (float)(near[t].open / seen[t].count) : 1.0f;
        far->raised = ratio(near[t].raised, near[t].open);
    }
    for (int t = 0; t < 2; t++) free(facets[t].all);
    return made;
}

/* Makes all for the amounts of dye that the yarns have on the mean over many threads. */
static bool make_even(WeftCloth *cloth) {
    Weave *m = &cloth->weave;
    SystemSeen seen[2] = {{0}};
    see(m, seen);
    m->openness = open_mean(m, seen);
    m->warp_far = far_of(&m->warp, &seen[0]);
    m->weft_far = far_of(&m->weft, &seen[1]);
    return make_colors(cloth, seen) && fit_far(cloth, seen);
}

bool cloth_far_make(WeftCloth *cloth) {
    WeaveYarn *yarns[2] = {&cloth->weave.warp, &cloth->weave.weft};
    float barre[2], uneven[2];
    for (int t = 0; t < 2; t++) {
        barre[t] = yarns[t]->barre, uneven[t] = yarns[t]->uneven;
        yarns[t]->barre = yarns[t]->uneven = 0.0f;
    }
    const bool made = make_even(cloth);
    for (int t = 0; t < 2; t++) yarns[t]->barre = barre[t], yarns[t]->uneven = uneven[t];
    return made;
}
