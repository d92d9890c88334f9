/* fitted_table.h - the functions A, h, g and k of shading/lobes/fibre_table.h at the nodes of a small table
 *
 * The fibres are white and upright, of density 1. Columns are uniform in the root of mu + 0.001, rows in the logarithm
 * of alpha. Between nodes all four are interpolated linearly, and the fit accounts for that. It starts from
 * shading/media/fibre_model.h, which has to be baked before. */
#pragma once

#include "fibre/slab_fit.h"

/* Describes a table and the command that made it. */
typedef struct FibreTableDesc {
    int columns, rows; /* each 2 .. 64 */
    double low, high;  /* alpha in the first and the last row */
    int rounds;        /* of the fit */
    int threads;       /* 0: all */
    SolveProgress progress;
    void *user;
} FibreTableDesc;

/* Fits a table: texels[rows][columns][4] become A, h, g, k, each a half float. *error is that over the slabs of the
 * fit: the mean of the means, the largest of the others. Returns false if memory is short or progress stops it. */
bool fibre_table_fit(const FibreTableDesc *desc, float *texels, FitError *error);
