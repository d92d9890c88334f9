#include "image/ktx2/uastc_etc1.h"

#include <limits.h>
#include <stdlib.h>

/* Khronos, "Data Format Specification", version 1.3.1, 2020, table 96, has the steps of a row of intensities, from selector 0. */
static const int steps[8][4] = {{-8, -2, 2, 8},     {-17, -5, 5, 17},   {-29, -9, 9, 29},     {-42, -13, 13, 42},
                                {-60, -18, 18, 60}, {-80, -24, 24, 80}, {-106, -33, 33, 106}, {-183, -47, 47, 183}};

static int clamped(int value, int low, int high) { return value < low ? low : value > high ? high : value; }

/* Returns the 8 bits that a base of 4 or 5 bits stands for. */
static int base_value(int base, unsigned differential) { return differential ? base << 3 | base >> 2 : base * 17; }

/* Returns the texel number k of a half. */
static int half_texel(unsigned flip, int half, int k) { return flip ? 8 * half + k : k / 2 * 4 + 2 * half + k % 2; }

/* Finds the base of each half: the nearest to the mean; that of the second within -4 .. 3 of the first where it is kept
 * as a difference. */
static void bases_find(uint8_t texels[UASTC_TEXELS][4], unsigned flip, unsigned differential, int bases[2][3]) {
    const int most = differential ? 31 : 15;
    for (int half = 0; half < 2; half++)
        for (int c = 0; c < 3; c++) {
            int sum = 0;
            for (int k = 0; k < 8; k++) sum += texels[half_texel(flip, half, k)][c];
            bases[half][c] = (sum * most + 1020) / 2040;
        }
    for (int c = 0; c < 3 && differential; c++) bases[1][c] = bases[0][c] + clamped(bases[1][c] - bases[0][c], -4, 3);
}

/* Returns the squares of the errors of a half with a row of intensities. */
static int half_error(uint8_t texels[UASTC_TEXELS][4], unsigned flip, int half, const int base[3], const int row[4]) {
    int sum = 0;
    for (int k = 0; k < 8; k++) {
        const uint8_t *texel = texels[half_texel(flip, half, k)];
        int best = INT_MAX;
        for (int s = 0; s < 4; s++) {
            int error = 0;
            for (int c = 0; c < 3; c++) {
                const int d = clamped(base[c] + row[s], 0, 255) - texel[c];
                error += d * d;
            }
            if (error < best) best = error;
        }
        sum += best;
    }
    return sum;
}

/* Finds the best rows of intensities for a cut and a kind of bases. Returns the squares of the errors. */
static int rows_find(uint8_t texels[UASTC_TEXELS][4], UastcEtc1 *hint) {
    int bases[2][3], sum = 0;
    bases_find(texels, hint->flip, hint->differential, bases);
    for (int half = 0; half < 2; half++) {
        int value[3], best = INT_MAX;
        for (int c = 0; c < 3; c++) value[c] = base_value(bases[half][c], hint->differential);
        for (unsigned i = 0; i < 8; i++) {
            const int error = half_error(texels, hint->flip, half, value, steps[i]);
            if (error >= best) continue;
            best = error;
            hint->intensity[half] = i;
        }
        sum += best;
    }
    return sum;
}

UastcEtc1 uastc_etc1_find(uint8_t texels[UASTC_TEXELS][4]) {
    UastcEtc1 found = {0};
    int best = INT_MAX;
    for (unsigned k = 0; k < 4; k++) {
        UastcEtc1 hint = {.flip = k & 1, .differential = k >> 1};
        const int error = rows_find(texels, &hint);
        if (error >= best) continue;
        best = error;
        found = hint;
    }
    return found;
}

/* The modifiers of alpha are in the same text, section 21.3, table 102. */
static const int modifiers[16][8] = {
    {-3, -6, -9, -15, 2, 5, 8, 14}, {-3, -7, -10, -13, 2, 6, 9, 12}, {-2, -5, -8, -13, 1, 4, 7, 12},
    {-2, -4, -6, -13, 1, 3, 5, 12}, {-3, -6, -8, -12, 2, 5, 7, 11},  {-3, -7, -9, -11, 2, 6, 8, 10},
    {-4, -7, -8, -11, 3, 6, 7, 10}, {-3, -5, -8, -11, 2, 4, 7, 10},  {-2, -6, -8, -10, 1, 5, 7, 9},
    {-2, -5, -8, -10, 1, 4, 7, 9},  {-2, -4, -8, -10, 1, 3, 7, 9},   {-2, -5, -7, -10, 1, 4, 6, 9},
    {-3, -4, -7, -10, 2, 3, 6, 9},  {-1, -2, -3, -10, 0, 1, 2, 9},   {-4, -6, -8, -9, 3, 5, 7, 8},
    {-3, -5, -7, -9, 2, 4, 6, 8},
};
enum { LEAST_MODIFIER = 3, GREATEST_MODIFIER = 7 };

/* Returns the squares of the errors of alpha with modifiers times a multiplier, around the base that puts the outermost
 * of them at the least and the greatest alpha. */
static int alpha_error(uint8_t texels[UASTC_TEXELS][4], int low, int high, const int row[8], int multiplier) {
    const int range = row[GREATEST_MODIFIER] - row[LEAST_MODIFIER];
    const int base = low + ((high - low) * -row[LEAST_MODIFIER] + range / 2) / range;
    int sum = 0;
    for (int t = 0; t < UASTC_TEXELS; t++) {
        int best = INT_MAX;
        for (int s = 0; s < 8; s++) {
            const int d = clamped(base + row[s] * multiplier, 0, 255) - texels[t][3];
            if (d * d < best) best = d * d;
        }
        sum += best;
    }
    return sum;
}

unsigned uastc_etc2_alpha(uint8_t texels[UASTC_TEXELS][4]) {
    int low = 255, high = 0, best = INT_MAX;
    unsigned found = 0;
    for (int t = 0; t < UASTC_TEXELS; t++) {
        low = texels[t][3] < low ? texels[t][3] : low;
        high = texels[t][3] > high ? texels[t][3] : high;
    }
    for (int r = 0; r < 16; r++) {
        const int fitting = (high - low) / (modifiers[r][GREATEST_MODIFIER] - modifiers[r][LEAST_MODIFIER]);
        for (int multiplier = clamped(fitting, 1, 15); multiplier <= clamped(fitting + 1, 1, 15); multiplier++) {
            const int error = alpha_error(texels, low, high, modifiers[r], multiplier);
            if (error >= best) continue;
            best = error;
            found = (unsigned)(r | multiplier << 4);
        }
    }
    return found;
}

UastcEtc1Solid uastc_etc1_solid(const uint8_t color[4]) {
    UastcEtc1Solid found = {0};
    int best = INT_MAX;
    for (unsigned k = 0; k < 64; k++) {
        UastcEtc1Solid solid = {.differential = k >> 5, .intensity = k >> 2 & 7, .selector = k & 3};
        const int most = solid.differential ? 31 : 15, step = steps[solid.intensity][solid.selector];
        int error = 0;
        for (int c = 0; c < 3; c++) {
            const int base = (clamped(color[c] - step, 0, 255) * most + 127) / 255;
            const int d = clamped(base_value(base, solid.differential) + step, 0, 255) - color[c];
            solid.base[c] = (unsigned)base;
            error += d * d;
        }
        if (error >= best) continue;
        best = error;
        found = solid;
    }
    return found;
}
