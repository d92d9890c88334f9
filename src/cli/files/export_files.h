/* export_files.h - the files of an exported text: the text, and its tables beside it */
#pragma once

#include <stdbool.h>

#include "cli/console/json_writer.h"
#include "weft/export.h"

/* A text that was made, and where it goes. */
typedef struct ExportFiles {
    const WeftExport *made;
    WeftExportLut lut;
    const char *path, *command; /* of the text; what was typed, for the tables */
    bool quiet;
} ExportFiles;

/* Writes the tables under their names beside path; their paths go to json, or to standard error where that is
 * NULL. Returns 0, or an exit code after one line on standard error. */
int export_tables_write(const ExportFiles *files, Json *json);

/* Writes the text. Returns as export_tables_write. */
int export_text_write(const ExportFiles *files);
