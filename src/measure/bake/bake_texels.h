/* bake_texels.h - the common parts of all kinds of baked tables: the list of kinds, and the loop over texels
 *
 * A new kind is a file with a BakeMaker and a line in BAKE_KINDS. */
#pragma once

#include "shading/catalogue/albedo.h"
#include "weft/bake.h"

/* Makes the table of a checked description, whose zeros have been replaced by the defaults. info is zeroed. A
 * failure leaves *out zeroed. */
typedef WeftResult BakeMaker(const WeftBakeDesc *desc, WeftBakeInfo *info, WeftImage *out, WeftError *error);
BakeMaker bake_albedo, bake_dfg, bake_solved, bake_ltc, bake_ltc_amplitude, bake_ltc_level, bake_fibre_table,
    bake_ltc_published;

/* K(id, maker, lobe, formed, width, height, help): the columns of a WeftBakeKind. */
#define BAKE_KINDS(K)                                                                                                  \
    K("albedo", bake_albedo, 2, 1, 64, 64, "E of LOBE; the parts of f0 and f90 where it mixes two colours")            \
    K("dfg", bake_dfg, 1, 1, 128, 128, "split sum: scale of f0 and bias of f90 of ggx, and E of LOBE")                 \
    K("ltc", bake_ltc, 2, 0, 32, 32, "linearly transformed cosines of LOBE: z, q, b, r")                               \
    K("ltc-amplitude", bake_ltc_amplitude, 2, 0, 32, 32, "their amplitudes of both colours, and each fit's error")     \
    K("ltc-level", bake_ltc_level, 2, 0, 32, 32, "the same with r = 0, in one texel: z, q, b, E of LOBE")              \
    K("fibre-table", bake_fibre_table, 0, 0, 24, 16, "the functions of the lobe fibre-table: A, h, g, k")              \
    K("ltc-fibre-published", bake_ltc_published, 0, 0, 32, 32, "the table of the lobe ltc-fibre-published: a, b, R")   \
    K("fibre-truth", bake_solved, 1, 1, 32, 32, "R and T of the solved slab of fibres; -p density of LOBE fibre")

/* Calls texel(user, x, y, thread) for all texels, on several threads (thread is below WEFT_THREADS_MAX), and
 * progress on the caller's. texel writes only to places of its own texel or thread. Fails with
 * WEFT_INTERRUPTED if progress stops it. */
WeftResult bake_texels(int width, int height, int threads, WeftProgress progress, void *progress_user,
                       void (*texel)(void *user, int x, int y, int thread), void *user);

/* A lobe over the axes of a table. */
typedef struct BakePlane {
    const WeftTableForm *form;
    int width, height;
    Lobe lobe;
    double tolerance; /* of the quadrature */
    int late;         /* texels by which the parameter is ahead of the axis */
} BakePlane;

/* The result of the quadrature at a texel. */
typedef struct BakeTexel {
    float part[WEFT_TABLE_PARTS]; /* by WeftTablePart: E of the white lobe, and the two parts of it */
    double error;                 /* the estimate of the quadrature */
    float cos_o, value;           /* value: first parameter of the lobe */
    bool beyond;                  /* value is beyond its hard range, and the parts are those at the end of the range */
} BakeTexel;
BakeTexel bake_texel(const BakePlane *plane, int x, int y);

/* Returns true if a table can be judged by E at a texel: its cosine is not 0, and its value is not beyond.
 * This takes almost no time. */
bool bake_judges(const BakePlane *plane, int x, int y);

/* Some channels of a table, and the lobe whose parts they store. */
typedef struct BakeLayer {
    Lobe lobe;
    int channels;
    WeftTablePart parts[2]; /* of the channels */
} BakeLayer;

/* Returns the parts of a lobe: E, or two if it mixes two colours, as the form requires. */
BakeLayer bake_layer(const Lobe *lobe, const WeftTableForm *form);

/* Fills a new table with layers, one after another, and info without its words. */
WeftResult bake_layers(const WeftBakeDesc *desc, const BakeLayer *layers, int count, WeftBakeInfo *info, WeftImage *out,
                       WeftError *error);

/* Returns true if two forms have the same axes; `total` is not compared. */
bool form_same(const WeftTableForm *a, const WeftTableForm *b);

/* Returns the first parameter of the lobe at t in [0, 1] of its axis, see weft_table_form_texel. */
float form_parameter(const WeftTableForm *form, int lobe, double t);
