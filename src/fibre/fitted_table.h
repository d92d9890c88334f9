/* fitted_table.h - the functions A, h, g and k of shading/lobes/fibre_table.h at the nodes of a small table
 *
 * Of white fibres that stand upright, of density 1. Columns are uniform in the root of mu + 0.001,
 * rows in the logarithm of alpha; between nodes all four are mixed linearly, and the fit is of what is mixed.
 * It starts from shading/media/fibre_model.h, which is to be baked first. */
#ifndef WEFT_FIBRE_FITTED_TABLE_H
#define WEFT_FIBRE_FITTED_TABLE_H

#include "fibre/slab_fit.h"

/* Describes a table and the command that made it. */
typedef struct FibreTableDesc {
    int columns, rows; /* each 2 .. 64 */
    double low, high;  /* alpha in the first and the last row */
    int rounds;        /* of the search */
    int threads;       /* 0: all */
    SolveProgress progress;
    void *user;
} FibreTableDesc;

/* texels[rows][columns][4] becomes A, h, g, k, each a half float; error, how far the table is off where it
 * was fitted: the mean of the means, the largest of the rest. False where memory is short or progress says
 * so. */
bool fibre_table_fit(const FibreTableDesc *desc, float *texels, FitError *error);

#endif
