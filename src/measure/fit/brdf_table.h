/* brdf_table.h - measured reflectance as lines of numbers (weft/fit.h has the format) */
#pragma once

#include <stddef.h>

#include "weft/result.h"

/* The wo, wi and f of each line. f is -1 in all channels if one of its numbers is negative. */
typedef struct BrdfTable {
    int count;
    float (*wo)[3], (*wi)[3], (*f)[3];
} BrdfTable;

enum { BRDF_TABLE_ROWS = 1000000 };

/* Reads a table. Fails with WEFT_MESSAGE_BRDF_TABLE or _MEMORY; release with brdf_table_free in any case. */
WeftResult brdf_table_read(const char *text, size_t size, const char *name, BrdfTable *out, WeftError *error);
void brdf_table_free(BrdfTable *table);
