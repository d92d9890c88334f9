/* macro.h - the macros of shading text, defined and expanded as C does: tables of rows, token pasting, calls
 * in arguments. Not there, since no table needs it: variable arguments, and a call whose name and parenthesis
 * come from different macros. */
#ifndef WEFT_TEXT_MACRO_H
#define WEFT_TEXT_MACRO_H

#include "base/memory.h"
#include "text/source/buffer.h"
#include "text/source/token.h"

/* Zero-initialise; release with arena_free(&macros->arena). */
typedef struct Macros {
    Arena arena;
    struct Macro *newest;
    bool short_of_memory;
    int depth, steps; /* calls inside each other now; expansions so far */
    size_t bytes;     /* of what macros stood for so far */
    char wrong[96];   /* what cannot be a macro or a call; empty while all is well */
} Macros;

/* Takes what follows "#define", which may run over several lines. A later definition wins. */
void macro_define(Macros *macros, const char *definition, size_t size);

void macro_undefine(Macros *macros, Token name);
bool macro_defined(const Macros *macros, Token name);

/* Takes one token from [*source, end), or the call that it begins, and appends what that stands for. */
void macro_next(Macros *macros, const char **source, const char *end, Buffer *out);

/* Appends [source, end) with every macro expanded. */
void macro_expand(Macros *macros, const char *source, const char *end, Buffer *out);

#endif
