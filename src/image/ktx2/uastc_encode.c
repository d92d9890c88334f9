#include "image/ktx2/uastc_encode.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/ktx2/uastc_etc1.h"

enum { AXIS_STEPS = 6, REFINEMENTS = 3, PATTERNS_TRIED = 2, WEIGHTS_MOST = 32, GOOD_ENOUGH = 48 };

/* A block in the channels of a mode: luminance and alpha, or colours, or colours and alpha. */
typedef struct ChannelValues {
    float value[UASTC_TEXELS][4];
    int channels;
    int count[4]; /* of colours that a channel stands for: luminance is three */
} ChannelValues;

/* A block as one mode has it. */
typedef struct Coded {
    int mode, pattern, selector;
    uint8_t digit[UASTC_ENDPOINTS], bits[UASTC_ENDPOINTS];
    uint8_t weight[UASTC_TEXELS][2];
    unsigned error; /* squares, summed over texels and channels */
} Coded;

/* The texels and channels that share a line: those of a subset in a plane. */
typedef struct Group {
    int texels[UASTC_TEXELS], texel_count;
    int channels[4], channel_count;
} Group;

void uastc_ends_make(UastcEnds *out) {
    static const unsigned bases[] = {1, 3, 5};
    for (int m = 0; m < UASTC_MODES; m++)
        for (int v = 0; v < 256; v++) {
            int best = INT_MAX;
            for (unsigned d = 0; d < bases[uastc_modes[m].digit]; d++)
                for (unsigned b = 0; b < 1u << uastc_modes[m].endpoint_bits; b++) {
                    const int value = (int)uastc_endpoint(&uastc_modes[m], d, b), distance = abs(value - v);
                    if (distance >= best) continue;
                    best = distance;
                    out->digit[m][v] = (uint8_t)d;
                    out->bits[m][v] = (uint8_t)b;
                    out->value[m][v] = (uint8_t)value;
                }
        }
}

static void mean_of(const ChannelValues *source, const Group *group, float mean[4]) {
    for (int c = 0; c < 4; c++) mean[c] = 0.0f;
    for (int k = 0; k < group->texel_count; k++)
        for (int c = 0; c < group->channel_count; c++)
            mean[c] += source->value[group->texels[k]][group->channels[c]] / (float)group->texel_count;
}

/* Finds the axis along which the colours of a group lie, of length 1. Returns the squares of the distances from it. */
static float axis_of(const ChannelValues *source, const Group *group, const float mean[4], float axis[4]) {
    float spread[4][4] = {{0.0f}}, trace = 0.0f, along = 0.0f;
    const int n = group->channel_count;
    for (int k = 0; k < group->texel_count; k++) {
        float d[4];
        for (int c = 0; c < n; c++) d[c] = source->value[group->texels[k]][group->channels[c]] - mean[c];
        for (int a = 0; a < n; a++)
            for (int b = 0; b <= a; b++) spread[a][b] += d[a] * d[b];
    }
    int widest = 0;
    for (int a = 0; a < n; a++) {
        trace += spread[a][a];
        if (spread[a][a] > spread[widest][widest]) widest = a;
        for (int b = a + 1; b < n; b++) spread[a][b] = spread[b][a];
    }
    for (int c = 0; c < 4; c++) axis[c] = c < n ? spread[c][widest] : 0.0f;
    for (int step = 0; step < AXIS_STEPS; step++) {
        float next[4] = {0.0f}, length = 0.0f;
        for (int a = 0; a < n; a++)
            for (int b = 0; b < n; b++) next[a] += spread[a][b] * axis[b];
        for (int a = 0; a < n; a++) length += next[a] * next[a];
        if (!(length > 0.0f)) return trace;
        length = sqrtf(length);
        for (int a = 0; a < n; a++) axis[a] = next[a] / length;
    }
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++) along += axis[a] * spread[a][b] * axis[b];
    return trace - along;
}

/* Takes the outermost places of the colours on their axis as the two ends. */
static void ends_guess(const ChannelValues *source, const Group *group, float ends[2][4]) {
    float mean[4], axis[4], low = 0.0f, high = 0.0f;
    mean_of(source, group, mean);
    axis_of(source, group, mean, axis);
    for (int k = 0; k < group->texel_count; k++) {
        float at = 0.0f;
        for (int c = 0; c < group->channel_count; c++)
            at += (source->value[group->texels[k]][group->channels[c]] - mean[c]) * axis[c];
        low = fminf(low, at);
        high = fmaxf(high, at);
    }
    for (int c = 0; c < group->channel_count; c++) {
        ends[0][c] = mean[c] + low * axis[c];
        ends[1][c] = mean[c] + high * axis[c];
    }
}

