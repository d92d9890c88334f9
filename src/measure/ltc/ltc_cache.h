/* ltc_cache.h - LTC tables kept in the user's cache, one file a table: the planes as floats */
#pragma once

#include "measure/ltc/ltc_bake.h"

/* Hashes all that a table depends on: the text of the lobe with the terms and tables that it reads, its parameters, the
 * text of the transform, the descriptor, the version of the fitter. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult ltc_key(const WeftLtc *ltc, uint64_t *key, WeftError *error);

/* Returns true if the texels meet the conditions of ltc_table.h for lookups. */
bool ltc_is_sound(const WeftLtc *ltc);

/* Fills the texels and returns true if the cache has a sound table of that key and size. */
bool ltc_cache_read(WeftLtc *ltc, uint64_t key, const WeftLog *log);

void ltc_cache_write(const WeftLtc *ltc, uint64_t key, const WeftLog *log);
