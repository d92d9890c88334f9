/* wpo.h - the binary files of WeavePoint, as lines of WIF
 *
 * Facts, which no document of the maker states, are from Russell Owen's converter dtx_to_wif (2024). Numbers of two bytes
 * have the high one first; a set of shafts or treadles is as many bytes as it needs, the lowest first, and the first
 * member is the lowest bit.
 *
 *   1 byte each: 123, version, kind (100 lift plan, 101 one treadle a pick, 102 several), zoom, shafts, treadles, -, 0 if
 *       shafts rise, -, warp threads and picks per inch, -, -
 *   2 bytes each: warp threads, picks; 7 bytes -
 *   lists, of which the length is in 2 bytes: shaft of each warp thread; colours of warp and of weft, from 0
 *   kind 100: a list of sets of shafts; or else a set of shafts for each treadle without a length, then a list of the
 *       treadle, or the set of treadles, of each pick
 *   66 bytes -, then the number of colours in 1 byte, and r, g, b of each: 0 to 255, before version 4 to 63
 *
 * Thicknesses and single spacings of threads are elsewhere in the file, and are not read. */
#pragma once

#include <stdbool.h>

#include "weave/ini.h"

/* Returns true if the bytes are such a file, or its first ones. */
bool wpo_is(const void *data, size_t size);

/* Reads one into lines of WIF, whose numbers mean nothing. Fails with WEFT_MESSAGE_DRAFT for a file that is too short, and
 * as ini_read does. Release with ini_free in either case. */
WeftResult wpo_read(const void *data, size_t size, const char *name, Ini *out, WeftError *error);