/* Finds the ends whose line is nearest to the colours, given their places on it. Leaves them where all have one place. */
static void ends_refine(const ChannelValues *source, const Group *group, int weight_bits,
                        const uint8_t weights[UASTC_TEXELS], float ends[2][4]) {
    float aa = 0.0f, ab = 0.0f, bb = 0.0f, a[4] = {0.0f}, b[4] = {0.0f};
    for (int k = 0; k < group->texel_count; k++) {
        const float high = (float)uastc_weight(weight_bits, weights[group->texels[k]]) / 64.0f, low = 1.0f - high;
        aa += low * low;
        ab += low * high;
        bb += high * high;
        for (int c = 0; c < group->channel_count; c++) {
            a[c] += low * source->value[group->texels[k]][group->channels[c]];
            b[c] += high * source->value[group->texels[k]][group->channels[c]];
        }
    }
    const float det = aa * bb - ab * ab;
    if (!(det > 1e-4f)) return;
    for (int c = 0; c < group->channel_count; c++) {
        ends[0][c] = (a[c] * bb - b[c] * ab) / det;
        ends[1][c] = (b[c] * aa - a[c] * ab) / det;
    }
}

static int byte_near(float value) { return value < 0.0f ? 0 : value > 255.0f ? 255 : (int)(value + 0.5f); }

/* The values on a line between two ends that a mode has. */
typedef struct LineValues {
    float value[WEIGHTS_MOST][4];
    int count;
} LineValues;

static void palette_fill(const UastcEnds *table, int mode, const Group *group, const float ends[2][4],
                         LineValues *out) {
    const int bits = uastc_modes[mode].weight_bits;
    out->count = 1 << bits;
    for (int w = 0; w < out->count; w++)
        for (int c = 0; c < group->channel_count; c++)
            out->value[w][c] =
                (float)uastc_between(table->value[mode][byte_near(ends[0][c])],
                                     table->value[mode][byte_near(ends[1][c])], uastc_weight(bits, (unsigned)w));
}

/* Gives each texel of a group the nearest value. Returns the squares of the distances. */
static unsigned weights_choose(const ChannelValues *source, const Group *group, const LineValues *palette,
                               uint8_t weights[UASTC_TEXELS]) {
    float sum = 0.0f;
    for (int k = 0; k < group->texel_count; k++) {
        const float *value = source->value[group->texels[k]];
        float best = INFINITY;
        for (int w = 0; w < palette->count; w++) {
            float distance = 0.0f;
            for (int c = 0; c < group->channel_count; c++) {
                const float d = value[group->channels[c]] - palette->value[w][c];
                distance += d * d * (float)source->count[group->channels[c]];
            }
            if (distance >= best) continue;
            best = distance;
            weights[group->texels[k]] = (uint8_t)w;
        }
        sum += best;
    }
    return (unsigned)sum;
}

/* Puts the ends and weights of a group into a block. The anchor, a group's first texel, has a weight whose highest bit is
 * 0: otherwise the line is reversed. */
static void group_put(const UastcEnds *table, const Group *group, int subset, int plane, float ends[2][4],
                      const uint8_t weights[UASTC_TEXELS], Coded *out) {
    const UastcMode *mode = &uastc_modes[out->mode];
    const int most = (1 << mode->weight_bits) - 1;
    const bool reversed = weights[group->texels[0]] > most / 2;
    for (int k = 0; k < group->texel_count; k++) {
        const uint8_t weight = weights[group->texels[k]];
        out->weight[group->texels[k]][plane] = (uint8_t)(reversed ? most - weight : weight);
    }
    for (int c = 0; c < group->channel_count; c++)
        for (int e = 0; e < 2; e++) {
            const int at = 2 * (mode->channels * subset + group->channels[c]) + (reversed ? 1 - e : e);
            out->digit[at] = table->digit[out->mode][byte_near(ends[e][c])];
            out->bits[at] = table->bits[out->mode][byte_near(ends[e][c])];
        }
}

