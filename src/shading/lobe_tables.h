/* lobe_tables.h - tables that lobes read themselves, whatever the material: made once, at the first need
 *
 * In GLSL the flattener (text/) puts in its place the same functions, for layers of the one array texture. */
#ifndef WEFT_SHADING_LOBE_TABLES_H
#define WEFT_SHADING_LOBE_TABLES_H

#include "shading/table.h"

/* T(name, index). charlie_neubelt: E of that lobe over all of its alphas. ltc_fibre: z, q, b and E, below
 * each other; low and high are roots of alpha. fibre: A, h, g and k likewise; low and high are log2 alpha. */
#define LOBE_TABLES(T)                                                                                       \
    T(charlie_neubelt, 0)                                                                                    \
    T(ltc_fibre, 1)                                                                                          \
    T(fibre, 2)                                                                                              \
    T(ltc_ggx, 3)
#define LOBE_TABLE_COUNT 4

/* Read-only after lobe_tables_make, which any number of threads may call at once; whoever makes a Lobe has.
 */
extern TableRef lobe_table_refs[LOBE_TABLE_COUNT];
void lobe_tables_make(void);

/* Makes the tables that a lobe reads, and all that need no computing. */
void lobe_tables_make_for(int id);

#define LOBE_TABLE_GET(name, index)                                                                          \
    FN TableRef lobe_table_##name(void) { return lobe_table_refs[index]; }
LOBE_TABLES(LOBE_TABLE_GET)
#undef LOBE_TABLE_GET

#endif
