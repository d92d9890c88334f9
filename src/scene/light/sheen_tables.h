/* sheen_tables.h - the tables of E that the sheens of a scene's materials ask for */
#ifndef WEFT_SCENE_SHEEN_TABLES_H
#define WEFT_SCENE_SHEEN_TABLES_H

#include "scene/record/scene.h"
#include "shading/catalogue/albedo.h"

typedef struct SheenTables SheenTables;

/* Makes the tables of all materials that a mesh wears, each over the range its roughness runs through; sheens
 * that are alike share one. threads: 0 is one a processor. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult sheen_tables_create(const WeftScene *scene, int threads, SheenTables **out, WeftError *error);

/* Makes the tables, and takes over those that `before` (may be NULL) has. These are then in both, and the
 * first to go must be freed with sheen_tables_free_but. */
WeftResult sheen_tables_renew(const SheenTables *before, const WeftScene *scene, int threads,
                              SheenTables **out, WeftError *error);

/* Returns true if one has a table that the other lacks or has elsewhere. */
bool sheen_tables_differ(const SheenTables *tables, const SheenTables *other);

/* tables may be NULL; frees all, or all that `kept` (may be NULL) does not have. */
void sheen_tables_free(SheenTables *tables);
void sheen_tables_free_but(SheenTables *tables, const SheenTables *kept);

/* Return the count of tables, and each of them. */
int sheen_tables_count(const SheenTables *tables);
const AlbedoTable *sheen_tables_at(const SheenTables *tables, int index);

/* Which of them a material's surface_stack takes; -1 where it asks for none. */
int sheen_tables_index(const SheenTables *tables, int material);

/* Returns the reference to a material's table, of kind TABLE_NONE if it has none. Lives as long as tables. */
TableRef sheen_tables_of(const SheenTables *tables, int material);

#endif
