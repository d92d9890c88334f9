/* two_columns.h - text for people: entries in two columns, wrapped at 80 */
#pragma once

#include <stdio.h>

/* Writes "  name", then text wrapped into the column that starts at `column`; a name that reaches into that
 * column stands on a line of its own. */
void layout_entry(FILE *stream, int column, const char *name, const char *text);
