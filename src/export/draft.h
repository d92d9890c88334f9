/* draft.h - a text for an engine while it is made: catalogue text, what of it is wanted, what is known */
#ifndef WEFT_EXPORT_DRAFT_H
#define WEFT_EXPORT_DRAFT_H

#include "shading/catalogue/albedo.h"
#include "text/assemble/text.h"
#include "text/passes/fold.h"
#include "text/passes/items.h"
#include "text/passes/spell.h"
#include "weft/export.h"

enum { DRAFT_ROOTS = 24, DRAFT_FACTS = 48, DRAFT_ID = 64, DRAFT_ALBEDOS = 2 };

/* The tables that the drafts of one text read, in the layers that they name. Zero-initialise. */
typedef struct DraftTables {
    TextTable all[TEXT_TABLES_MAX];
    char names[TEXT_TABLES_MAX][WEFT_EXPORT_NAME];
    bool used[TEXT_TABLES_MAX]; /* the text still reads it in the end */
    int count;
} DraftTables;

typedef struct Draft {
    const WeftExportDesc *desc;
    Speller speller;
    Text text;                           /* TEXT_PLAIN */
    char roots[DRAFT_ROOTS][SPELL_NAME]; /* what an engine calls */
    const char *whole[5];                /* records that keep all members; ended by NULL */
    FoldFact facts[DRAFT_FACTS];
    AlbedoTable *albedos[DRAFT_ALBEDOS]; /* owned; text.tables looks into them */
    char albedo_names[DRAFT_ALBEDOS][SPELL_NAME];
    int root_count, fact_count, albedo_count;
    char id[2][DRAFT_ID]; /* of a lobe, then of that on the right, or of a material: an identifier */
    DraftTables *tables;  /* of this draft and those before it; borrowed */
    Items items;
    Buffer folded; /* what the items are cut from */
} Draft;

/* Both may be called in any case after one another. */
void draft_begin(Draft *draft, const WeftExportDesc *desc, DraftTables *tables);
void draft_free(Draft *draft);

/* Text that is wanted, under a name with the id in it: draft_root(draft, "%s_eval", id). */
__attribute__((format(printf, 2, 3))) void draft_root(Draft *draft, const char *format, ...);

/* path must outlive the draft. */
void draft_fact(Draft *draft, const char *path, int value);

/* An empty table of E to fill, NULL where memory is short. */
AlbedoTable *draft_albedo(Draft *draft);

/* Closes the text, folds it, keeps what the roots need and adds its tables to those of the drafts before. */
WeftResult draft_cut(Draft *draft, WeftError *error);

/* "a-b" as an identifier, to which a prefix and endings with '_' may be joined: '_' stands neither first nor
 * last nor twice in a row, since GLSL keeps names with "__" for itself (OpenGL Shading Language 4.60,
 * section 3.7). */
void draft_identifier(const char *name, char id[DRAFT_ID]);

/* A lobe's functions; which: 0, or 1 for that on the right. */
void draft_lobe(Draft *draft, const WeftLobe *lobe, int which);

/* Returns true if the first parameter of the lobe's record is set from an artist's roughness. */
bool draft_lobe_rough(const WeftLobe *lobe);

/* Returns the name of a lobe's record. */
const char *draft_lobe_record(int lobe);

/* A profile's, a workflow's or a material's functions. */
WeftResult draft_material(Draft *draft, WeftError *error);

/* The tables in the words of the target: samplers or arrays, and the function that reads a texel. */
void draft_tables(const Draft *draft, Buffer *out); /* any draft: the tables are those of all */

/* Lists the tables that the program must upload, in the order in which the text names them. */
WeftResult draft_uploads(const Draft *draft, WeftExport *out, WeftError *error);

/* The comment at the top. */
void drafts_head(const Draft *drafts, int count, const WeftExport *uploads, Buffer *out);

/* Keeps one copy of the items that drafts share. Items of one name that differ are marked `own`: they go by
 * the id of their draft. Call it when all drafts are cut. */
void drafts_merge(Draft *drafts, int count);

/* Puts the items: first those that several drafts share or one alone has, then each draft's own. */
void drafts_spell(Draft *drafts, int count, Buffer *out);

/* Shadertoy's: the ball and its light, behind the functions. */
void draft_ball(const Draft *draft, Buffer *out);

/* Lines that give an engine profile a cloth to show. */
void draft_ball_inputs(const Draft *draft, Buffer *out);

/* Lines as printf makes them. */
__attribute__((format(printf, 2, 3))) void put_line(Buffer *out, const char *format, ...);

#endif
