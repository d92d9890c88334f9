/* albedo.h - the directional albedo E of any lobe, by quadrature and as a table
 *
 *   E(wo) = integral over the hemisphere of f(wo, wi) cos_i dwi
 *
 * Lobes with TRAIT_FRESNEL have two parts: f0 E0 + f90 E90, with weights 1 - s and s inside the integral. */
#ifndef WEFT_SHADING_ALBEDO_H
#define WEFT_SHADING_ALBEDO_H

#include "shading/registry.h"

typedef struct Albedo {
    float f0, f90; /* f90 is 0 without TRAIT_FRESNEL */
} Albedo;

/* E for wo, z > 0, to `tolerance` absolute. */
Albedo albedo_quadrature(const Lobe *lobe, Dir wo, double tolerance);

/* E over cos_o (ALBEDO_MU nodes, uniform in sqrt(cos_o)) and one parameter (ALBEDO_ROWS nodes, uniform in its
 * square root, or one row where it is held fixed). */
enum { ALBEDO_MU = 64, ALBEDO_ROWS = 32 };

typedef struct AlbedoTable {
    LobeId lobe;
    int rows;
    float low, high; /* of the parameter `alpha`, at the first and last row */
    float e[ALBEDO_ROWS][ALBEDO_MU];
} AlbedoTable;

/* Fills the f0 part for a lobe as its parameter 0 runs over low .. high (equal: one row), the others as
 * given. Runs on `threads` threads (0: all). */
void albedo_table_fill(AlbedoTable *table, const Lobe *lobe, float low, float high, int threads);

/* E by bilinear interpolation, clamped to the table's ends. */
float albedo_table_read(const AlbedoTable *table, float cos_o, float alpha);

#endif
