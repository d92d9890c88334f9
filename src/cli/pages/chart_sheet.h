/* chart_sheet.h - the reference materials as a picture */
#pragma once

/* Writes a swatch of each to path. Returns 0, or an exit code after one line on standard error. */
int chart_sheet_write(const char *path);
