/* albedo.h - the directional albedo E of any lobe, by quadrature and as a table
 *
 *   E(wo) = integral over the hemisphere of f(wo, wi) cos_i dwi
 *
 * Lobes with TRAIT_TWO_COLORS have two parts: f0 E0 + f90 E90, with weights 1 - s and s inside the integral.
 */
#ifndef WEFT_SHADING_ALBEDO_H
#define WEFT_SHADING_ALBEDO_H

#include "shading/registry.h"
#include "shading/table.h"

typedef struct Albedo {
    float f0, f90; /* f90 is 0 without TRAIT_TWO_COLORS */
} Albedo;

/* E for wo, z > 0, to `tolerance` absolute. Of a lobe with TRAIT_REFERENCE it is the mean of 4 / tolerance
 * walks, with a standard error of sqrt(tolerance) / 4 at most: 0.0025 where 1e-4 is asked for. */
Albedo albedo_quadrature(const Lobe *lobe, Dir wo, double tolerance);

/* Works as albedo_quadrature, with an error estimate: the change that the last halving of the step made. That is
 * above `tolerance` where the finest step was not enough. */
Albedo albedo_quadrature_error(const Lobe *lobe, Dir wo, double tolerance, double *error);

/* Returns true where colour is no factor and no share either: for a tinted lobe, and where f0 makes F. */
bool albedo_asks_color(const Lobe *lobe);

/* E of such a lobe in the colour w: of each channel by itself. */
void albedo_in_color(const Lobe *lobe, Dir wo, const float w[3], double tolerance, float e[3]);

/* E of a white lobe (f0 = f90 = 1) over cos_o = (1 - (1 - y)^2)^4, ALBEDO_MU nodes uniform in y, and over one
 * parameter, ALBEDO_ROWS nodes uniform in its eighth root, or one row where it is held fixed: so E bends
 * about equally everywhere, though it changes fastest near grazing at low alpha, and for some diffuse lobes
 * as sin(theta_o) near the normal.
 *
 * For a tinted lobe there are three maps more, from which E(w) of any colour follows by the law of its f:
 *
 *   E(w) = E(1) c(w),  c: tint_color with s, q_o = q_i = q and e of these maps
 *
 * which is right at w = 1, at 7/8, at 1/2 and, as a slope, at 0.
 *
 * Of a lobe whose fibres lean, one with the parameters tilt > 0 and azimuth, these are for wo across the nap,
 * whatever the azimuth; and there are maps more of E by heading (table.h), for the tilt of the lobe or for
 * TABLE_TILTS of them. */
enum {
    ALBEDO_MU = 40,
    ALBEDO_ROWS = 32,
    ALBEDO_MAPS = 4,
    ALBEDO_MAPS_MOST = ALBEDO_MAPS + TABLE_TILTS * TABLE_HEADINGS
};

typedef struct AlbedoTable {
    Lobe lobe; /* parameter 0 is not used */
    int rows;
    float low, high;           /* the range asked for */
    float root_low, root_high; /* eighth roots of the first and last row, inside the lobe's hard range */
    int maps;                  /* all, of `rows` rows each */
    int tilts;                 /* with maps for headings: 0, 1 or TABLE_TILTS */
    /* E, then s, q and e. The last column: on cosine average, 2 integral of E mu dmu, and s, q, e of that; of
     * E by heading the average over azimuths too. */
    float e[ALBEDO_MAPS_MOST * ALBEDO_ROWS][ALBEDO_MU + 1];
} AlbedoTable;

/* Fills the table for a lobe as its parameter 0 runs over low .. high (equal: one row), the others as given.
 * Runs on `threads` threads (0: all). */
void albedo_table_fill(AlbedoTable *table, const Lobe *lobe, float low, float high, int threads);

/* Works as albedo_table_fill, for a sheen whose tilt a texture scales from 0 to that of the lobe. */
void albedo_table_fill_tilts(AlbedoTable *table, const Lobe *lobe, float low, float high, int threads);

/* Returns true if the table is the lobe's for parameter 0 over low .. high and, if scaled, for all tilts. */
bool albedo_table_serves(const AlbedoTable *table, const Lobe *lobe, float low, float high, bool scaled);

/* The table for table.h to read, which clamps to its ends; it must outlive the reference. Off the nodes it is
 * within 2e-3 of the quadrature for alpha >= 0.005 and cos_o >= 1e-3, but for the lobes that
 * tests/shading/test_energy names, whose E has creases. Of fibres that lean, a white base under rule
 * albedo-view is within 0.08 of 1, and 0.03 for one tilt and alpha >= 0.5 (tests/shading/test_leaning). */
TableRef albedo_table_ref(const AlbedoTable *table);

#endif
