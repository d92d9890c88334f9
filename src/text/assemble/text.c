#include "text/assemble/text.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "base/fail.h"
#include "base/file.h"
#include "text/assemble/catalogue.h"
#include "text/source/layout.h"
#include "text/source/reference.h"

typedef struct TextName {
    struct TextName *next;
    const char *name;
} TextName;

enum { CONDITIONS_MAX = 16, CONDITION_LIMIT = 1024, FILE_LIMIT = 1 << 20, INCLUDES_MAX = 32 };

/* The open #if lines at a place. */
typedef struct Conditions {
    int depth;
    Origin opened[CONDITIONS_MAX];
    bool on[CONDITIONS_MAX];    /* true if this branch and those around it are taken */
    bool spent[CONDITIONS_MAX]; /* true if no later branch may be taken */
} Conditions;

static bool failed(const Text *text) { return text->error.result != WEFT_OK; }

static void fail_memory(Text *text) {
    if (!failed(text)) fail(&text->error, WEFT_MESSAGE_MEMORY, "shader text", NULL);
}

WeftResult text_fail_at(Origin origin, WeftMessage message, const char *what, WeftError *error) {
    char place[200];
    size_t size = strlen(origin.file);
    const char *file = size < 180 ? origin.file : origin.file + size - 180; /* the line is not to be cut */
    snprintf(place, sizeof place, "%s:%d", file, origin.line);
    return fail(error, message, place, "%s", what);
}

/* Fails with the place that the text's buffer has reached. */
static void fail_dialect(Text *text, const char *what) {
    if (!failed(text)) text_fail_at(text->buffer.origin, WEFT_MESSAGE_TEXT_DIALECT, what, &text->error);
}

void text_define(Text *text, const char *name, const char *body) {
    Buffer line = {0};
    buffer_put_text(&line, name);
    buffer_put_text(&line, " ");
    buffer_put_text(&line, body);
    if (line.failed)
        fail_memory(text);
    else
        macro_define(&text->macros, line.bytes, line.size);
    buffer_free(&line);
}

void text_undefine(Text *text, const char *name) {
    macro_undefine(&text->macros, (Token){TOKEN_NAME, name, strlen(name)});
}

void text_begin(Text *text, const TextDesc *desc) {
    *text = (Text){.desc = *desc, .gap = true};
    switch (desc->language) {
    case TEXT_GLSL_330: text_line(text, "#version 330 core"); break;
    case TEXT_GLSL_ES_300: text_line(text, "#version 300 es\nprecision highp float;\nprecision highp int;"); break;
    case TEXT_GLSL_450: text_line(text, "#version 450"); break;
    case TEXT_PLAIN: break;
    }
    text_define(text, desc->language == TEXT_GLSL_ES_300 ? "GL_ES" : "GL_core_profile", "1");
    if (!desc->tables) return;
    text_line(text, "\n%suniform highp sampler2DArray weft_tables;",
              desc->language == TEXT_GLSL_450 ? "layout(set = 0, binding = 0) " : "");
}

/* Appends formatted text. */
static void put_line(Text *text, const char *format, va_list arguments) {
    va_list again;
    va_copy(again, arguments);
    text->buffer.origin = (Origin){0};
    int size = vsnprintf(NULL, 0, format, arguments);
    char *line = size < 0 ? NULL : alloc_array((size_t)size + 2, 1);
    if (line) {
        vsnprintf(line, (size_t)size + 1, format, again);
        line[size] = '\n';
        buffer_put(&text->buffer, line, (size_t)size + 1);
        free(line);
    } else {
        fail_memory(text);
    }
    va_end(again);
    text->gap = true;
}

void text_line(Text *text, const char *format, ...) {
    if (failed(text)) return;
    if (text->marked && !text->depth) buffer_put_text(&text->buffer, "\n" TEXT_FILE_MARK " - */\n");
    text->marked = NULL;
    va_list arguments;
    va_start(arguments, format);
    put_line(text, format, arguments);
    va_end(arguments);
}

