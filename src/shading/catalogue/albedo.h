/* albedo.h - the directional albedo E of any lobe, by quadrature and as a table
 *
 *   E(wo) = integral over the hemisphere of f(wo, wi) cos_i dwi
 *
 * With TRAIT_TWO_COLORS it is f0 E0 + f90 E90: the integrals of f (1 - s) and of f s, s being the Fresnel weight. */
#pragma once

#include "shading/catalogue/registry.h"
#include "shading/lobe/table.h"

typedef struct Albedo {
    float f0, f90; /* E0 and E90, for colours of 1; f90 is 0 without TRAIT_TWO_COLORS */
} Albedo;

/* Returns E for wo, z > 0, to the absolute error `tolerance`. A lobe with TRAIT_REFERENCE is estimated by random walks:
 * E is the mean of 4 / tolerance of them, with a standard error of at most sqrt(tolerance) / 4: 0.0025 if tolerance is
 * 1e-4. */
Albedo albedo_quadrature(const Lobe *lobe, Dir wo, double tolerance);

/* Works as albedo_quadrature. *error is the change that the last halving of the step made; it exceeds `tolerance` if
 * the finest step was not enough. */
Albedo albedo_quadrature_error(const Lobe *lobe, Dir wo, double tolerance, double *error);

/* Returns true if E of a colour is not f0 E0 + f90 E90: the lobe is tinted, or computes F from f0. */
bool albedo_depends_on_color(const Lobe *lobe);

/* Computes E of such a lobe for the three channels w of a colour. */
void albedo_in_color(const Lobe *lobe, Dir wo, const float w[3], double tolerance, float e[3]);

/* Returns the wo of that cosine for which the E of a brushed lobe is greatest, of four azimuths over half a circle
 * from its own; of another lobe, the wo at azimuth 0. */
Dir albedo_brightest(const Lobe *lobe, float cos_o);

/* A table has E of a white lobe (f0 = f90 = 1). Its ALBEDO_MU columns are uniform in y, cos_o = (1 - (1 - y)^2)^4. Its
 * ALBEDO_ROWS rows are uniform in the eighth root of parameter 0; there is one row if that is fixed. E changes fastest
 * near grazing at low alpha; near the normal some diffuse lobes change as sin(theta_o). With this spacing the curvature
 * of E is about equal everywhere.
 *
 * A tinted lobe has three more maps (s, q, e). They give E for a colour w by the same formula that tints f
 * (tint.h):
 *
 *   E(w) = E(1) c(w),  c: tint_color with s, q_o = q_i = q and e of these maps
 *
 * E(w) is exact at w = 1, 7/8 and 1/2, and so is its slope at w = 0.
 *
 * A brushed lobe's table is of albedo_brightest: it does not depend on the heading and must not be below E at any
 * heading by more than a hundredth, or layer rules would return more light than arrives.
 *
 * If the fibres of a lobe lean (it has the parameters tilt > 0 and azimuth), these maps are for wo across the nap.
 * They hold for any azimuth of the nap. Further maps have E by heading (table.h), for the tilt of the lobe or for
 * TABLE_TILTS tilts. */
enum {
    ALBEDO_MU = 40,
    ALBEDO_ROWS = 32,
    ALBEDO_MAPS = 4, /* E, s, q and e */
    ALBEDO_MAPS_MOST = ALBEDO_MAPS + TABLE_TILTS * TABLE_HEADINGS
};

typedef struct AlbedoTable {
    Lobe lobe; /* parameter 0 is not used */
    int rows;
    float low, high;           /* the requested range */
    float root_low, root_high; /* eighth roots of the first and last row, inside the lobe's hard range */
    int maps;                  /* number of all maps, of `rows` rows each */
    int tilts;                 /* number of tilts with maps for headings: 0, 1 or TABLE_TILTS */
    /* [map * rows + row][column]: maps of E, s, q and e, then of E by heading. The last column has the average
     * of E over wo, 2 integral of E mu dmu, and the s, q and e of this average. In maps by heading it has the
     * average over wo and azimuth, repeated in all five maps of a tilt. */
    float e[ALBEDO_MAPS_MOST * ALBEDO_ROWS][ALBEDO_MU + 1];
} AlbedoTable;

/* Fills the table for a lobe with parameter 0 from low to high (one row if they are equal), the others as given.
 * Uses `threads` threads, 0 for all. */
void albedo_table_fill(AlbedoTable *table, const Lobe *lobe, float low, float high, int threads);

/* Works as albedo_table_fill, for a sheen whose tilt a texture scales, from 0 to the tilt of the lobe. */
void albedo_table_fill_tilts(AlbedoTable *table, const Lobe *lobe, float low, float high, int threads);

/* Returns true if albedo_table_fill (scaled: albedo_table_fill_tilts) would make this table of these arguments. */
bool albedo_table_serves(const AlbedoTable *table, const Lobe *lobe, float low, float high, bool scaled);

/* Returns the table as table.h reads it, clamped to its ends; it must outlive the reference. Between nodes it
 * is within 2e-3 of the quadrature for alpha >= 0.005 and cos_o >= 1e-3, except for the lobes that
 * tests/shading/test_energy names, whose E has creases. A white base under leaning fibres, by rule albedo-view,
 * has a total albedo that is wrong by at most 0.08, and by at most 0.03 with one tilt and alpha >= 0.5
 * (tests/shading/test_leaning). */
TableRef albedo_table_ref(const AlbedoTable *table);
