/* text.h - the catalogue as GLSL: its files flattened into one text, for a driver or for an engine
 *
 *   Text text;
 *   text_begin(&text, &(TextDesc){.language = TEXT_GLSL_330});
 *   text_include(&text, "shading/lobes/ggx.h");
 *   text_line(&text, "void main() { ... }");
 *   if (text_end(&text, &error) == WEFT_OK) use(text.bytes);
 *   text_free(&text);
 *
 * The texts are those of src/shading when the library was built. What they include is put in its place, once;
 * comments, unless they are wanted, the branches for C and the macros are gone: tables of parameters are
 * members, enumerations constants. Of each line the Text knows the line that it was made from. A failure
 * stays in the Text: later calls do nothing, and text_end returns it.
 *
 * A Text belongs to one thread at a time; two of them share nothing. */
#ifndef WEFT_TEXT_TEXT_H
#define WEFT_TEXT_TEXT_H

#include "text/source/macro.h"
#include "weft/result.h"

typedef enum TextLanguage {
    TEXT_GLSL_330,    /* desktop OpenGL 3.3 core */
    TEXT_GLSL_ES_300, /* OpenGL ES 3.0, WebGL 2 */
    TEXT_GLSL_450,    /* Vulkan, through its compilers */
    TEXT_PLAIN        /* what these share, without a first line: for another language to be made from */
} TextLanguage;

/* Zero-initialise. */
typedef struct TextDesc {
    TextLanguage language;
    /* Declares the array texture weft_tables that shading/lobe/table.h reads: one float a texel, a layer a table.
     */
    bool tables;
    /* A folder whose files win over those of the library: shading/lobes/ggx.h below it is taken where it is
     * there. May be NULL; must outlive the Text. */
    const char *folder;
    /* Comments stay. A line between items of different files is then a comment that names the second one,
     * TEXT_FILE_MARK; what a file begins with is behind its first one, TEXT_HEAD_MARK. */
    bool comments;
    /* Tables in the layers from 0 on, behind which the text's own follow; one of them is not added again.
     * Borrowed for as long as the Text. */
    const struct TextTable *before;
    int before_count;
    /* Engines' tables with more rows or columns are put in anew with so many of both, where a text is to hold
     * them itself; 0: as they are. */
    int table_side;
} TextDesc;

#define TEXT_FILE_MARK "/*@"
#define TEXT_HEAD_MARK "/*!"

/* A layer of weft_tables: `rows` rows of `columns` floats. Borrowed: it must outlive whoever uploads it. */
typedef struct TextTable {
    const float *texels;
    int rows, columns;
    const char *name; /* for people; may be NULL; borrowed too */
} TextTable;

enum { TEXT_TABLES_MAX = 32 };

typedef struct Text {
    const char *bytes; /* what text_end has closed; ends with a zero byte */
    size_t size;
    TextTable
        tables[TEXT_TABLES_MAX]; /* what the text expects in the layers of weft_tables, behind `before` */
    int table_count;
    /* The rest is the text's own. */
    TextDesc desc;
    Buffer buffer;
    Macros macros;
    struct TextName *included;
    struct TextName *headed; /* files whose beginning is in the text */
    int depth;               /* files being included inside each other */
    bool gap;                /* a blank line is due */
    const char *marked;      /* the file that a comment has named last; NULL: the caller's lines */
    WeftError error;
} Text;

/* Starts with the #version and precision lines. Call text_free afterwards, in any case. */
void text_begin(Text *text, const TextDesc *desc);

/* A file of the catalogue by its name ("shading/lobes/ggx.h") and what it includes, except what the text has
 * already. Fails with WEFT_MESSAGE_TEXT_NAME, or _TEXT_DIALECT with file and line where it is not
 * shading text. */
void text_include(Text *text, const char *file);

/* From here on an include of that file is nothing: the caller's own lines take its place. False where the
 * text has the file already. */
bool text_provide(Text *text, const char *file);

/* Lines of the caller's own choice as though they were that file; a name of the catalogue, borrowed. */
void text_source(Text *text, const char *file, const Buffer *bytes);

/* From here on the name stands for that body ("int", "4") in files of the catalogue, and for itself again. */
void text_define(Text *text, const char *name, const char *body);
void text_undefine(Text *text, const char *name);

/* One line of the caller's own, as printf makes it. Macros are not expanded in it. */
__attribute__((format(printf, 2, 3))) void text_line(Text *text, const char *format, ...);

/* Adds a table and returns its layer, the Table of shading/lobe/table.h; -1 where there are TEXT_TABLES_MAX with
 * those before, which is a failure too (WEFT_MESSAGE_DESC). */
int text_table(Text *text, TextTable table);

/* The file and line that a line of the text comes from, both counted from 1; lines that a macro stands for
 * come from where it is called. The file is a name of the catalogue, behind the folder where it was found
 * there. NULL of lines that the caller made, and where there is no such line. Valid until text_free. */
Origin text_origin(const Text *text, int line);

/* Fails with "FILE:LINE: what the message says: what"; the file must not be NULL. */
WeftResult text_fail_at(Origin origin, WeftMessage message, const char *what, WeftError *error);

/* Sets text->bytes and size, or returns what went wrong first. */
WeftResult text_end(Text *text, WeftError *error);

void text_free(Text *text);

#endif
