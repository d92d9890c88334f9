/* huffman.h - canonical Huffman codes as BasisLZ stores them
 *
 * Khronos, "KTX File Format Specification", version 2.0.4, 2024, annex "BasisLZ/ETC1S Bitstream Specification",
 * "Compressed Huffman Tables"; Deutsch, RFC 1951, 1996, section 3.2.2, for the codes that lengths stand for. */
#pragma once

#include "image/ktx2/bits.h"

enum { HUFFMAN_SYMBOLS = 16384, HUFFMAN_LONGEST = 16, HUFFMAN_NONE = -1 };

/* The symbols in the order of their codes: all of length 1, then all of length 2 ... */
typedef struct Huffman {
    uint16_t count[HUFFMAN_LONGEST + 1]; /* symbols of each length */
    uint16_t symbols[HUFFMAN_SYMBOLS];
} Huffman;

/* Reads a table. Returns false if it is damaged: its lengths are no code, or do not add up. An empty one is no damage. */
bool huffman_read(Bits *bits, Huffman *out);

/* Returns the next symbol, or HUFFMAN_NONE where the bits are no code. */
int huffman_take(Bits *bits, const Huffman *table);
