/* albedo.h - the directional albedo E of any lobe, by quadrature and as a table
 *
 *   E(wo) = integral over the hemisphere of f(wo, wi) cos_i dwi
 *
 * Lobes with TRAIT_TWO_COLORS have two parts: f0 E0 + f90 E90, with weights 1 - s and s inside the integral.
 */
#ifndef WEFT_SHADING_ALBEDO_H
#define WEFT_SHADING_ALBEDO_H

#include "shading/registry.h"

typedef struct Albedo {
    float f0, f90; /* f90 is 0 without TRAIT_TWO_COLORS */
} Albedo;

/* E for wo, z > 0, to `tolerance` absolute. */
Albedo albedo_quadrature(const Lobe *lobe, Dir wo, double tolerance);

/* E of a white lobe (f0 = f90 = 1) over cos_o, ALBEDO_MU nodes uniform in its fourth root, and over one
 * parameter, ALBEDO_ROWS nodes uniform in its eighth root, or one row where it is held fixed: so E bends
 * about equally everywhere, though it changes fastest near grazing at low alpha. */
enum { ALBEDO_MU = 32, ALBEDO_ROWS = 32 };

typedef struct AlbedoTable {
    LobeId lobe;
    int rows;
    float low, high;           /* the range asked for */
    float root_low, root_high; /* eighth roots of the first and last row, inside the lobe's hard range */
    float e[ALBEDO_ROWS][ALBEDO_MU];
} AlbedoTable;

/* Fills the table for a lobe as its parameter 0 runs over low .. high (equal: one row), the others as given.
 * Runs on `threads` threads (0: all). */
void albedo_table_fill(AlbedoTable *table, const Lobe *lobe, float low, float high, int threads);

/* E by bicubic interpolation, clamped to the table's ends. Off the nodes it is within 2e-3 of the quadrature
 * for alpha >= 0.005 and cos_o >= 1e-3 (tests/shading/test_energy). */
float albedo_table_read(const AlbedoTable *table, float cos_o, float alpha);

#endif
