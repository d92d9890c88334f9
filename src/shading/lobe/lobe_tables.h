/* lobe_tables.h - tables that belong to a lobe, not to a material; each is made once, when first needed
 *
 * In GLSL the flattener (text/) supplies the same functions, which read layers of one array texture. */
#pragma once

#include "shading/lobe/table.h"

/* T(name). charlie_neubelt: E of that lobe over its whole range of alpha. The others are of kind TABLE_PLANES.
 * ltc_fibre_published: planes a, b, R of ltc_table_published.
 * ltc_fibre and ltc_ggx: planes z, q, b, amplitude (E) of ltc_table_level; TableRef.low and high are square
 * roots of alpha. fibre: A, h, g, k of lobes/fibre_table.h; low and high are log2 of alpha. */
#define LOBE_TABLES(T)                                                                                                 \
    T(charlie_neubelt)                                                                                                 \
    T(ltc_fibre)                                                                                                       \
    T(fibre)                                                                                                           \
    T(ltc_ggx)                                                                                                         \
    T(ltc_fibre_published)
#define LOBE_TABLE_PLACE(name) LOBE_TABLE_##name,
enum { LOBE_TABLES(LOBE_TABLE_PLACE) LOBE_TABLE_COUNT };
#undef LOBE_TABLE_PLACE

/* Read-only once made. Any number of threads may call lobe_tables_make at once; the functions that return a Lobe
 * call it first. */
extern TableRef lobe_table_refs[LOBE_TABLE_COUNT];
void lobe_tables_make(void);

/* Unpacks all baked tables; computes charlie_neubelt only if lobe `id` reads it. */
void lobe_tables_make_for(int id);

#define LOBE_TABLE_GET(name)                                                                                           \
    FN TableRef lobe_table_##name(void) { return lobe_table_refs[LOBE_TABLE_##name]; }
LOBE_TABLES(LOBE_TABLE_GET)
#undef LOBE_TABLE_GET
