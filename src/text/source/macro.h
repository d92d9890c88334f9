/* macro.h - the macros of shading text, defined and expanded as in C: tables of rows, token pasting, calls in arguments
 *
 * DOES NOT: have variable arguments, or calls whose name and parenthesis come from different macros; none is needed. */
#pragma once

#include "base/memory.h"
#include "text/source/buffer.h"
#include "text/source/token.h"

/* Zero-initialise; release with arena_free(&macros->arena). */
typedef struct Macros {
    Arena arena;
    struct Macro *newest;
    bool short_of_memory;
    int depth;      /* nested calls now */
    int steps;      /* expansions so far */
    size_t bytes;   /* of expanded text so far */
    char wrong[96]; /* message on the first bad definition or call; empty without one */
} Macros;

/* Defines a macro from the text after "#define", which may have several lines. A later definition wins. */
void macro_define(Macros *macros, const char *definition, size_t size);

void macro_undefine(Macros *macros, Token name);
bool macro_defined(const Macros *macros, Token name);

/* Takes one token from [*source, end), or the call that it begins, and appends its expansion. */
void macro_next(Macros *macros, const char **source, const char *end, Buffer *out);

/* Appends [source, end) with every macro expanded. */
void macro_expand(Macros *macros, const char *source, const char *end, Buffer *out);
