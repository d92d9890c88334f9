/* splice.h - a list of edits of a text */
#pragma once

#include "text/source/buffer.h"

/* Replaces [at, end) of the text by a piece of `words`. */
typedef struct Edit {
    const char *at, *end;
    size_t from, size; /* of the words */
    bool dropped;      /* with the blanks before it, or the whole line if it has nothing else */
} Edit;

/* Zero-initialise. */
typedef struct Edits {
    Edit *all;
    size_t count, capacity;
    Buffer words;
    bool failed; /* memory ran out */
} Edits;

/* Adds an edit that replaces [at, end) by `with`, or removes it if that is NULL. */
void edit_put(Edits *edits, const char *at, const char *end, const char *with);

/* Adds an edit that removes a statement with a comment after it, and the line if that has nothing else. */
void edit_drop(Edits *edits, const char *at, const char *end);

/* Appends the text with its edits, without edits inside others, and frees them. Returns false, and appends nothing, if
 * there are none. */
bool edits_apply(Edits *edits, const char *text, Buffer *out);
