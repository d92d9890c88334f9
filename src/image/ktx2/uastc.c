#include "image/ktx2/uastc.h"

#include "image/ktx2/bits.h"

const UastcMode uastc_modes[UASTC_MODES] = {
    {1, 4, 19, 0, 0, UASTC_TRITS, 6, 4, 1, 1, 3},   {53, 6, 21, 0, 0, UASTC_BITS, 8, 2, 1, 1, 3},
    {29, 5, 20, 0, 5, UASTC_BITS, 4, 3, 2, 1, 3},   {3, 5, 20, 0, 4, UASTC_TRITS, 2, 2, 3, 1, 3},
    {19, 5, 20, 0, 5, UASTC_QUINTS, 3, 2, 2, 1, 3}, {11, 5, 20, 0, 0, UASTC_BITS, 8, 3, 1, 1, 3},
    {27, 5, 20, 2, 0, UASTC_QUINTS, 5, 2, 1, 2, 3}, {7, 5, 20, 0, 5, UASTC_QUINTS, 3, 2, 2, 1, 3},
    {23, 5, 5, 0, 0, UASTC_BITS, 8, 0, 0, 0, 4},    {15, 5, 28, 0, 5, UASTC_BITS, 4, 2, 2, 1, 4},
    {2, 3, 20, 0, 0, UASTC_TRITS, 4, 4, 1, 1, 4},   {0, 2, 19, 2, 0, UASTC_TRITS, 4, 2, 1, 2, 4},
    {6, 3, 20, 0, 0, UASTC_TRITS, 6, 3, 1, 1, 4},   {31, 5, 28, 2, 0, UASTC_BITS, 8, 1, 1, 2, 4},
    {13, 5, 28, 0, 0, UASTC_BITS, 8, 2, 1, 1, 4},   {5, 7, 30, 0, 0, UASTC_BITS, 8, 4, 1, 1, 2},
    {21, 6, 29, 0, 5, UASTC_BITS, 8, 2, 2, 1, 2},   {37, 6, 29, 0, 0, UASTC_BITS, 8, 2, 1, 2, 2},
    {9, 4, 19, 0, 0, UASTC_BITS, 5, 5, 1, 1, 3},
};

/* Bit k of a pattern is set if texel k is in the second subset. */
enum { PAIRS = 30, MERGED = 19, TRIPLES = 11 };
static const uint16_t pairs[PAIRS] = {
    0xcccc, 0x8888, 0x1111, 0xecc8, 0x377f, 0xfeec, 0x0137, 0x137f, 0xc800, 0x0013,
    0xfe80, 0x17ff, 0x0017, 0x00ff, 0xfff0, 0x0fff, 0xff71, 0x8eff, 0x08ce, 0x008c,
    0x7310, 0xceff, 0x7331, 0x088c, 0xceef, 0x6666, 0xf00f, 0x5555, 0x0f0f, 0x36c9,
};
/* Those of mode 7 are patterns of three subsets in BC7, of which two are one here. */
static const uint16_t merged[MERGED] = {
    0x00f0, 0x4444, 0x0133, 0xcc80, 0xf0ff, 0x2222, 0xffc8, 0xccce, 0x3c03, 0x00ee,
    0x7700, 0x3003, 0x00ce, 0xff80, 0x6fff, 0x1333, 0x11ff, 0x136c, 0x00ef,
};
/* The texels of the second subset, and those of the third. */
static const uint16_t triples[TRIPLES][2] = {
    {0x3300, 0xcc00}, {0x00ff, 0xf000}, {0x000f, 0xf000}, {0x000f, 0x00f0}, {0x3333, 0x4444}, {0x6666, 0x8888},
    {0xcccc, 0x2222}, {0xee00, 0x1111}, {0x4444, 0x9999}, {0xf00f, 0x0f00}, {0x0cc0, 0xc00c},
};

int uastc_patterns(int mode) {
    const int subsets = uastc_modes[mode].subsets;
    return subsets == 3 ? TRIPLES : subsets < 2 ? 1 : mode == 7 ? MERGED : PAIRS;
}

int uastc_subset(int mode, int pattern, int texel) {
    const int subsets = uastc_modes[mode].subsets;
    if (subsets < 2) return 0;
    if (subsets == 3) return (triples[pattern][0] >> texel & 1) + 2 * (triples[pattern][1] >> texel & 1);
    return (mode == 7 ? merged : pairs)[pattern] >> texel & 1;
}

/* Returns an endpoint whose digit counts for factor, and whose bits but the lowest are spread over 9 bits; the lowest
 * inverts the result. */
static unsigned endpoint_spread(unsigned digit, unsigned factor, unsigned spread, unsigned bits) {
    const unsigned inverse = bits & 1 ? 0x1ff : 0;
    return (inverse & 0x80) | ((digit * factor + spread) ^ inverse) >> 2;
}

unsigned uastc_endpoint(const UastcMode *mode, unsigned digit, unsigned bits) {
    const unsigned high = bits >> 1;
    if (mode->digit == UASTC_TRITS) switch (mode->endpoint_bits) {
        case 2: return endpoint_spread(digit, 93, high * 0x116, bits);
        case 4: return endpoint_spread(digit, 22, high << 6 | high, bits);
        default: return endpoint_spread(digit, 5, high << 4 | high >> 4, bits);
        }
    if (mode->digit == UASTC_QUINTS)
        return mode->endpoint_bits == 3 ? endpoint_spread(digit, 26, high << 7 | high << 1 | high >> 1, bits)
                                        : endpoint_spread(digit, 6, high << 5 | high >> 3, bits);
    return mode->endpoint_bits == 8   ? bits
           : mode->endpoint_bits == 5 ? bits << 3 | bits >> 2
                                      : bits << 4 | bits; /* of 4 bits */
}

