/* little_endian.h - little-endian numbers in files */
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Returns count bytes, at most 8, as a number. */
static inline uint64_t little_endian(const unsigned char *bytes, size_t count) {
    uint64_t value = 0;
    for (size_t k = count; k-- > 0;) value = value << 8 | bytes[k];
    return value;
}

static inline double little_endian_double(const unsigned char *bytes) {
    uint64_t bits = little_endian(bytes, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline float little_endian_float(const unsigned char *bytes) {
    uint32_t bits = (uint32_t)little_endian(bytes, 4);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}
