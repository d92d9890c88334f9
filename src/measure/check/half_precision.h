/* half_precision.h - lobes evaluated in half precision */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* Returns true if the compiler that built this has half floats; otherwise half_eval returns 0. */
bool half_here(void);

/* A table of shading/lobe/table.h. */
typedef struct HalfTable {
    const float *texels;
    int kind, rows, columns;
    float low, high;
} HalfTable;

/* Sets the tables that lobes read, in the order of lobe_table_refs. Call it before the first half_eval of a
 * lobe with WEFT_LOBE_TABLE, and not while one runs. */
void half_tables(const HalfTable *tables, int count);

/* Evaluates f of a white lobe without WEFT_LOBE_REFERENCE, in 1/sr, for n pairs of directions; all values are
 * rounded to half first. The horizon is not tested: a cosine of 0 reaches the lobe. */
void half_eval(int lobe, const float *params, size_t n, const float *ox, const float *oy, const float *oz,
               const float *ix, const float *iy, const float *iz, float *f);