/* Fits the line of a group. Returns the squares of its errors. */
static unsigned group_fit(const UastcEnds *table, const ChannelValues *source, const Group *group, int subset,
                          int plane, Coded *out) {
    float ends[2][4];
    unsigned best = UINT_MAX;
    ends_guess(source, group, ends);
    for (int round = 0; round <= REFINEMENTS && best; round++) {
        LineValues palette;
        uint8_t weights[UASTC_TEXELS];
        palette_fill(table, out->mode, group, (const float(*)[4])ends, &palette);
        const unsigned error = weights_choose(source, group, &palette, weights);
        if (error >= best) break;
        best = error;
        group_put(table, group, subset, plane, ends, weights, out);
        ends_refine(source, group, uastc_modes[out->mode].weight_bits, weights, ends);
    }
    return best;
}

/* Collects the texels of a subset and the channels of a plane; selector is the channel of the second plane, or -1. */
static Group group_of(int mode, int pattern, int subset, int plane, int selector) {
    Group group = {.texel_count = 0, .channel_count = 0};
    for (int t = 0; t < UASTC_TEXELS; t++)
        if (uastc_subset(mode, pattern, t) == subset) group.texels[group.texel_count++] = t;
    for (int c = 0; c < uastc_modes[mode].channels; c++)
        if ((c == selector) == (plane == 1)) group.channels[group.channel_count++] = c;
    return group;
}

/* Keeps a block of this mode, pattern and channel of the second plane, or -1, if it is better than what there is. */
static void block_try(const UastcEnds *table, const ChannelValues *source, int mode, int pattern, int selector,
                      Coded *best) {
    Coded coded = {.mode = mode, .pattern = pattern, .selector = selector, .error = 0};
    for (int s = 0; s < uastc_modes[mode].subsets && coded.error < best->error; s++)
        for (int p = 0; p < uastc_modes[mode].planes; p++) {
            const Group group = group_of(mode, pattern, s, p, selector);
            coded.error += group_fit(table, source, &group, s, p, &coded);
        }
    if (coded.error < best->error) *best = coded;
}

/* Tries the patterns whose subsets lie nearest to lines. */
static void patterns_try(const UastcEnds *table, const ChannelValues *source, int mode, Coded *best) {
    float distance[PATTERNS_TRIED + 1];
    int nearest[PATTERNS_TRIED + 1], count = 0;
    for (int pattern = 0; pattern < uastc_patterns(mode); pattern++) {
        float sum = 0.0f, mean[4], axis[4];
        for (int s = 0; s < uastc_modes[mode].subsets; s++) {
            const Group group = group_of(mode, pattern, s, 0, -1);
            mean_of(source, &group, mean);
            sum += axis_of(source, &group, mean, axis);
        }
        int at = count < PATTERNS_TRIED ? count++ : PATTERNS_TRIED;
        for (; at > 0 && distance[at - 1] > sum; at--) {
            distance[at] = distance[at - 1];
            nearest[at] = nearest[at - 1];
        }
        distance[at] = sum;
        nearest[at] = pattern;
    }
    for (int k = 0; k < count; k++) block_try(table, source, mode, nearest[k], -1, best);
}

static void mode_try(const UastcEnds *table, const ChannelValues *source, int mode, Coded *best) {
    const UastcMode *m = &uastc_modes[mode];
    if (m->subsets > 1) {
        if (best->error > GOOD_ENOUGH) patterns_try(table, source, mode, best);
    } else if (m->planes == 1) {
        block_try(table, source, mode, 0, -1, best);
    } else {
        for (int c = m->selector_bits ? 0 : 1; c < m->channels && best->error; c++)
            block_try(table, source, mode, 0, c, best);
    }
}

/* Takes the channels of a mode from the texels. */
static ChannelValues source_of(uint8_t texels[UASTC_TEXELS][4], int channels) {
    ChannelValues source = {.channels = channels, .count = {channels == 2 ? 3 : 1, 1, 1, 1}};
    for (int t = 0; t < UASTC_TEXELS; t++)
        for (int c = 0; c < channels; c++) source.value[t][c] = (float)texels[t][channels == 2 && c ? 3 : c];
    return source;
}

/* Bits to write, the first in the lowest place. */
typedef struct BitWriter {
    unsigned char *block;
    int at;
} BitWriter;

static void bits_put(BitWriter *writer, unsigned value, int count) {
    for (int k = 0; k < count; k++, writer->at++)
        writer->block[writer->at / 8] |= (unsigned char)((value >> k & 1) << writer->at % 8);
}

static void digits_put(BitWriter *writer, UastcDigit digit, const uint8_t *digits, int count) {
    const int group = digit == UASTC_TRITS ? 5 : 3;
    const unsigned base = digit == UASTC_TRITS ? 3 : 5;
    for (int first = 0; first < count; first += group) {
        const int here = count - first < group ? count - first : group;
        unsigned number = 0;
        for (int k = here; k-- > 0;) number = number * base + digits[first + k];
        bits_put(writer, number, uastc_digit_bits(digit, here));
    }
}

