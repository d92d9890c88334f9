/* tables.h - the catalogue's own tables in a text: layers of weft_tables, and the functions that name them */
#pragma once

#include "shading/catalogue/albedo.h"
#include "text/assemble/text.h"

/* Writes the functions of shading/lobe/lobe_tables.h, in its place, for the tables that are made by now; baked ones
 * always are. text_lobe calls it if a lobe needs it. */
void text_lobe_tables(Text *text);

/* Defines a function without parameters that returns the table, which must outlive the text. */
void text_albedo_table(Text *text, const char *function, const char *name, const AlbedoTable *table);

/* Defines the function of shading/catalogue/engine_tables.h for those tables; any other is TABLE_NONE there, so E is 0.
 * Call it once in a text that has a profile. Making a table takes up to half a second the first time. */
void text_engine_tables(Text *text, const int *which, int count);
