/* engine_tables.h - albedo tables (LUTs) that engines ship, computed by their own procedures, errors included
 *
 * They are of kind TABLE_LINEAR, as the engines' samplers read them, with roughness (not squared) down the rows. In
 * GLSL the flattener (text/) supplies engine_table, which reads layers of one array texture. */
#pragma once

#include "shading/lobe/table.h"

/* E of charlie-neubelt and of white ggx. google/filament, libs/ibl/src/CubemapIBL.cpp, 128 x 128. Its rows are
 * shifted: row j of n holds roughness (j + 1.5) / n, at most 1, but a sampler expects (j + 0.5) / n there. So at
 * roughness 0.1 and cos_o 0.3 the table has .071 for E of the sheen in place of .055; from roughness 0.3 on it is
 * within 4 %. With its 1024 points E of ggx is up to .009 off the integral, most near grazing.
 *   Babylon.js ships an image of 256 x 256, which the same procedure reproduces. Substitute: the rounding to 8 bits
 * and the spacing of ggx at 256 rows are left out. */
/* three.js ships E of white ggx. mrdoob/three.js, src/renderers/shaders/DFGLUTData.js, 16 x 16.
 *
 * One row a table: T(NAME, name, rows and columns, points of the sum, true for the sheen, true if rows are shifted). */
#define ENGINE_TABLES(T)                                                                                               \
    T(FILAMENT_SHEEN, filament_sheen, 128, 4096, true, true)                                                           \
    T(FILAMENT_GGX, filament_ggx, 128, 1024, false, true)                                                              \
    T(BABYLON_SHEEN, babylon_sheen, 256, 4096, true, true)                                                             \
    T(BABYLON_GGX, babylon_ggx, 256, 1024, false, true)                                                                \
    T(THREE_GGX, three_ggx, 16, 4096, false, false)

#define ENGINE_TABLE_ID(NAME, name, side, points, sheen, shifted) ENGINE_##NAME,
enum { ENGINE_TABLES(ENGINE_TABLE_ID) ENGINE_COUNT };

/* Returns a table, computed at the first call. Any number of threads may call it at once. */
TableRef engine_table(int which);
