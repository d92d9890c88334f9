/* uastc.h - blocks of 4 x 4 texels in UASTC LDR, of 16 bytes each
 *
 * Binomial, "UASTC LDR 4x4 Texture Specification", 2025; Khronos, "Khronos Data Format Specification", version 1.3.1,
 * 2020, chapter 23 (ASTC: sections 23.12 to 23.20). */
#pragma once

#include <stdbool.h>
#include <stdint.h>

enum { UASTC_BYTES = 16, UASTC_MODES = 19, UASTC_SOLID = 8, UASTC_TEXELS = 16, UASTC_ENDPOINTS = 18 };

/* An end of a line of colours has bits, and may have a digit to base 3 or to base 5 beside them. */
typedef enum UastcDigit { UASTC_BITS, UASTC_TRITS, UASTC_QUINTS } UastcDigit;

/* The numbers of a block of one mode, in the order of their bits: the mode, hints for other formats, which channel has
 * the second weights or which texel is in which subset, digits of the endpoints, their bits, weights. */
typedef struct UastcMode {
    uint8_t code, code_bits;
    uint8_t start;           /* bits of mode and hints */
    uint8_t selector_bits;   /* of the channel with the second weights, where any of them may have it */
    uint8_t pattern_bits;    /* of the number of the pattern of subsets */
    UastcDigit digit;        /* of each endpoint */
    uint8_t endpoint_bits;   /* of each endpoint */
    uint8_t weight_bits;     /* of each weight but an anchor's, whose highest bit is 0 and left out */
    uint8_t subsets, planes; /* planes 2: one channel has weights of its own */
    uint8_t channels;        /* 2: luminance and alpha */
} UastcMode;

extern const UastcMode uastc_modes[UASTC_MODES];

/* Returns how many patterns there are of a mode's subsets, and the subset of a texel in one of them. */
int uastc_patterns(int mode);
int uastc_subset(int mode, int pattern, int texel);

/* Returns the 8 bit value of an endpoint of this digit and these bits. */
unsigned uastc_endpoint(const UastcMode *mode, unsigned digit, unsigned bits);

/* Returns the share of the second endpoint, of 64, that a weight of so many bits stands for. */
unsigned uastc_weight(int bits, unsigned weight);

/* Returns the value at a share of 64 between two endpoints. */
unsigned uastc_between(unsigned low, unsigned high, unsigned share);

/* Returns the bits that count digits take: 5 of base 3 in 8, 3 of base 5 in 7, the rest in as few as they need. */
int uastc_digit_bits(UastcDigit digit, int count);

/* Decodes a block to texels of red, green, blue and alpha, row by row. Returns false if the block has a mode or a
 * pattern that does not exist. */
bool uastc_decode(const unsigned char block[UASTC_BYTES], uint8_t texels[UASTC_TEXELS][4]);
