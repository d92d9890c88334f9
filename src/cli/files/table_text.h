/* table_text.h - a table that is text: rows of numbers, or an array of a program */
#pragma once

#include <stdbool.h>

#include "weft/image.h"

/* Returns true for a suffix of such files: .csv .txt .tsv, or those of C, GLSL and HLSL. */
bool table_text_suffix(const char *path);

/* Reads the table, F32. Its size is that which the file names, in its brackets or as those that `weft bake` writes
 * do; else it is square, of more than one channel if `several`, or rows are lines of one channel, with a line on
 * standard error. Returns 0, or an exit code after one line. */
int table_text_read(const char *path, bool several, WeftImage *table);
