/* lobe_tables.h - tables that lobes read themselves, whatever the material: made once, at the first need
 *
 * In GLSL the flattener (text/) puts in its place the same functions, for layers of the one array texture. */
#ifndef WEFT_SHADING_LOBE_TABLES_H
#define WEFT_SHADING_LOBE_TABLES_H

#include "shading/table.h"

/* Read-only after lobe_tables_make, which any number of threads may call at once; whoever makes a Lobe has.
 */
extern TableRef lobe_table_refs[1];
void lobe_tables_make(void);

/* E of charlie-neubelt over all of its alphas. */
FN TableRef lobe_table_charlie_neubelt(void) { return lobe_table_refs[0]; }

#endif
