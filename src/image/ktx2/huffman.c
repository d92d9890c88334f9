#include "image/ktx2/huffman.h"

#include <string.h>

/* Makes a table of the length of each symbol's code, 0 for a symbol without. Returns false unless the codes are all that
 * there are of their lengths; a single symbol may have a code of any. */
static bool huffman_make(const uint8_t *lengths, int count, Huffman *out) {
    uint32_t place[HUFFMAN_LONGEST + 2] = {0}, room = 1, used = 0;
    memset(out->count, 0, sizeof out->count);
    for (int k = 0; k < count; k++) out->count[lengths[k]]++;
    out->count[0] = 0;
    for (int n = 1; n <= HUFFMAN_LONGEST; n++) {
        if (out->count[n] > 2 * room) return false;
        room = 2 * room - out->count[n];
        used += out->count[n];
        place[n + 1] = used;
    }
    for (int k = 0; k < count; k++)
        if (lengths[k]) out->symbols[place[lengths[k]]++] = (uint16_t)k;
    return room == 0 || used <= 1;
}

int huffman_take(Bits *bits, const Huffman *table) {
    uint32_t code = 0, first = 0, passed = 0;
    for (int n = 1; n <= HUFFMAN_LONGEST; n++) {
        code = code << 1 | bits_take(bits, 1);
        first <<= 1;
        if (code - first < table->count[n]) return table->symbols[passed + code - first];
        first += table->count[n];
        passed += table->count[n];
    }
    return HUFFMAN_NONE;
}

/* The runs that the symbols from 17 on stand for: bits of the length, the least length, whether the last code length is
 * repeated and not 0. */
static const struct {
    int bits, least;
    bool last;
} runs[] = {{3, 3, false}, {7, 11, false}, {2, 3, true}, {7, 7, true}};
enum { FIRST_RUN = HUFFMAN_LONGEST + 1, LENGTH_SYMBOLS = 21 };

/* Reads the code lengths of count symbols by the table of lengths. */
static bool lengths_take(Bits *bits, const Huffman *table, uint8_t *lengths, int count) {
    int at = 0;
    while (at < count) {
        const int symbol = huffman_take(bits, table);
        if (symbol == HUFFMAN_NONE) return false;
        if (symbol < FIRST_RUN) {
            lengths[at++] = (uint8_t)symbol;
            continue;
        }
        const int r = symbol - FIRST_RUN, run = (int)bits_take(bits, runs[r].bits) + runs[r].least;
        if (run > count - at) return false;
        const uint8_t length = runs[r].last && at ? lengths[at - 1] : 0;
        if (runs[r].last && !length) return false;
        memset(lengths + at, length, (size_t)run);
        at += run;
    }
    return true;
}

bool huffman_read(Bits *bits, Huffman *out) {
    static const uint8_t order[LENGTH_SYMBOLS] = {17, 18, 19, 20, 0,  8, 7,  9, 6,  10, 5,
                                                  11, 4,  12, 3,  13, 2, 14, 1, 15, 16};
    uint8_t lengths[HUFFMAN_SYMBOLS] = {0}, of_lengths[LENGTH_SYMBOLS] = {0};
    const int count = (int)bits_take(bits, 14);
    memset(out->count, 0, sizeof out->count);
    if (!count) return true;
    const int given = (int)bits_take(bits, 5);
    if (given < 1 || given > LENGTH_SYMBOLS) return false;
    for (int k = 0; k < given; k++) of_lengths[order[k]] = (uint8_t)bits_take(bits, 3);
    /* The table of lengths is made where the table itself will be. */
    return huffman_make(of_lengths, LENGTH_SYMBOLS, out) && lengths_take(bits, out, lengths, count) &&
           huffman_make(lengths, count, out) && !bits_overrun(bits);
}
