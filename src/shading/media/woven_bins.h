/* woven_bins.h - the slopes along a yarn, as bins that lobe woven sums over
 *
 *   s_y = tan(crimp) s |s|^(floats - 1),  s from -1 to 1 along the visible part of a yarn
 *   s = x^power,  power = 1.5 (1 + 0.05 crimp^2) / (floats + 0.5)
 *
 *   Each half of the yarn is cut into n bins at x_0 = 0, x_1 = 1.2 / (2 n - 1) and even steps from there to x_n = 1. A
 * bin from x_k to x_(k + 1) stands for two slopes: its mean s_y, and the opposite on the other half. Bin 0 is one part
 * with its opposite, and level on the mean. It is 1.2 times as wide as even bins would be: the others face away from
 * grazing light one by one, and bin 0 never does. The factor with crimp^2 moves the bins of steep yarns closer to it. n
 * need not be whole: the last bin is then as much narrower, so that f has no steps. Own fit to means over points.
 *   Bins are members of a list, not an array: a GPU would keep an array with a computed index in slow local memory,
 * while it selects among members in registers. */
#pragma once

#include "shading/dialect/lang.h"

#define WOVEN_BINS 17 /* the most: the level one, and 16 in the list, as many rounds as ROUNDS unrolls */

STRUCT(WovenBin) {
    float slope;  /* mean s_y, in parts of the steepest: 0 to 1 */
    float weight; /* of each of the two slopes in the sum; 0: the bin is not used */
};

/* The bins from bin 1 on. */
#define WOVEN_EACH_BIN(N)                                                                                              \
    N(b1) N(b2) N(b3) N(b4) N(b5) N(b6) N(b7) N(b8) N(b9) N(b10) N(b11) N(b12) N(b13) N(b14) N(b15) N(b16)
#define WOVEN_BIN_MEMBER(name) WovenBin name;
STRUCT(WovenBins){WOVEN_EACH_BIN(WOVEN_BIN_MEMBER)};

/* Returns the n that a yarn needs, at least 3, with no upper bound. At the end of the yarn its angle changes by
 * `rate` per x, which is t times alpha, the width of D. n grows with t, and a little with t^2. A yarn that is steep and
 * rough needs more bins than D does. Own fit. */
FN float woven_bins_needed(float alpha, float crimp, float floats) {
    float rate = 1.5f * floats / (floats + 0.5f) * crimp, t = rate / max(alpha, 1e-3f);
    return max(max(t * (1.55f + 0.06f * t) + 1.0f, 9.0f * (rate - 0.65f) + 3.0f), 3.0f);
}

/* The numbers of the formulas above, by which a yarn is cut into bins. */
STRUCT(WovenCut) { float floats, power, n; };

/* The end of a bin. */
STRUCT(WovenBinEnd) {
    float s;
    float integral; /* of (floats + 1) s^floats from 0 to s */
};

/* Returns the end of bin k - 1, at x_k, for k > 0. */
FN WovenBinEnd woven_bin_end(WovenCut c, float k) {
    float first = 1.2f / (2.0f * c.n - 1.0f), step = (1.0f - first) / (c.n - 1.0f);
    WovenBinEnd e;
    e.s = pow(min(first + (k - 1.0f) * step, 1.0f), c.power);
    e.integral = e.s * pow(e.s, c.floats);
    return e;
}

/* Returns the bin between two ends, with its width in s as weight. */
FN WovenBin woven_bin(WovenCut c, WovenBinEnd low, WovenBinEnd high) {
    WovenBin b;
    b.weight = max(high.s - low.s, 0.0f);
    b.slope = min((high.integral - low.integral) / ((c.floats + 1.0f) * max(b.weight, 1e-4f)), 1.0f);
    return b;
}

/* Returns all bins, with their widths in s as weights. */
#define WOVEN_CUT_BIN(name)                                                                                            \
    high = woven_bin_end(c, k + 1.0f);                                                                                 \
    bins.name = woven_bin(c, low, high);                                                                               \
    low = high;                                                                                                        \
    k = k + 1.0f;
FN WovenBins woven_bins_cut(WovenCut c) {
    WovenBins bins;
    WovenBinEnd low = woven_bin_end(c, 1.0f), high;
    float k = 1.0f;
    WOVEN_EACH_BIN(WOVEN_CUT_BIN)
    return bins;
}

/* Returns the weighted sum of the squared slopes. */
#define WOVEN_ADD_SQUARE(name) sum = sum + bins->name.weight * bins->name.slope * bins->name.slope;
FN float woven_bins_square(const WovenBins *bins) {
    float sum = 0.0f;
    WOVEN_EACH_BIN(WOVEN_ADD_SQUARE)
    return sum;
}

/* Returns the bins with all weights multiplied. */
#define WOVEN_SCALE_BIN(name) scaled.name.weight = scaled.name.weight * factor;
FN WovenBins woven_bins_scaled(const WovenBins *bins, float factor) {
    WovenBins scaled = *bins;
    WOVEN_EACH_BIN(WOVEN_SCALE_BIN)
    return scaled;
}

/* Returns the k-th of a to h, k from 0 to 7. */
FN float woven_pick(int k, float a, float b, float c, float d, float e, float f, float g, float h) {
    float low = k < 2 ? (k < 1 ? a : b) : (k < 3 ? c : d), high = k < 6 ? (k < 5 ? e : f) : (k < 7 ? g : h);
    return k < 4 ? low : high;
}

/* Returns bin k + 1, k from 0 to 15. */
#define WOVEN_PICK(part)                                                                                               \
    low =                                                                                                              \
        woven_pick(k, m->b1.part, m->b2.part, m->b3.part, m->b4.part, m->b5.part, m->b6.part, m->b7.part, m->b8.part); \
    high = woven_pick(k - 8, m->b9.part, m->b10.part, m->b11.part, m->b12.part, m->b13.part, m->b14.part, m->b15.part, \
                      m->b16.part);                                                                                    \
    b.part = k < 8 ? low : high;
FN WovenBin woven_bin_at(const WovenBins *m, int k) {
    WovenBin b;
    float low, high;
    WOVEN_PICK(slope)
    WOVEN_PICK(weight)
    return b;
}
