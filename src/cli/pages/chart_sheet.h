/* chart_sheet.h - the reference materials as a picture */
#ifndef WEFT_CLI_CHART_SHEET_H
#define WEFT_CLI_CHART_SHEET_H

/* Writes a swatch of each to path. Returns 0, or an exit code after one line on standard error. */
int chart_sheet_write(const char *path);

#endif
