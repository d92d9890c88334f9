/* ltc_bake.h - the table of linearly transformed cosines of a lobe, over cos_o and one parameter */
#pragma once

#include "shading/catalogue/registry.h"
#include "shading/ltc/ltc_table.h"
#include "weft/ltc.h"

struct WeftLtc {
    Lobe lobe;        /* parameter 0 is not used */
    float f0, second; /* the colours that the matrix is fitted to */
    bool level;       /* r is 0 everywhere */
    int norm, rows, columns;
    float low, high; /* of parameter 0 */
    float *texels;   /* WEFT_LTC_CHANNELS planes, as in ltc_table.h */
    bool cached;
    double seconds;
};

/* Allocates rows * columns cells. Returns false if memory is short. */
bool ltc_create(WeftLtc *ltc);

static inline int ltc_cells(const WeftLtc *ltc) { return ltc->rows * ltc->columns; }

/* Returns the cosine of a column; the second function returns the lobe of a row. */
float ltc_cos_o(const WeftLtc *ltc, int column);
Lobe ltc_lobe(const WeftLtc *ltc, int row);

/* Returns the table for ltc_table.h, which must not outlive ltc. */
LtcTable ltc_table_ref(const WeftLtc *ltc);

/* Fits every cell; lobe, norm, rows, columns, low and high must be set. The result does not depend on the
 * number of threads. Fails with WEFT_INTERRUPTED or WEFT_MESSAGE_MEMORY. */
WeftResult ltc_bake(WeftLtc *ltc, const WeftLtcDesc *desc, WeftError *error);

/* Returns true if f is isotropic for every value of the parameter from low to high. */
bool ltc_isotropic(const WeftLtc *ltc);
