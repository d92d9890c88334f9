/* bits.h - numbers of any count of bits, the first bit of a number in the lowest free bit of a byte */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bits to read. What lies behind the end reads as 0. */
typedef struct Bits {
    const unsigned char *data;
    size_t size; /* bytes */
    size_t at;   /* bits that were taken */
} Bits;

/* Returns the next count bits, 0 to 24, as a number. */
static inline uint32_t bits_take(Bits *bits, int count) {
    const size_t byte = bits->at >> 3;
    uint32_t word = 0;
    for (size_t k = 0; k < 4 && byte + k < bits->size; k++) word |= (uint32_t)bits->data[byte + k] << 8 * k;
    word = word >> (bits->at & 7) & ((1u << count) - 1u);
    bits->at += (size_t)count;
    return word;
}

/* Returns true if more bits were taken than there are. */
static inline bool bits_overrun(const Bits *bits) { return bits->at > 8 * bits->size; }
