/* draft.h - a text for an engine while it is made: catalogue text, the functions that are called, and constants */
#pragma once

#include "shading/catalogue/albedo.h"
#include "text/assemble/text.h"
#include "text/passes/fold.h"
#include "text/passes/items.h"
#include "text/passes/spell.h"
#include "weft/export.h"

enum { DRAFT_ROOTS = 24, DRAFT_FACTS = 48, DRAFT_ID = 64, DRAFT_ALBEDOS = 2 };

/* The tables that the drafts of one text read; a table's index is the layer in the text. Zero-initialise. */
typedef struct DraftTables {
    TextTable all[TEXT_TABLES_MAX];
    char names[TEXT_TABLES_MAX][WEFT_EXPORT_NAME];
    bool used[TEXT_TABLES_MAX]; /* the final text reads it */
    int count;
} DraftTables;

typedef struct Draft {
    const WeftExportDesc *desc;
    Speller speller;
    Text text;                           /* TEXT_PLAIN */
    char roots[DRAFT_ROOTS][SPELL_NAME]; /* the functions that an engine calls */
    const char *whole[5];                /* records that keep all members; ended by NULL */
    FoldFact facts[DRAFT_FACTS];         /* constants that fold conditions of the text */
    AlbedoTable *albedos[DRAFT_ALBEDOS]; /* owned; text.tables points into them */
    char albedo_names[DRAFT_ALBEDOS][SPELL_NAME];
    float *colors; /* of a cloth from afar, as a table; owned; text.tables points to it */
    int root_count, fact_count, albedo_count;
    char id[2][DRAFT_ID]; /* identifier of a material, or of a lobe and of that on the right */
    DraftTables *tables;  /* of this draft and those before it; borrowed */
    Items items;
    Buffer folded; /* the text that the items are cut from */
} Draft;

/* Begins a draft, and releases it; draft_free may follow any other call. */
void draft_begin(Draft *draft, const WeftExportDesc *desc, DraftTables *tables);
void draft_free(Draft *draft);

/* Adds a function that an engine calls, by a name with the id in it: draft_root(draft, "%s_eval", id). */
__attribute__((format(printf, 2, 3))) void draft_root(Draft *draft, const char *format, ...);

/* Adds the fact that an expression such as "m.layer" has a constant value. path must outlive the draft. */
void draft_fact(Draft *draft, const char *path, int value);

/* Returns an empty table of E to fill, or NULL if memory is short. */
AlbedoTable *draft_albedo(Draft *draft);

/* Closes the text, folds it, keeps the items that the roots need and adds its tables to those of the drafts before. */
WeftResult draft_cut(Draft *draft, WeftError *error);

/* Converts a name such as "a-b" to an identifier, to which a prefix and endings with '_' may be joined: '_' is neither
 * first nor last nor repeated, since GLSL reserves names with "__" (OpenGL Shading Language 4.60, section 3.7). */
void draft_identifier(const char *name, char id[DRAFT_ID]);

/* Adds a lobe's functions. which: 0, or 1 for the lobe on the right. */
void draft_lobe(Draft *draft, const WeftLobe *lobe, int which);

/* Returns true if the first parameter of the lobe's record is set from an artist's roughness. */
bool draft_lobe_rough(const WeftLobe *lobe);

/* Returns the name of a lobe's record. */
const char *draft_lobe_record(int lobe);

/* Adds the functions by which a map lights a lobe; the text fails where that takes more than weights of look-ups.
 * The text calls ID_albedo. */
void draft_ambient(Draft *draft, const WeftLobe *lobe);

/* Adds the functions of a profile, a workflow or a material. */
WeftResult draft_material(Draft *draft, WeftError *error);

/* Adds the functions by which a text sees the cloth of its description: its numbers and tables, where it lies, its lobes
 * from afar, and ID_see. */
void draft_cloth(Draft *draft);

/* Fails if the target cannot hold the tables of all drafts. */
WeftResult draft_tables_fit(const Draft *draft, WeftError *error);

/* Writes the tables of all drafts in the target's language: samplers or arrays, and the function that reads a texel. */
void draft_tables(const Draft *draft, Buffer *out);

/* Lists the tables that the program must upload, in the order in which the text names them. */
WeftResult draft_uploads(const Draft *draft, WeftExport *out, WeftError *error);

/* Writes the comment at the top. */
void drafts_head(const Draft *drafts, int count, const WeftExport *uploads, Buffer *out);

/* Keeps one copy of the items that drafts share. Items of one name that differ are marked `own`: their names get the id
 * of their draft. Call it when all drafts are cut. */
void drafts_merge(Draft *drafts, int count);

/* Writes the items: first those that several drafts share or only one has, then each draft's own. */
void drafts_spell(Draft *drafts, int count, Buffer *out);

/* Returns true if the target's language is HLSL. */
static inline bool draft_is_hlsl(const Draft *draft) { return draft->speller.language == SPELL_HLSL; }

/* Writes the functions that a Custom Function node of Unity calls, in both precisions: of a lobe, color times f times the
 * cosine; of a material, its f times the cosine for the inputs that the text reads. */
void draft_unity(const Draft *draft, Buffer *out);

/* Writes the ball and its light behind the functions of a Shadertoy. */
void draft_ball(const Draft *draft, Buffer *out);

/* Writes the lines that give an engine profile a cloth to show. */
void draft_ball_inputs(const Draft *draft, Buffer *out);

/* Writes a line as printf does, and a newline. */
__attribute__((format(printf, 2, 3))) void put_line(Buffer *out, const char *format, ...);