unsigned uastc_weight(int bits, unsigned weight) {
    static const unsigned repeated[6] = {0, 63, 21, 9, 0, 0}; /* a weight of 1, 2 or 3 bits fills 6 bits by itself */
    const unsigned six = bits == 4   ? weight << 2 | weight >> 2
                         : bits == 5 ? weight << 1 | weight >> 4
                                     : weight * repeated[bits];
    return six > 32 ? six + 1 : six;
}

unsigned uastc_between(unsigned low, unsigned high, unsigned share) {
    return (low * 257 * (64 - share) + high * 257 * share + 32) >> 14;
}

int uastc_digit_bits(UastcDigit digit, int count) {
    static const int trits[] = {0, 2, 4, 5, 7}, quints[] = {0, 3, 5};
    if (digit == UASTC_TRITS) return count / 5 * 8 + trits[count % 5];
    return digit == UASTC_QUINTS ? count / 3 * 7 + quints[count % 3] : 0;
}

/* Reads the digits of count endpoints. */
static void digits_take(Bits *bits, UastcDigit digit, int count, unsigned *digits) {
    const int group = digit == UASTC_TRITS ? 5 : 3;
    const unsigned base = digit == UASTC_TRITS ? 3 : 5;
    for (int first = 0; first < count; first += group) {
        const int here = count - first < group ? count - first : group;
        uint32_t number = bits_take(bits, uastc_digit_bits(digit, here));
        for (int k = 0; k < here; k++, number /= base) digits[first + k] = number % base;
    }
}

static void endpoints_take(Bits *bits, const UastcMode *mode, unsigned ends[UASTC_ENDPOINTS]) {
    const int count = 2 * mode->channels * mode->subsets;
    unsigned digits[UASTC_ENDPOINTS] = {0};
    if (mode->digit != UASTC_BITS) digits_take(bits, mode->digit, count, digits);
    for (int k = 0; k < count; k++) ends[k] = uastc_endpoint(mode, digits[k], bits_take(bits, mode->endpoint_bits));
}

/* Reads the shares of both planes; the first texel of each subset is its anchor. */
static void shares_take(Bits *bits, const UastcMode *mode, const int subset[UASTC_TEXELS],
                        unsigned shares[UASTC_TEXELS][2]) {
    bool anchored[3] = {false};
    for (int t = 0; t < UASTC_TEXELS; t++) {
        const int count = mode->weight_bits - (anchored[subset[t]] ? 0 : 1);
        anchored[subset[t]] = true;
        for (int p = 0; p < mode->planes; p++) shares[t][p] = uastc_weight(mode->weight_bits, bits_take(bits, count));
    }
}

static void solid_put(Bits *bits, uint8_t texels[UASTC_TEXELS][4]) {
    for (int c = 0; c < 4; c++) {
        const uint8_t value = (uint8_t)bits_take(bits, 8);
        for (int t = 0; t < UASTC_TEXELS; t++) texels[t][c] = value;
    }
}

/* Fills a texel from the endpoints of its subset: luminance and alpha, or three or four channels. */
static void texel_put(const UastcMode *mode, const unsigned *ends, const unsigned shares[2], int second,
                      uint8_t *texel) {
    for (int c = 0; c < 4; c++) {
        const int from = mode->channels == 2 ? c == 3 : c;
        texel[c] = from == mode->channels
                       ? 255
                       : (uint8_t)uastc_between(ends[2 * from], ends[2 * from + 1], shares[from == second]);
    }
}

bool uastc_decode(const unsigned char block[UASTC_BYTES], uint8_t texels[UASTC_TEXELS][4]) {
    int m = 0;
    while (m < UASTC_MODES && (block[0] & ((1 << uastc_modes[m].code_bits) - 1)) != uastc_modes[m].code) m++;
    if (m == UASTC_MODES) return false;
    const UastcMode *mode = &uastc_modes[m];
    Bits bits = {.data = block, .size = UASTC_BYTES, .at = mode->start};
    if (m == UASTC_SOLID) {
        solid_put(&bits, texels);
        return true;
    }
    const int selector = (int)bits_take(&bits, mode->selector_bits),
              pattern = (int)bits_take(&bits, mode->pattern_bits);
    if (pattern >= uastc_patterns(m)) return false;
    const int second = mode->planes == 1 ? -1 : mode->selector_bits ? selector : 1;
    unsigned ends[UASTC_ENDPOINTS], shares[UASTC_TEXELS][2] = {{0}};
    int subset[UASTC_TEXELS];
    for (int t = 0; t < UASTC_TEXELS; t++) subset[t] = uastc_subset(m, pattern, t);
    endpoints_take(&bits, mode, ends);
    shares_take(&bits, mode, subset, shares);
    for (int t = 0; t < UASTC_TEXELS; t++)
        texel_put(mode, ends + 2 * mode->channels * subset[t], shares[t], second, texels[t]);
    return true;
}