static void solid_write(const uint8_t color[4], unsigned char block[UASTC_BYTES]) {
    const UastcEtc1Solid solid = uastc_etc1_solid(color);
    BitWriter writer = {.block = block, .at = 0};
    bits_put(&writer, uastc_modes[UASTC_SOLID].code, uastc_modes[UASTC_SOLID].start);
    for (int c = 0; c < 4; c++) bits_put(&writer, color[c], 8);
    bits_put(&writer, solid.differential, 1);
    bits_put(&writer, solid.intensity, 3);
    bits_put(&writer, solid.selector, 2);
    for (int c = 0; c < 3; c++) bits_put(&writer, solid.base[c], 5);
}

static void coded_write(const Coded *coded, unsigned char block[UASTC_BYTES]) {
    const UastcMode *mode = &uastc_modes[coded->mode];
    const int ends = 2 * mode->channels * mode->subsets;
    bool anchored[3] = {false};
    BitWriter writer = {.block = block, .at = 0};
    bits_put(&writer, mode->code, mode->code_bits);
    writer.at = mode->start;
    bits_put(&writer, (unsigned)coded->selector, mode->selector_bits);
    bits_put(&writer, (unsigned)coded->pattern, mode->pattern_bits);
    if (mode->digit != UASTC_BITS) digits_put(&writer, mode->digit, coded->digit, ends);
    for (int k = 0; k < ends; k++) bits_put(&writer, coded->bits[k], mode->endpoint_bits);
    for (int t = 0; t < UASTC_TEXELS; t++) {
        bool *anchor = &anchored[uastc_subset(coded->mode, coded->pattern, t)];
        for (int p = 0; p < mode->planes; p++) bits_put(&writer, coded->weight[t][p], mode->weight_bits - !*anchor);
        *anchor = true;
    }
}

/* Writes the hints by what a block decodes to: for ETC1, behind those for BC1, which stay 0, and for alpha where the mode
 * has it. Modes 10 to 12 have one hint for BC1 in place of two, and no bias; the bias that changes nothing is 13. */
static void hints_write(int mode, unsigned char block[UASTC_BYTES]) {
    enum { NO_BIAS = 13 };
    const bool few = mode >= 10 && mode <= 12;
    uint8_t texels[UASTC_TEXELS][4];
    uastc_decode(block, texels);
    const UastcEtc1 hint = uastc_etc1_find(texels);
    BitWriter writer = {.block = block, .at = uastc_modes[mode].code_bits + (few ? 1 : 2)};
    bits_put(&writer, hint.flip, 1);
    bits_put(&writer, hint.differential, 1);
    for (int half = 0; half < 2; half++) bits_put(&writer, hint.intensity[half], 3);
    if (!few) bits_put(&writer, NO_BIAS, 5);
    if (mode >= 9 && mode <= 17) bits_put(&writer, uastc_etc2_alpha(texels), 8);
}

void uastc_encode(const UastcEnds *ends, uint8_t texels[UASTC_TEXELS][4], unsigned char block[UASTC_BYTES]) {
    bool flat = true, grey = true, opaque = true;
    for (int t = 0; t < UASTC_TEXELS; t++) {
        flat &= memcmp(texels[t], texels[0], 4) == 0;
        grey &= texels[t][0] == texels[t][1] && texels[t][1] == texels[t][2];
        opaque &= texels[t][3] == 255;
    }
    memset(block, 0, UASTC_BYTES);
    if (flat) {
        solid_write(texels[0], block);
        return;
    }
    const ChannelValues sources[5] = {
        [2] = source_of(texels, 2), [3] = source_of(texels, 3), [4] = source_of(texels, 4)};
    Coded best = {.error = UINT_MAX};
    for (int many = 0; many < 2; many++) /* modes of one subset first, which may leave nothing to gain */
        for (int m = 0; m < UASTC_MODES; m++) {
            const int channels = uastc_modes[m].channels;
            if (m == UASTC_SOLID || (uastc_modes[m].subsets > 1) != (many == 1) || !best.error) continue;
            if (channels == 2 ? grey : channels == 3 ? opaque : !opaque) mode_try(ends, &sources[channels], m, &best);
        }
    coded_write(&best, block);
    hints_write(best.mode, block);
}
