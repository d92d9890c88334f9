#include "gltf/asset/vertex_codec.h"

#include <stdint.h>
#include <string.h>

#include "base/little_endian.h"

enum { GROUP = 16, BLOCK_MOST = 256, BLOCK_BYTES = 8192, STRIDE_MOST = 256, TAIL_LEAST = 24 };
enum { CONTROL_SHORT, CONTROL_LONG, CONTROL_ZEROS, CONTROL_LITERAL };
enum { CHANNEL_BYTES, CHANNEL_WORDS, CHANNEL_BITS };

/* The bytes that are left before the tail. */
typedef struct VertexCodes {
    const unsigned char *at;
    size_t left;
} VertexCodes;

/* Returns the next bytes, NULL if there are not as many. */
static const unsigned char *take(VertexCodes *codes, size_t count) {
    const unsigned char *at = codes->at;
    if (count > codes->left) return NULL;
    codes->at += count;
    codes->left -= count;
    return at;
}

/* Reads a group of 16 deltas of so many bits: one that is all ones stands for a byte behind them. */
static bool group_read(VertexCodes *codes, int bits, uint8_t deltas[GROUP]) {
    const unsigned char *packed = take(codes, 2 * (size_t)bits);
    const int ones = (1 << bits) - 1, a_byte = bits ? 8 / bits : 8;
    if (!packed) return false;
    for (int k = 0; k < GROUP; k++) {
        const int place = k % a_byte * bits, shift = bits == 1 ? place : 8 - bits - place;
        deltas[k] = bits ? (uint8_t)(packed[k / a_byte] >> shift & ones) : 0;
        if (!bits || bits == 8 || deltas[k] != ones) continue;
        const unsigned char *byte = take(codes, 1);
        if (!byte) return false;
        deltas[k] = *byte;
    }
    return true;
}

/* Reads the deltas of one byte of all elements of a block; room: for whole groups. */
static bool deltas_read(VertexCodes *codes, int control, size_t count, uint8_t *deltas) {
    static const int lengths[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
    const size_t groups = (count + GROUP - 1) / GROUP;
    if (control == CONTROL_ZEROS || control == CONTROL_LITERAL) {
        const unsigned char *literal = take(codes, control == CONTROL_ZEROS ? 0 : count);
        if (literal && control == CONTROL_LITERAL) memcpy(deltas, literal, count);
        if (control == CONTROL_ZEROS) memset(deltas, 0, count);
        return literal != NULL;
    }
    const unsigned char *header = take(codes, (groups + 3) / 4);
    if (!header) return false;
    for (size_t g = 0; g < groups; g++)
        if (!group_read(codes, lengths[control][header[g / 4] >> 2 * (g % 4) & 3], deltas + GROUP * g)) return false;
    return true;
}

static uint32_t unzigzag(uint32_t v) { return v & 1 ? ~(v >> 1) : v >> 1; }

/* Adds the deltas of four bytes to the element before: bytes, words of 16 bits, or bits, which the encoder has rotated to the
 * left. Returns false where mode is none of these. */
static bool channel_add(int mode, const uint8_t *const deltas[4], size_t k, const unsigned char last[4],
                        unsigned char out[4]) {
    const int kind = mode & 15, rotation = mode >> 4;
    if (kind > CHANNEL_BITS || (kind != CHANNEL_BITS && rotation)) return false;
    const uint8_t bytes[4] = {deltas[0][k], deltas[1][k], deltas[2][k], deltas[3][k]};
    if (kind == CHANNEL_BITS) {
        const uint32_t v = (uint32_t)little_endian(bytes, 4);
        const uint32_t bits = (uint32_t)little_endian(last, 4) ^ (v >> rotation | v << ((32 - rotation) & 31));
        for (int b = 0; b < 4; b++) out[b] = (unsigned char)(bits >> 8 * b & 255);
        return true;
    }
    const int width = kind == CHANNEL_WORDS ? 2 : 1;
    for (int b = 0; b < 4; b += width) {
        const uint32_t sum = (uint32_t)little_endian(last + b, (size_t)width) +
                             unzigzag((uint32_t)little_endian(bytes + b, (size_t)width));
        for (int c = 0; c < width; c++) out[b + c] = (unsigned char)(sum >> 8 * c & 255);
    }
    return true;
}

/* Decodes a block. last: the element before it, which becomes its last. */
static bool block_decode(VertexCodes *codes, const unsigned char *modes, size_t count, size_t stride,
                         unsigned char *last, unsigned char *out) {
    const unsigned char *controls = take(codes, stride / 4);
    uint8_t deltas[4][BLOCK_MOST];
    const uint8_t *const of_channel[4] = {deltas[0], deltas[1], deltas[2], deltas[3]};
    if (!controls) return false;
    for (size_t c = 0; c < stride / 4; c++) {
        for (int b = 0; b < 4; b++)
            if (!deltas_read(codes, controls[c] >> 2 * b & 3, count, deltas[b])) return false;
        for (size_t k = 0; k < count; k++) {
            unsigned char *to = out + k * stride + 4 * c;
            if (!channel_add(modes[c], of_channel, k, last + 4 * c, to)) return false;
            memcpy(last + 4 * c, to, 4);
        }
    }
    return true;
}

bool vertex_decode(const unsigned char *data, size_t size, size_t count, size_t stride, unsigned char *out) {
    const size_t ends = stride + stride / 4, tail = ends < TAIL_LEAST ? TAIL_LEAST : ends;
    const size_t whole = BLOCK_BYTES / stride / GROUP * GROUP, most = whole < BLOCK_MOST ? whole : BLOCK_MOST;
    unsigned char last[STRIDE_MOST];
    if (size < 1 + tail || data[0] != VERTEX_CODEC_1) return false;
    VertexCodes codes = {data + 1, size - 1 - tail};
    const unsigned char *modes = data + size - stride / 4;
    memcpy(last, data + size - ends, stride);
    for (size_t at = 0; at < count;) {
        const size_t n = count - at < most ? count - at : most;
        if (!block_decode(&codes, modes, n, stride, last, out + at * stride)) return false;
        at += n;
    }
    return codes.left == 0;
}
