/* text.h - the catalogue as GLSL: its files flattened into one text, for a driver or for an engine
 *
 *   Text text;
 *   text_begin(&text, &(TextDesc){.language = TEXT_GLSL_330});
 *   text_include(&text, "shading/lobes/ggx.h");
 *   text_line(&text, "void main() { ... }");
 *   if (text_end(&text, &error) == WEFT_OK) use(text.bytes);
 *   text_free(&text);
 *
 * The texts are those of src/shading when the library was built. Included files replace their #include, once. Comments,
 * unless they are wanted, branches for C and macros are gone: tables of parameters become members, enumerations
 * constants. The Text has the origin of each of its lines. A failure stays in the Text: later calls do nothing, and
 * text_end returns it.
 *
 * A Text belongs to one thread at a time; two of them share nothing. */
#pragma once

#include "text/source/macro.h"
#include "weft/result.h"

typedef enum TextLanguage {
    TEXT_GLSL_330,    /* desktop OpenGL 3.3 core */
    TEXT_GLSL_ES_300, /* OpenGL ES 3.0, WebGL 2 */
    TEXT_GLSL_450,    /* Vulkan, through its compilers */
    TEXT_PLAIN        /* their common subset, without a first line: the source of other languages */
} TextLanguage;

/* Zero-initialise. */
typedef struct TextDesc {
    TextLanguage language;
    /* Declares the array texture weft_tables of shading/lobe/table.h: one float a texel, a layer a table. */
    bool tables;
    /* A folder whose files replace those of the library of the same name, such as shading/lobes/ggx.h below it. May be
     * NULL; must outlive the Text. */
    const char *folder;
    /* Comments stay. Between items of different files a comment, TEXT_FILE_MARK, names the second; the first such
     * comment of a file is followed by the file's opening comment, TEXT_HEAD_MARK. */
    bool comments;
    /* Tables in the first layers, which are not added again; the text's own follow. Borrowed for as long as the
     * Text. */
    const struct TextTable *before;
    int before_count;
    /* Engines' tables with more rows or columns are resampled to so many of both, for texts that contain their tables;
     * 0: as they are. */
    int table_side;
} TextDesc;

#define TEXT_FILE_MARK "/*@"
#define TEXT_HEAD_MARK "/*!"

/* A layer of weft_tables: `rows` rows of `columns` floats. Borrowed: it must live until it is uploaded. */
typedef struct TextTable {
    const float *texels;
    int rows, columns;
    const char *name; /* for people; may be NULL; borrowed too */
} TextTable;

enum { TEXT_TABLES_MAX = 32 };

typedef struct Text {
    const char *bytes; /* set by text_end; ends with a zero byte */
    size_t size;
    TextTable tables[TEXT_TABLES_MAX]; /* layers of weft_tables after those of `before` */
    int table_count;
    /* The rest is private. */
    TextDesc desc;
    Buffer buffer;
    Macros macros;
    struct TextName *included;
    struct TextName *headed; /* files whose opening comment is in the text */
    int depth;               /* files being included inside each other */
    bool gap;                /* a blank line is due */
    const char *marked;      /* file of the last TEXT_FILE_MARK; NULL: the caller's lines */
    WeftError error;
} Text;

/* Begins a text with the #version and precision lines. Call text_free afterwards, in any case. */
void text_begin(Text *text, const TextDesc *desc);

/* Appends a file of the catalogue ("shading/lobes/ggx.h") and the files that it includes, except those that the text
 * has. Fails with WEFT_MESSAGE_TEXT_NAME, or _TEXT_DIALECT with file and line if it is not shading text. */
void text_include(Text *text, const char *file);

/* Makes later includes of a file do nothing, since the caller's own lines replace it. Returns false if the text has the
 * file already. */
bool text_provide(Text *text, const char *file);

/* Appends lines of the caller's as though they were a file; its name, one of the catalogue, is borrowed. */
void text_source(Text *text, const char *file, const Buffer *bytes);

/* Define a macro with a body ("int", "4") for files that are appended later, and remove it. */
void text_define(Text *text, const char *name, const char *body);
void text_undefine(Text *text, const char *name);

/* Appends a line of the caller's, formatted as by printf. Macros are not expanded in it. */
__attribute__((format(printf, 2, 3))) void text_line(Text *text, const char *format, ...);

/* Adds a table and returns its layer, TableRef.texels of shading/lobe/table.h. Returns -1 and fails (WEFT_MESSAGE_DESC)
 * if there are TEXT_TABLES_MAX, with those before. */
int text_table(Text *text, TextTable table);

/* Returns the file and line from which a line of the text was made, both counted from 1; lines of a macro are those of
 * its call. The file is a name of the catalogue, with the folder before it if it was found there; NULL for lines of the
 * caller, and if there is no such line. Valid until text_free. */
Origin text_origin(const Text *text, int line);

/* Fails with "FILE:LINE: text of the message: what"; the file must not be NULL. */
WeftResult text_fail_at(Origin origin, WeftMessage message, const char *what, WeftError *error);

/* Sets text->bytes and size, or returns the first failure. */
WeftResult text_end(Text *text, WeftError *error);

void text_free(Text *text);
