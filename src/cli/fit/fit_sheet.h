/* fit_sheet.h - slices of a measured BRDF beside those of fits */
#pragma once

#include "weft/weft.h"

/* Writes a .png: in rows phi_d 90 and 0 degrees, in columns the data, read from path, the best fit and the
 * baseline, and how these differ. Of a table of samples, which has gaps, a slice has those within 45 degrees of
 * phi_d, in cells of 3 degrees. Returns 0, or an exit code after one line on standard error. */
int fit_sheet_write(const char *path, const WeftData *data, const WeftFit *fit, const char *output);