/* Records that the text has a file. Returns false if it was recorded before, or on failure. */
static bool include_first(Text *text, const char *file) {
    if (failed(text)) return false;
    for (TextName *name = text->included; name; name = name->next)
        if (strcmp(name->name, file) == 0) return false;
    TextName *name = arena_array(&text->macros.arena, 1, sizeof *name);
    char *copy = arena_text(&text->macros.arena, file);
    if (!name || !copy) {
        fail_memory(text);
        return false;
    }
    *name = (TextName){text->included, copy};
    text->included = name;
    return true;
}

bool text_provide(Text *text, const char *file) { return include_first(text, file); }

/* Defines the names of types as macros: "typedef A B, C;" makes B and C names of A, "typedef enum A { ... } A;" makes A
 * a name of int. */
static void define_types(Text *text, const char *c, const char *end) {
    while (c < end) {
        if (!token_is(token_next(&c, end), "typedef")) continue;
        Token type = token_solid(&c, end), name = token_solid(&c, end);
        bool enumeration = token_is(type, "enum");
        for (; name.kind == TOKEN_NAME || token_is(name, ","); name = token_solid(&c, end)) {
            if (name.kind != TOKEN_NAME) continue;
            char line[256];
            int size = snprintf(line, sizeof line, "%.*s %.*s", (int)name.size, name.at,
                                enumeration ? 3 : (int)type.size, enumeration ? "int" : type.at);
            if (size > 0 && (size_t)size < sizeof line) macro_define(&text->macros, line, (size_t)size);
        }
    }
}

static void check_macros(Text *text) {
    if (text->macros.short_of_memory) fail_memory(text);
    if (*text->macros.wrong) fail_dialect(text, text->macros.wrong);
}

/* Marks where a file begins, with the comment at its top. */
static void put_head(Text *text, const char *file, const Buffer *source) {
    const char *stop = comment_end(source->bytes, source->bytes + source->size);
    text_line(text, TEXT_HEAD_MARK "%.*s", (int)(stop - source->bytes) - 2, source->bytes + 2);
    TextName *name = arena_array(&text->macros.arena, 1, sizeof *name);
    if (!name) {
        fail_memory(text);
        return;
    }
    *name = (TextName){text->headed, file};
    text->headed = name;
}

/* Writes a comment with the file of the next items, and before the first of them the file's opening comment. */
static void put_marks(Text *text, const char *file, const Buffer *source) {
    if (text->marked == file) return;
    bool first = source->bytes && is_comment(source->bytes, source->bytes + source->size);
    for (const TextName *name = text->headed; name; name = name->next) first &= name->name != file;
    text_line(text, "\n" TEXT_FILE_MARK " %s */", file);
    if (first) put_head(text, file, source);
    text->marked = file;
}

/* Writes the declarations between two directives of source. The expansion of a macro has the origin of its call. */
static void put_chunk(Text *text, const Buffer *source, const char *chunk, const char *end) {
    if (text->desc.comments && blank_end(chunk, end) < end) put_marks(text, buffer_origin(source, 0).file, source);
    define_types(text, chunk, end);
    Buffer expanded = {0};
    while (chunk < end && !expanded.failed && !*text->macros.wrong) {
        text->buffer.origin = expanded.origin = buffer_origin(source, (size_t)(chunk - source->bytes));
        macro_next(&text->macros, &chunk, end, &expanded);
    }
    if (expanded.failed) fail_memory(text);
    check_macros(text);
    Buffer glsl = {0};
    if (!failed(text) && expanded.bytes) reference_put(&expanded, &glsl);
    if (glsl.failed) fail_memory(text);
    if (!failed(text) && glsl.bytes) {
        const char *wrong = layout_put(&glsl, &text->gap, &text->buffer);
        if (wrong) fail_dialect(text, wrong);
    }
    buffer_free(&glsl);
    buffer_free(&expanded);
}

