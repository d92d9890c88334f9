/* dtx.h - the text files of Fiberworks, as lines of WIF
 *
 * A file begins with @@StartDTX. A line "@@Name" begins a section, "%%key value" states a number or a flag of it, and
 * the rest is its data. Facts, which no document of the maker states, are from Russell Owen's converter dtx_to_wif (2024)
 * and the drafts that Fiberworks saved in both formats beside it:
 *
 *   Description   the title
 *   Info          shafts, treadles, ends and picks
 *   Threading     the shaft of each warp thread
 *   Tieup         a row of 0 and 1 for each shaft, shaft 1 in the last one; a column for each treadle
 *   Treadling     the treadle of each pick, or "1,3" for several
 *   Liftplan      a row of 0 and 1 for each pick; a column for each shaft
 *   Color Palet   r,g,b of 0 to 255
 *   Warp Colors   the colour of each thread, from 0; Weft Colors alike
 *   Warp Spacing  of each thread, in steps of 0.053 cm, of which 4 are the default; Weft Spacing alike
 *
 * "%%sinking" or "%%%%sinking" in the tie-up or the lift plan says that its shafts sink. */
#pragma once

#include <stdbool.h>

#include "weave/ini.h"

/* Returns true if the bytes are such a file. */
bool dtx_is(const void *data, size_t size);

/* Reads one into lines of WIF with the line numbers of the file; what is not known there is a warning. Fails as ini_read
 * does. Release with ini_free in either case. */
WeftResult dtx_read(const void *data, size_t size, const char *name, const WeftLog *log, Ini *out, WeftError *error);
