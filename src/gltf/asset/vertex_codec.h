/* vertex_codec.h - version 1 of meshoptimizer's vertex codec, which libmeshoptimizer has from 0.23 on
 *
 * Khronos Group, KHR_meshopt_compression, draft of 2026, appendix A, "Mode 0: attributes". */
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum { VERTEX_CODEC_1 = 0xa1 }; /* the first byte of such data */

/* Decodes `count` elements of `stride` bytes, 4 to 256 and a multiple of 4, into out. Returns false if the data are
 * damaged: out then has any bytes. */
bool vertex_decode(const unsigned char *data, size_t size, size_t count, size_t stride, unsigned char *out);