/* Writes a #define of a number as a constant. Returns false if it is another #define. */
static bool put_constant(Text *text, const char *c, const char *end) {
    Token name = token_solid(&c, end);
    if (c < end && *c == '(') return false;
    const char *value = c;
    Token sign = token_solid(&c, end), number = token_is(sign, "-") ? token_next(&c, end) : sign;
    if (number.kind != TOKEN_NUMBER || token_solid(&c, end).kind != TOKEN_NONE) return false;
    bool hex = number.size > 1 && (number.at[1] == 'x' || number.at[1] == 'X'), real = false;
    for (size_t k = 0; k < number.size; k++) real |= !hex && strchr(".eEf", number.at[k]) != NULL;
    while (is_blank(*value)) value++;
    if (text->gap && text->buffer.size) buffer_put(&text->buffer, "\n", 1);
    text->gap = false;
    buffer_put_text(&text->buffer, real ? "const float " : "const int ");
    buffer_put(&text->buffer, name.at, name.size);
    buffer_put_text(&text->buffer, " = ");
    buffer_put(&text->buffer, value, (size_t)(number.at + number.size - value));
    buffer_put_text(&text->buffer, ";\n");
    return true;
}

static bool condition_or(Text *text, const char **c, const char *end);

static bool condition_one(Text *text, const char **c, const char *end) {
    Token token = token_solid(c, end);
    if (token_is(token, "!")) return !condition_one(text, c, end);
    if (token.kind == TOKEN_NUMBER) return !token_is(token, "0");
    if (token_is(token, "(")) {
        bool inner = condition_or(text, c, end);
        if (!token_is(token_solid(c, end), ")")) fail_dialect(text, "an #if without its parenthesis");
        return inner;
    }
    if (token_is(token, "defined")) {
        Token name = token_solid(c, end);
        bool parenthesis = token_is(name, "(");
        if (parenthesis) name = token_solid(c, end);
        if (parenthesis) token_solid(c, end);
        return macro_defined(&text->macros, name);
    }
    fail_dialect(text, "an #if of more than defined, !, && and ||");
    return false;
}

/* Takes "&&" or "||" where it comes next. */
static bool take_pair(const char **cursor, const char *end, const char *mark) {
    const char *c = *cursor;
    if (!token_is(token_solid(&c, end), mark) || !token_is(token_next(&c, end), mark)) return false;
    *cursor = c;
    return true;
}

static bool condition_and(Text *text, const char **c, const char *end) {
    bool all = condition_one(text, c, end);
    while (take_pair(c, end, "&")) all &= condition_one(text, c, end);
    return all;
}

static bool condition_or(Text *text, const char **c, const char *end) {
    bool any = condition_and(text, c, end);
    while (take_pair(c, end, "|")) any |= condition_and(text, c, end);
    return any;
}

/* Evaluates the condition of a whole #if line. */
static bool condition(Text *text, const char *c, const char *end) {
    bool any = end - c < CONDITION_LIMIT && condition_or(text, &c, end);
    if (token_solid(&c, end).kind != TOKEN_NONE) fail_dialect(text, "an #if of more than defined, !, && and ||");
    return any;
}

/* Includes the file of #include "name": from src/, or from the including file's folder if the name has none. */
static void include_line(Text *text, const char *file, const char *c, const char *end) {
    Token name = token_solid(&c, end);
    if (name.kind != TOKEN_STRING || name.size < 3) {
        fail_dialect(text, "includes a header of C");
        return;
    }
    char path[256];
    const char *slash = memchr(name.at, '/', name.size) ? NULL : strrchr(file, '/');
    snprintf(path, sizeof path, "%.*s%.*s", slash ? (int)(slash + 1 - file) : 0, file, (int)name.size - 2, name.at + 1);
    text_include(text, path);
}

