/* sheen_tables.h - the albedo tables of the sheens of a scene's materials */
#pragma once

#include "scene/record/scene.h"
#include "shading/catalogue/albedo.h"

typedef struct SheenTables SheenTables;

/* Makes the tables of all materials that a mesh has, each over the range of its roughness; equal sheens share one.
 * threads: 0 is one a processor. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult sheen_tables_create(const WeftScene *scene, int threads, SheenTables **out, WeftError *error);

/* Makes the tables, and shares those that `before` (may be NULL) has. The first of the two must then be freed with
 * sheen_tables_free_but. */
WeftResult sheen_tables_renew(const SheenTables *before, const WeftScene *scene, int threads, SheenTables **out,
                              WeftError *error);

/* Returns true if one has a table that the other lacks or has at another index. */
bool sheen_tables_differ(const SheenTables *tables, const SheenTables *other);

/* Free all tables, or all that `kept` (may be NULL) does not have; tables may be NULL. */
void sheen_tables_free(SheenTables *tables);
void sheen_tables_free_but(SheenTables *tables, const SheenTables *kept);

/* Return the count of tables, and each of them. */
int sheen_tables_count(const SheenTables *tables);
const AlbedoTable *sheen_tables_at(const SheenTables *tables, int index);

/* Returns the index of the table of a material's surface_stack, or -1 if it needs none. */
int sheen_tables_index(const SheenTables *tables, int material);

/* Returns the reference to a material's table, of kind TABLE_NONE if it has none. Lives as long as tables. */
TableRef sheen_tables_of(const SheenTables *tables, int material);
