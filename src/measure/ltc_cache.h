/* ltc_cache.h - LTC tables kept in the user's cache, one file a table
 *
 * A file is little-endian: "weft-ltc", the key (8 bytes), rows and columns (4 each), the planes as 32-bit
 * floats, and the hash of all that (8 bytes). */
#ifndef WEFT_MEASURE_LTC_CACHE_H
#define WEFT_MEASURE_LTC_CACHE_H

#include "measure/ltc_bake.h"

/* All that a table depends on: the lobe's text with the terms and tables it reads, its parameters, the text
 * of the transform, the descriptor, the version of the fitter. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult ltc_key(const WeftLtc *ltc, uint64_t *key, WeftError *error);

enum { LTC_HEAD = 8 + 8 + 4 + 4, LTC_TAIL = 8 };

/* Writes the hash of all that is before it into the last bytes of a file; size >= LTC_TAIL. */
void ltc_seal(unsigned char *data, size_t size);

/* Reads a file's bytes: rows, columns and texels of *out, which is to be freed; false where they are not such
 * a table with that key, and *out has no texels then. */
bool ltc_unpack(const unsigned char *data, size_t size, uint64_t key, WeftLtc *out);

/* Fills the texels if the cache has a table of that key and size; false if not. */
bool ltc_cache_read(WeftLtc *ltc, uint64_t key, const WeftLog *log);

void ltc_cache_write(const WeftLtc *ltc, uint64_t key, const WeftLog *log);

#endif