static bool is_on(const Conditions *conditions) {
    return conditions->depth == 0 || conditions->on[conditions->depth - 1];
}

/* Takes #if, #ifdef, #ifndef, #elif, #else and #endif. Returns false for other directives. */
static bool take_condition(Text *text, Token word, const char *c, const char *end, Conditions *conditions) {
    bool negative = token_is(word, "ifndef"), defined = negative || token_is(word, "ifdef");
    if (defined || token_is(word, "if")) {
        if (conditions->depth == CONDITIONS_MAX) {
            fail_dialect(text, "too many #if inside each other");
            return true;
        }
        bool outer = is_on(conditions);
        bool taken = outer && (defined ? macro_defined(&text->macros, token_solid(&c, end)) != negative
                                       : condition(text, c, end));
        conditions->opened[conditions->depth] = text->buffer.origin;
        conditions->on[conditions->depth] = taken;
        conditions->spent[conditions->depth++] = taken || !outer;
        return true;
    }
    bool otherwise = token_is(word, "else"), elif = token_is(word, "elif"), close = token_is(word, "endif");
    if (!otherwise && !elif && !close) return false;
    if (conditions->depth == 0) {
        fail_dialect(text, "an #else or #endif without its #if");
        return true;
    }
    int at = conditions->depth - 1;
    if (close)
        conditions->depth = at;
    else if ((conditions->on[at] = !conditions->spent[at] && (otherwise || condition(text, c, end))))
        conditions->spent[at] = true;
    return true;
}

/* Takes a directive; c is after its "#". */
static void take_directive(Text *text, const char *file, const char *c, const char *end, Conditions *conditions) {
    Token word = token_solid(&c, end);
    if (take_condition(text, word, c, end, conditions) || !is_on(conditions)) return;
    if (token_is(word, "include")) {
        include_line(text, file, c, end);
    } else if (token_is(word, "define")) {
        if (!put_constant(text, c, end)) macro_define(&text->macros, c, (size_t)(end - c));
    } else if (token_is(word, "undef")) {
        macro_undefine(&text->macros, token_solid(&c, end));
    } else if (!token_is(word, "pragma") ||
               !token_is(token_solid(&c, end), "once")) { /* a file is included once anyway */
        fail_dialect(text, "a directive that shading text does not have");
    }
}

static const char *line_end(const char *c, const char *end) {
    while (c < end && (*c != '\n' || c[-1] == '\\')) c++;
    return c;
}

/* Writes a file, whose source has no comments. */
static void put_file(Text *text, const char *file, const Buffer *source) {
    Conditions conditions = {0};
    const char *chunk = source->bytes, *end = chunk + source->size;
    text->gap = true;
    for (const char *line = chunk, *next; line < end && !failed(text); line = next) {
        const char *hash = line;
        while (hash < end && (*hash == ' ' || *hash == '\t')) hash++;
        if (hash == end || *hash != '#') {
            while (hash < end && *hash != '\n') hash++;
            next = hash < end ? hash + 1 : end;
            continue;
        }
        const char *stop = line_end(hash, end);
        next = stop < end ? stop + 1 : end;
        if (is_on(&conditions)) put_chunk(text, source, chunk, line);
        text->buffer.origin = buffer_origin(source, (size_t)(hash - source->bytes));
        if (!failed(text)) take_directive(text, file, hash + 1, stop, &conditions);
        check_macros(text);
        chunk = next;
    }
    if (is_on(&conditions) && !failed(text)) put_chunk(text, source, chunk, end);
    if (conditions.depth) {
        text->buffer.origin = conditions.opened[conditions.depth - 1];
        fail_dialect(text, "an #if without its #endif");
    }
    text->gap = true;
}

typedef struct Source {
    const char *path; /* the path shown to people */
    const char *bytes, *end;
    unsigned char *own; /* owned, may be NULL */
} Source;

static void fail_missing(Text *text, const char *file) {
    char what[300];
    snprintf(what, sizeof what, "includes %s, which does not exist", file);
    if (text->depth)
        fail_dialect(text, what);
    else
        fail(&text->error, WEFT_MESSAGE_TEXT_NAME, file, NULL);
}

/* Finds a file in the folder, else in the library. Returns false on failure. */
static bool find_file(Text *text, const char *file, Source *out) {
    char path[1024];
    struct stat status;
    FileBytes read;
    if (text->desc.folder && (size_t)snprintf(path, sizeof path, "%s/%s", text->desc.folder, file) < sizeof path &&
        (stat(path, &status) == 0 || (errno != ENOENT && errno != ENOTDIR))) {
        if (file_read(path, FILE_LIMIT, &read, &text->error) != WEFT_OK) return false;
        const char *bytes = (const char *)read.data;
        *out = (Source){arena_text(&text->macros.arena, path), bytes, bytes + read.size, read.data};
        if (!out->path) fail_memory(text);
        return true;
    }
    CatalogueFile found;
    if (!catalogue_find(file, &found)) {
        fail_missing(text, file);
        return false;
    }
    *out = (Source){found.name, found.bytes, found.end, NULL};
    return true;
}

static void put_source(Text *text, const char *file, const Source *source) {
    Buffer stripped = {.origin = {source->path, 1}};
    text->buffer.origin = stripped.origin;
    layout_strip(source->bytes, source->end, text->desc.comments, &stripped);
    text->depth++;
    if (stripped.failed)
        fail_memory(text);
    else if (stripped.bytes && !failed(text))
        put_file(text, file, &stripped);
    text->depth--;
    buffer_free(&stripped);
}

void text_include(Text *text, const char *file) {
    if (!include_first(text, file)) return;
    if (text->depth == INCLUDES_MAX) {
        fail(&text->error, WEFT_MESSAGE_TEXT_DIALECT, file, "too many files inside each other");
        return;
    }
    Source source;
    if (!find_file(text, file, &source)) return;
    put_source(text, file, &source);
    free(source.own);
}

void text_source(Text *text, const char *file, const Buffer *bytes) {
    if (bytes->failed) fail_memory(text);
    if (failed(text) || !bytes->bytes) return;
    put_source(text, file, &(Source){file, bytes->bytes, bytes->bytes + bytes->size, NULL});
}

int text_table(Text *text, TextTable table) {
    if (failed(text)) return -1;
    const TextDesc *desc = &text->desc;
    for (int k = 0; k < desc->before_count; k++)
        if (desc->before[k].texels == table.texels && desc->before[k].rows == table.rows &&
            desc->before[k].columns == table.columns)
            return k;
    if (desc->before_count + text->table_count == TEXT_TABLES_MAX) {
        fail(&text->error, WEFT_MESSAGE_DESC, "shader text", "more than %d tables", TEXT_TABLES_MAX);
        return -1;
    }
    text->tables[text->table_count] = table;
    return desc->before_count + text->table_count++;
}

WeftResult text_end(Text *text, WeftError *error) {
    if (text->buffer.failed || text->macros.short_of_memory) fail_memory(text);
    if (failed(text)) {
        if (error) *error = text->error;
        return text->error.result;
    }
    text->bytes = text->buffer.bytes;
    text->size = text->buffer.size;
    return WEFT_OK;
}

Origin text_origin(const Text *text, int line) {
    const char *c = text->buffer.bytes;
    while (c && --line > 0) c = (c = strchr(c, '\n')) ? c + 1 : NULL;
    if (!c || !*c || line < 0) return (Origin){0};
    while (*c == ' ') c++;
    return buffer_origin(&text->buffer, (size_t)(c - text->buffer.bytes));
}

void text_free(Text *text) {
    buffer_free(&text->buffer);
    arena_free(&text->macros.arena);
    *text = (Text){0};
}
